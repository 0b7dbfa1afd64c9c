// The files of a simulation that no other module writes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "lab/simulate/simulate.hpp"
#include "mansard/base/text.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::simulate {
namespace {

using Json = nlohmann::ordered_json;
using geometry::Point2;

/// Little-endian, as the header says.
template <class T>
void append(std::string& bytes, T value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

auto json_of(const model::Value& value) -> Json {
  return std::visit(
      [](const auto& v) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>) return nullptr;
        else return v;
      },
      value);
}

/// Metres to the millimetre, in the file's frame.
auto place(Point2 p, const model::Frame& frame) -> Json {
  const auto rounded = [](double x) { return std::round(x * 1000) / 1000 + 0.0; };
  return {rounded(p.x + static_cast<double>(frame.origin[0])), rounded(p.y + static_cast<double>(frame.origin[1]))};
}

auto rings_of(const geometry::Polygon& polygon, const model::Frame& frame) -> Json {
  Json rings = Json::array();
  const auto add = [&](const geometry::Ring& ring) {
    Json points = Json::array();
    for (const Point2 p : ring) points.push_back(place(p, frame));
    points.push_back(points.front());
    rings.push_back(std::move(points));
  };
  add(polygon.outer);
  for (const auto& hole : polygon.holes) add(hole);
  return rings;
}

auto attribute(const model::Attributes& attributes, std::string_view name) -> Json {
  for (const auto& [key, value] : attributes)
    if (key == name) return json_of(value);
  return nullptr;
}

auto building_json(const model::Building& building, double z0) -> Json {
  Json parts = Json::array();
  for (const auto& part : building.parts) {
    double top = part.plan.base;
    for (const auto v : part.model.solid.vertices) top = std::max(top, v.z);
    const auto areas = label::areas(part.model);
    parts.push_back({{"id", part.id},
                     {"role", attribute(part.attributes, "ms_role")},
                     {"base", z0 + part.plan.base},
                     {"eaves", attribute(part.attributes, "ms_eaves")},
                     {"top", z0 + top},
                     {"volume", solid::volume(part.model.solid)},
                     {"area_roof_flat", areas.roof_flat},
                     {"area_roof_sloped", areas.roof_sloped},
                     {"area_wall", areas.wall},
                     {"area_party_wall", areas.party_wall}});
  }
  return {{"id", building.id},
          {"ground", z0 + building.ground},
          {"roof", attribute(building.attributes, "sim_roof")},
          {"storeys", attribute(building.attributes, "sim_storeys")},
          {"parts", std::move(parts)}};
}

/// Of a model of another producer: what its faces say.
auto model_building_json(const model::Building& building, const ModelSource::Building& facts, double z0) -> Json {
  Json areas = Json::object();
  for (std::size_t c = 0; c < class_count; ++c)
    areas["area_" + std::string(to_string(static_cast<Class>(c)))] = facts.area[c];
  Json out = {{"id", building.id},
              {"ground", z0 + building.ground},
              {"top", z0 + facts.top},
              {"ground_faces", facts.ground_faces}};
  out.update(areas);
  return out;
}

auto model_json(const ModelSource& model) -> Json {
  Json out = {{"file", model.file.path}, {"bytes", model.file.bytes}, {"sha256", model.file.sha256}};
  if (!model.lod.empty()) out["lod"] = model.lod;
  return out;
}

auto accuracy_json(const Accuracy& accuracy) -> Json {
  return {{"noise_m", accuracy.noise},
          {"correlated_area_m2", accuracy.correlated_area},
          {"spacing_m", accuracy.spacing},
          {"blur_m", accuracy.blur}};
}

auto planted_json(const Planted& planted, const Options& options) -> Json {
  Json out = accuracy_json(planted.mesh);
  const auto offset = offset_of(options.survey, static_cast<std::uint64_t>(options.seed));
  out["offset_m"] = {offset.x, offset.y};
  out["offset_spread_m"] = offset_spread(options.survey);
  if (planted.points) out["points"] = accuracy_json(*planted.points);
  return out;
}

auto faults_json(const std::vector<Fault>& faults, const model::City& city) -> Json {
  Json out = Json::array();
  for (const auto& fault : faults)
    out.push_back({{"building", city.buildings[fault.building].id},
                   {"kind", to_string(fault.kind)},
                   {"amount", fault.amount},
                   {"direction", fault.direction}});
  return out;
}

auto height(const std::optional<double>& z, double z0) -> Json { return z ? Json(z0 + *z) : Json(nullptr); }

}  // namespace

