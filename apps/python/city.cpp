#include "apps/python/city.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <algorithm>
#include <cmath>

#include "apps/python/settings.hpp"
#include "apps/python/work.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/formats/results.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/pipeline/solids.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/solid/solid.hpp"

namespace py = pybind11;

namespace mansard::python {
namespace {

using geometry::Point2;
using geometry::Point3;
static_assert(sizeof(Point2) == 2 * sizeof(double) && sizeof(Point3) == 3 * sizeof(double));
static_assert(sizeof(model::ProfilePoint) == 2 * sizeof(double));
static_assert(sizeof(model::FaceClass) == 1);

/// One building, part or solid of a city, which it keeps alive.
struct BuildingHandle {
  CityPointer city;
  std::size_t at = 0;
  [[nodiscard]] auto building() const -> const model::Building& { return city->city.buildings[at]; }
};
struct PartHandle {
  CityPointer city;
  std::size_t building = 0, at = 0;
  [[nodiscard]] auto part() const -> const model::Part& { return city->city.buildings[building].parts[at]; }
  [[nodiscard]] auto plan() const -> model::Plan& { return city->plans[building][at].plan; }
};
struct SolidHandle {
  std::shared_ptr<const void> owner;
  const model::LabelledSolid* solid = nullptr;
  geometry::Point3 origin;
  [[nodiscard]] auto operator->() const -> const model::LabelledSolid* { return solid; }
};

auto value_error(const std::string& what) -> py::value_error { return py::value_error(what); }

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;

auto ring_of(const Points& points) -> geometry::Ring {
  if (points.ndim() != 2 || points.shape(1) != 2 || points.shape(0) < 3)
    throw value_error("a ring is an array of shape (n, 2) with n of 3 or more");
  geometry::Ring ring;
  const auto read = points.unchecked<2>();
  for (py::ssize_t i = 0; i < read.shape(0); ++i) {
    if (!std::isfinite(read(i, 0)) || !std::isfinite(read(i, 1))) throw value_error("coordinates must be finite");
    ring.push_back({read(i, 0), read(i, 1)});
  }
  return ring;
}

auto profile_of(const Points& points) -> model::Profile {
  if (points.ndim() != 2 || points.shape(1) != 2 || points.shape(0) < 2)
    throw value_error("a profile is an array of shape (n, 2): metres inward and metres above the base, from (0, 0)");
  model::Profile profile;
  const auto read = points.unchecked<2>();
  for (py::ssize_t i = 0; i < read.shape(0); ++i) profile.push_back({read(i, 0), read(i, 1)});
  return profile;
}

auto profile_array(const model::Profile& profile) -> py::array_t<double> {
  return taken<double>(std::vector<model::ProfilePoint>(profile), 2);
}

/// Arrays that are copies must not look as if writing to them changed the plan.
auto frozen(py::array_t<double> array) -> py::array_t<double> {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

void set_ring(model::PlanRing& ring, const Points& points) {
  auto to = ring_of(points);
  if (to.size() != ring.points.size())
    throw value_error("the ring has " + std::to_string(ring.points.size()) + " corners, and " +
                      std::to_string(to.size()) + " are given; make a new Plan to change their number");
  ring.points = std::move(to);
}

auto checked_uses(std::vector<std::uint32_t> uses, std::size_t edges, std::size_t profiles)
    -> std::vector<std::uint32_t> {
  if (uses.size() != edges) throw value_error("profile_of_edge needs one index for each edge");
  for (const auto use : uses)
    if (use >= profiles)
      throw value_error("profile_of_edge names profile " + std::to_string(use) + " of " + std::to_string(profiles));
  return uses;
}

auto new_plan(const Points& outer, const std::vector<Points>& profiles, std::optional<std::vector<std::uint32_t>> uses,
              const std::vector<Points>& holes, const std::optional<std::vector<std::vector<std::uint32_t>>>& hole_uses,
              double base, double cap) -> model::Plan {
  model::Plan plan;
  plan.base = base;
  plan.cap = cap;
  for (const auto& profile : profiles) plan.profiles.push_back(profile_of(profile));
  if (plan.profiles.empty()) throw value_error("a plan needs a profile");
  plan.outer.points = ring_of(outer);
  const auto edges = plan.outer.points.size();
  plan.outer.profile_of_edge =
      uses ? checked_uses(std::move(*uses), edges, profiles.size()) : std::vector<std::uint32_t>(edges, 0);
  if (hole_uses && hole_uses->size() != holes.size())
    throw value_error("profile_of_hole_edge needs one list for each hole");
  for (std::size_t h = 0; h < holes.size(); ++h) {
    model::PlanRing ring{ring_of(holes[h]), {}};
    ring.profile_of_edge = hole_uses ? checked_uses((*hole_uses)[h], ring.points.size(), profiles.size())
                                     : std::vector<std::uint32_t>(ring.points.size(), 0);
    plan.holes.push_back(std::move(ring));
  }
  return plan;
}

auto attributes_of(const model::Attributes& attributes) -> py::dict {
  py::dict all;
  for (const auto& [name, value] : attributes) all[py::str(name)] = to_python(value);
  return all;
}

auto origin_of(const model::Frame& frame) -> geometry::Point3 {
  return {static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1]),
          static_cast<double>(frame.origin[2])};
}

void bind_plan(py::module_& m) {
  py::class_<model::Plan>(m, "Plan")
      .def(py::init(&new_plan), py::arg("outer"), py::arg("profiles"), py::arg("profile_of_edge") = py::none(),
           py::arg("holes") = py::list(), py::arg("profile_of_hole_edge") = py::none(), py::arg("base") = 0.0,
           py::arg("cap") = 100.0)
      .def_property(
          "outer", [](const model::Plan& p) { return frozen(ring_array(p.outer.points)); },
          [](model::Plan& p, const Points& points) { set_ring(p.outer, points); })
      .def_property_readonly("holes",
                             [](const model::Plan& p) {
                               py::list all;
                               for (const auto& hole : p.holes) all.append(frozen(ring_array(hole.points)));
                               return py::tuple(all);
                             })
      .def_property(
          "profiles",
          [](const model::Plan& p) {
            py::list all;
            for (const auto& profile : p.profiles) all.append(frozen(profile_array(profile)));
            return py::tuple(all);
          },
          [](model::Plan& p, const std::vector<Points>& profiles) {
            if (profiles.size() != p.profiles.size())
              throw value_error("the plan has " + std::to_string(p.profiles.size()) + " profiles, and " +
                                std::to_string(profiles.size()) + " are given");
            std::vector<model::Profile> all;
            for (const auto& profile : profiles) all.push_back(profile_of(profile));
            p.profiles = std::move(all);
          })
      .def(
          "set_profile",
          [](model::Plan& p, std::size_t index, const Points& points) {
            if (index >= p.profiles.size()) throw py::index_error("there is no such profile");
            p.profiles[index] = profile_of(points);
          },
          py::arg("index"), py::arg("points"), "Replaces one profile by points (n, 2).")
      .def_property(
          "profile_of_edge", [](const model::Plan& p) { return py::tuple(py::cast(p.outer.profile_of_edge)); },
          [](model::Plan& p, std::vector<std::uint32_t> uses) {
            p.outer.profile_of_edge = checked_uses(std::move(uses), p.outer.points.size(), p.profiles.size());
          })
      .def_property_readonly("profile_of_hole_edge",
                             [](const model::Plan& p) {
                               py::list all;
                               for (const auto& hole : p.holes) all.append(py::tuple(py::cast(hole.profile_of_edge)));
                               return py::tuple(all);
                             })
      .def_readwrite("base", &model::Plan::base)
      .def_readwrite("cap", &model::Plan::cap)
      .def(
          "copy", [](const model::Plan& p) { return model::Plan(p); }, "A plan of its own.")
      .def("__eq__", [](const model::Plan& a, const model::Plan& b) { return a == b; })
      .def("__repr__", [](const model::Plan& p) {
        return "<mansard.Plan of " + std::to_string(p.outer.points.size()) + " edges, " +
               std::to_string(p.holes.size()) + " holes, " + std::to_string(p.profiles.size()) + " profiles>";
      });
}

void bind_solid(py::module_& m) {
  py::class_<SolidHandle>(m, "Solid")
      .def_property_readonly("vertices",
                             [](const py::object& self) {
                               const auto& vertices = self.cast<const SolidHandle&>()->solid.vertices;
                               return view(reinterpret_cast<const double*>(vertices.data()),
                                           {static_cast<py::ssize_t>(vertices.size()), 3}, self);
                             })
      .def_property_readonly("origin",
                             [](const SolidHandle& s) { return py::make_tuple(s.origin.x, s.origin.y, s.origin.z); })
      .def_property_readonly("faces",
                             [](const SolidHandle& s) {
                               py::list faces;
                               for (const auto& face : s->solid.faces) faces.append(py::cast(face.loops));
                               return faces;
                             })
      .def_property_readonly("normals",
                             [](const SolidHandle& s) {
                               std::vector<Point3> normals;
                               for (const auto& face : s->solid.faces) normals.push_back(face.normal);
                               return taken<double>(std::move(normals), 3);
                             })
      .def_property_readonly("areas",
                             [](const SolidHandle& s) {
                               std::vector<double> areas;
                               for (const auto& face : s->solid.faces) areas.push_back(solid::area(s->solid, face));
                               return taken<double>(std::move(areas), 0);
                             })
      .def_property_readonly("classes",
                             [](const py::object& self) {
                               const auto& classes = self.cast<const SolidHandle&>()->classes;
                               return view(reinterpret_cast<const std::uint8_t*>(classes.data()),
                                           {static_cast<py::ssize_t>(classes.size())}, self);
                             })
      .def(
          "triangles",
          [](const SolidHandle& s) {
            auto cut = value_of(solid::triangulate(s->solid));
            return py::make_tuple(taken<std::uint32_t>(std::move(cut.triangles), 3),
                                  taken<std::uint32_t>(std::move(cut.face_of), 0));
          },
          "The faces as triangles (m, 3), outward, and the face of each (m,).")
      .def_property_readonly("volume", [](const SolidHandle& s) { return solid::volume(s->solid); })
      .def(
          "check", [](const SolidHandle& s) { return solid::check(s->solid, solid::written_rules()); },
          "What is wrong with it by the rules of val3dity 2.6, planes to 0.1 mm; empty: valid.")
      .def("__repr__", [](const SolidHandle& s) {
        return "<mansard.Solid of " + std::to_string(s->solid.faces.size()) + " faces>";
      });
}

// Parts and buildings.

auto outcome_of(const BuildingHandle& b) -> py::object {
  if (b.city->reports.empty()) return py::none();
  return py::cast(std::string(report::to_string(b.city->reports[b.at].outcome)));
}

struct RaisedHandle {
  std::shared_ptr<const edit::RaisedBuilding> raised;
  geometry::Point3 origin;
};

auto raised(const BuildingHandle& b, const py::object& progress) -> RaisedHandle {
  const auto& city = *b.city;
  std::vector<model::Plan> neighbours;
  for (std::size_t other = 0; other < city.plans.size(); ++other)
    if (other != b.at)
      for (const auto& part : city.plans[other]) neighbours.push_back(part.plan);
  std::vector<edit::NamedPlan> before;
  for (const auto& part : b.building().parts) before.push_back({part.id, part.plan});
  auto made = std::make_shared<edit::RaisedBuilding>();
  run_work(progress, static_cast<std::uint64_t>(city.options.seed), [&](const base::Run& run) {
    edit::Site site{neighbours, before, city.scan ? &city.scan->rays() : nullptr};
    *made = edit::raise(city.plans[b.at], site, city.options, run);
  });
  return {made, origin_of(city.city.frame)};
}

auto solid_of(const CityPointer& city, const model::LabelledSolid& solid) -> SolidHandle {
  return {city, &solid, origin_of(city->city.frame)};
}

void bind_part(py::module_& m) {
  py::class_<PartHandle>(m, "Part")
      .def_property_readonly("id", [](const PartHandle& p) { return p.part().id; })
      .def_property_readonly("attributes", [](const PartHandle& p) { return attributes_of(p.part().attributes); })
      .def_property(
          "plan", [](PartHandle& p) -> model::Plan& { return p.plan(); },
          [](PartHandle& p, const model::Plan& plan) { p.plan() = plan; }, py::return_value_policy::reference_internal)
      .def_property_readonly("edited", [](const PartHandle& p) { return p.plan() != p.part().plan; })
      .def(
          "reset", [](PartHandle& p) { p.plan() = p.part().plan; }, "Takes back the edits of the plan.")
      .def_property_readonly("solid", [](const PartHandle& p) { return solid_of(p.city, p.part().model); })
      .def("__repr__", [](const PartHandle& p) { return "<mansard.Part '" + p.part().id + "'>"; });
}

void bind_building(py::module_& m) {
  py::class_<BuildingHandle>(m, "Building")
      .def_property_readonly("id", [](const BuildingHandle& b) { return b.building().id; })
      .def_property_readonly("attributes",
                             [](const BuildingHandle& b) { return attributes_of(b.building().attributes); })
      .def_property_readonly("ground",
                             [](const BuildingHandle& b) {
                               return b.building().ground + static_cast<double>(b.city->city.frame.origin[2]);
                             })
      .def_property_readonly("__geo_interface__",
                             [](const BuildingHandle& b) {
                               py::dict feature;
                               feature["type"] = "Feature";
                               feature["id"] = b.building().id;
                               feature["geometry"] = geo_of(b.building().footprint, b.city->city.frame);
                               feature["properties"] = attributes_of(b.building().attributes);
                               return feature;
                             })
      .def_property_readonly("parts",
                             [](const BuildingHandle& b) {
                               std::vector<PartHandle> parts;
                               for (std::size_t p = 0; p < b.building().parts.size(); ++p)
                                 parts.push_back({b.city, b.at, p});
                               return parts;
                             })
      .def_property_readonly("solids",
                             [](const BuildingHandle& b) {
                               std::vector<SolidHandle> solids;
                               for (const auto& solid : b.building().solids)
                                 solids.push_back(solid_of(b.city, solid.model));
                               return solids;
                             })
      .def_property_readonly("outcome", &outcome_of)
      .def_property_readonly("reasons",
                             [](const BuildingHandle& b) {
                               return b.city->reports.empty() ? std::vector<base::Diagnostic>()
                                                              : b.city->reports[b.at].reasons;
                             })
      .def_property_readonly(
          "rmse",
          [](const BuildingHandle& b) { return b.city->reports.empty() ? std::nullopt : b.city->reports[b.at].rmse; })
      .def_property_readonly("edited", [](const BuildingHandle& b) { return b.city->edited(b.at); })
      .def("extrude_plans", &raised, py::arg("progress") = py::none(),
           "Extrudes the edited plans and measures them, and changes nothing. Returns an ExtrudedBuilding.")
      .def("__repr__", [](const BuildingHandle& b) {
        return "<mansard.Building '" + b.building().id + "' of " + std::to_string(b.building().parts.size()) +
               " parts>";
      });

  py::class_<RaisedHandle>(m, "ExtrudedBuilding")
      .def_property_readonly("valid", [](const RaisedHandle& r) { return r.raised->valid(); })
      .def_property_readonly(
          "rmse",
          [](const RaisedHandle& r) { return r.raised->mse ? std::optional(std::sqrt(*r.raised->mse)) : std::nullopt; })
      .def_property_readonly("volume",
                             [](const RaisedHandle& r) {
                               double all = 0;
                               for (const auto& part : r.raised->parts) all += part.volume;
                               return all;
                             })
      .def_property_readonly("diagnostics",
                             [](const RaisedHandle& r) {
                               auto all = r.raised->diagnostics;
                               for (const auto& part : r.raised->parts)
                                 all.insert(all.end(), part.diagnostics.begin(), part.diagnostics.end());
                               return all;
                             })
      .def_property_readonly("solids", [](const RaisedHandle& r) {
        py::dict all;
        for (const auto& part : r.raised->parts)
          all[py::str(part.id)] =
              part.model ? py::cast(SolidHandle{r.raised, &*part.model, r.origin}) : py::object(py::none());
        return all;
      });
}

// The city.

/// With the edits of the plans taken over.
auto edited_city(const CityPointer& state, const py::object& progress) -> CityPointer {
  edit::History history(state->city);
  edit::Edit all{"plans edited in Python", {}};
  for (std::size_t b = 0; b < state->plans.size(); ++b)
    if (state->edited(b)) all.changes.push_back({state->city.buildings[b].id, 0, state->plans[b]});
  if (!all.changes.empty()) value_of(history.apply(std::move(all)));
  CityState edited;
  edited.city = run_for(progress, static_cast<std::uint64_t>(state->options.seed), [&](const base::Run& run) {
    const rays::Scene* mesh = state->scan ? &state->scan->rays() : nullptr;
    return edit::edited_city(
        state->city, history, [mesh](std::string_view) { return mesh; }, state->options, run);
  });
  edited.scan = state->scan;
  edited.options = state->options;
  return city_pointer(std::move(edited));
}

auto is_edited(const CityState& state) -> bool {
  for (std::size_t b = 0; b < state.plans.size(); ++b)
    if (state.edited(b)) return true;
  return false;
}

/// Each path in the format of its file extension. Of a format that cannot be written there is no file: the others are
/// complete, and the error says so. Returns the warnings.
auto write(const CityPointer& state, const std::vector<std::filesystem::path>& paths, const std::string& format,
           bool overwrite, const Settings& settings, const py::object& progress) -> std::vector<base::Diagnostic> {
  const auto written = is_edited(*state) ? edited_city(state, progress) : state;
  auto options = written->options;
  auto lists = pipeline::option_lists(options);
  apply(lists, {}, "", settings);
  std::vector<formats::Target> targets;
  for (const auto& path : paths) {
    std::optional<formats::Format> kind = formats::format_of(path);
    if (!format.empty()) {
      const auto& all = formats::formats();
      const auto at = std::ranges::find(all, format, &formats::FormatName::name);
      kind = at == all.end() ? std::nullopt : std::optional(at->format);
    }
    if (!kind) {
      std::string known;
      for (const auto& each : formats::formats())
        known += (known.empty() ? "" : ", ") + std::string(format.empty() ? each.ending : each.name);
      raise_error({base::error("option-value", "names no format; expected one of " + known,
                               format.empty() ? path.string() : format)});
    }
    targets.push_back({*kind, path});
    std::error_code status;
    if (!overwrite && std::filesystem::exists(path, status))
      raise_error(
          {base::error("output-exists", "already exists; choose another, or give overwrite=True", path.string())});
  }
  const auto made = run_for(progress, 1, [&](const base::Run& run) -> base::Result<formats::Written> {
    base::Outputs outputs;
    auto each = formats::write_each(
        targets, {written->city.frame, written->city.made_by}, options.write, {},
        [&](formats::CityWriter& writer) -> base::Result<void> {
          for (const auto& building : written->city.buildings) {
            if (run.cancelled()) return base::stopped();
            if (auto added = writer.add(building); !added) return added;
          }
          return writer.finish();
        },
        outputs);
    if (!each) return each;
    if (auto committed = outputs.commit(run.cancel); !committed) return committed.failure();
    return each;
  });
  std::vector<base::Diagnostic> missing;
  for (const auto& [target, why] : made.missing) {
    auto& told = missing.emplace_back(why);
    const auto name = target.path.filename().string();
    told.message += "; there is no " + name + ", and the other files are complete; once this is corrected, write " +
                    name + " alone";
  }
  if (!missing.empty()) raise_error(missing);
  return made.warnings;
}

auto read_city(const std::filesystem::path& path, const std::string& preset, const Settings& settings,
               const py::object& progress) -> CityPointer {
  auto reader = value_of(formats::read_city(path));
  CityState state;
  state.options = options_of(preset, {});
  state.warnings = pipeline::take_options(reader->header().made_by, state.options);
  auto lists = pipeline::option_lists(state.options);
  apply(lists, {}, "", settings);
  auto raised = run_for(progress, static_cast<std::uint64_t>(state.options.seed),
                        [&](const base::Run& run) { return pipeline::read_raised(*reader, state.options, run); });
  for (auto& part : raised.fell_short)
    state.warnings.insert(state.warnings.end(), part.reasons.begin(), part.reasons.end());
  for (const auto* more : {&raised.refused, &raised.remarks})
    state.warnings.insert(state.warnings.end(), more->begin(), more->end());
  state.city = std::move(raised.city);
  pipeline::note_options(state.options, state.city.made_by);
  return city_pointer(std::move(state));
}

auto error_map(const CityState& state) -> py::object {
  if (state.error_maps.empty()) return py::none();
  return map_array(evaluate::merged(state.error_maps), state.city.frame);
}

}  // namespace

