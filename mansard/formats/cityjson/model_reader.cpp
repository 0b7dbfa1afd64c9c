// CityJSON 1.0 to 2.0 and CityJSONSeq: the buildings of a city model.
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "mansard/base/nesting.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/json/json_access.hpp"
#include "mansard/formats/models.hpp"
#include "mansard/formats/files/words.hpp"

namespace mansard::formats {
namespace {

using geometry::Point3;

auto bad(const std::string& what, const std::string& name) -> base::Diagnostic {
  return base::error("ingest-model-format", what + "; check what the file is, or export it again", name);
}

/// An array to go through; an empty one for anything else.
auto all_of(const Json& value) -> const Json& {
  static const Json none = Json::array();
  return value.is_array() ? value : none;
}

/// A LoD is text since CityJSON 1.1 and was a number before.
auto lod_of(const Json& geometry) -> std::string {
  const Json& lod = member(geometry, "lod");
  if (lod.is_number()) return base::to_text(lod.get<double>());
  return text_of(lod);
}

auto value_of(const std::string& lod) -> double { return base::to_number(lod).value_or(0); }

struct Transform {
  std::array<double, 3> scale{1, 1, 1}, translate{0, 0, 0};
};

auto transform_of(const Json& document) -> Transform {
  Transform out;
  const Json& transform = member(document, "transform");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const Json& s = item(member(transform, "scale"), axis); s.is_number()) out.scale[axis] = s.get<double>();
    if (const Json& t = item(member(transform, "translate"), axis); t.is_number())
      out.translate[axis] = t.get<double>();
  }
  return out;
}

auto vertices_of(const Json& document, const Transform& transform) -> std::vector<Point3> {
  constexpr double lost = std::numeric_limits<double>::quiet_NaN();
  std::vector<Point3> out;
  const Json& vertices = member(document, "vertices");
  if (!vertices.is_array()) return out;
  out.reserve(vertices.size());
  for (const Json& vertex : vertices) {
    std::array<double, 3> c{lost, lost, lost};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (const Json& number = item(vertex, axis); number.is_number())
        c[axis] = number.get<double>() * transform.scale[axis] + transform.translate[axis];
    out.push_back({c[0], c[1], c[2]});
  }
  return out;
}

/// The class of a semantic surface; none for one that does not say. The outer ceiling is the underside of the eaves,
/// the outer floor a terrace: both belong to the roof.
auto class_of(const std::string& type) -> std::optional<model::SurfaceClass> {
  if (type == "WallSurface") return model::SurfaceClass::wall;
  if (type == "RoofSurface" || type == "OuterCeilingSurface" || type == "OuterFloorSurface")
    return model::SurfaceClass::roof;
  if (type == "GroundSurface") return model::SurfaceClass::ground;
  if (type == "Window" || type == "Door" || type.empty()) return std::nullopt;  // in walls or roofs: by direction
  return model::SurfaceClass::other;
}

/// What was met and not used, for one warning each.
struct Tally {
  std::map<std::string, std::size_t> objects, geometries, lods;
  std::size_t without_geometry = 0, without_lod = 0, repeated = 0, shells = 0;
};

class Reader {
 public:
  Reader(const std::string& lod, const std::string& name) : wanted_(lod), name_(name) {}

  auto add(const Json& document, const Transform& transform) -> base::Result<void> {
    vertices_ = vertices_of(document, transform);
    const Json& objects = member(document, "CityObjects");
    if (!objects.is_object()) return bad("it has no CityObjects", name_);
    for (const auto& [id, object] : objects.items()) {
      const std::string type = text_of(member(object, "type"));
      if (!is_building(type)) {
        ++tally_.objects[type];
        continue;
      }
      if (auto done = add_object(objects, id, object); !done) return done;
    }
    return {};
  }

  auto finish(std::string crs) -> base::Result<RawModel> {
    if (!wanted_.empty() && tally_.lods.empty() && tally_.without_lod > 0)
      return base::error("ingest-model-lod", "no building has LoD " + wanted_ + "; there are " + listed(known_lods_),
                         name_);
    RawModel out;
    out.buildings = std::move(buildings_);
    out.crs = std::move(crs);
    for (const auto& [lod, count] : tally_.lods) out.lod += (out.lod.empty() ? "" : ", ") + lod;
    warn(out.warnings);
    return out;
  }