auto ply(const Scan& scan, const model::Frame& frame) -> std::string {
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment made by mansard simulate\n";
  bytes += "comment class: 0 wall, 1 roof, 2 ground, 3 other; building: row of truth.json's buildings, -1 for none\n";
  bytes += "element vertex " + std::to_string(scan.mesh.vertices.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
           std::to_string(scan.mesh.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nproperty uchar class\nproperty int building\nend_header\n";
  constexpr std::size_t vertex_size = 24, face_size = 18;
  bytes.reserve(bytes.size() + vertex_size * scan.mesh.vertices.size() + face_size * scan.mesh.triangles.size());
  for (const auto v : scan.mesh.vertices) {
    append(bytes, v.x + static_cast<double>(frame.origin[0]));
    append(bytes, v.y + static_cast<double>(frame.origin[1]));
    append(bytes, v.z + static_cast<double>(frame.origin[2]));
  }
  for (std::size_t t = 0; t < scan.mesh.triangles.size(); ++t) {
    append(bytes, std::uint8_t{3});
    for (const auto v : scan.mesh.triangles[t]) append(bytes, static_cast<std::int32_t>(v));
    append(bytes, static_cast<std::uint8_t>(scan.classes[t]));
    append(bytes, scan.buildings[t] == Scan::none ? std::int32_t{-1} : static_cast<std::int32_t>(scan.buildings[t]));
  }
  return bytes;
}

auto geojson(const std::vector<model::Footprint>& footprints, const model::Frame& frame) -> std::string {
  Json features = Json::array();
  for (const auto& footprint : footprints) {
    Json properties = Json::object(), polygons = Json::array();
    for (const auto& [name, value] : footprint.attributes) properties[name] = json_of(value);
    for (const auto& polygon : footprint.polygons) polygons.push_back(rings_of(polygon, frame));
    const bool single = polygons.size() == 1;
    features.push_back({{"type", "Feature"},
                        {"properties", std::move(properties)},
                        {"geometry",
                         {{"type", single ? "Polygon" : "MultiPolygon"},
                          {"coordinates", single ? Json(polygons.front()) : Json(polygons)}}}});
  }
  Json out = {{"type", "FeatureCollection"}};
  if (frame.crs.starts_with("EPSG:"))
    out["crs"] = {{"type", "name"}, {"properties", {{"name", "urn:ogc:def:crs:EPSG::" + frame.crs.substr(5)}}}};
  out["features"] = std::move(features);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

auto surface_obj(const Surface& surface, const model::City& city) -> std::string {
  const auto& origin = city.frame.origin;
  std::string out = "# made by mansard simulate\n";
  if (!city.frame.crs.empty()) out += "# crs " + city.frame.crs + "\n";
  for (const auto& v : surface.mesh.vertices)
    out += "v " + base::to_text(v.x + static_cast<double>(origin[0])) + " " +
           base::to_text(v.y + static_cast<double>(origin[1])) + " " +
           base::to_text(v.z + static_cast<double>(origin[2])) + "\n";
  for (std::size_t b = 0; b < city.buildings.size(); ++b) {
    out += "o " + city.buildings[b].id + "\n";
    for (std::size_t c = 0; c < class_count; ++c) {
      std::string faces;
      for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
        if (surface.buildings[t] != b || surface.classes[t] != static_cast<Class>(c)) continue;
        faces += 'f';
        for (const auto v : surface.mesh.triangles[t]) faces += " " + std::to_string(v + 1);
        faces += '\n';
      }
      if (!faces.empty()) out += "g " + std::string(to_string(static_cast<Class>(c))) + "\n" + faces;
    }
  }
  return out;
}

auto true_footprints(const Truth& truth) -> std::vector<model::Footprint> {
  const auto z0 = static_cast<double>(truth.city.frame.origin[2]);
  std::vector<model::Footprint> out;
  for (const auto& building : truth.city.buildings) {
    auto& feature = out.emplace_back();
    feature.id = building.id;
    feature.polygons = building.footprint;
    feature.attributes = {{"id", building.id}, {"ground", z0 + building.ground}};
  }
  return out;
}

auto truth_json(const Truth& truth, const std::vector<model::Footprint>& footprints, const Options& options,
                const std::string& source, const std::vector<Crown>& crowns, const std::optional<Planted>& planted)
    -> std::string {
  const auto& frame = truth.city.frame;
  const auto z0 = static_cast<double>(frame.origin[2]);
  Json used = Json::object();
  Options copy = options;
  const auto list = option_list(copy);
  for (const auto& option : list.options()) used["simulate." + option.name] = option.get();
  Json buildings = Json::array(), walls = Json::array(), features = Json::array();
  for (std::size_t b = 0; b < truth.city.buildings.size(); ++b) {
    const auto& building = truth.city.buildings[b];
    buildings.push_back(truth.model ? model_building_json(building, truth.model->buildings[b], z0)
                                    : building_json(building, z0));
  }
  for (const auto& wall : truth.party_walls)
    walls.push_back({{"first", truth.city.buildings[wall.first].id},
                     {"second", truth.city.buildings[wall.second].id},
                     {"line", {place(wall.line.start, frame), place(wall.line.end, frame)}},
                     {"first_top", height(wall.first_top, z0)},
                     {"second_top", height(wall.second_top, z0)}});
  for (const auto& footprint : footprints)
    features.push_back({{"id", footprint.id}, {"buildings", attribute(footprint.attributes, "buildings")}});
  Json out = {{"type", "mansard-truth"}, {"version", 1}, {"source", source}};
  if (truth.model) out["model"] = model_json(*truth.model);
  out["seed"] = options.seed;
  out["crs"] = frame.crs;
  out["options"] = std::move(used);
  if (planted) out["planted"] = planted_json(*planted, options);
  out["buildings"] = std::move(buildings);
  out["party_walls"] = std::move(walls);
  out["footprints"] = std::move(features);
  Json trees = Json::array();
  for (const auto& crown : crowns) {
    auto centre = place(xy(crown.centre), frame);
    centre.push_back(z0 + crown.centre.z);
    trees.push_back({{"building", truth.city.buildings[crown.building].id},
                     {"centre", std::move(centre)},
                     {"radius", crown.radius},
                     {"within", crown.within}});
  }
  out["crowns"] = std::move(trees);
  if (planted && !planted->faults.empty()) out["faults"] = faults_json(planted->faults, truth.city);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mansard::simulate
