#include "apps/cli/settings.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/shell_word.hpp"
#include "mansard/base/bound_text.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/attribute_choice.hpp"
#include "mansard/formats/levels.hpp"

namespace mansard::cli {
namespace {

auto in_one_line(const std::vector<std::string>& words) -> std::string {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : " ") + word;
  return all;
}

/// A TOML value as the text an option takes: arrays become words separated by spaces.
auto text_of(const toml::node& node) -> std::optional<std::string> {
  if (const auto* value = node.as_string()) return value->get();
  if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
  if (const auto* value = node.as_integer()) return std::to_string(value->get());
  if (const auto* value = node.as_floating_point()) return base::to_text(value->get());
  if (const auto* array = node.as_array()) {
    std::vector<std::string> words;
    for (const auto& entry : *array) {
      auto word = text_of(entry);
      if (!word) return std::nullopt;
      words.push_back(std::move(*word));
    }
    return in_one_line(words);
  }
  return std::nullopt;
}

auto names_of(const std::vector<pipeline::Preset>& presets) -> std::string {
  std::string all;
  for (const auto& preset : presets) all += (all.empty() ? "" : ", ") + preset.name;
  return all;
}

void append(std::vector<base::Diagnostic>& all, const base::Result<void>& done, const std::string& where = "") {
  if (done) return;
  for (auto why : done.errors()) {
    if (!where.empty()) why.subject = where;
    all.push_back(std::move(why));
  }
}

auto result_of(std::vector<base::Diagnostic> wrong) -> base::Result<void> {
  if (wrong.empty()) return {};
  return base::Failure{std::move(wrong)};
}

auto apply_preset(Menu& menu, const std::string& name) -> base::Result<void> {
  for (const auto& preset : menu.presets) {
    if (preset.name != name) continue;
    for (const auto& [key, value] : preset.values)
      if (auto set = pipeline::set_option(menu.lists, key, value); !set) return set;
    return {};
  }
  return base::error("option-value", "unknown preset '" + name + "'; expected " + names_of(menu.presets), "--preset");
}

/// The keys of one table. `at` names the file.
void apply_table(Menu& menu, const std::string& module, const toml::table& keys, const std::string& at,
                 std::vector<base::Diagnostic>& wrong) {
  for (const auto& [key, value] : keys) {
    const std::string name = module + "." + std::string(key.str());
    const auto word = text_of(value);
    if (!word)
      wrong.push_back(base::error("config", "'" + name + "' has a value of the wrong type; see 'mansard options'", at));
    else append(wrong, pipeline::set_option(menu.lists, name, *word), at + ": " + name);
  }
}

auto apply_config(Menu& menu, const std::string& path) -> base::Result<void> {
  const auto text = base::read_file(path);
  if (!text) return text.failure();
  toml::table table;
  try {
    table = toml::parse(*text);
  } catch (const toml::parse_error& e) {
    const auto at = e.source().begin;
    return base::error("config", std::string(e.description()) + " (line " + std::to_string(at.line) + ")", path);
  }
  // The preset comes first wherever it is in the file, so that the file's own keys change it.
  if (const auto* preset = table.get("preset")) {
    const auto name = text_of(*preset);
    if (auto done = apply_preset(menu, name.value_or("")); !done) return done;
  }
  std::vector<base::Diagnostic> wrong;
  for (const auto& [module, node] : table) {
    if (module.str() == "preset") continue;
    if (const auto* keys = node.as_table()) apply_table(menu, std::string(module.str()), *keys, path, wrong);
    else
      wrong.push_back(base::error("config",
                                  "'" + std::string(module.str()) +
                                      "' is outside a table; write [MODULE] and the options of that module below it",
                                  path));
  }
  return result_of(std::move(wrong));
}

auto menu_of(pipeline::Options& options) -> Menu { return {pipeline::option_lists(options), pipeline::presets()}; }

/// Whether the preset changes an option of one of the modules.
auto concerns(const pipeline::Preset& preset, const std::vector<std::string>& modules) -> bool {
  return std::ranges::any_of(preset.values, [&](const auto& value) {
    return std::ranges::find(modules, value.first.substr(0, value.first.find('.'))) != modules.end();
  });
}

}  // namespace

auto dashed(std::string text) -> std::string {
  std::ranges::replace(text, '_', '-');
  return text;
}

auto range_text(const base::Option& option) -> std::string {
  const auto& [minimum, maximum] = option.range;
  if (std::isfinite(minimum) && std::isfinite(maximum))
    return base::bound_text(minimum) + " to " + base::bound_text(maximum);
  if (std::isfinite(minimum)) return "at least " + base::bound_text(minimum);
  return std::isfinite(maximum) ? "at most " + base::bound_text(maximum) : "";
}

