#include "apps/python/functions.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <array>

#include "apps/python/city.hpp"
#include "apps/python/settings.hpp"
#include "apps/python/work.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/label/scan.hpp"
#include "mansard/pipeline/evaluation.hpp"
#include "mansard/pipeline/inputs.hpp"
#include "mansard/pipeline/run_report.hpp"
#include "mansard/pipeline/states.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/report/layers.hpp"

namespace py = pybind11;

namespace mansard::python {
namespace {

namespace fs = std::filesystem;
using ScanPointer = std::shared_ptr<Scan>;

static_assert(sizeof(geometry::Triangle) == 3 * sizeof(std::uint32_t));
static_assert(sizeof(model::SurfaceClass) == 1 && sizeof(simulate::Class) == 1);

auto seed_of(const pipeline::Options& options) { return static_cast<std::uint64_t>(options.seed); }

template <class Enum>
auto class_array(const std::vector<Enum>& classes) -> py::array_t<std::uint8_t> {
  return taken<std::uint8_t>(std::vector<Enum>(classes), 0);
}

auto vertices_of(const geometry::Mesh& mesh, const py::object& owner) {
  return view(reinterpret_cast<const double*>(mesh.vertices.data()),
              {static_cast<py::ssize_t>(mesh.vertices.size()), 3}, owner);
}
auto triangles_of(const geometry::Mesh& mesh, const py::object& owner) {
  return view(reinterpret_cast<const std::uint32_t*>(mesh.triangles.data()),
              {static_cast<py::ssize_t>(mesh.triangles.size()), 3}, owner);
}

/// GeoJSON features, in the file's coordinates.
auto features_of(const formats::Layer& layer, const model::Frame& frame) -> py::list {
  const auto x = static_cast<double>(frame.origin[0]), y = static_cast<double>(frame.origin[1]);
  py::list all;
  for (const auto& feature : layer.features) {
    py::dict entry, properties;
    for (std::size_t f = 0; f < layer.fields.size(); ++f)
      properties[py::str(layer.fields[f].name)] = to_python(feature.values[f]);
    entry["type"] = "Feature";
    entry["properties"] = properties;
    if (!feature.polygons.empty()) {
      entry["geometry"] = geo_of(feature.polygons, frame);
    } else if (!feature.lines.empty()) {
      py::list lines;
      for (const auto& line : feature.lines) {
        py::list points;
        for (const auto& p : line) points.append(py::make_tuple(p.x + x, p.y + y));
        lines.append(points);
      }
      py::dict geometry;
      const bool one = lines.size() == 1;
      geometry["type"] = one ? "LineString" : "MultiLineString";
      geometry["coordinates"] = one ? py::object(lines[0]) : py::object(lines);
      entry["geometry"] = geometry;
    } else {
      entry["geometry"] = py::none();
    }
    all.append(entry);
  }
  return all;
}

auto read_scan(const std::vector<fs::path>& meshes, const fs::path& footprints, bool derive, const std::string& preset,
               const Settings& settings, const py::object& progress) -> ScanPointer {
  const auto options = options_of(preset, settings);
  return std::make_shared<Scan>(run_for(progress, seed_of(options), [&](const base::Run& run) {
    return pipeline::read_inputs({meshes, footprints, derive}, options, run);
  }));
}

auto city_of(report::Reconstruction made, const model::Scene& scene, const ScanPointer& scan,
             const pipeline::Options& options) -> CityPointer {
  CityState state;
  state.report = report::run_json(made, scene);
  state.scan = scan;
  state.options = options;
  state.warnings = scene.warnings;
  state.warnings.insert(state.warnings.end(), made.warnings.begin(), made.warnings.end());
  state.reports = std::move(made.buildings);
  state.error_maps = std::move(made.error_maps);
  state.city = std::move(made.city);
  state.summary = std::move(static_cast<report::Summary&>(made));
  return city_pointer(std::move(state));
}

auto reconstruct(const ScanPointer& scan, const std::string& preset, const Settings& settings,
                 const py::object& progress) -> CityPointer {
  const auto options = options_of(preset, settings);
  auto made = run_for(progress, seed_of(options),
                      [&](const base::Run& run) { return pipeline::reconstruct(scan->scene(), options, run); });
  return city_of(std::move(made), scan->scene(), scan, options);
}

auto extrude_footprints(const fs::path& footprints, const std::string& preset, const Settings& settings,
                        const py::object& progress) -> CityPointer {
  const auto options = options_of(preset, settings);
  std::optional<model::Scene> scene;
  auto made = run_for(progress, seed_of(options), [&](const base::Run& run) -> base::Result<report::Reconstruction> {
    auto read = ingest::read_footprints(footprints, options.ingest, run);
    if (!read) return read.failure();
    scene.emplace(*std::move(read));
    return pipeline::raise_footprints(*scene, options, run);
  });
  return city_of(std::move(made), *scene, nullptr, options);
}

auto segment(const ScanPointer& scan, const std::string& preset, const Settings& settings, const py::object& progress)
    -> py::tuple {
  const auto options = options_of(preset, settings);
  const auto made = run_for(progress, seed_of(options),
                            [&](const base::Run& run) { return pipeline::segment(scan->scene(), options, run); });
  py::dict layers;
  for (const auto& layer : report::segment_layers(scan->scene(), made.segmented, made.made_by)) {
    py::dict collection;
    collection["type"] = "FeatureCollection";
    collection["features"] = features_of(layer, scan->scene().frame);
    layers[py::str(layer.name)] = collection;
  }
  return py::make_tuple(report::run_json(made, scan->scene()), layers);
}

auto evaluate(const fs::path& model, const std::vector<fs::path>& meshes, const fs::path& truth,
              const fs::path& footprints, const std::string& lod, const std::string& preset, const Settings& settings,
              const py::object& progress) -> py::tuple {
  const auto options = options_of(preset, settings);
  std::string json, table;
  evaluate::ErrorMap map;
  model::Frame frame;
  run_for(progress, seed_of(options), [&](const base::Run& run) -> base::Result<bool> {
    const auto input = pipeline::read_evaluation({model, meshes, truth, footprints, lod}, options.ingest, run);
    if (!input) return input.failure();
    auto result = pipeline::evaluate_model(*input, options, run);
    if (!result) return result.failure();
    json = report::evaluation_json(*result, *input);
    table = report::evaluation_table(*result, *input);
    map = std::move(result->map);
    frame = input->scene.frame;
    return true;
  });
  const auto drawn = map_array(std::move(map), frame);
  return py::make_tuple(json, table, drawn[0], drawn[1]);
}

/// A state, and the scan that it was made from: empty for that of the run.
using StatePaths = std::pair<fs::path, std::vector<fs::path>>;

auto compared(const StatePaths& old_paths, const StatePaths& new_paths, bool scans, const Settings& settings,
              const py::object& progress) -> std::string {
  pipeline::Options options;
  compare::Options asked;
  auto lists = pipeline::option_lists(options);
  lists.push_back(compare::option_list(asked));
  apply(lists, pipeline::presets(), "", settings);
  return run_for(progress, seed_of(options), [&](const base::Run& run) -> base::Result<std::string> {
    const auto read = [&](const StatePaths& paths) {
      return pipeline::read_state(paths.first, {paths.second, scans, false}, options, run);
    };
    auto old = read(old_paths);
    if (!old) return old.failure();
    auto now = read(new_paths);
    if (!now) return now.failure();
    const auto changes = pipeline::changes_between(*old, *now, asked, run);
    if (!changes) return changes.failure();
    return report::changes_json(*changes);
  });
}

auto run_report(const fs::path& run_folder, const std::vector<fs::path>& scan, bool use_scans,
                const std::vector<fs::path>& reviews, const fs::path& changes, std::size_t worst,
                const std::string& title, const std::string& date, const py::object& progress) -> std::string {
  return run_for(progress, 0, [&](const base::Run& run) -> base::Result<std::string> {
    auto made = pipeline::run_report(run_folder, {scan, use_scans, reviews, changes, worst, title, date}, run);
    if (!made) return made.failure();
    return std::move(made->html);
  });
}

auto label(const std::vector<fs::path>& meshes, const fs::path& model_path, const std::string& lod,
           const Settings& settings, const py::object& progress) -> py::tuple {
  const auto options = options_of("", settings);
  ingest::ScannedMesh mesh;
  model::Frame frame;
  std::vector<model::SurfaceClass> classes;
  run_for(progress, seed_of(options), [&](const base::Run& run) -> base::Result<bool> {
    const auto model = pipeline::read_any_model(model_path, {lod, options.ingest.crs}, run);
    if (!model) return model.failure();
    frame = model->frame;
    auto read = ingest::read_mesh(meshes, frame, options.ingest, run);
    if (!read) return read.failure();
    mesh = *std::move(read);
    const auto surface = model::surface_of(*model);
    if (auto met = ingest::check_overlap(surface.mesh, mesh.mesh, {"model", "mesh"}, frame, model_path.string()); !met)
      return met.failure();
    classes = label::label_scan(mesh.mesh, surface, {}, run);
    if (run.cancelled()) return base::error("cancelled", "stopped on request");
    return true;
  });
  return py::make_tuple(taken<double>(std::move(mesh.mesh.vertices), 3),
                        taken<std::uint32_t>(std::move(mesh.mesh.triangles), 3), class_array(classes),
                        py::make_tuple(frame.origin[0], frame.origin[1], frame.origin[2]));
}

/// A block with known truth and its scan.
struct Simulation {
  CityPointer truth;
  geometry::Mesh mesh;
  std::vector<simulate::Class> classes;
  std::string ply, footprints;
};

auto simulated(const std::string& kind, const fs::path& footprints, const std::string& preset, const Settings& settings,
               const py::object& progress) -> std::shared_ptr<Simulation> {
  simulate::Options options;
  std::vector<base::OptionList> lists{simulate::option_list(options)};
  std::vector<pipeline::Preset> presets;
  for (const auto& each : simulate::presets()) presets.push_back({each.name, each.meaning, each.values});
  apply(lists, presets, preset, settings);
  const auto kind_of_block = simulate::kind_of(kind);
  if (footprints.empty() && !kind_of_block)
    raise_error({base::error(
        "option-value", "unknown kind of block; expected terrace, perimeter, courtyard, towers or detached", kind)});
  auto out = std::make_shared<Simulation>();
  CityState state;
  run_for(progress, static_cast<std::uint64_t>(options.seed), [&](const base::Run& run) -> base::Result<bool> {
    auto truth = [&]() -> base::Result<simulate::Truth> {
      if (footprints.empty()) return simulate::make_block(*kind_of_block, options.block, run.seed, run);
      const auto scene = ingest::read_footprints(footprints, {}, run);
      if (!scene) return scene.failure();
      state.warnings = scene->warnings;
      return simulate::furnish(*scene, options.block, run.seed, state.warnings, run);
    }();
    if (!truth) return truth.failure();
    const auto surface = simulate::surface_of(truth->city);
    if (!surface) return surface.failure();
    auto scan = simulate::scan(*surface, options.scan, run.seed, run);
    if (!scan) return scan.failure();
    const auto drawn = simulate::survey(*truth, options.survey, run.seed);
    if (!drawn) return drawn.failure();
    out->ply = simulate::ply(*scan, truth->city.frame);
    out->footprints = simulate::geojson(*drawn, truth->city.frame);
    out->mesh = std::move(scan->mesh);
    out->classes = std::move(scan->classes);
    auto& made_by = truth->city.made_by;
    made_by.version = MANSARD_VERSION;
    for (const auto& option : lists.front().options())
      made_by.options.emplace_back("simulate." + option.name, option.get());
    state.city = std::move(truth->city);
    return true;
  });
  out->truth = city_pointer(std::move(state));
  return out;
}

}  // namespace

void bind_functions(py::module_& m) {
  py::class_<Scan, ScanPointer>(m, "Scan")
      .def_property_readonly(
          "vertices", [](const py::object& self) { return vertices_of(self.cast<const Scan&>().scene().mesh, self); })
      .def_property_readonly(
          "triangles", [](const py::object& self) { return triangles_of(self.cast<const Scan&>().scene().mesh, self); })
      .def_property_readonly("origin", [](const Scan& s) { return py::tuple(py::cast(s.scene().frame.origin)); })
      .def_property_readonly("crs", [](const Scan& s) { return s.scene().frame.crs; })
      .def_property_readonly("warnings", [](const Scan& s) { return s.scene().warnings; })
      .def_property_readonly("footprints",
                             [](const Scan& s) {
                               py::list features;
                               for (const auto& footprint : s.scene().footprints) {
                                 py::dict feature, properties;
                                 for (const auto& [name, value] : footprint.attributes)
                                   properties[py::str(name)] = to_python(value);
                                 feature["type"] = "Feature";
                                 feature["id"] = footprint.id;
                                 feature["properties"] = properties;
                                 feature["geometry"] = footprint.polygons.empty()
                                                           ? py::object(py::none())
                                                           : py::object(geo_of(footprint.polygons, s.scene().frame));
                                 features.append(feature);
                               }
                               py::dict all;
                               all["type"] = "FeatureCollection";
                               all["features"] = features;
                               return all;
                             })
      .def("__repr__", [](const Scan& s) {
        return "<mansard.Scan of " + std::to_string(s.scene().mesh.triangles.size()) + " triangles and " +
               std::to_string(s.scene().footprints.size()) + " footprints>";
      });
  py::class_<Simulation, std::shared_ptr<Simulation>>(m, "Simulation")
      .def_readonly("truth", &Simulation::truth)
      .def_property_readonly(
          "vertices", [](const py::object& self) { return vertices_of(self.cast<const Simulation&>().mesh, self); })
      .def_property_readonly(
          "triangles", [](const py::object& self) { return triangles_of(self.cast<const Simulation&>().mesh, self); })
      .def_property_readonly("classes", [](const Simulation& s) { return class_array(s.classes); })
      .def_property_readonly("mesh_ply", [](const Simulation& s) { return py::bytes(s.ply); })
      .def_property_readonly("footprints_text", [](const Simulation& s) { return s.footprints; });

  m.def("read_scan", &read_scan, py::arg("meshes"), py::arg("footprints"), py::arg("derive"), py::arg("preset"),
        py::arg("settings"), py::arg("progress"));
  m.def("reconstruct", &reconstruct, py::arg("scan"), py::arg("preset"), py::arg("settings"), py::arg("progress"));
  m.def("extrude_footprints", &extrude_footprints, py::arg("footprints"), py::arg("preset"), py::arg("settings"),
        py::arg("progress"));
  m.def("segment", &segment, py::arg("scan"), py::arg("preset"), py::arg("settings"), py::arg("progress"));
  m.def("evaluate", &evaluate, py::arg("model"), py::arg("meshes"), py::arg("truth"), py::arg("footprints"),
        py::arg("lod"), py::arg("preset"), py::arg("settings"), py::arg("progress"));
  m.def("compare", &compared, py::arg("old"), py::arg("new"), py::arg("scans"), py::arg("settings"),
        py::arg("progress"));
  m.def("report", &run_report, py::arg("run"), py::arg("scan"), py::arg("use_scans"), py::arg("reviews"),
        py::arg("changes"), py::arg("worst"), py::arg("title"), py::arg("date"), py::arg("progress"));
  m.def("label", &label, py::arg("meshes"), py::arg("model"), py::arg("lod"), py::arg("settings"), py::arg("progress"));
  m.def("simulate", &simulated, py::arg("kind"), py::arg("footprints"), py::arg("preset"), py::arg("settings"),
        py::arg("progress"));
}

}  // namespace mansard::python
