#include "apps/cli/grammar.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "apps/cli/exit.hpp"
#include "apps/cli/settings.hpp"
#include "lab/explore/explore.hpp"
#include "lab/simulate/simulate.hpp"

namespace mansard::cli {
namespace {

using Words = std::vector<std::string>;

template <class Presets>
auto names_of(const Presets& presets) -> Words {
  Words names;
  for (const auto& preset : presets) names.push_back(preset.name);
  return names;
}

/// The words that CLI11 does not know: by option, and where verbs differ by "verb option".
auto choices() -> std::map<std::string, Words> {
  std::map<std::string, Words> all;
  pipeline::Options pipeline;
  simulate::Options simulate;
  auto lists = pipeline::option_lists(pipeline);
  lists.push_back(simulate::option_list(simulate));
  for (const auto& list : lists)
    for (const auto& option : list.options()) {
      const bool flag = option.kind == base::Option::Kind::flag;
      if (option.kind == base::Option::Kind::choice || flag)
        all["--" + dashed(list.module() + "-" + option.name)] = flag ? Words{"true", "false"} : option.choices;
    }
  all["--preset"] = names_of(pipeline::presets());
  all["simulate --preset"] = names_of(simulate::presets());
  for (const auto kind : {simulate::Kind::terrace, simulate::Kind::perimeter, simulate::Kind::courtyard,
                          simulate::Kind::towers, simulate::Kind::detached})
    all["simulate --block"].emplace_back(simulate::to_string(kind));
  all["explore EXPERIMENT"] = explore::experiment_names();
  for (const auto& code : all_codes()) all["explain CODE"].push_back(code.code);
  for (const auto& format : formats::formats()) all["convert --to"].emplace_back(format.name);
  all["completion SHELL"] = {"bash", "zsh", "fish"};
  return all;
}

/// By what the value is called.
auto takes_of(std::string_view value) -> Takes {
  static constexpr std::array paths{"FILE", "LIST", "MODEL", "MESH", "FOOTPRINTS", "REPORT", "OUT", "PLAN"};
  if (value.empty()) return Takes::nothing;
  if (value.find("DIR") != value.npos || value.starts_with("PROJECT")) return Takes::folder;
  return std::ranges::any_of(paths, [&](std::string_view word) { return value.starts_with(word); }) ? Takes::path
                                                                                                    : Takes::text;
}

auto term_of(const CLI::Option& option, const std::string& verb, const std::map<std::string, Words>& known) -> Term {
  Term term;
  for (const auto& name : option.get_lnames()) term.names.push_back("--" + name);
  for (const auto& name : option.get_snames()) term.names.push_back("-" + name);
  term.meaning = option.get_description();
  if (option.get_group() != "Options") term.room = option.get_group();
  term.required = option.get_required();
  const bool flag = option.get_items_expected_max() == 0;
  const std::string own = option.nonpositional() ? "" : option.get_name(true);
  if (!flag) {
    term.values = static_cast<std::size_t>(std::max(1, option.get_items_expected_max()));
    term.needs_value = option.get_items_expected_min() > 0;
    // A validator's range follows the name of the value after a colon.
    const auto type = option.get_type_name();
    term.value = type.substr(0, type.find(':'));
    if (term.value.empty() || term.value == "TEXT") term.value = own.empty() ? "TEXT" : own;
    if (term.value == "UINT" || term.value == "INT") term.value = "N";
    if (term.value == "FLOAT") term.value = "X";
    term.takes = takes_of(term.value);
  }
  for (const auto& key : {verb + " " + (own.empty() ? term.names.front() : own), own.empty() ? term.names.front() : ""})
    if (const auto at = known.find(key); at != known.end()) {
      term.takes = Takes::words;
      term.words = at->second;
      if (!term.needs_value) term.value = "";
      break;
    }
  return term;
}

}  // namespace

auto forms_of(const CLI::App& app) -> std::vector<Form> {
  const auto known = choices();
  std::vector<Form> forms;
  for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    Form form{verb->get_name(), verb->get_description(), {}, {}};
    for (const auto* option : verb->get_options()) {
      auto term = term_of(*option, form.verb, known);
      (option->nonpositional() ? form.options : form.arguments).push_back(std::move(term));
    }
    forms.push_back(std::move(form));
  }
  return forms;
}

}  // namespace mansard::cli
