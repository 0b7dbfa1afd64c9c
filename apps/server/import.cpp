#include "apps/server/import.hpp"

#include <algorithm>
#include <vector>

#include "apps/server/exports.hpp"
#include "apps/server/json.hpp"
#include "apps/server/options.hpp"
#include "apps/server/zip.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/model/find.hpp"
#include "mansard/model/move.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

auto read(const fs::path& path) -> base::Result<std::unique_ptr<formats::CityReader>> {
  if (formats::is_database_name(path))
    return base::error("write-read-format", "this is a database; give a file that mansard wrote",
                       formats::name_to_show(path));
  if (auto there = formats::check_input(path); !there) return there.error();
  return formats::read_city(path);
}

/// The models in an unpacked archive: a tileset at its top or in its only folder, else the first file that mansard
/// wrote.
auto models_in(const fs::path& folder, const fs::path& zip) -> base::Result<fs::path> {
  std::vector<fs::path> files;
  std::error_code failure;
  for (fs::recursive_directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
    if (at->is_regular_file(failure)) files.push_back(at->path());
  std::ranges::sort(files);
  for (const auto& file : files)
    if (file.filename() == "tileset.json") return file.parent_path();
  for (const auto& file : files)
    if (read(file)) return file;
  return base::error("server-archive",
                     "the ZIP file has no models that mansard wrote; it must have a tileset.json or one "
                     "file in a format that can be opened again",
                     zip.string());
}

void move(model::City& city, const model::Frame& frame) {
  const auto by = model::between(city.frame, frame);
  for (auto& building : city.buildings) model::move(building, by);
  city.frame = frame;
}

auto move_into(const model::Frame& frame, model::City& city, const fs::path& path) -> base::Result<void> {
  if (!frame.crs.empty() && !city.frame.crs.empty() && frame.crs != city.frame.crs)
    return base::error("server-import",
                       "the model is in " + city.frame.crs + " and the project's mesh in " + frame.crs +
                           "; open the model in a project of its own, or convert it first",
                       path.string());
  move(city, {frame.origin, frame.crs.empty() ? city.frame.crs : frame.crs});
  return {};
}

/// The report of a building, from its attributes.
auto report_of(const model::Building& building, const pipeline::RaisedPlans& raised, std::size_t at)
    -> report::BuildingReport {
  report::BuildingReport report;
  report.id = building.id;
  report.parts = building.parts.size();
  report.ground = building.ground + static_cast<double>(raised.city.frame.origin[2]);
  if (building.parts.empty()) report.outcome = report::Outcome::covered;
  for (const auto& part : building.parts) {
    const auto* block = model::find<std::string>(part.attributes, "ms_block");
    if (report.block.empty() && block != nullptr) report.block = *block;
    report.volume += solid::volume(part.model.solid);
    if (const auto* why = model::find<std::string>(part.attributes, "ms_fallback"); why != nullptr && !why->empty()) {
      report.outcome = report::Outcome::fallback;
      report.reasons.push_back(base::warning(*why, "the part was simplified by the run that made it", part.id));
    }
  }
  for (const auto& less : raised.fell_short)
    if (less.building == at) {
      report.outcome = report::Outcome::fallback;
      report.reasons.insert(report.reasons.end(), less.reasons.begin(), less.reasons.end());
    }
  return report;
}

}  // namespace

auto check_import(const fs::path& path) -> base::Result<void> {
  if (is_zip(path)) {
    if (auto there = formats::check_input(path); !there) return there.error();
    const auto names = names_in_zip(path);
    return names ? base::Result<void>() : names.error();
  }
  const auto reader = read(path);
  if (!reader) return reader.error();
  return {};
}

auto import_city(const fs::path& path, const fs::path& work, const std::optional<model::Frame>& frame, RunRecord record,
                 const base::Run& run) -> base::Result<RunOutcome> {
  run.report("read", path.string(), 0);
  std::optional<WorkFolder> unpacked;
  auto models = path;
  if (is_zip(path)) {
    unpacked.emplace(work);
    const auto folder = work / "model.3dtiles";  // the name by which a tileset is known
    if (auto done = unzip(path, folder); !done) return done.error();
    const auto found = models_in(folder, path);
    if (!found) return found.error();
    models = *found;
  }
  auto reader = read(models);
  if (!reader) return reader.error();
  pipeline::Options options;
  report::Reconstruction result;
  result.warnings = pipeline::take_options((*reader)->header().made_by, options);
  auto city = formats::read_whole(**reader);
  if (!city) return city.failure();
  if (frame)
    if (auto moved = move_into(*frame, *city, path); !moved) return moved.error();
  run.report("extrude", path.string(), 0.3);
  auto raised = pipeline::raise_plans(std::move(*city), options, run);
  if (!raised) return raised.error();
  if (!raised->refused.empty()) return base::Failure{std::move(raised->refused)};
  for (std::size_t b = 0; b < raised->city.buildings.size(); ++b)
    result.buildings.push_back(report_of(raised->city.buildings[b], *raised, b));

  RunOutcome out{std::move(record), {}};
  count_models(result.buildings, raised->city, out.record);
  out.record.options = differing(options);
  model::Scene scene;  // without a mesh: the report has only frame and inputs
  scene.frame = raised->city.frame;
  if (auto file = formats::input_file(path)) scene.inputs.push_back(std::move(*file));
  result.city = std::move(raised->city);
  out.files.emplace_back("report.json", report::run_json(result, scene));
  out.files.emplace_back("plans.json", formats::plans(result.city));
  out.files.emplace_back("layers.json", text_of(layers_json({})));
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  return out;
}

}  // namespace mansard::server