void Settings::add_to(CLI::App& verb) {
  pipeline::Options defaults;
  add_to(verb, menu_of(defaults));
}

void Settings::add_to(CLI::App& verb, const Menu& menu) {
  const auto& modules = entry_of(verb.get_name()).modules;
  verb.add_option("--config", config_, "Read options from a TOML file, a table for each module")->type_name("FILE");
  if (std::ranges::any_of(menu.presets, [&](const auto& preset) { return concerns(preset, modules); }))
    verb.add_option("--preset", preset_, "Start from a set of values: " + names_of(menu.presets))->type_name("NAME");
  for (const auto& list : menu.lists)
    if (std::ranges::find(modules, list.module()) != modules.end()) add_list(verb, list);
}

void Settings::add_list(CLI::App& verb, const base::OptionList& list) {
  for (const auto& option : list.options()) {
    auto& given = given_.emplace_back();
    given.key = list.module() + "." + option.name;
    std::string names = "--" + dashed(list.module() + "-" + option.name);
    if (!option.alias.empty()) names += ",--" + dashed(option.alias);
    // Vectors of numbers (an offset, a box) are texts of several words.
    const std::size_t words = option.kind == base::Option::Kind::string
                                  ? static_cast<std::size_t>(std::ranges::count(option.get(), ' ')) + 1
                                  : 1;
    given.flag = option.kind == base::Option::Kind::flag;
    given.option = verb.add_option(names, given.words, option.meaning);
    if (words > 1) given.option->delimiter(',');  // XMIN,YMIN,XMAX,YMAX, as other tools have it, is the same
    given.option->expected(given.flag ? 0 : static_cast<int>(words), static_cast<int>(words));
    given.option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->group(list.module())->allow_extra_args(false);
    if (given.flag) given.option->default_str("");  // what it is without a word; CLI11 would give the empty list's text
    static constexpr std::array kinds{"", "N", "X", "TEXT", "WORD"};
    given.option->type_name(words == 3   ? "X Y Z"
                            : words == 4 ? "XMIN YMIN XMAX YMAX"
                                         : kinds[static_cast<std::size_t>(option.kind)]);
  }
}

namespace {

/// Options of `write` that are lists of names are read where files are written: too late to tell that one is wrong.
auto check_lists(const std::vector<base::OptionList>& lists) -> base::Result<void> {
  for (const auto& list : lists) {
    if (list.module() != "write") continue;
    if (const auto* names = list.find("attributes"))
      if (auto choice = formats::AttributeChoice::of(names->get()); !choice) return choice.failure();
    if (const auto* levels = list.find("lod"))
      if (auto known = formats::check_lods(levels->get()); !known) return known;
  }
  return {};
}

}  // namespace

auto Settings::apply(pipeline::Options& options) const -> base::Result<void> { return apply(menu_of(options)); }

auto Settings::apply(Menu menu) const -> base::Result<void> {
  std::vector<base::Diagnostic> wrong;
  if (!preset_.empty()) append(wrong, apply_preset(menu, preset_));
  if (!config_.empty()) append(wrong, apply_config(menu, config_));
  for (const auto& given : given_) {
    if (given.option->count() == 0) continue;
    const auto typed = given.option->get_name();
    const auto words = static_cast<std::size_t>(std::max(1, given.option->get_items_expected_max()));
    if (const auto times = given.option->count() / words; !given.flag && times > 1) {
      wrong.push_back(base::error("option-value", "is given " + std::to_string(times) + " times; give it once", typed));
      continue;
    }
    const std::string value = given.flag && in_one_line(given.words).empty() ? "true" : in_one_line(given.words);
    append(wrong, pipeline::set_option(menu.lists, given.key, value), typed);
  }
  if (wrong.empty()) append(wrong, check_lists(menu.lists));
  return result_of(std::move(wrong));
}

auto Settings::typed(const std::vector<std::string>& without) const -> std::string {
  std::string all;
  if (!preset_.empty()) all += " --preset " + quoted(preset_);
  if (!config_.empty()) all += " --config " + quoted(config_);
  for (const auto& given : given_) {
    if (given.option->count() == 0 || std::ranges::find(without, given.key) != without.end()) continue;
    all += " --" + given.option->get_lnames().back();  // the short name, where it has two
    for (const auto& word : given.words) all += " " + quoted(word);
  }
  return all;
}

}  // namespace mansard::cli
