#include "apps/server/outcome.hpp"

#include <algorithm>
#include "mansard/formats/layers.hpp"
#include "mansard/formats/plans.hpp"

#include "apps/server/options.hpp"
#include "mansard/report/layers.hpp"

namespace mansard::server {

auto bytes_of(const std::vector<float>& values) -> std::string {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

auto scores_of(const evaluate::Scores& s) -> RunScores {
  return {s.mse, s.footprint_mse, s.footprint_median_absolute, s.inside.mse, s.missed, s.invented};
}

auto scores_of(const std::vector<std::shared_ptr<const evaluate::Comparison>>& blocks) -> RunScores {
  std::vector<evaluate::Scores> scores;
  for (const auto& block : blocks) scores.push_back(block->scores);
  return scores_of(evaluate::combined(scores));
}

void count_models(const std::vector<report::BuildingReport>& reports, const model::City& city, RunRecord& record) {
  record.buildings = reports.size();
  record.full =
      static_cast<std::size_t>(std::ranges::count(reports, report::Outcome::full, &report::BuildingReport::outcome));
  record.parts = record.faces = 0;
  for (const auto& building : city.buildings)
    for (const auto& part : building.parts) {
      ++record.parts;
      record.faces += part.model.solid.faces.size();
    }
}

auto error_name(std::size_t map) -> std::string { return "error-" + std::to_string(map) + ".bin"; }

auto reconstruct(const OpenScene& scene, RunRecord record, const base::Run& how) -> base::Result<RunOutcome> {
  pipeline::Options options;
  if (auto set = set_all(options, record.options); !set) return set.error();
  auto run = how;
  run.seed = static_cast<std::uint64_t>(options.seed);
  const auto result = [&]() -> base::Result<report::Reconstruction> {
    const auto whole = scene.with_mesh();
    if (!whole) return whole.failure();
    return pipeline::reconstruct(*whole, options, run, pipeline::Keep::segmentations, record.blocks);
  }();
  if (!result) return result.error();
  run.report("write", "", 1);
  auto layers = formats::geopackage(
      report::segment_layers(scene.scene(), result->segmented, result->city.made_by, result->city.buildings),
      scene.scene().frame);
  if (!layers) return layers.error();
  RunOutcome out{std::move(record), {}};
  out.record.scores = scores_of(result->scores);
  out.record.times = result->times;
  count_models(result->buildings, result->city, out.record);
  out.files.emplace_back("report.json", report::run_json(*result, scene.scene()));
  out.files.emplace_back("plans.json", formats::plans(result->city));
  out.files.emplace_back("layers.json", text_of(layers_json(result->segmented)));
  out.files.emplace_back("segment.gpkg", std::move(*layers));
  out.record.maps.clear();
  for (std::size_t b = 0; b < result->error_maps.size(); ++b) {
    const auto& map = result->error_maps[b];
    out.files.emplace_back(error_name(b), bytes_of(map.difference));
    out.record.maps.push_back({result->blocks[b].name, map.origin, map.grid, map.columns, map.rows});
  }
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  return out;
}

}  // namespace mansard::server
