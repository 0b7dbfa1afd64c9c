#include "apps/cli/settings.hpp"

#include <toml++/toml.h>
#include <algorithm>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"

namespace mansard::cli {
namespace {

auto joined(const std::vector<std::string>& words) -> std::string {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : " ") + word;
  return all;
}

auto describe(const base::Option& option) -> std::string {
  std::string text = option.meaning;
  if (!option.unit.empty()) text += " [" + option.unit + "]";
  if (option.kind == base::Option::Kind::choice) {
    text += " (";
    for (const auto& word : option.choices) text += (word == option.choices.front() ? "" : ", ") + word;
    text += ")";
  }
  const std::string value = option.get();
  return text + (value.empty() ? "" : " default " + value);
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
    return joined(words);
  }
  return std::nullopt;
}

auto names_of(const std::vector<pipeline::Preset>& presets) -> std::string {
  std::string all;
  for (const auto& preset : presets) all += (all.empty() ? "" : ", ") + preset.name;
  return all;
}

auto apply_preset(Menu& menu, const std::string& name) -> base::Result<void> {
  for (const auto& preset : menu.presets) {
    if (preset.name != name) continue;
    for (const auto& [key, value] : preset.values)
      if (auto set = pipeline::set_option(menu.lists, key, value); !set) return set.error();
    return {};
  }
  return base::error("option-value", "'" + name + "' is no preset; there are " + names_of(menu.presets), "preset");
}

auto apply_config(Menu& menu, const std::string& path) -> base::Result<void> {
  const auto text = base::read_file(path);
  if (!text) return text.error();
  toml::table table;
  try {
    table = toml::parse(*text);
  } catch (const toml::parse_error& e) {
    const auto at = e.source().begin;
    return base::error("config", std::string(e.description()) + " (line " + std::to_string(at.line) + ")", path);
  }
  // The preset comes first wherever it stands in the file, so that the file's own keys change it.
  if (const auto* preset = table.get("preset")) {
    const auto name = text_of(*preset);
    if (auto done = apply_preset(menu, name.value_or("")); !done) return done;
  }
  for (const auto& [room, node] : table) {
    if (room.str() == "preset") continue;
    const auto* keys = node.as_table();
    if (keys == nullptr)
      return base::error(
          "config", "'" + std::string(room.str()) + "' is not a room's table; write [room] and its keys below", path);
    for (const auto& [key, value] : *keys) {
      const std::string name = std::string(room.str()) + "." + std::string(key.str());
      const auto word = text_of(value);
      if (!word) return base::error("config", "'" + name + "' has a value of the wrong kind", path);
      if (auto done = pipeline::set_option(menu.lists, name, *word); !done) {
        auto why = done.error();
        why.subject = path + ": " + why.subject;
        return why;
      }
    }
  }
  return {};
}

auto menu_of(pipeline::Options& options) -> Menu { return {pipeline::option_lists(options), pipeline::presets()}; }

}  // namespace

auto dashed(std::string text) -> std::string {
  std::ranges::replace(text, '_', '-');
  return text;
}

void Settings::add_to(CLI::App& verb) {
  pipeline::Options defaults;
  add_to(verb, menu_of(defaults));
}

void Settings::add_to(CLI::App& verb, const Menu& menu) {
  verb.add_option("--config", config_, "Options from a TOML file, a table per room")->type_name("FILE");
  verb.add_option("--preset", preset_, "Start from a preset: " + names_of(menu.presets))->type_name("NAME");
  for (const auto& list : menu.lists)
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
      given.option = verb.add_option(names, given.words, describe(option));
      given.option->expected(given.flag ? 0 : static_cast<int>(words), static_cast<int>(words));
      given.option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->group(list.module())->allow_extra_args(false);
      static constexpr std::array kinds{"", "N", "X", "TEXT", "WORD"};
      given.option->type_name(kinds[static_cast<std::size_t>(option.kind)]);
    }
}

auto Settings::apply(pipeline::Options& options) const -> base::Result<void> { return apply(menu_of(options)); }

auto Settings::apply(Menu menu) const -> base::Result<void> {
  if (!preset_.empty())
    if (auto done = apply_preset(menu, preset_); !done) return done;
  if (!config_.empty())
    if (auto done = apply_config(menu, config_); !done) return done;
  for (const auto& given : given_) {
    if (given.option->count() == 0) continue;
    const auto words = static_cast<std::size_t>(std::max(1, given.option->get_items_expected_max()));
    if (const auto times = given.option->count() / words; !given.flag && times > 1)
      return base::error("option-value", "it is given " + std::to_string(times) + " times; give it once", given.key);
    const std::string value = given.flag && joined(given.words).empty() ? "true" : joined(given.words);
    if (auto done = pipeline::set_option(menu.lists, given.key, value); !done) return done;
  }
  return {};
}

auto Settings::names(const CLI::App& verb) -> std::vector<std::string> {
  std::vector<std::string> all;
  for (const auto* option : verb.get_options())
    for (const auto& name : option->get_lnames()) all.push_back("--" + name);
  return all;
}

}  // namespace mansard::cli
