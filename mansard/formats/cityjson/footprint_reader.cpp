#include "mansard/formats/cityjson/footprint_reader.hpp"
#include "mansard/formats/cityjson/address.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/base/text.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/cityjson/cityjson_document.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::formats {
namespace {

using geometry::Point3;

auto footprint_complaints(const std::string& subject) -> CityComplaints {
  return {"ingest-footprints-format", subject,
          [](std::size_t line, bool) { return "line " + std::to_string(line) + " is not JSON, or it is cut short"; }};
}

/// A surface in space with what it says it is.
struct Outline {
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

auto is_level(const Outline& surface) -> bool {
  const Point3 n = area_vector(surface.loops.front());
  constexpr double level = 0.999;  // under 3°
  return length(n) > 0 && std::abs(n.z) > level * length(n);
}

auto lowest(const Outline& surface) -> double {
  double low = std::numeric_limits<double>::infinity();
  for (const Point3 p : surface.loops.front()) low = std::min(low, p.z);
  return low;
}

auto flat_polygon(const Outline& surface) -> RawPolygon {
  RawPolygon out;
  for (const auto& loop : surface.loops) {
    geometry::Ring ring;
    for (const Point3 p : loop) ring.push_back(xy(p));
    out.push_back(std::move(ring));
  }
  return out;
}

class FootprintReader {
 public:
  void add(const CityDocument& document) {
    for (const auto& [id, object] : document.objects().items())
      if (text_of(member(object, "type")) == "Building") add_building(id, object, document);
  }
  auto take() -> std::vector<RawFeature> { return std::move(features_); }

 private:
  void add_building(const std::string& id, const Json& building, const CityDocument& document) {
    RawFeature feature;
    feature.number = static_cast<std::int64_t>(features_.size());
    feature.own_id = id;
    for (const auto& [name, value] : member(building, "attributes").items())
      if (!name.starts_with("ms_")) feature.attributes.emplace_back(name, to_value(value));
    detail::each_of_address(building, [&](const std::string& name, const Json& value) {
      feature.attributes.emplace_back(name, to_value(value));
    });
    std::vector<Outline> surfaces = outline_of({&building}, document);
    if (surfaces.empty()) surfaces = outline_of(parts_of(building, document.objects()), document);
    for (const auto& surface : surfaces) feature.parts.push_back(flat_polygon(surface));
    const Json& geometry = item(member(building, "geometry"), 0);
    feature.geometry = geometry.is_null() ? "NONE" : text_of(member(geometry, "type"));
    if (surfaces.empty() && feature.geometry != "NONE") feature.other_geometry = true;
    features_.push_back(std::move(feature));
  }

  static auto to_value(const Json& value) -> model::Value {
    if (value.is_null()) return {};
    if (value.is_boolean()) return value.get<bool>();
    // What no 64 bits with a sign hold stays as it is written.
    if (value.is_number_unsigned() && value.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max())
      return value.dump();
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
  static auto outline_of(const std::vector<const Json*>& objects, const CityDocument& document)
      -> std::vector<Outline> {
    std::vector<Outline> flat, ground, level;
    for (const Json* object : objects) {
      std::vector<std::pair<double, std::vector<Outline>>> by_lod;
      const Json& geometries = member(*object, "geometry");
      for (std::size_t i = 0; i < geometries.size(); ++i)
        by_lod.emplace_back(height_of_lod(item(geometries, i)), surfaces_of(item(geometries, i), document));
      std::ranges::stable_sort(by_lod, std::ranges::greater(), [](const auto& one) { return one.first; });
      add_flat(by_lod, flat);
      add_ground(by_lod, ground);
      add_lowest(by_lod, level);
    }
    return !flat.empty() ? flat : !ground.empty() ? ground : level;
  }

  using ByLod = std::vector<std::pair<double, std::vector<Outline>>>;  // the highest LoD first

  /// LoD 0 may hold the edge of the roof beside the outline on the ground: the latter, where they are told apart.
  static void add_flat(const ByLod& by_lod, std::vector<Outline>& out) {
    if (by_lod.empty() || by_lod.back().first >= 1) return;
    const auto& surfaces = by_lod.back().second;
    const bool told = std::ranges::any_of(surfaces, [](const Outline& s) { return s.kind == "GroundSurface"; });
    for (const auto& surface : surfaces)
      if (!told || surface.kind == "GroundSurface") out.push_back(surface);
  }
  static void add_ground(const ByLod& by_lod, std::vector<Outline>& out) {
    const std::size_t before = out.size();
    for (const auto& [lod, surfaces] : by_lod) {
      for (const auto& surface : surfaces)
        if (surface.kind == "GroundSurface") out.push_back(surface);
      if (out.size() > before) return;
    }
  }
  static void add_lowest(const ByLod& by_lod, std::vector<Outline>& out) {
    if (by_lod.empty()) return;
    constexpr double step = 0.5;  // m; floors of one house differ by less, storeys by more
    double low = std::numeric_limits<double>::infinity();
    for (const auto& surface : by_lod.front().second)
      if (is_level(surface)) low = std::min(low, lowest(surface));
    for (const auto& surface : by_lod.front().second)
      if (is_level(surface) && lowest(surface) < low + step) out.push_back(surface);
  }

  /// Without a LoD it is taken for the usual solid.
  static auto height_of_lod(const Json& geometry) -> double { return base::to_number(lod_of(geometry)).value_or(1); }

  /// Vertices that do not exist are left out.
  static auto surfaces_of(const Json& geometry, const CityDocument& document) -> std::vector<Outline> {
    std::vector<Outline> out;
    detail::each_shell({geometry, {}}, [&](const detail::CityShell& shell) {
      detail::each_surface(shell, [&](const detail::CitySurface& given) {
        Outline surface{{}, text_of(member(given.semantics, "type"))};
        for (std::size_t r = 0; r < given.rings.json.size(); ++r) {
          const Json& ring = item(given.rings.json, r);
          std::vector<Point3> loop;
          for (std::size_t k = 0; k < ring.size(); ++k)
            if (const Point3* vertex = document.vertex(item(ring, k))) loop.push_back(*vertex);
          if (loop.size() >= 3) surface.loops.push_back(std::move(loop));
        }
        if (!surface.loops.empty()) out.push_back(std::move(surface));
      });
    });
    return out;
  }

  std::vector<RawFeature> features_;
};

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
  FootprintReader reader;
  const auto crs = each_document(bytes, footprint_complaints(subject), [&](const CityDocument& document) {
    reader.add(document);
    return base::Result<void>();
  });
  if (!crs) return crs.error();
  FeatureFile out;
  out.features = reader.take();
  take_crs(*crs, out);
  return out;
}

}  // namespace mansard::formats
