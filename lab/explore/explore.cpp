// The steps of an experiment: every scan, every setting, a row each.
#include "lab/explore/explore.hpp"

#include <algorithm>

#include "lab/explore/detail/measure.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/crs/globe.hpp"

namespace mansard::explore {
namespace {

/// Whatever is wrong with the request, before any work.
auto checked(const Request& request) -> base::Result<std::vector<Setting>> {
  if (request.datasets.empty()) return base::error("explore-list", "there is no dataset; give one at least");
  auto settings = settings_of(request.axes, request.most_runs);
  if (!settings) return settings;
  if (settings->size() * request.datasets.size() > request.most_runs)
    return base::error("explore-runs", std::to_string(request.datasets.size()) + " datasets with " +
                                           std::to_string(settings->size()) + " settings each are more than " +
                                           std::to_string(request.most_runs) +
                                           " runs; give fewer, or allow more with --most-runs");
  for (const auto& dataset : request.datasets) {
    const auto options = detail::with(request.options, dataset.options);
    if (!options) return options.error();
    for (const auto& setting : *settings)
      if (const auto set = detail::with(*options, setting); !set) return set.error();
  }
  return settings;
}

auto info_of(const Dataset& dataset, const model::Scene& scene) -> DatasetInfo {
  DatasetInfo info{dataset, scene.inputs, scene.frame.crs, {}, {}, {}};
  for (const auto& footprint : scene.footprints)
    info.footprints.insert(info.footprints.end(), footprint.polygons.begin(), footprint.polygons.end());
  if (info.footprints.empty()) return info;
  const auto box = geometry::bounds(info.footprints);
  const geometry::Point2 middle = 0.5 * (box.least + box.most);
  info.centre = {middle.x + static_cast<double>(scene.frame.origin[0]),
                 middle.y + static_cast<double>(scene.frame.origin[1])};
  const auto globe = crs::Globe::of(scene.frame);
  std::vector<geometry::Point3> at{{middle.x, middle.y, 0}};
  if (globe && *globe && (*globe)->to_angles(at)) info.angles = {at.front().x, at.front().y};
  return info;
}

auto failed(std::size_t dataset, const base::Diagnostic& why) -> Row {
  Row row;
  row.dataset = dataset;
  row.failure = why;
  return row;
}

/// Progress of the whole from the progress of one run.
auto part_of(const base::Run& run, const std::string& name, double before, double share, std::uint64_t seed)
    -> base::Run {
  base::Run inner = run;
  inner.seed = seed;
  if (run.progress)
    inner.progress = [&run, name, before, share](auto stage, auto, double fraction) {
      run.progress(stage, name, before + share * fraction);
    };
  return inner;
}

auto told(const Dataset& dataset, const Setting& setting) -> std::string {
  std::string text = dataset.name;
  for (const auto& [key, value] : setting) text += " " + key + "=" + value;
  return text;
}

}  // namespace

auto investigate(const Request& request, const base::Run& run) -> base::Result<Study> {
  const auto settings = checked(request);
  if (!settings) return settings.error();
  Study study{
      request.experiment, request.axes, {}, {}, detail::values_of(request.options), detail::quoted(request.command),
      request.version};
  const double share = 1.0 / static_cast<double>(request.datasets.size() * settings->size());
  std::optional<base::Diagnostic> unread;
  for (std::size_t d = 0; d < request.datasets.size(); ++d) {
    const auto& dataset = request.datasets[d];
    const auto options = *detail::with(request.options, dataset.options);
    const auto scene = ingest::read_scene(dataset.meshes, dataset.footprints, options.ingest, run);
    if (run.cancelled()) return base::stopped();
    if (!scene) {
      unread = scene.error();
      study.datasets.push_back({dataset, {}, {}, {}, {}, {}});
      study.rows.push_back(failed(d, *unread));
      continue;
    }
    study.datasets.push_back(info_of(dataset, *scene));
    for (std::size_t s = 0; s < settings->size(); ++s) {
      const auto& setting = (*settings)[s];
      const auto set = *detail::with(options, setting);
      const std::size_t number = d * settings->size() + s;
      const auto inner = part_of(run, told(dataset, setting), share * static_cast<double>(number), share,
                                 static_cast<std::uint64_t>(set.seed));
      Row row = detail::measure(*scene, set, request, number + 1, inner);
      if (run.cancelled()) return base::stopped();
      row.dataset = d;
      row.setting = setting;
      row.command = detail::command_of(dataset, set);
      study.rows.push_back(std::move(row));
    }
  }
  const bool any_read = std::ranges::any_of(study.datasets, [](const auto& d) { return !d.inputs.empty(); });
  if (!any_read) return *unread;
  return study;
}

}  // namespace mansard::explore
