// `mansard completion SHELL`: a script for the shell, made of what the verbs take.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "apps/cli/exit.hpp"
#include "apps/cli/grammar.hpp"
#include "apps/cli/verbs.hpp"

namespace mansard::cli {
namespace {

auto joined(const std::vector<std::string>& words, const char* between = " ") -> std::string {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : between) + word;
  return all;
}

auto replaced(std::string text, std::string_view what, std::string_view by) -> std::string {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

// ---- bash

/// What bash does for the word after an option, or in an argument's place.
auto bash_action(const Term& term) -> std::string {
  switch (term.takes) {
    case Takes::nothing: return "";
    case Takes::text: return ":";
    case Takes::words: return "_mansard_words '" + joined(term.words) + "'";
    case Takes::path: return "_mansard_paths -f";
    case Takes::folder: return "_mansard_paths -d";
  }
  return "";
}

/// Options that mean the same for every verb that has them get one line, the others one per verb.
auto bash_values(const std::vector<Form>& forms) -> std::string {
  std::map<std::string, std::map<std::string, std::vector<std::string>>> by_action;  // option, action, verbs
  for (const auto& form : forms)
    for (const auto& term : form.options)
      if (term.needs_value || term.takes == Takes::words)
        for (const auto& name : term.names) by_action[name][bash_action(term)].push_back(form.verb);
  std::map<std::string, std::vector<std::string>> patterns;  // action, patterns
  for (const auto& [name, actions] : by_action)
    for (const auto& [action, verbs] : actions)
      for (const auto& verb : actions.size() == 1 ? std::vector<std::string>{"*"} : verbs)
        patterns[action].push_back(verb + ":" + name);
  std::string text;
  for (const auto& [action, all] : patterns)
    text += "    " + joined(all, " | ") + ")\n      " + action + "\n      return ;;\n";
  return text;
}

auto bash(const std::vector<Form>& forms) -> std::string {
  std::string text = R"(# bash completion of mansard, made by 'mansard completion bash'
_mansard_words() {
  COMPREPLY=($(compgen -W "$1" -- "$word"))
}
_mansard_paths() {
  local IFS=$'\n'
  compopt -o filenames 2> /dev/null
  COMPREPLY=($(compgen "$1" -- "$word"))
}
_mansard() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb=${COMP_WORDS[1]}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    _mansard_words ')";
  for (const auto& form : forms) text += form.verb + " ";
  text += "--help --version'\n    return\n  fi\n  case $verb:$before in\n" + bash_values(forms) +
          "  esac\n  case $verb in\n";
  for (const auto& form : forms) {
    std::vector<std::string> names;
    for (const auto& term : form.options) names.insert(names.end(), term.names.begin(), term.names.end());
    text += "    " + form.verb + ")\n      if [[ $word == -* ]]; then\n        _mansard_words '" + joined(names) +
            "'\n        return\n      fi\n";
    // Arguments of several kinds stand one after the other; where any of them is a path, paths are offered.
    const auto paths = std::ranges::find_if(
        form.arguments, [](const auto& term) { return term.takes == Takes::path || term.takes == Takes::folder; });
    const auto words = std::ranges::find(form.arguments, Takes::words, &Term::takes);
    if (words != form.arguments.end())
      text += "      if ((COMP_CWORD == 2)); then\n        " + bash_action(*words) + "\n        return\n      fi\n";
    if (paths != form.arguments.end()) text += "      " + bash_action(*paths) + "\n";
    text += "      ;;\n";
  }
  return text + "  esac\n}\ncomplete -F _mansard mansard\n";
}

// ---- zsh

auto zsh_quoted(const std::string& text) -> std::string { return replaced(text, "'", "'\\''"); }

/// A description within [ ] of a spec, or a message between colons.
auto zsh_text(const std::string& text) -> std::string {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return zsh_quoted(out);
}

auto zsh_action(const Term& term) -> std::string {
  switch (term.takes) {
    case Takes::nothing: return "";
    case Takes::text: return "";
    case Takes::words: return "(" + joined(term.words) + ")";
    case Takes::path: return "_files";
    case Takes::folder: return "_files -/";
  }
  return "";
}

auto zsh(const std::vector<Form>& forms) -> std::string {
  std::string text =
      "#compdef mansard\n# zsh completion of mansard, made by 'mansard completion zsh'\n_mansard() {\n"
      "  if (( CURRENT == 2 )); then\n    local -a verbs=(\n";
  for (const auto& form : forms) text += "      '" + form.verb + ":" + zsh_text(form.meaning) + "'\n";
  text +=
      "      '--help:Show the verbs' '--version:Show the version'\n    )\n    _describe verb verbs\n    return\n  fi\n"
      "  local verb=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $verb in\n";
  for (const auto& form : forms) {
    text += "    " + form.verb + ")\n      _arguments -s";
    for (const auto& term : form.options)
      for (const auto& name : term.names) {
        // Names of one option exclude each other; one value after another of several is a message of its own.
        text += " \\\n        '(" + joined(term.names) + ")" + name + "[" + zsh_text(term.meaning) + "]";
        for (std::size_t i = 0; i < term.values; ++i)
          text += std::string(term.needs_value ? ":" : "::") + zsh_text(term.value.empty() ? "value" : term.value) +
                  ":" + zsh_action(term);
        text += "'";
      }
    for (const auto& term : form.arguments) {
      const std::string message = ":" + zsh_text(term.value) + ":" + zsh_action(term) + "'";
      text += " \\\n        '" + (term.values > 1 ? "*" + message : ":" + message.substr(1));
    }
    text += "\n      ;;\n";
  }
  return text +
         "  esac\n}\nif [[ $funcstack[1] == _mansard ]]; then\n  _mansard \"$@\"\nelse\n  compdef _mansard "
         "mansard\nfi\n";
}

// ---- fish

auto fish_quoted(const std::string& text) -> std::string {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

auto fish_value(const Term& term) -> std::string {
  if (term.takes == Takes::words) return (term.needs_value ? " -x -a " : " -f -a ") + fish_quoted(joined(term.words));
  if (term.takes == Takes::folder) return " -x -a '(__fish_complete_directories)'";
  return term.takes == Takes::path ? " -r -F" : term.needs_value ? " -x" : "";
}

auto fish(const std::vector<Form>& forms) -> std::string {
  std::string text = "# fish completion of mansard, made by 'mansard completion fish'\n";
  for (const auto* word : {"help", "version"})
    text += std::string("complete -c mansard -n __fish_use_subcommand -f -l ") + word + "\n";
  for (const auto& form : forms)
    text +=
        "complete -c mansard -n __fish_use_subcommand -f -a " + form.verb + " -d " + fish_quoted(form.meaning) + "\n";
  for (const auto& form : forms) {
    const std::string start = "complete -c mansard -n '__fish_seen_subcommand_from " + form.verb + "'";
    for (const auto& term : form.options) {
      text += start;
      for (const auto& name : term.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      text += fish_value(term) + " -d " + fish_quoted(term.meaning) + "\n";
    }
    const bool paths = std::ranges::any_of(
        form.arguments, [](const auto& term) { return term.takes == Takes::path || term.takes == Takes::folder; });
    if (!paths) text += start + " -f\n";
    for (const auto& term : form.arguments)
      if (term.takes == Takes::words) text += start + " -a " + fish_quoted(joined(term.words)) + "\n";
  }
  return text;
}

}  // namespace

auto completion_verb(CLI::App& app) -> Verb {
  auto* verb =
      app.add_subcommand("completion", "Print a script that completes verbs, options and their values in a shell");
  auto shell = std::make_shared<std::string>();
  verb->add_option("SHELL", *shell, "bash, zsh or fish")->required();
  return {verb, [shell, &app] {
            const std::map<std::string, std::function<std::string(const std::vector<Form>&)>> shells{
                {"bash", bash}, {"zsh", zsh}, {"fish", fish}};
            const auto at = shells.find(*shell);
            if (at == shells.end())
              return give_up(base::error("usage", "there are completions for bash, zsh and fish", *shell));
            std::fputs(at->second(forms_of(app)).c_str(), stdout);
            return static_cast<int>(all_done);
          }};
}

}  // namespace mansard::cli
