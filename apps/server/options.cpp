#include "apps/server/options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "apps/server/formats.hpp"

namespace mansard::server {
namespace {

constexpr std::array<std::string_view, 4> input_modules{"ingest", "cloud", "derive", "block"};
/// Modules that have options but no part in a run.
constexpr std::array<std::string_view, 2> other_modules{"roof", "texture"};

constexpr std::array kind_names{"boolean", "integer", "number", "string", "choice"};

auto is_one_of(std::string_view module, const auto& modules) -> bool {
  return std::ranges::find(modules, module) != modules.end();
}

auto finite_or_null(double value) -> Json { return std::isfinite(value) ? Json(value) : Json(nullptr); }

auto used_in(std::string_view module) -> std::string_view {
  if (is_one_of(module, input_modules)) return "inputs";
  return is_one_of(module, other_modules) ? "other" : "runs";
}

auto json_of(const base::Option& option, const std::string& module) -> Json {
  return {{"module", module},
          {"name", option.name},
          {"used_in", used_in(module)},
          {"kind", kind_names[static_cast<std::size_t>(option.kind)]},
          {"unit", option.unit},
          {"minimum", finite_or_null(option.range.minimum)},
          {"maximum", finite_or_null(option.range.maximum)},
          {"choices", option.choices},
          {"default", option.get()},
          {"alias", option.alias},
          {"meaning", option.meaning},
          {"source", option.source},
          {"advanced", option.advanced}};
}

}  // namespace

auto set_all(pipeline::Options& options, const Texts& values) -> base::Result<void> {
  auto lists = pipeline::option_lists(options);
  for (const auto& [key, value] : values)
    if (auto set = pipeline::set_option(lists, key, value); !set) return set;
  return {};
}

auto differing(pipeline::Options options) -> Texts {
  pipeline::Options defaults;
  const auto own = pipeline::option_lists(options), usual = pipeline::option_lists(defaults);
  Texts out;
  for (std::size_t l = 0; l < own.size(); ++l)
    for (std::size_t o = 0; o < own[l].options().size(); ++o) {
      const auto value = own[l].options()[o].get();
      if (value != usual[l].options()[o].get()) out[own[l].module() + "." + own[l].options()[o].name] = value;
    }
  return out;
}

auto is_input_option(const std::string& key) -> bool {
  const auto dot = key.find('.');
  return dot != std::string::npos && is_one_of(std::string_view(key).substr(0, dot), input_modules);
}

auto run_options(const RunRequest& request, const Texts& reading) -> base::Result<pipeline::Options> {
  pipeline::Options options;
  if (auto set = set_all(options, reading); !set) return set.error();
  if (!request.preset.empty()) {
    const auto& presets = pipeline::presets();
    const auto preset = std::ranges::find(presets, request.preset, &pipeline::Preset::name);
    if (preset == presets.end())
      return base::error("option-value", "unknown preset '" + request.preset + "'; /api/options lists the presets",
                         request.preset);
    if (auto set = set_all(options, {preset->values.begin(), preset->values.end()}); !set) return set.error();
  }
  for (const auto& [key, value] : request.options)
    if (is_input_option(key))
      return base::error("option-value",
                         "this option says how the inputs are read; a run cannot change it: read the inputs again "
                         "with it",
                         key);
  if (auto set = set_all(options, request.options); !set) return set.error();
  return options;
}

auto options_json() -> Json {
  pipeline::Options defaults;
  Json options = Json::array(), presets = Json::array();
  for (const auto& list : pipeline::option_lists(defaults))
    for (const auto& option : list.options()) options.push_back(json_of(option, list.module()));
  for (const auto& preset : pipeline::presets()) {
    Json values = Json::object();
    for (const auto& [key, value] : preset.values) values[key] = value;
    presets.push_back({{"name", preset.name}, {"meaning", preset.meaning}, {"values", values}});
  }
  return {{"options", std::move(options)},
          {"presets", std::move(presets)},
          {"formats", formats_json()},
          {"compressed_extensions", compressed_extensions_json()}};
}

}  // namespace mansard::server