 private:
  static auto is_building(const std::string& type) -> bool {
    return type == "Building" || type == "BuildingPart" || type == "BuildingInstallation";
  }

  static auto listed(const std::set<std::string>& words) -> std::string {
    std::string all;
    for (const auto& word : words) all += (all.empty() ? "" : ", ") + (word.empty() ? "unnamed" : word);
    return all.empty() ? "none" : all;
  }

  /// The part and the building that an object's faces belong to: an installation is part of what it is on.
  auto place_of(const Json& objects, std::string id, const Json& object) -> model::ModelPart& {
    std::string part;
    const Json* at = &object;
    for (std::size_t steps = 0; steps < 8; ++steps) {  // no deeper than any sane hierarchy, and no circle
      const bool installation = text_of(member(*at, "type")) == "BuildingInstallation";
      if (part.empty() && !installation) part = id;
      const std::string parent = text_of(item(member(*at, "parents"), 0));
      if (parent.empty() || !objects.contains(parent)) break;
      id = parent;
      at = &objects[parent];
    }
    if (part.empty()) part = id;
    const auto [b, is_new] = building_of_.try_emplace(id, buildings_.size());
    if (is_new) buildings_.push_back({id, {}});
    auto& parts = buildings_[b->second].parts;
    const auto [p, is_first] = part_of_.try_emplace({b->second, part}, parts.size());
    if (is_first) parts.push_back({part, {}});
    return parts[p->second];
  }

  auto add_object(const Json& objects, const std::string& id, const Json& object) -> base::Result<void> {
    model::ModelPart& part = place_of(objects, id, object);
    const Json* geometry = choose(member(object, "geometry"));
    if (geometry == nullptr) return {};
    const std::string type = text_of(member(*geometry, "type"));
    const Json& boundaries = member(*geometry, "boundaries");
    const Json& semantics = member(*geometry, "semantics");
    const Json &values = member(semantics, "values"), &surfaces = member(semantics, "surfaces");
    if (type == "MultiSurface" || type == "CompositeSurface") return add_surfaces(boundaries, values, surfaces, part);
    if (type == "Solid") return add_solid(boundaries, values, surfaces, part);
    for (std::size_t i = 0; i < boundaries.size(); ++i)
      if (auto done = add_solid(item(boundaries, i), item(values, i), surfaces, part); !done) return done;
    return {};
  }

  /// The geometry to read: of the LoD asked for, or of the highest one; LoD 0 is a footprint.
  auto choose(const Json& geometries) -> const Json* {
    const Json* best = nullptr;
    std::string lod;
    bool any = false;
    for (const Json& geometry : all_of(geometries)) {
      const std::string type = text_of(member(geometry, "type")), own = lod_of(geometry);
      static const std::set<std::string> known{"MultiSurface", "CompositeSurface", "Solid", "MultiSolid",
                                               "CompositeSolid"};
      if (!known.contains(type)) {
        ++tally_.geometries[type];
        continue;
      }
      if (!own.empty() && value_of(own) < 1) continue;
      any = true;
      known_lods_.insert(own);
      if (!wanted_.empty() && own != wanted_ && !own.starts_with(wanted_ + ".")) continue;
      if (best != nullptr && own == lod) ++tally_.repeated;
      if (best != nullptr && value_of(own) <= value_of(lod)) continue;
      best = &geometry;
      lod = own;
    }
    if (best != nullptr) ++tally_.lods[lod.empty() ? "unnamed" : lod];
    else ++(any ? tally_.without_lod : tally_.without_geometry);
    return best;
  }

  auto add_solid(const Json& shells, const Json& values, const Json& surfaces, model::ModelPart& part)
      -> base::Result<void> {
    if (shells.is_array() && shells.size() > 1) tally_.shells += shells.size() - 1;
    return add_surfaces(item(shells, 0), item(values, 0), surfaces, part);
  }

