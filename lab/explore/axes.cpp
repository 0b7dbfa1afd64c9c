// What is varied: axes from text, the experiments' own, their product.
#include <algorithm>
#include <array>

#include "lab/explore/explore.hpp"
#include "mansard/base/text.hpp"

namespace mansard::explore {
namespace {

constexpr std::array names{"alpha-beta", "quality", "gamma", "datasets", "profiles", "table", "grid"};

auto split(std::string_view text, char by) -> std::vector<std::string> {
  std::vector<std::string> words;
  for (;;) {
    const auto end = text.find(by);
    words.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return words;
    text.remove_prefix(end + 1);
  }
}

/// The key of an option by any of its names.
auto key_of(std::string name, std::vector<base::OptionList>& lists) -> base::Result<std::string> {
  name.erase(0, std::min(name.find_first_not_of('-'), name.size()));
  std::ranges::replace(name, '-', '_');
  std::vector<std::string> known;
  for (const auto& list : lists)
    for (const auto& option : list.options()) {
      std::string alias = option.alias;
      std::ranges::replace(alias, '-', '_');
      const std::string key = list.module() + "." + option.name;
      if (name == key || name == list.module() + "_" + option.name || (!alias.empty() && name == alias)) return key;
      known.push_back(key);
      if (!alias.empty()) known.push_back(alias);
    }
  return base::error(
      "option-unknown",
      "there is no such option" + base::did_you_mean(base::nearest_word(name, known)) + "; see 'mansard options'",
      name);
}

auto own_axes(Experiment experiment) -> std::vector<Axis> {
  switch (experiment) {
    case Experiment::alpha_beta:
      return {{"segment.alpha", {"0", "20", "40", "80", "160"}}, {"segment.beta", {"0", "30", "60", "120", "240"}}};
    case Experiment::quality: return {{"profile.quality", {"simple", "moderate", "high"}}};
    case Experiment::gamma: return {{"sweep.gamma", {"10", "20", "30", "40", "50", "60", "70", "80", "90"}}};
    case Experiment::datasets:
    case Experiment::profiles:
    case Experiment::table:
    case Experiment::grid: return {};
  }
  return {};
}

}  // namespace

auto to_string(Experiment experiment) -> std::string_view { return names[static_cast<std::size_t>(experiment)]; }

auto experiment_of(std::string_view name) -> std::optional<Experiment> {
  const auto at = std::ranges::find(names, name);
  if (at == names.end()) return std::nullopt;
  return static_cast<Experiment>(at - names.begin());
}

auto experiment_names() -> std::vector<std::string> { return {names.begin(), names.end()}; }

auto axis_of(std::string_view text) -> base::Result<Axis> {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0)
    return base::error("explore-axis", "this is no axis; write an option, '=' and its values, as in 'gamma=10,20,40'",
                       std::string(text));
  pipeline::Options options;
  auto lists = pipeline::option_lists(options);
  auto key = key_of(std::string(text.substr(0, equals)), lists);
  if (!key) return key.error();
  Axis axis{std::move(*key), split(text.substr(equals + 1), ',')};
  if (axis.key.starts_with("ingest."))
    return base::error("explore-axis",
                       "options of ingest cannot be varied, because the scan is read once; run the experiment again",
                       axis.key);
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    if (std::find(axis.values.begin(), axis.values.begin() + static_cast<std::ptrdiff_t>(i), axis.values[i]) !=
        axis.values.begin() + static_cast<std::ptrdiff_t>(i))
      return base::error("explore-axis", "the value '" + axis.values[i] + "' is given twice; give it once", axis.key);
    if (auto set = pipeline::set_option(lists, axis.key, axis.values[i]); !set) return set.error();
  }
  return axis;
}

auto axes_of(Experiment experiment, const std::vector<Axis>& asked) -> base::Result<std::vector<Axis>> {
  for (std::size_t i = 0; i < asked.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (asked[i].key == asked[j].key)
        return base::error("explore-axis", "it is given twice; put all its values into one --grid", asked[i].key);
  if (experiment == Experiment::grid) {
    if (asked.empty())
      return base::error("explore-axis", "there is nothing to vary; say --grid key=a,b,c, once per option");
    return asked;
  }
  auto axes = own_axes(experiment);
  for (const auto& axis : asked) {
    const auto own = std::ranges::find(axes, axis.key, &Axis::key);
    if (own == axes.end())
      return base::error("explore-axis",
                         "the experiment '" + std::string(to_string(experiment)) +
                             "' does not vary this; use the experiment 'grid', or set it as an option",
                         axis.key);
    *own = axis;
  }
  return axes;
}

auto settings_of(const std::vector<Axis>& axes, std::size_t most) -> base::Result<std::vector<Setting>> {
  std::vector<Setting> all{{}};
  for (const auto& axis : axes) {
    if (all.size() * axis.values.size() > most)
      return base::error("explore-runs",
                         "the axes make more than " + std::to_string(most) +
                             " settings; give fewer values, or allow more with --most-runs",
                         axis.key);
    std::vector<Setting> next;
    for (const auto& setting : all)
      for (const auto& value : axis.values) {
        next.push_back(setting);
        next.back().emplace_back(axis.key, value);
      }
    all = std::move(next);
  }
  return all;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"explore-axis", "What is to be varied could not be understood, or this experiment does not vary it.",
       "An axis is an option and its values: --grid gamma=10,20,40. 'mansard options' lists the options; those of "
       "ingest "
       "cannot be varied.",
       4},
      {"explore-runs", "The experiment asks for more runs than is allowed.",
       "Give fewer values, or allow more with --most-runs.", 4},
      {"explore-list", "The list of datasets is not TOML, or an entry of it lacks something or has something unknown.",
       "An entry is [[dataset]] with name, meshes, footprints, and options if need be; see tools/datasets.toml.", 4},
  };
}

}  // namespace mansard::explore