auto Scan::rays() const -> const rays::Scene& {
  if (!rays_) rays_.emplace(scene_.mesh);
  return *rays_;
}

auto CityState::edited(std::size_t building) const -> bool {
  const auto& parts = city.buildings[building].parts;
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (plans[building][p].plan != parts[p].plan) return true;
  return false;
}

auto city_pointer(CityState state) -> CityPointer {
  for (const auto& building : state.city.buildings) {
    auto& plans = state.plans.emplace_back();
    for (const auto& part : building.parts) plans.push_back({part.id, part.plan});
  }
  return std::make_shared<CityState>(std::move(state));
}

auto map_array(evaluate::ErrorMap map, const model::Frame& frame) -> py::tuple {
  const auto origin = origin_of(frame);
  const double x = map.origin.x + origin.x - map.grid / 2, y = map.origin.y + origin.y - map.grid / 2;
  const auto extent = py::make_tuple(x, x + map.grid * static_cast<double>(map.columns), y,
                                     y + map.grid * static_cast<double>(map.rows));
  const auto rows = static_cast<py::ssize_t>(map.rows), columns = static_cast<py::ssize_t>(map.columns);
  return py::make_tuple(taken<float>(std::move(map.difference), 0).attr("reshape")(rows, columns), extent);
}

auto to_python(const model::Value& value) -> py::object {
  return std::visit(
      [](const auto& v) -> py::object {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>) return py::none();
        else return py::cast(v);
      },
      value);
}