  auto add_surfaces(const Json& boundaries, const Json& values, const Json& surfaces, model::ModelPart& part)
      -> base::Result<void> {
    if (!boundaries.is_array()) return bad("the boundaries of '" + part.id + "' are no array", name_);
    for (std::size_t i = 0; i < boundaries.size(); ++i) {
      model::ModelFace face;
      for (const Json& ring : all_of(boundaries[i])) {
        auto& loop = face.loops.emplace_back();
        for (const Json& corner : all_of(ring)) {
          if (!corner.is_number_integer() || corner.get<std::int64_t>() < 0 ||
              corner.get<std::uint64_t>() >= vertices_.size())
            return bad("'" + part.id + "' names a vertex that does not exist (" + corner.dump() + ")", name_);
          loop.push_back(vertices_[corner.get<std::size_t>()]);
        }
      }
      const Json& value = item(values, i);
      const Json& surface = value.is_number_unsigned() ? item(surfaces, value.get<std::size_t>()) : Json();
      const auto kind = class_of(text_of(member(surface, "type")));
      face.kind = kind.value_or(model::SurfaceClass::other);
      face.by_normal = !kind;
      part.faces.push_back(std::move(face));
    }
    return {};
  }

  void warn(std::vector<base::Diagnostic>& warnings) const {
    const auto say = [&](const std::string& words) {
      warnings.push_back(base::warning("ingest-model-left-out", words, name_));
    };
    const auto counted = [](const std::map<std::string, std::size_t>& by_type) {
      std::string all;
      for (const auto& [type, count] : by_type)
        all += (all.empty() ? "" : ", ") + std::to_string(count) + " " + (type.empty() ? "without a type" : type);
      return all;
    };
    if (!tally_.objects.empty()) say("objects that are no buildings were left out: " + counted(tally_.objects));
    if (!tally_.geometries.empty()) say("geometries of other kinds were left out: " + counted(tally_.geometries));
    if (tally_.without_lod > 0)
      say(std::to_string(tally_.without_lod) + " objects have no geometry of LoD " + wanted_ + " and were left out");
    if (tally_.repeated > 0)
      say(std::to_string(tally_.repeated) + " geometries repeat the LoD of one before them; the first was read");
    if (tally_.shells > 0) say(std::to_string(tally_.shells) + " inner shells of solids were left out");
    if (tally_.lods.size() > 1)
      warnings.push_back(base::warning(
          "ingest-model-lods",
          "the highest LoD differs between objects: " + counted(tally_.lods) + "; --lod reads one of them", name_));
  }

  std::string wanted_;
  const std::string& name_;
  std::vector<Point3> vertices_;
  std::vector<model::ModelBuilding> buildings_;
  std::map<std::string, std::size_t> building_of_;
  std::map<std::pair<std::size_t, std::string>, std::size_t> part_of_;
  std::set<std::string> known_lods_;
  Tally tally_;
};

auto check_head(const Json& document, const std::string& name) -> base::Result<void> {
  if (text_of(member(document, "type")) != "CityJSON") return bad("it is JSON, but no CityJSON", name);
  const std::string version = text_of(member(document, "version"));
  if (version.starts_with("1.") || version.starts_with("2.")) return {};
  return bad("it is CityJSON " + (version.empty() ? "without a version" : version) + ", and 1.0 to 2.0 are read", name);
}

/// A line per document: the first is the head, the others are features with vertices of their own.
auto read_lines(std::string_view bytes, Reader& reader, Json& head, const std::string& name) -> base::Result<void> {
  std::size_t number = 0;
  Transform transform;
  while (!bytes.empty()) {
    const auto line = take_line(bytes);
    ++number;
    if (line.find_first_not_of(" \t") == line.npos) continue;
    Json document = Json::parse(line, nullptr, false);
    if (document.is_discarded())
      return bad(head.is_null() ? "it is neither CityJSON nor OBJ, or it is cut short"
                                : "line " + std::to_string(number) + " is not JSON",
                 name);
    if (head.is_null()) {
      if (auto sound = check_head(document, name); !sound) return sound;
      transform = transform_of(document);
      head = document;
    }
    if (auto done = reader.add(document, transform); !done) return done;
  }
  return {};
}

}  // namespace

auto read_cityjson(std::string_view bytes, const std::string& lod, const std::string& name) -> base::Result<RawModel> {
  if (base::nests_too_deep(bytes)) return bad("its JSON nests too deep", name);
  Reader reader(lod, name);
  Json document = Json::parse(bytes, nullptr, false);
  if (document.is_discarded()) {
    document = Json();
    if (auto done = read_lines(bytes, reader, document, name); !done) return done.error();
  } else {
    if (auto sound = check_head(document, name); !sound) return sound.error();
    if (auto done = reader.add(document, transform_of(document)); !done) return done.error();
  }
  return reader.finish(text_of(member(member(document, "metadata"), "referenceSystem")));
}

}  // namespace mansard::formats
