#include "apps/cli/grammar.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "apps/cli/exit.hpp"
#include "apps/cli/layout.hpp"
#include "apps/cli/settings.hpp"
#include "lab/explore/explore.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/base/text.hpp"
#include "mansard/compare/compare.hpp"

namespace mansard::cli {
namespace {

using Words = std::vector<std::string>;

template <class Presets>
auto names_of(const Presets& presets) -> Words {
  Words names;
  for (const auto& preset : presets) names.push_back(preset.name);
  return names;
}

/// What CLI11 does not know: the words of a verb's own options by option, and where verbs differ by "verb option"; and
/// the options of the modules.
struct KnownWords {
  std::map<std::string, Words> words;
  pipeline::Options pipeline;
  compare::Options compare;
  simulate::Options simulate;
  std::vector<base::OptionList> lists = pipeline::option_lists(pipeline);

  KnownWords() {
    lists.push_back(compare::option_list(compare));
    lists.push_back(simulate::option_list(simulate));
    words["--preset"] = names_of(pipeline::presets());
    words["simulate --preset"] = names_of(simulate::presets());
    for (const auto kind : {simulate::Kind::terrace, simulate::Kind::perimeter, simulate::Kind::courtyard,
                            simulate::Kind::towers, simulate::Kind::detached})
      words["simulate --block"].emplace_back(simulate::to_string(kind));
    words["explore EXPERIMENT"] = explore::experiment_names();
    for (const auto& code : all_codes()) words["explain CODE"].push_back(code.code);
    for (const auto& format : formats::formats()) words["--formats"].emplace_back(format.name);
    words["convert --to"] = words["--formats"];
    words["--formats"].emplace_back("all");
    words["completion SHELL"] = {"bash", "zsh", "fish"};
  }
  KnownWords(const KnownWords&) = delete;  // the lists are bound to the members
  auto operator=(const KnownWords&) -> KnownWords& = delete;

  [[nodiscard]] auto option(const std::string& module, const std::string& name) const -> const base::Option* {
    for (const auto& list : lists)
      if (list.module() == module)
        for (const auto& option : list.options())
          if ("--" + dashed(module + "-" + option.name) == name) return &option;
    return nullptr;
  }
};

/// By what the value is called.
auto takes_of(std::string_view value) -> Takes {
  static constexpr std::array paths{"FILE", "LIST", "MODEL", "MESH", "FOOTPRINTS", "REPORT", "OUT", "PLAN"};
  if (value.empty()) return Takes::nothing;
  if (value.find("DIR") != value.npos || value.starts_with("PROJECT")) return Takes::folder;
  return std::ranges::any_of(paths, [&](std::string_view word) { return value.starts_with(word); }) ? Takes::path
                                                                                                    : Takes::text;
}

/// A validator's "[0 - 10]" as "0 to 10".
auto range_of(const std::string& validator) -> std::string {
  const auto from = validator.find(" in ["), end = validator.find(']', from);
  if (from == std::string::npos || end == std::string::npos) return "";
  std::string range = validator.substr(from + 5, end - from - 5);
  if (const auto dash = range.find(" - "); dash != std::string::npos) range.replace(dash, 3, " to ");
  return range;
}

void add_value(const CLI::Option& option, const std::string& own, Term& term) {
  term.values = static_cast<std::size_t>(std::max(1, option.get_items_expected_max()));
  term.needs_value = option.get_items_expected_min() > 0;
  // A validator's range follows the name of the value after a colon.
  const auto type = option.get_type_name();
  const auto colon = type.find(':');
  term.value = type.substr(0, colon);
  if (colon != std::string::npos) term.range = range_of(type.substr(colon));
  if (term.value.empty() || term.value == "TEXT") term.value = own.empty() ? "TEXT" : own;
  if (term.value == "UINT" || term.value == "INT") term.value = "N";
  if (term.value == "FLOAT") term.value = "X";
  term.takes = takes_of(term.value);
  // Of lists CLI11 has "[]".
  if (const auto initial = option.get_default_str(); !initial.starts_with('[')) term.initial = initial;
}

void add_module_option(const base::Option& option, Term& term) {
  term.unit = option.unit;
  term.range = range_text(option);
  term.initial = option.get();
  term.advanced = option.advanced;
  const bool flag = option.kind == base::Option::Kind::flag;
  if (option.kind != base::Option::Kind::choice && !flag) return;
  term.takes = Takes::words;
  term.words = flag ? Words{"true", "false"} : option.choices;
  if (!term.needs_value) term.value = "";
}

auto term_of(const CLI::Option& option, const std::string& verb, const KnownWords& known) -> Term {
  Term term;
  for (const auto& name : option.get_lnames()) term.names.push_back("--" + name);
  for (const auto& name : option.get_snames()) term.names.push_back("-" + name);
  term.meaning = option.get_description();
  if (option.get_group() != "Options") term.module = option.get_group();
  term.required = option.get_required();
  const std::string own = option.nonpositional() ? "" : option.get_name(true);
  if (option.get_items_expected_max() > 0) add_value(option, own, term);
  if (!term.module.empty()) {
    if (const auto* of_module = known.option(term.module, term.names.front())) add_module_option(*of_module, term);
    return term;
  }
  for (const auto& key : {verb + " " + (own.empty() ? term.names.front() : own), own.empty() ? term.names.front() : ""})
    if (const auto at = known.words.find(key); at != known.words.end()) {
      term.takes = Takes::words;
      term.words = at->second;
      break;
    }
  return term;
}

auto form_with(const CLI::App& verb, const KnownWords& known) -> Form {
  Form form{verb.get_name(), verb.get_description(), {}, {}};
  for (const auto* option : verb.get_options()) {
    auto term = term_of(*option, form.verb, known);
    (option->nonpositional() ? form.options : form.arguments).push_back(std::move(term));
  }
  return form;
}

/// The text without what is in parentheses.
auto without_details(std::string text) -> std::string {
  for (std::size_t from = 0; (from = text.find(" (", from)) != std::string::npos;) {
    const auto end = text.find(')', from);
    if (end == std::string::npos) break;
    text.erase(from, end + 1 - from);
  }
  return text;
}

}  // namespace

auto forms_of(const CLI::App& app) -> std::vector<Form> {
  const KnownWords known;
  std::vector<Form> forms;
  for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    forms.push_back(form_with(*verb, known));
  return forms;
}

auto form_of(const CLI::App& verb) -> Form { return form_with(verb, KnownWords()); }

auto explained(const Term& term, bool full) -> std::string {
  std::vector<std::string> notes;
  const bool few = term.takes == Takes::words && term.needs_value && term.words.size() <= 12;
  const auto missing = [&](const std::string& word) { return term.meaning.find(word) == std::string::npos; };
  if (full && few && std::ranges::any_of(term.words, missing)) notes.push_back(listed(term.words, "or"));
  if (!term.unit.empty()) notes.push_back(term.unit);
  if (full && !term.range.empty()) notes.push_back(term.range);
  if (!term.initial.empty()) notes.push_back("default " + term.initial);
  std::string text;
  for (const auto& note : notes) text += (text.empty() ? "" : "; ") + note;
  const bool own = term.module.empty();
  return (own && !full ? without_details(term.meaning) : term.meaning) + (text.empty() ? "" : " [" + text + "]");
}

}  // namespace mansard::cli