auto ring_array(const geometry::Ring& ring) -> py::array_t<double> {
  return taken<double>(std::vector<geometry::Point2>(ring.begin(), ring.end()), 2);
}

auto geo_of(const std::vector<geometry::Polygon>& polygons, const model::Frame& frame) -> py::dict {
  const auto x = static_cast<double>(frame.origin[0]), y = static_cast<double>(frame.origin[1]);
  const auto ring_of_points = [&](const geometry::Ring& ring) {
    py::list points;
    for (const auto& p : ring) points.append(py::make_tuple(p.x + x, p.y + y));
    if (!ring.empty()) points.append(py::make_tuple(ring.front().x + x, ring.front().y + y));
    return points;
  };
  py::list all;
  for (const auto& polygon : polygons) {
    py::list rings;
    rings.append(ring_of_points(polygon.outer));
    for (const auto& hole : polygon.holes) rings.append(ring_of_points(hole));
    all.append(rings);
  }
  py::dict geometry;
  const bool one = polygons.size() == 1;
  geometry["type"] = one ? "Polygon" : "MultiPolygon";
  geometry["coordinates"] = one ? py::object(all[0]) : py::object(all);
  return geometry;
}

void bind_city(py::module_& m) {
  py::class_<base::Diagnostic>(m, "Diagnostic")
      .def_property_readonly(
          "severity",
          [](const base::Diagnostic& d) { return d.severity == base::Severity::error ? "error" : "warning"; })
      .def_readonly("code", &base::Diagnostic::code)
      .def_readonly("message", &base::Diagnostic::message)
      .def_readonly("subject", &base::Diagnostic::subject)
      .def("__str__", [](const base::Diagnostic& d) { return base::to_string(d); })
      .def("__repr__", [](const base::Diagnostic& d) { return "<mansard.Diagnostic " + base::to_string(d) + ">"; });
  bind_plan(m);
  bind_solid(m);
  bind_part(m);
  bind_building(m);

  py::class_<CityState, CityPointer>(m, "City")
      .def_property_readonly("buildings",
                             [](const CityPointer& c) {
                               std::vector<BuildingHandle> all;
                               for (std::size_t b = 0; b < c->city.buildings.size(); ++b) all.push_back({c, b});
                               return all;
                             })
      .def("__len__", [](const CityState& c) { return c.city.buildings.size(); })
      .def("__getitem__",
           [](const CityPointer& c, const std::string& id) {
             const auto& all = c->city.buildings;
             const auto at = std::ranges::find(all, id, &model::Building::id);
             if (at == all.end()) throw py::key_error(id);
             return BuildingHandle{c, static_cast<std::size_t>(at - all.begin())};
           })
      .def_property_readonly("crs", [](const CityState& c) { return c.city.frame.crs; })
      .def_property_readonly("origin", [](const CityState& c) { return py::tuple(py::cast(c.city.frame.origin)); })
      .def_property_readonly("version", [](const CityState& c) { return c.city.made_by.version; })
      .def_property_readonly("options",
                             [](const CityState& c) {
                               py::dict all;
                               for (const auto& [key, value] : c.city.made_by.options) all[py::str(key)] = value;
                               return all;
                             })
      .def_readonly("warnings", &CityState::warnings)
      .def_property_readonly("report_text", [](const CityState& c) { return c.report; })
      .def("error_map", &error_map,
           "Model - mesh in metres, (rows, columns) from the south, and (xmin, xmax, ymin, ymax); None without a mesh.")
      .def_property_readonly("edited", &is_edited)
      .def("with_edits", &edited_city, py::arg("progress") = py::none(),
           "A city in which the edited plans are extruded and all faces are classified again.")
      .def("_write_all", &write, py::arg("paths"), py::arg("format"), py::arg("overwrite"), py::arg("settings"),
           py::arg("progress"))
      .def("__repr__", [](const CityState& c) {
        return "<mansard.City of " + std::to_string(c.city.buildings.size()) + " buildings" +
               (c.city.frame.crs.empty() ? "" : " in " + c.city.frame.crs) + ">";
      });
  m.def("read_city", &read_city, py::arg("path"), py::arg("preset"), py::arg("settings"), py::arg("progress"));
  m.def(
      "extrude_plan",
      [](const model::Plan& plan, const Settings& settings) {
        const auto options = options_of("", settings);
        auto raised = value_of(pipeline::raise_part(plan, options));
        std::vector<model::Solid> solids{std::move(raised.solid)};
        auto solid = std::make_shared<model::LabelledSolid>(
            std::move(label::classify(std::move(solids), options.label).front()));
        return py::make_tuple(SolidHandle{solid, solid.get(), {}}, raised.outcome == extrude::Outcome::full,
                              raised.warnings);
      },
      py::arg("plan"), py::arg("settings"));
}

}  // namespace mansard::python
