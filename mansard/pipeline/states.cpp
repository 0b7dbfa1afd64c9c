// The steps of reading a state: which file has its models, what is known of their accuracy, and the scan.
#include "mansard/pipeline/states.hpp"

#include <algorithm>
#include <array>

#include "mansard/base/files.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/model_crs.hpp"
#include "mansard/evaluate/truth.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/ingest/model.hpp"
#include "mansard/model/move.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/run_files.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/report/read_run.hpp"

namespace mansard::pipeline {
namespace {

namespace fs = std::filesystem;
using geometry::Point3;

// ---- buildings

auto number_of(const model::Value& value) -> std::optional<double> {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  return std::nullopt;
}

auto number_at(const model::Attributes& attributes, std::string_view name) -> std::optional<double> {
  for (const auto& [key, value] : attributes)
    if (key == name) return number_of(value);
  return std::nullopt;
}

/// m; the error to expect, else the distance from the scan that the models were made from (3DBAG: b3_rmse_lod22).
auto error_of(const model::Attributes& attributes) -> std::optional<double> {
  for (const auto* name : {"ms_error", "ms_rmse_lod22", "b3_rmse_lod22", "rmse_lod22"})
    if (const auto number = number_at(attributes, name); number && *number >= 0) return number;
  return std::nullopt;
}

auto lowest_of(const model::ModelBuilding& building) -> double {
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& part : building.parts)
    for (const auto& face : part.faces)
      for (const auto& loop : face.loops)
        for (const auto p : loop) lowest = std::min(lowest, p.z);
  return lowest;
}

/// The outline of a model's faces; a warning where there is none.
auto outline_of(const model::ModelBuilding& building, std::vector<base::Diagnostic>& warnings)
    -> std::vector<geometry::Polygon> {
  auto outline = evaluate::outline_of(building.parts);
  if (outline && !outline->empty()) return std::move(*outline);
  warnings.push_back(base::warning("compare-outline",
                                   "it has no outline seen from above, and is not compared" +
                                       (outline ? std::string() : " (" + outline.error().message + ")"),
                                   building.id));
  return {};
}

void take_model(const model::Model& model, StateFiles& out) {
  for (const auto& building : model.buildings)
    out.state.buildings.push_back({building.id, outline_of(building, out.warnings), lowest_of(building), {}, {}});
  out.state.models = model::surface_of(model).mesh;
  out.frame = model.frame;
}

void take_city(const model::City& city, bool own, StateFiles& out) {
  const auto model = model_of(city);
  std::size_t m = 0;
  for (const auto& building : city.buildings) {
    const bool has_model = m < model.buildings.size() && model.buildings[m].id == building.id;
    compare::Building one{building.id, building.footprint, building.ground,
                          number_at(building.attributes, "ms_confidence"), error_of(building.attributes)};
    if (has_model && one.outline.empty()) one.outline = outline_of(model.buildings[m], out.warnings);
    if (has_model && !own) one.ground = lowest_of(model.buildings[m]);
    out.state.buildings.push_back(std::move(one));
    m += has_model ? 1 : 0;
  }
  out.state.models = model::surface_of(model).mesh;
  out.frame = city.frame;
}

// ---- files

void add(const std::vector<base::Diagnostic>& more, std::vector<base::Diagnostic>& to) {
  to.insert(to.end(), more.begin(), more.end());
}

auto read_own(formats::CityReader& reader, const StateOptions& wanted, const base::Run& run, StateFiles& out)
    -> base::Result<void> {
  model::City city;
  if (!wanted.keep_city && (reader.has_models() || reader.has_solids())) {
    std::vector<base::Diagnostic> refused;
    auto whole = formats::read_whole(reader, &refused);
    if (!whole) return whole.failure();
    add(refused, out.warnings);
    city = std::move(*whole);
  } else {
    Options options;
    add(take_options(reader.header().made_by, options), out.warnings);
    auto raised = read_raised(reader, options, run);
    if (!raised) return raised.failure();
    for (const auto& part : raised->refused)
      out.warnings.push_back(base::warning(part.code, part.message + "; the part is left out", part.subject));
    city = std::move(raised->city);
  }
  out.own = true;
  take_city(city, true, out);
  if (wanted.keep_city) out.city = std::move(city);
  return {};
}

auto extrude_footprints(const Options& options, const base::Run& run, StateFiles& out) -> base::Result<void> {
  const auto scene = ingest::read_footprints(out.models, options.ingest, run);
  if (!scene) return scene.failure();
  add(scene->warnings, out.warnings);
  auto made = raise_footprints(*scene, options, run);
  if (!made) return made.failure();
  take_city(made->city, true, out);
  out.inputs = scene->inputs;
  out.own = true;
  out.city = std::move(made->city);
  return {};
}

auto read_state_models(const StateOptions& wanted, const Options& options, const base::Run& run, StateFiles& out)
    -> base::Result<void> {
  const auto& path = out.models;
  auto reader = formats::read_city(path);
  if (reader) return read_own(**reader, wanted, run, out);
  if (!is_foreign(reader.error())) return reader.failure();
  const std::string extension = formats::extension_of(path);
  if (extension == ".obj") {
    auto model = ingest::read_model(path, {{}, options.ingest.crs});
    if (!model) return model.failure();
    add(model->warnings, out.warnings);
    out.inputs = model->inputs;
    take_model(*model, out);
    return {};
  }
  if (formats::has_extension(path, &formats::Reads::models)) {
    auto foreign = formats::read_foreign(path);
    if (!foreign) return foreign.failure();
    add(foreign->warnings, out.warnings);
    take_city(foreign->city, false, out);
    out.city = std::move(foreign->city);
    return {};
  }
  if (formats::has_extension(path, &formats::Reads::footprints)) return extrude_footprints(options, run, out);
  return reader.failure();
}

// ---- the scan

auto read_state_scan(const std::vector<fs::path>& paths, const Options& options, const base::Run& run, StateFiles& out)
    -> base::Result<void> {
  if (paths.empty()) return {};
  auto scan = ingest::read_mesh(paths, out.frame, options.ingest, run);
  if (!scan) return scan.failure();
  out.state.scan = std::move(scan->mesh);
  out.scans = paths;
  out.inputs.insert(out.inputs.end(), scan->inputs.begin(), scan->inputs.end());
  return {};
}

}  // namespace

