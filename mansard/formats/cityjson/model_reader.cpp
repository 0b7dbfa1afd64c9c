// CityJSON 1.0 to 2.0 and CityJSONSeq: the buildings of a city model.
#include <map>
#include <optional>
#include <set>

#include "mansard/base/text.hpp"
#include "mansard/formats/cityjson/cityjson_document.hpp"
#include "mansard/formats/models.hpp"

namespace mansard::formats {
namespace {

using geometry::Point3;

auto model_complaints(const std::string& name) -> CityComplaints {
  return {"ingest-model-format", name, [](std::size_t line, bool first) {
            return first ? "it is neither CityJSON nor OBJ, or it is cut short"
                         : "line " + std::to_string(line) + " is not JSON";
          }};
}

/// An array to go through; an empty one for anything else.
auto all_of(const Json& value) -> const Json& {
  static const Json none = Json::array();
  return value.is_array() ? value : none;
}

auto value_of(const std::string& lod) -> double { return base::to_number(lod).value_or(0); }

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

class ModelReader {
 public:
  ModelReader(const std::string& lod, const std::string& name, const CityComplaints& complaints)
      : wanted_(lod), name_(name), bad_(complaints) {}

  auto add(const CityDocument& document) -> base::Result<void> {
    const Json& objects = document.objects();
    for (const auto& [id, object] : objects.items()) {
      const std::string type = text_of(member(object, "type"));
      if (!is_building(type)) {
        ++tally_.objects[type];
        continue;
      }
      if (auto done = add_object(document, id, object); !done) return done;
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
    if (is_first) parts.push_back({part, {}, text_of(member(member(objects.at(part), "attributes"), "ms_role"))});
    return parts[p->second];
  }

  auto add_object(const CityDocument& document, const std::string& id, const Json& object) -> base::Result<void> {
    model::ModelPart& part = place_of(document.objects(), id, object);
    const Json* geometry = choose(member(object, "geometry"));
    base::Result<void> done;
    if (geometry == nullptr) return done;
    detail::each_shell({*geometry, {}}, [&](const detail::CityShell& shell) {
      if (!done) return;
      if (shell.number > 0) ++tally_.shells;
      else if (!shell.surfaces.json.is_array()) done = bad_("the boundaries of '" + part.id + "' are no array");
      else
        detail::each_surface(shell, [&](const detail::CitySurface& surface) {
          if (done) done = add_surface(document, surface, part);
        });
    });
    return done;
  }

  /// The geometry to read: of the LoD asked for, or of the highest one; LoD 0 is a footprint.
  auto choose(const Json& geometries) -> const Json* {
    const Json* best = nullptr;
    std::string lod;
    bool any = false;
    for (const Json& geometry : all_of(geometries)) {
      const std::string own = lod_of(geometry);
      if (!shell_depth(geometry)) {
        ++tally_.geometries[text_of(member(geometry, "type"))];
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

  auto add_surface(const CityDocument& document, const detail::CitySurface& surface, model::ModelPart& part)
      -> base::Result<void> {
    model::ModelFace face;
    for (const Json& ring : all_of(surface.rings.json)) {
      auto& loop = face.loops.emplace_back();
      for (const Json& corner : all_of(ring)) {
        const Point3* vertex = document.vertex(corner);
        if (vertex == nullptr)
          return bad_("'" + part.id + "' names a vertex that does not exist (" + corner.dump() + ")");
        loop.push_back(*vertex);
      }
    }
    const auto kind = class_of(text_of(member(surface.semantics, "type")));
    face.kind = kind.value_or(model::SurfaceClass::other);
    face.by_normal = !kind;
    part.faces.push_back(std::move(face));
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
  const CityComplaints& bad_;
  std::vector<model::ModelBuilding> buildings_;
  std::map<std::string, std::size_t> building_of_;
  std::map<std::pair<std::size_t, std::string>, std::size_t> part_of_;
  std::set<std::string> known_lods_;
  Tally tally_;
};

}  // namespace

auto read_cityjson(std::string_view bytes, const std::string& lod, const std::string& name) -> base::Result<RawModel> {
  const CityComplaints complaints = model_complaints(name);
  ModelReader reader(lod, name, complaints);
  auto crs = each_document(bytes, complaints, [&](const CityDocument& document) { return reader.add(document); });
  if (!crs) return crs.error();
  return reader.finish(*std::move(crs));
}

}  // namespace mansard::formats
