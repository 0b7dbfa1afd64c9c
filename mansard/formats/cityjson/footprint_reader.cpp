#include "mansard/formats/cityjson/footprint_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "mansard/base/nesting.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/json/json_access.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::formats {
namespace {

using geometry::Point3;

auto bad(const std::string& what, const std::string& subject) -> base::Diagnostic {
  return base::error("ingest-footprints-format", what + "; check what the file is, or export it again", subject);
}

/// A surface in space with what it says it is.
struct Surface {
  std::vector<std::vector<Point3>> loops;
  std::string kind;
};

/// Twice the area of a loop along its normal (M. E. Newell).
auto area_vector(const std::vector<Point3>& loop) -> Point3 {
  Point3 sum;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum = sum + cross(loop[i] - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
  return sum;
}

auto is_level(const Surface& surface) -> bool {
  const Point3 n = area_vector(surface.loops.front());
  constexpr double level = 0.999;  // under 3°
  return length(n) > 0 && std::abs(n.z) > level * length(n);
}

auto lowest(const Surface& surface) -> double {
  double low = std::numeric_limits<double>::infinity();
  for (const Point3 p : surface.loops.front()) low = std::min(low, p.z);
  return low;
}

auto flat_polygon(const Surface& surface) -> RawPolygon {
  RawPolygon out;
  for (const auto& loop : surface.loops) {
    geometry::Ring ring;
    for (const Point3 p : loop) ring.push_back(xy(p));
    out.push_back(std::move(ring));
  }
  return out;
}

class Reader {
 public:
  explicit Reader(const std::string& subject) : subject_(subject) {}

  /// A whole document, or a line of CityJSONSeq under its first line's transform.
  auto add(const Json& document, const Json& head) -> base::Result<void> {
    take_vertices(document, member(head, "transform"));
    const Json& objects = member(document, "CityObjects");
    if (!objects.is_object()) return bad("it has no CityObjects", subject_);
    for (const auto& [id, object] : objects.items())
      if (text_of(member(object, "type")) == "Building") add_building(id, object, objects);
    return {};
  }
  auto take() -> std::vector<RawFeature> { return std::move(features_); }

 private:
  void take_vertices(const Json& document, const Json& transform) {
    vertices_.clear();
    const Json &scale = member(transform, "scale"), &translate = member(transform, "translate");
    const auto number = [](const Json& value, double otherwise) {
      return value.is_number() ? value.get<double>() : otherwise;
    };
    const Json& vertices = member(document, "vertices");
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      std::array<double, 3> c{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        c[axis] = number(item(item(vertices, v), axis), std::numeric_limits<double>::quiet_NaN()) *
                      number(item(scale, axis), 1) +
                  number(item(translate, axis), 0);
      vertices_.push_back({c[0], c[1], c[2]});
    }
  }

  void add_building(const std::string& id, const Json& building, const Json& objects) {
    RawFeature feature;
    feature.number = static_cast<std::int64_t>(features_.size());
    feature.own_id = id;
    for (const auto& [name, value] : member(building, "attributes").items())
      if (!name.starts_with("ms_")) feature.attributes.emplace_back(name, to_value(value));
    std::vector<Surface> surfaces = outline_of({&building});
    if (surfaces.empty()) surfaces = outline_of(parts_of(building, objects));
    for (const auto& surface : surfaces) feature.parts.push_back(flat_polygon(surface));
    const Json& geometry = item(member(building, "geometry"), 0);
    feature.geometry = geometry.is_null() ? "NONE" : text_of(member(geometry, "type"));
    if (surfaces.empty() && feature.geometry != "NONE") feature.other_geometry = true;
    features_.push_back(std::move(feature));
  }

  static auto to_value(const Json& value) -> model::Value {
    if (value.is_null()) return {};
    if (value.is_boolean()) return value.get<bool>();
    if (value.is_number_integer()) return value.get<std::int64_t>();
    if (value.is_number()) return value.get<double>();
    if (value.is_string()) return value.get<std::string>();
    return value.dump();
  }

  static auto parts_of(const Json& building, const Json& objects) -> std::vector<const Json*> {
    std::vector<const Json*> out;
    const Json& children = member(building, "children");
    for (std::size_t i = 0; i < children.size(); ++i) {
      const Json& part = member(objects, text_of(item(children, i)).c_str());
      if (text_of(member(part, "type")) == "BuildingPart") out.push_back(&part);
    }
    return out;
  }

  /// By the best evidence that any of the objects has.
  auto outline_of(const std::vector<const Json*>& objects) -> std::vector<Surface> {
    std::vector<Surface> flat, ground, level;
    for (const Json* object : objects) {
      std::vector<std::pair<double, std::vector<Surface>>> by_lod;
      const Json& geometries = member(*object, "geometry");
      for (std::size_t i = 0; i < geometries.size(); ++i)
        by_lod.emplace_back(lod_of(item(geometries, i)), surfaces_of(item(geometries, i)));
      std::ranges::stable_sort(by_lod, std::ranges::greater(), [](const auto& one) { return one.first; });
      add_flat(by_lod, flat);
      add_ground(by_lod, ground);
      add_lowest(by_lod, level);
    }
    return !flat.empty() ? flat : !ground.empty() ? ground : level;
  }

  using ByLod = std::vector<std::pair<double, std::vector<Surface>>>;  // the highest LoD first

  /// LoD 0 may hold the edge of the roof beside the outline on the ground: the latter, where they are told apart.
  static void add_flat(const ByLod& by_lod, std::vector<Surface>& out) {
    if (by_lod.empty() || by_lod.back().first >= 1) return;
    const auto& surfaces = by_lod.back().second;
    const bool told = std::ranges::any_of(surfaces, [](const Surface& s) { return s.kind == "GroundSurface"; });
    for (const auto& surface : surfaces)
      if (!told || surface.kind == "GroundSurface") out.push_back(surface);
  }
  static void add_ground(const ByLod& by_lod, std::vector<Surface>& out) {
    const std::size_t before = out.size();
    for (const auto& [lod, surfaces] : by_lod) {
      for (const auto& surface : surfaces)
        if (surface.kind == "GroundSurface") out.push_back(surface);
      if (out.size() > before) return;
    }
  }
  static void add_lowest(const ByLod& by_lod, std::vector<Surface>& out) {
    if (by_lod.empty()) return;
    constexpr double step = 0.5;  // m; floors of one house differ by less, storeys by more
    double low = std::numeric_limits<double>::infinity();
    for (const auto& surface : by_lod.front().second)
      if (is_level(surface)) low = std::min(low, lowest(surface));
    for (const auto& surface : by_lod.front().second)
      if (is_level(surface) && lowest(surface) < low + step) out.push_back(surface);
  }

  static auto lod_of(const Json& geometry) -> double {
    const Json& lod = member(geometry, "lod");
    // Text since CityJSON 1.1, a number before; nothing at all is taken for the usual solid.
    return lod.is_number() ? lod.get<double>() : base::to_number(text_of(lod)).value_or(1);
  }

  auto surfaces_of(const Json& geometry) -> std::vector<Surface> {
    std::vector<Surface> out;
    const Json& semantics = member(geometry, "semantics");
    const std::string type = text_of(member(geometry, "type"));
    const std::size_t depth = type == "MultiSolid" || type == "CompositeSolid"       ? 2
                              : type == "Solid"                                      ? 1
                              : type == "MultiSurface" || type == "CompositeSurface" ? 0
                                                                                     : 9;
    if (depth < 9)
      collect(member(geometry, "boundaries"), member(semantics, "values"), member(semantics, "surfaces"), depth, out);
    return out;
  }
  void collect(const Json& boundaries, const Json& values, const Json& kinds, std::size_t depth,
               std::vector<Surface>& out) {
    for (std::size_t i = 0; boundaries.is_array() && i < boundaries.size(); ++i) {
      if (depth > 0) {
        collect(boundaries[i], item(values, i), kinds, depth - 1, out);
        continue;
      }
      Surface surface;
      for (std::size_t r = 0; r < boundaries[i].size(); ++r) {
        const Json& ring = item(boundaries[i], r);
        std::vector<Point3> loop;
        for (std::size_t k = 0; k < ring.size(); ++k)
          if (const Json& corner = item(ring, k);
              corner.is_number_unsigned() && corner.get<std::size_t>() < vertices_.size())
            loop.push_back(vertices_[corner.get<std::size_t>()]);
        if (loop.size() >= 3) surface.loops.push_back(std::move(loop));
      }
      if (const Json& kind = item(values, i); kind.is_number_unsigned())
        surface.kind = text_of(member(item(kinds, kind.get<std::size_t>()), "type"));
      if (!surface.loops.empty()) out.push_back(std::move(surface));
    }
  }

  const std::string& subject_;
  std::vector<Point3> vertices_;
  std::vector<RawFeature> features_;
};

auto check_head(const Json& document, const std::string& subject) -> base::Result<void> {
  if (text_of(member(document, "type")) != "CityJSON") return bad("it is JSON, but no CityJSON", subject);
  const std::string version = text_of(member(document, "version"));
  if (version.starts_with("1.") || version.starts_with("2.")) return {};
  return bad("it is CityJSON " + (version.empty() ? "without a version" : version) + ", and 1.0 to 2.0 are read",
             subject);
}

auto read_lines(std::string_view bytes, Reader& reader, Json& head, const std::string& subject) -> base::Result<void> {
  for (std::size_t number = 1; !bytes.empty(); ++number) {
    const auto line = take_line(bytes);
    if (line.find_first_not_of(" \t") == line.npos) continue;
    const Json document = Json::parse(line, nullptr, false);
    if (document.is_discarded())
      return bad("line " + std::to_string(number) + " is not JSON, or it is cut short", subject);
    if (head.is_null()) {
      if (auto sound = check_head(document, subject); !sound) return sound;
      head = document;
    }
    if (auto done = reader.add(document, head); !done) return done;
  }
  return {};
}

/// CityJSON names a CRS by a URL, older versions by a URN; both end in the register's number.
void take_crs(const std::string& spelt, FeatureFile& file) {
  if (spelt.empty()) return;
  const crs::GdalMessages messages;
  const auto at = spelt.find_last_of("/:");
  const auto number = at == spelt.npos ? std::nullopt : base::to_integer(spelt.substr(at + 1));
  const auto crs =
      crs::from_words(number && spelt.find("EPSG") != spelt.npos ? "EPSG:" + std::to_string(*number) : spelt);
  if (crs) file.crs = crs::wkt_of(crs::flat(crs->system).system);
  else file.crs_failure = "'" + spelt + "'";
}

}  // namespace

auto looks_like_cityjson(std::string_view bytes) -> bool {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != bytes.npos && bytes[first] == '{' && bytes.find("\"CityJSON\"") != bytes.npos;
}

auto read_cityjson_footprints(std::string_view bytes, const std::string& subject) -> base::Result<FeatureFile> {
  if (base::nests_too_deep(bytes)) return bad("its JSON nests too deep", subject);
  Reader reader(subject);
  Json head = Json::parse(bytes, nullptr, false);
  if (head.is_discarded()) {
    head = Json();
    if (auto done = read_lines(bytes, reader, head, subject); !done) return done.error();
  } else {
    if (auto sound = check_head(head, subject); !sound) return sound.error();
    if (auto done = reader.add(head, head); !done) return done.error();
  }
  FeatureFile out;
  out.features = reader.take();
  take_crs(text_of(member(member(head, "metadata"), "referenceSystem")), out);
  return out;
}

}  // namespace mansard::formats