auto read_state(const fs::path& path, const StateOptions& wanted, const Options& options, const base::Run& run)
    -> base::Result<StateFiles> {
  StateFiles out;
  out.path = out.models = path;
  Options used = options;
  std::error_code status;
  std::vector<fs::path> scans = wanted.scans;
  if (fs::is_directory(path, status) && fs::exists(path / "run.json", status)) {
    out.models = detail::models_in(path);
    if (out.models.empty())
      return base::error("compare-state",
                         "there are no models in this folder that can be read; add cityjson or plans to --formats of "
                         "the run",
                         path.string());
    const auto text = base::read_file(path / "run.json");
    if (!text) return text.failure();
    const auto earlier = report::read_run(*text, (path / "run.json").string());
    if (!earlier) return earlier.failure();
    out.measured = earlier->accuracy.has_value();
    if (out.measured) out.state.accuracy = *earlier->accuracy;
    detail::take_reading(*earlier, used);
    if (scans.empty() && wanted.use_scans) {
      auto found = detail::scan_of(*earlier, path, used);
      if (!found.missing.empty())
        out.warnings.push_back(base::warning("compare-scan-gone",
                                             "the scan of this run is not there any more, or is another one (" +
                                                 found.missing +
                                                 "): models alone are compared; name the scan to use it",
                                             path.string()));
      scans = std::move(found.files);
    }
  }
  if (auto read = read_state_models(wanted, options, run, out); !read) return read.failure();
  if (out.state.buildings.empty())
    return base::error("compare-state", "there are no buildings in it", out.models.string());
  if (auto read = read_state_scan(scans, used, run, out); !read) {
    if (!wanted.scans.empty() || run.cancelled()) return read.failure();
    auto why = read.error();
    out.warnings.push_back(base::warning(
        "compare-scan-gone", "the scan of this run cannot be read: models alone are compared (" + why.message + ")",
        path.string()));
  }
  if (run.cancelled()) return base::stopped();
  return out;
}

auto changes_between(StateFiles& old, const StateFiles& now, const compare::Options& options, const base::Run& run)
    -> base::Result<report::Changes> {
  if (auto one = in_one_frame(old, now); !one) return one.failure();
  auto found = compare::changes(old.state, now.state, options, run);
  if (run.cancelled()) return base::stopped();
  auto inputs = old.inputs;
  inputs.insert(inputs.end(), now.inputs.begin(), now.inputs.end());
  return report::Changes{old.state,         now.state,         std::move(found),  options,          now.frame,
                         old.path.string(), now.path.string(), std::move(inputs), detail::version()};
}

auto in_one_frame(StateFiles& old, const StateFiles& now) -> base::Result<void> {
  if (!old.frame.crs.empty() && !now.frame.crs.empty() && !crs::same_crs(old.frame.crs, now.frame.crs))
    return base::error("compare-crs",
                       "the old state is in " + old.frame.crs + ", the new one in " + now.frame.crs +
                           "; transform one of them: for footprints with heights --crs does that",
                       old.path.string());
  const auto shift = model::between(old.frame, now.frame);
  for (auto* mesh : {&old.state.models, &old.state.scan}) {
    for (auto& p : mesh->vertices) p = p + shift;
    for (auto& p : mesh->points) p = p + shift;
  }
  geometry::Box2 before, after;
  for (auto& building : old.state.buildings) {
    building.ground += shift.z;
    for (auto& polygon : building.outline) geometry::move(polygon, xy(shift));
    before.include(geometry::bounds(building.outline));
  }
  old.frame = now.frame;
  for (const auto& building : now.state.buildings) after.include(geometry::bounds(building.outline));
  if (before.overlaps(after)) return {};
  const auto in_words = [&](const geometry::Box2& box) {
    const auto range = [&](double least, double most, std::size_t axis) {
      const auto at = static_cast<double>(now.frame.origin[axis]);
      return base::to_text(least + at, 0) + " to " + base::to_text(most + at, 0);
    };
    return "x " + range(box.least.x, box.most.x, 0) + ", y " + range(box.least.y, box.most.y, 1);
  };
  return base::error("compare-overlap",
                     "the states are of different places: the old one is in " + in_words(before) + ", the new one in " +
                         in_words(after) + "; check both",
                     old.path.string());
}

}  // namespace mansard::pipeline
