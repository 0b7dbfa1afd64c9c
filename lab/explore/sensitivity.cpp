#include "lab/explore/sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

#include "lab/explore/detail/measure.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/documents.hpp"

namespace mansard::explore {
namespace {

auto trial_of(std::string dataset, std::string key, std::string value) -> Trial {
  Trial trial;
  trial.dataset = std::move(dataset), trial.key = std::move(key), trial.value = std::move(value);
  return trial;
}

/// Those that a reconstruction from meshes and footprints decides by. Options of `ingest` are for reading the scan
/// once, those of `evaluate` are the measure itself.
constexpr std::array<std::string_view, 10> modules{"block",   "slice",   "sweep",  "fracture", "segment",
                                                   "profile", "extrude", "refine", "label",    "pipeline"};

auto matches(std::string_view pattern, const std::string& module, const base::Option& option) -> bool {
  if (pattern.ends_with(".*")) return pattern.substr(0, pattern.size() - 2) == module;
  return pattern == module + "." + option.name || (!option.alias.empty() && pattern == option.alias);
}

/// The values to try, without the present one and each once.
auto values_for(const base::Option& option) -> std::vector<std::string> {
  using Kind = base::Option::Kind;
  const std::string now = option.get();
  std::vector<std::string> values;
  const auto add = [&](const std::string& value) {
    if (value != now && std::ranges::find(values, value) == values.end()) values.push_back(value);
  };
  if (option.kind == Kind::flag || option.kind == Kind::choice)
    for (const auto& value : option.choices) add(value);
  const auto number = base::to_number(now);
  if (!number || (option.kind != Kind::number && option.kind != Kind::integer)) return values;
  for (const double factor : {0.5, 2.0}) {
    const double value = std::clamp(factor * *number, option.range.minimum, option.range.maximum);
    add(option.kind == Kind::integer ? base::to_text(std::floor(value), 0) : base::to_text(value));
  }
  return values;
}

/// FNV-1a: enough to tell models apart that are not made to deceive.
auto digest_of(std::string_view bytes) -> std::string {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[(hash >> shift) & 15U];
  return text;
}

auto models_of(model::City city) -> base::Result<std::string> {
  city.made_by = {};
  const auto text = formats::cityjson(city);
  if (!text) return text.error();
  return digest_of(*text);
}

auto trial_of(const model::Scene& scene, const pipeline::Options& options, Trial trial, const base::Run& run) -> Trial {
  const auto result = pipeline::reconstruct(scene, options, run);
  if (!result) {
    trial.failure = base::to_string(result.error());
    return trial;
  }
  trial.rmse = std::sqrt(result->scores.footprint_mse);
  trial.rmse_inside = std::sqrt(result->scores.inside.mse);
  for (const auto& building : result->city.buildings)
    for (const auto& part : building.parts) {
      ++trial.parts;
      trial.faces += part.model.solid.faces.size();
    }
  trial.cpu_seconds = result->times.total.cpu_seconds;
  const auto models = models_of(result->city);
  if (models) trial.models = *models;
  else trial.failure = base::to_string(models.error());
  return trial;
}

auto relative(double value, double usual) -> double {
  if (value == usual) return 0;
  return std::abs(value - usual) / std::max(std::abs(usual), 1e-9);
}

auto effect_on(const Trial& trial, const Trial& usual) -> double {
  if (!trial.failure.empty() || !usual.failure.empty()) return 0;
  return std::max({relative(trial.rmse, usual.rmse), relative(trial.rmse_inside, usual.rmse_inside),
                   relative(static_cast<double>(trial.faces), static_cast<double>(usual.faces))});
}

auto present_values(pipeline::Options options) -> std::map<std::string, std::string> {
  std::map<std::string, std::string> values;
  for (const auto& list : pipeline::option_lists(options))
    for (const auto& option : list.options()) values[list.module() + "." + option.name] = option.get();
  return values;
}

/// The run that others are compared with first, then every parameter at every value.
auto settings_of(const std::vector<Axis>& parameters) -> std::vector<std::pair<std::string, std::string>> {
  std::vector<std::pair<std::string, std::string>> settings{{"", ""}};
  for (const auto& axis : parameters)
    for (const auto& value : axis.values) settings.emplace_back(axis.key, value);
  return settings;
}

}  // namespace

auto parameters_of(const std::vector<std::string>& patterns, const pipeline::Options& options)
    -> base::Result<std::vector<Axis>> {
  pipeline::Options copy = options;
  std::vector<bool> used(patterns.size(), false);
  std::vector<Axis> axes;
  for (const auto& list : pipeline::option_lists(copy))
    for (const auto& option : list.options()) {
      bool wanted = patterns.empty() && std::ranges::find(modules, list.module()) != modules.end();
      for (std::size_t i = 0; i < patterns.size(); ++i)
        if (matches(patterns[i], list.module(), option)) wanted = used[i] = true;
      auto values = wanted && list.module() != "ingest" ? values_for(option) : std::vector<std::string>();
      if (!values.empty()) axes.push_back({list.module() + "." + option.name, std::move(values)});
    }
  for (std::size_t i = 0; i < patterns.size(); ++i)
    if (!used[i])
      return base::error("explore-axis", "no parameter has this name; give module.name or module.*", patterns[i]);
  return axes;
}

auto effects_of(const std::vector<Trial>& usual, const std::vector<Trial>& trials, const std::vector<Axis>& parameters,
                const pipeline::Options& options) -> std::vector<Effect> {
  std::map<std::tuple<std::string, std::string, std::string>, const Trial*> found;
  for (const auto& trial : trials) found[{trial.dataset, trial.key, trial.value}] = &trial;
  const auto present = present_values(options);
  std::map<std::string, double> of_parameter;
  std::vector<Effect> effects;
  for (const auto& axis : parameters)
    for (const auto& value : axis.values) {
      Effect effect{axis.key, value, present.at(axis.key), {}, 0, true};
      for (const auto& base : usual) {
        const auto at = found.find({base.dataset, axis.key, value});
        effect.trials.push_back(at != found.end() ? *at->second : trial_of(base.dataset, axis.key, value));
        const Trial& trial = effect.trials.back();
        effect.largest = std::max(effect.largest, effect_on(trial, base));
        effect.none = effect.none && trial.failure.empty() && base.failure.empty() && trial.models == base.models;
      }
      of_parameter[axis.key] = std::max(of_parameter[axis.key], effect.largest);
      effects.push_back(std::move(effect));
    }
  std::ranges::stable_sort(effects,
                           [&](const Effect& a, const Effect& b) { return of_parameter[a.key] > of_parameter[b.key]; });
  return effects;
}

auto sensitivity(const SensitivityRequest& request, const base::Run& run) -> base::Result<Sensitivity> {
  const auto settings = settings_of(request.parameters);
  std::map<std::tuple<std::string, std::string, std::string>, Trial> known;
  for (const auto& trial : request.known) known[{trial.dataset, trial.key, trial.value}] = trial;
  std::mutex lock;
  std::size_t done = 0;
  const std::size_t all = settings.size() * request.datasets.size();
  const auto finished = [&](const Trial& trial, bool is_new) {
    const std::scoped_lock guard(lock);
    if (is_new && request.on_done) request.on_done(trial);
    run.report("sensitivity", trial.dataset + (trial.key.empty() ? "" : " " + trial.key + " = " + trial.value),
               static_cast<double>(++done) / static_cast<double>(all));
  };
  std::vector<Trial> usual, trials;
  for (const auto& dataset : request.datasets) {
    auto options = detail::with(request.options, dataset.options);
    if (!options) return options.error();
    const auto scene = ingest::read_scene(dataset.meshes, dataset.footprints, options->ingest, run);
    if (run.cancelled()) return base::error("cancelled", "stopped on request");
    if (!scene) return scene.error();
    std::vector<Trial> own(settings.size());
    base::Run inner{run.cancel, nullptr, static_cast<std::uint64_t>(options->seed)};
    base::parallel_for(settings.size(), [&](std::size_t i) {
      const auto& [key, value] = settings[i];
      own[i] = trial_of(dataset.name, key, value);
      if (run.cancelled()) return;
      if (const auto at = known.find({dataset.name, key, value}); at != known.end()) {
        own[i] = at->second;
        return finished(own[i], false);
      }
      const auto set = key.empty() ? options : detail::with(*options, {{key, value}});
      base::Run seeded = inner;
      if (set) seeded.seed = static_cast<std::uint64_t>(set->seed);
      if (!set) own[i].failure = base::to_string(set.error());
      else own[i] = trial_of(*scene, *set, own[i], seeded);
      if (!run.cancelled()) finished(own[i], true);
    });
    if (run.cancelled()) return base::error("cancelled", "stopped on request");
    usual.push_back(own.front());
    trials.insert(trials.end(), own.begin() + 1, own.end());
  }
  auto effects = effects_of(usual, trials, request.parameters, request.options);
  return Sensitivity{std::move(usual), std::move(effects), detail::quoted(request.command), request.version};
}

}  // namespace mansard::explore
