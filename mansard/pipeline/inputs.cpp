#include "mansard/pipeline/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/pipeline/scan_checks.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::pipeline {
namespace {

using geometry::Box2;

auto in_words(const Box2& box) -> std::string {
  return "x " + base::to_text(box.least.x, 1) + " to " + base::to_text(box.most.x, 1) + ", y " +
         base::to_text(box.least.y, 1) + " to " + base::to_text(box.most.y, 1);
}

/// Makes surroundings of the footprints that do not meet a box of the working CRS.
auto keep_within(const Box2& box, model::Scene& scene) -> base::Result<void> {
  const geometry::Point2 origin{static_cast<double>(scene.frame.origin[0]), static_cast<double>(scene.frame.origin[1])};
  Box2 all;
  std::vector<model::Footprint> wanted;
  for (auto& footprint : scene.footprints) {
    Box2 own;
    for (const auto& polygon : footprint.polygons) own.include(geometry::bounds(polygon.outer));
    own = {own.least + origin, own.most + origin};
    all.include(own);
    (own.overlaps(box) ? wanted : scene.surroundings).push_back(std::move(footprint));
  }
  scene.footprints = std::move(wanted);
  if (!scene.footprints.empty()) return {};
  return base::error("derive-nothing", "no derived footprint is in the box asked for (" + in_words(box) +
                                           "); they are in " + in_words(all));
}

/// The heights of the ground that an attribute of the footprints says.
auto take_grounds(const Options& options, model::Scene& scene) -> base::Result<void> {
  const auto& name = options.roof.ground_attribute;
  if (name.empty()) return {};
  auto reading = options.roof;
  reading.ground = std::numeric_limits<double>::quiet_NaN();
  bool any = false;
  for (auto* footprints : {&scene.footprints, &scene.surroundings})
    for (auto& footprint : *footprints) {
      const auto at = std::ranges::find(footprint.attributes, name, &model::Attributes::value_type::first);
      if (at == footprint.attributes.end()) continue;
      any = true;
      auto read = roof::form_of({*at}, reading);
      if (std::isfinite(read.form.ground)) footprint.ground = read.form.ground;
      for (auto& warning : read.warnings) {
        warning.subject = footprint.id;
        scene.warnings.push_back(std::move(warning));
      }
    }
  if (any || scene.footprints.empty()) return {};
  return base::error("pipeline-ground-attribute",
                     "no footprint has the attribute '" + name + "' of --ground-attribute; check its name",
                     "roof.ground_attribute");
}

/// Adds what is wrong with the scan as a whole to its warnings. Fails where nothing sensible can come of it.
auto check(const Options& options, const base::Run& run, const ingest::MeshCells* cells, model::Scene& scene)
    -> base::Result<void> {
  if (options.scan_checks == ScanChecks::off) return {};
  auto checked = check_scan(scene, cells, options, run);
  if (!checked) return checked.failure();
  base::Failure failure;
  for (auto& finding : checked->findings) {
    if (finding.severity == base::Severity::error && options.scan_checks == ScanChecks::stop) {
      failure.diagnostics.push_back(std::move(finding));
      continue;
    }
    finding.severity = base::Severity::warning;
    scene.warnings.push_back(std::move(finding));
  }
  if (failure.diagnostics.empty()) return {};
  failure.diagnostics.front().message += "; --pipeline-scan-checks warn goes on nevertheless";
  return failure;
}

}  // namespace

auto is_footprints_name(const std::filesystem::path& path) -> bool {
  using formats::Reads;
  return formats::is_database_name(path.string()) ||
         (formats::has_extension(path, &Reads::footprints) && !formats::has_extension(path, &Reads::mesh));
}

auto is_mesh_name(const std::filesystem::path& path) -> bool {
  using formats::Reads;
  if (is_footprints_name(path)) return false;
  std::error_code status;  // a folder named .gdb is a database of Esri, and one that ends in .shp has shapefiles
  const bool folder = std::filesystem::is_directory(path, status) && formats::extension_of(path) != ".gdb";
  return folder || path.filename() == "tileset.json" || path.filename() == "ept.json" ||
         formats::has_extension(path, &Reads::mesh) || formats::has_extension(path, &Reads::raster);
}

auto in_order(const std::vector<std::filesystem::path>& typed) -> TypedInputs {
  TypedInputs out{{typed, {}, false}, false};
  auto& meshes = out.paths.meshes;
  if (meshes.empty()) return out;
  if (is_mesh_name(meshes.back()) && std::ranges::count_if(meshes, is_footprints_name) == 1) {
    const auto at = std::ranges::find_if(meshes, is_footprints_name);
    std::rotate(at, std::next(at), meshes.end());
    out.wrong_order = true;
  }
  out.paths.footprints = std::move(meshes.back());
  meshes.pop_back();
  return out;
}

auto read_inputs(const InputPaths& paths, const Options& options, const base::Run& run) -> base::Result<model::Scene> {
  if (paths.footprints.empty() != paths.derive_footprints)
    return base::error("pipeline-footprints",
                       paths.derive_footprints
                           ? "footprints are given, and are to be drawn from the mesh too; leave one of the two"
                           : "there are no footprints; give some, or have them drawn from the mesh with "
                             "--derive-footprints",
                       paths.footprints.string());
  if (!paths.derive_footprints) {
    auto scene = ingest::read_scene(paths.meshes, paths.footprints, options.ingest, run);
    if (!scene) return scene;
    if (auto taken = take_grounds(options, *scene); !taken) return taken.failure();
    if (auto checked = check(options, run, nullptr, *scene); !checked) return checked.failure();
    return scene;
  }
  // The ground, and so what stands on it, is found by what it is joined to, however far: footprints are those of the
  // whole mesh, and the box only chooses among them.
  const auto box = ingest::box_of(options.ingest);
  if (!box) return box.failure();
  ingest::Options whole = options.ingest;
  whole.bbox = {};
  auto scene = ingest::read_scene(paths.meshes, paths.footprints, whole, run);
  if (!scene) return scene;
  auto derived = derive::footprints(*scene, options.derive, run);
  if (!derived) return derived.failure();
  scene->footprints = std::move(derived->footprints);
  scene->warnings.insert(scene->warnings.end(), derived->warnings.begin(), derived->warnings.end());
  if (const auto& within = *box)
    if (auto kept = keep_within(*within, *scene); !kept) return kept.failure();
  return scene;
}

auto read_city_inputs(const InputPaths& paths, const Options& options, const base::Run& run)
    -> base::Result<ingest::CityScene> {
  if (!paths.footprints.empty() && !paths.derive_footprints) {
    auto city = ingest::read_city(paths.meshes, paths.footprints, options.ingest, run);
    if (!city) return city;
    if (auto taken = take_grounds(options, city->scene); !taken) return taken.failure();
    if (auto checked = check(options, run, city->cells.get(), city->scene); !checked) return checked.failure();
    return city;
  }
  auto scene = read_inputs(paths, options, run);
  if (!scene) return scene.failure();
  return ingest::CityScene{std::move(*scene), nullptr};
}

}  // namespace mansard::pipeline
