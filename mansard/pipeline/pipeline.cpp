// The steps of a reconstruction, a call each.
#include "mansard/pipeline/pipeline.hpp"

#include <algorithm>
#include <functional>

#include "mansard/base/stopped.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/decided.hpp"
#include "mansard/pipeline/detail/every_block.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"
#include "mansard/pipeline/detail/place.hpp"
#include "mansard/pipeline/detail/shown.hpp"

namespace mansard::pipeline {

auto reconstruct(const model::Scene& scene, const Options& options, const base::Run& run, Keep keep,
                 std::span<const std::string> only, const Schedule& schedule) -> base::Result<report::Reconstruction> {
  base::Watch watch;
  auto division = detail::divide(scene, options, run);
  if (!division) return division.error();
  if (auto known = detail::keep_only(*division, only); !known) return known.error();
  detail::Maker maker(options, keep, schedule);
  maker.announce(*division);
  auto results = detail::for_every(*division, run, std::ref(maker));
  if (run.cancelled()) return base::stopped();
  auto reuse = maker.finish(only.empty());
  if (!reuse) return reuse.failure();

  report::Reconstruction out;
  out.reuse = std::move(*reuse);
  out.city.frame = scene.frame;
  out.city.made_by = detail::made_by(scene, options);
  std::vector<std::optional<detail::Finished>> finished(scene.footprints.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    auto& result = results[i];
    for (auto& [feature, one] : detail::finish_block(scene, result, options, out.warnings))
      if (feature < finished.size()) finished[feature] = std::move(one);
    out.blocks.push_back(std::move(result.report));
    out.error_maps.push_back(std::move(result.map));
    if (result.segmented) out.segmented.push_back(std::move(*result.segmented));
  }
  for (std::size_t f = 0; f < finished.size(); ++f) {
    auto& made = finished[f];
    if (!made && !only.empty()) continue;
    if (!made) made = detail::unbuilt(scene, f, options);
    out.city.buildings.push_back(std::move(made->building));
    out.buildings.push_back(std::move(made->report));
  }
  out.scores = detail::combined_scores(out.blocks);
  detail::report_overlaps(out, run);
  if (run.cancelled()) return base::stopped();
  out.times = {watch.stop(), detail::stage_times(division->time, out.blocks)};
  return out;
}

auto segment(const model::Scene& scene, const Options& options, const base::Run& run)
    -> base::Result<report::Segmented> {
  base::Watch watch;
  const auto division = detail::divide(scene, options, run);
  if (!division) return division.error();
  struct Result {
    report::BlockReport report;
    report::SegmentedBlock segmented;
    std::vector<base::Diagnostic> warnings;
  };
  auto results = detail::for_every(
      *division, run, [&](const auto& block, const auto& inner, const auto& tell, const auto& making) {
        base::Watch own_watch;
        Result result;
        if (!block.ground_known) {
          auto none = detail::refused(block, options.block);
          result.report = std::move(none.report);
          result.segmented = detail::unsegmented(block, none.failed.front().second);
          result.warnings.push_back(*result.segmented.failure);
          return result;
        }
        const auto own = block::in_own_frame(block);
        const auto shown = detail::shown_of(own.block, options, inner, tell, result.report, result.warnings);
        result.segmented =
            detail::segment_block(shown->block(), shown->mesh(), detail::decided_by(options, result.report.accuracy),
                                  inner, tell, result.report, result.warnings);
        detail::place(result.segmented, own);
        result.report.times.total = own_watch.stop();
        result.report.times.stages.insert(result.report.times.stages.begin(), making);
        return result;
      });
  if (run.cancelled()) return base::stopped();

  report::Segmented out;
  out.made_by = detail::made_by(scene, options);
  for (auto& result : results) {
    out.blocks.push_back(std::move(result.report));
    out.segmented.push_back(std::move(result.segmented));
    out.warnings.insert(out.warnings.end(), result.warnings.begin(), result.warnings.end());
  }
  out.times = {watch.stop(), detail::stage_times(division->time, out.blocks)};
  return out;
}

auto raise_part(const model::Plan& plan, const Options& options, const base::Run& run)
    -> base::Result<extrude::Raised> {
  return extrude::raise(plan, detail::with_grid(options.extrude), run);
}

}  // namespace mansard::pipeline
