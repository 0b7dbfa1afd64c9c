#include "mansard/formats/foreign.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/cityjson/address.hpp"
#include "mansard/formats/cityjson/cityjson_document.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/model/file_grid.hpp"

namespace mansard::formats {
namespace {

using geometry::Point2;
using geometry::Point3;
using model::FaceClass;

constexpr double upright = 0.2;  // z of a normal, as label::Options::wall_angle

auto class_of(const Json& semantics, Point3 normal) -> FaceClass {
  const std::string type = text_of(member(semantics, "type"));
  if (type == "RoofSurface" || type == "OuterFloorSurface") return FaceClass::roof;
  if (type == "GroundSurface") return FaceClass::ground;
  if (type == "OuterCeilingSurface") return FaceClass::soffit;
  if (type == "WallSurface") return FaceClass::wall;
  return normal.z > upright ? FaceClass::roof : normal.z < -upright ? FaceClass::ground : FaceClass::wall;
}

auto value_of(const Json& json) -> model::Value {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  if (json.is_null()) return {};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

auto attributes_of(const Json& object) -> model::Attributes {
  model::Attributes out;
  const Json& all = member(object, "attributes");
  if (all.is_object())
    for (const auto& [name, value] : all.items()) out.emplace_back(name, value_of(value));
  detail::each_of_address(object,
                          [&](const std::string& name, const Json& value) { out.emplace_back(name, value_of(value)); });
  return out;
}

auto is_building(const std::string& type) -> bool {
  return type == "Building" || type == "BuildingPart" || type == "BuildingInstallation" ||
         type == "BuildingConstructiveElement";
}

/// "EPSG:7415" of "urn:ogc:def:crs:EPSG::7415" or "https://www.opengis.net/def/crs/EPSG/0/7415"; empty without a code.
auto crs_of(const std::string& system) -> std::string {
  if (system.find("EPSG") == std::string::npos) return {};
  const auto digits = system.find_last_not_of("0123456789");
  const std::string code = digits == std::string::npos ? system : system.substr(digits + 1);
  return code.empty() ? std::string() : "EPSG:" + code;
}

class ForeignReader {
 public:
  auto add(const CityDocument& document) -> base::Result<void> {
    const Json& objects = document.objects();
    for (const auto& [id, object] : objects.items()) {
      const std::string type = text_of(member(object, "type"));
      if (!is_building(type)) ++others_[type];
    }
    for (const auto& [id, object] : objects.items()) {
      if (text_of(member(object, "type")) != "Building") continue;
      add_building(document, id, object);
    }
    return {};
  }

  void finish(ForeignCity& out) {
    for (const auto& lod : lods_) out.lods += (out.lods.empty() ? "" : ", ") + lod;
    const auto warn = [&](std::size_t count, const std::string& what) {
      if (count > 0) out.warnings.push_back(base::warning("write-foreign", std::to_string(count) + " " + what));
    };
    for (const auto& [type, count] : others_) warn(count, "objects of the type " + type + " are left out");
    warn(without_, "buildings have no surfaces at any level of detail");
    warn(lost_, "faces have no area, or corners that are missing, and are left out");
    out.city.buildings = std::move(buildings_);
    if (origin_) out.city.frame.origin = *origin_;
  }

 private:
  void add_building(const CityDocument& document, const std::string& id, const Json& object) {
    std::vector<std::pair<std::string, const Json*>> all{{id, &object}};
    std::set<std::string> seen{id};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Json& children = member(*all[i].second, "children");
      for (std::size_t c = 0; children.is_array() && c < children.size(); ++c) {
        const std::string child = text_of(children[c]);
        const Json& found = member(document.objects(), child.c_str());
        if (found.is_object() && is_building(text_of(member(found, "type"))) && seen.insert(child).second)
          all.emplace_back(child, &found);
      }
    }
    // One level for all of a building: a part in detail beside another one as a block would be no model of it.
    std::string finest;
    for (const auto& [key, one] : all)
      each_geometry(*one, [&](const Json& geometry, const std::string& lod) {
        if (shell_depth(geometry) && lod != "0" && lod.substr(0, 2) != "0." && number_of(lod) > number_of(finest))
          finest = lod;
      });
    model::Building building;
    building.id = id;
    building.attributes = attributes_of(object);
    for (const auto& [key, one] : all) {
      model::LabelledSolid model;
      each_geometry(*one, [&](const Json& geometry, const std::string& lod) {
        if (lod == finest && !finest.empty()) add_surfaces(document, geometry, model);
      });
      if (model.solid.faces.empty()) continue;
      building.solids.push_back({{building.parts.size()}, model});
      building.parts.push_back(
          {key == id ? id + "-1" : key, {}, std::move(model), key == id ? model::Attributes() : attributes_of(*one)});
    }
    if (building.parts.empty()) ++without_;
    else lods_.insert(finest);
    add_footprint(document, object, building);
    buildings_.push_back(std::move(building));
  }

  static auto number_of(const std::string& lod) -> double {
    return lod.empty() ? -1 : base::to_number(lod).value_or(0);
  }

  template <class Work>
  static void each_geometry(const Json& object, Work work) {
    const Json& all = member(object, "geometry");
    for (std::size_t i = 0; all.is_array() && i < all.size(); ++i) work(all[i], lod_of(all[i]));
  }

  auto local(Point3 p) -> Point3 {
    if (!origin_) {
      origin_.emplace();
      const std::array<double, 3> c{p.x, p.y, 0};  // heights stay as they are
      for (std::size_t axis = 0; axis < 3; ++axis) (*origin_)[axis] = static_cast<std::int64_t>(std::floor(c[axis]));
    }
    const auto on_grid = [](double v, std::int64_t origin) {
      return std::round((v - static_cast<double>(origin)) * model::quanta_per_metre) / model::quanta_per_metre;
    };
    return {on_grid(p.x, (*origin_)[0]), on_grid(p.y, (*origin_)[1]), on_grid(p.z, (*origin_)[2])};
  }

  /// The rings of a surface, without corners that repeat; empty where one is missing or not finite.
  auto rings_of(const CityDocument& document, const Json& rings) -> std::vector<std::vector<Point3>> {
    constexpr double far = 1e8;  // m
    std::vector<std::vector<Point3>> out;
    for (std::size_t r = 0; rings.is_array() && r < rings.size(); ++r) {
      auto& loop = out.emplace_back();
      for (std::size_t i = 0; rings[r].is_array() && i < rings[r].size(); ++i) {
        const auto* vertex = document.vertex(rings[r][i]);
        if (vertex == nullptr || !(std::abs(vertex->x) < far && std::abs(vertex->y) < far && std::abs(vertex->z) < far))
          return {};
        const Point3 p = local(*vertex);
        if (loop.empty() || loop.back() != p) loop.push_back(p);
      }
      while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
      if (loop.size() < 3) {
        if (out.size() == 1) return {};
        out.pop_back();
      }
    }
    return out;
  }

  void add_surfaces(const CityDocument& document, const Json& geometry, model::LabelledSolid& model) {
    std::map<Point3, std::uint32_t> numbers;
    for (std::uint32_t v = 0; v < model.solid.vertices.size(); ++v) numbers.emplace(model.solid.vertices[v], v);
    const detail::Item whole{geometry, {}};
    detail::each_shell(whole, [&](const detail::CityShell& shell) {
      detail::each_surface(shell, [&](const detail::CitySurface& surface) {
        const auto rings = rings_of(document, surface.rings.json);
        Point3 sum;
        if (!rings.empty())
          for (std::size_t i = 1; i + 1 < rings[0].size(); ++i)
            sum = sum + cross(rings[0][i] - rings[0][0], rings[0][i + 1] - rings[0][0]);
        constexpr double least = 1e-8;  // m², twice the area: less than a quantum's square
        if (!(length(sum) > least)) {
          ++lost_;
          return;
        }
        model::Face face;
        face.normal = geometry::normalised(sum);
        for (const auto& ring : rings) {
          auto& loop = face.loops.emplace_back();
          for (const auto p : ring) {
            const auto [entry, added] = numbers.try_emplace(p, static_cast<std::uint32_t>(model.solid.vertices.size()));
            if (added) model.solid.vertices.push_back(p);
            loop.push_back(entry->second);
          }
        }
        const auto kind = class_of(surface.semantics, face.normal);
        face.kind = kind == FaceClass::ground   ? model::FaceKind::base
                    : kind == FaceClass::soffit ? model::FaceKind::soffit
                                                : model::FaceKind::side;
        model.solid.faces.push_back(std::move(face));
        model.classes.push_back(kind);
      });
    });
  }

  /// LoD 0, or the ground of the models.
  void add_footprint(const CityDocument& document, const Json& object, model::Building& building) {
    double lowest = std::numeric_limits<double>::infinity();
    const auto add = [&](const std::vector<std::vector<Point3>>& rings) {
      geometry::Polygon polygon;
      for (std::size_t r = 0; r < rings.size(); ++r) {
        auto& ring = r == 0 ? polygon.outer : polygon.holes.emplace_back();
        for (const auto p : rings[r]) {
          ring.push_back(xy(p));
          lowest = std::min(lowest, p.z);
        }
      }
      if (polygon.outer.size() >= 3) building.footprint.push_back(geometry::oriented(std::move(polygon)));
    };
    each_geometry(object, [&](const Json& geometry, const std::string& lod) {
      if (lod != "0" && lod.substr(0, 2) != "0.") return;
      if (!building.footprint.empty()) return;  // "0.1" and "0.2" are the same place
      detail::each_shell(detail::Item{geometry, {}}, [&](const detail::CityShell& shell) {
        detail::each_surface(shell, [&](const detail::CitySurface& surface) {
          if (const auto rings = rings_of(document, surface.rings.json); !rings.empty()) add(rings);
        });
      });
    });
    if (building.footprint.empty()) {
      for (const auto& part : building.parts)
        for (std::size_t f = 0; f < part.model.classes.size(); ++f) {
          if (part.model.classes[f] != FaceClass::ground) continue;
          std::vector<std::vector<Point3>> rings;
          for (const auto& loop : part.model.solid.faces[f].loops) {
            auto& ring = rings.emplace_back();
            for (const auto v : loop) ring.push_back(part.model.solid.vertices[v]);
          }
          add(rings);
        }
      if (auto united = geometry::unite(building.footprint)) building.footprint = std::move(*united);
    }
    for (const auto& part : building.parts)
      for (const auto v : part.model.solid.vertices) lowest = std::min(lowest, v.z);
    building.ground = std::isfinite(lowest) ? lowest : 0;
  }

  std::optional<std::array<std::int64_t, 3>> origin_;
  std::vector<model::Building> buildings_;
  std::map<std::string, std::size_t> others_;
  std::set<std::string> lods_;
  std::size_t without_ = 0, lost_ = 0;
};

}  // namespace

auto read_foreign(const std::filesystem::path& path) -> base::Result<ForeignCity> {
  const auto bytes = base::read_file(path);
  if (!bytes) return bytes.failure();
  auto input = input_file(path);
  if (!input) return input.failure();
  const CityComplaints complaints{"ingest-model-format", path.string(), [](std::size_t line, bool first) {
                                    return first ? std::string("it is not CityJSON, or it is cut short")
                                                 : "line " + std::to_string(line) + " is not JSON";
                                  }};
  ForeignReader reader;
  const auto system =
      each_document(*bytes, complaints, [&](const CityDocument& document) { return reader.add(document); });
  if (!system) return system.failure();
  ForeignCity out;
  reader.finish(out);
  out.city.frame.crs = crs_of(*system);
  if (!out.city.frame.crs.empty()) {
    crs::register_gdal();
    const crs::GdalMessages messages;
    const auto known = crs::from_words(out.city.frame.crs);
    if (known && !crs::in_metres(known->system))
      return base::error("ingest-model-format",
                         "its coordinates are not in metres (" + out.city.frame.crs +
                             "); bring it to a projected coordinate system first",
                         path.string());
    if (!known) out.city.frame.crs.clear();
  }
  out.city.made_by.inputs.push_back(std::move(*input));
  if (out.city.buildings.empty())
    return base::error("ingest-model-format", "it has no buildings; give a city model with buildings", path.string());
  for (auto& warning : out.warnings) warning.subject = path.string();
  return out;
}

auto takes_foreign(Format format) -> bool {
  switch (format) {
    case Format::cityjson:
    case Format::cityjsonseq:
    case Format::geojson:
    case Format::plans: return false;
    default: return true;
  }
}

}  // namespace mansard::formats
