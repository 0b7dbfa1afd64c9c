#include "apps/server/import.hpp"

#include <algorithm>

#include "apps/server/json.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

auto read(const fs::path& path) -> base::Result<std::unique_ptr<formats::CityReader>> {
  if (formats::is_database_name(path))
    return base::error("write-read-format", "this is a database; name a file that mansard wrote",
                       formats::name_to_show(path));
  if (auto there = formats::check_input(path); !there) return there.error();
  return formats::read_city(path);
}

void move(geometry::Ring& ring, geometry::Point2 by) {
  for (auto& p : ring) p = p + by;
}

/// Whole metres: nothing is rounded that was not.
void move(model::City& city, const model::Frame& frame) {
  const auto along = [&](std::size_t i) { return static_cast<double>(city.frame.origin[i] - frame.origin[i]); };
  const geometry::Point2 by{along(0), along(1)};
  for (auto& building : city.buildings) {
    building.ground += along(2);
    for (auto& polygon : building.footprint) {
      move(polygon.outer, by);
      for (auto& hole : polygon.holes) move(hole, by);
    }
    for (auto& part : building.parts) {
      part.plan.base += along(2);
      move(part.plan.outer.points, by);
      for (auto& hole : part.plan.holes) move(hole.points, by);
    }
  }
  city.frame = frame;
}

auto text_at(const model::Attributes& attributes, std::string_view name) -> std::string {
  for (const auto& [key, value] : attributes)
    if (const auto* text = std::get_if<std::string>(&value); text != nullptr && key == name) return *text;
  return {};
}

/// What the attributes still say of how it went.
auto report_of(const model::Building& building, const pipeline::RaisedPlans& raised, std::size_t at)
    -> pipeline::BuildingReport {
  pipeline::BuildingReport report;
  report.id = building.id;
  report.parts = building.parts.size();
  report.ground = building.ground + static_cast<double>(raised.city.frame.origin[2]);
  if (building.parts.empty()) report.outcome = pipeline::Outcome::covered;
  for (const auto& part : building.parts) {
    if (report.block.empty()) report.block = text_at(part.attributes, "ms_block");
    report.volume += solid::volume(part.model.solid);
    if (const auto why = text_at(part.attributes, "ms_fallback"); !why.empty()) {
      report.outcome = pipeline::Outcome::fallback;
      report.reasons.push_back(base::warning(why, "it fell back when it was made", part.id));
    }
  }
  for (const auto& less : raised.fell_short)
    if (less.building == at) {
      report.outcome = pipeline::Outcome::fallback;
      report.reasons.insert(report.reasons.end(), less.reasons.begin(), less.reasons.end());
    }
  return report;
}

}  // namespace

auto check_import(const fs::path& path) -> base::Result<void> {
  const auto reader = read(path);
  if (!reader) return reader.error();
  return {};
}

auto import_city(const fs::path& path, const std::optional<model::Frame>& frame, RunRecord record, const base::Run& run)
    -> base::Result<RunOutcome> {
  run.report("read", path.string(), 0);
  auto reader = read(path);
  if (!reader) return reader.error();
  pipeline::Options options;
  pipeline::Reconstruction result;
  result.warnings = pipeline::take_options((*reader)->header().made_by, options);
  auto city = formats::read_whole(**reader);
  if (!city) return city.error();
  if (frame) {
    if (!frame->crs.empty() && !city->frame.crs.empty() && frame->crs != city->frame.crs)
      return base::error("server-import",
                         "the model is in " + city->frame.crs + ", and the scan in " + frame->crs +
                             "; open it in a project of its own",
                         path.string());
    move(*city, {frame->origin, frame->crs.empty() ? city->frame.crs : frame->crs});
  }
  run.report("extrude", path.string(), 0.3);
  auto raised = pipeline::raise_plans(std::move(*city), options, run);
  if (!raised) return raised.error();
  for (std::size_t b = 0; b < raised->city.buildings.size(); ++b)
    result.buildings.push_back(report_of(raised->city.buildings[b], *raised, b));

  RunOutcome out{std::move(record), {}};
  out.record.buildings = result.buildings.size();
  out.record.full = static_cast<std::size_t>(
      std::ranges::count(result.buildings, pipeline::Outcome::full, &pipeline::BuildingReport::outcome));
  for (const auto& building : raised->city.buildings)
    for (const auto& part : building.parts) {
      ++out.record.parts;
      out.record.faces += part.model.solid.faces.size();
    }
  out.record.options = differing(options);
  model::Scene scene;  // without a mesh the report has what is known
  scene.frame = raised->city.frame;
  if (auto file = formats::input_file(path)) scene.inputs.push_back(std::move(*file));
  result.city = std::move(raised->city);
  out.files.emplace_back("report.json", pipeline::report_json(result, scene));
  out.files.emplace_back("plans.json", formats::plans(result.city));
  out.files.emplace_back("layers.json", text_of(layers_json({})));
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  return out;
}

}  // namespace mansard::server
