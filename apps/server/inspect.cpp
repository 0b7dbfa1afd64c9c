#include "apps/server/inspect.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <variant>

#include "mansard/base/run.hpp"
#include "mansard/base/text.hpp"
#include "mansard/edit/attributes.hpp"
#include "mansard/report/attributes.hpp"
#include "mansard/report/review.hpp"

namespace mansard::server {
namespace {

auto values_of(const model::Attributes& attributes, std::vector<std::string>& order, std::set<std::string>& seen)
    -> Json {
  Json values = Json::object();
  for (const auto& [name, value] : attributes) {
    if (seen.insert(name).second) order.push_back(name);
    values[name] = value_json(value);
  }
  return values;
}

/// By name, of the one list of attributes.
auto meanings() -> std::map<std::string, formats::Attribute> {
  std::map<std::string, formats::Attribute> known;
  for (const auto& list : {report::attributes(), edit::attributes(), report::review_attributes()})
    for (const auto& attribute : list) known.emplace(attribute.name, attribute);
  return known;
}

}  // namespace

auto value_json(const model::Value& value) -> Json {
  return std::visit(
      [](const auto& one) -> Json {
        using Kind = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<Kind, std::monostate>) return nullptr;
        else if constexpr (std::is_same_v<Kind, double>) return std::isfinite(one) ? Json(one) : Json(nullptr);
        else return one;
      },
      value);
}

auto attributes_json(const model::City& city) -> Json {
  std::vector<std::string> order;
  std::set<std::string> seen;
  Json buildings = Json::array();
  for (const auto& building : city.buildings) {
    Json parts = Json::array();
    Json own = values_of(building.attributes, order, seen);
    for (const auto& part : building.parts)
      parts.push_back({{"id", part.id}, {"values", values_of(part.attributes, order, seen)}});
    buildings.push_back({{"id", building.id}, {"values", std::move(own)}, {"parts", std::move(parts)}});
  }
  return {{"attributes", meanings_json(order)}, {"buildings", std::move(buildings)}};
}

auto meanings_json(const std::vector<std::string>& names) -> Json {
  const auto known = meanings();
  Json list = Json::array();
  for (const auto& name : names) {
    const auto at = known.find(name);
    const bool ours = at != known.end();
    list.push_back({{"name", name},
                    {"source", !ours},
                    {"unit", ours ? at->second.unit : ""},
                    {"meaning", ours ? at->second.meaning : ""}});
  }
  return list;
}

auto level_json(const model::City& city, formats::Lod lod, const solid::LevelOptions& options) -> Json {
  std::vector<Json> made(city.buildings.size());
  base::parallel_for(city.buildings.size(), [&](std::size_t b) {
    const auto& building = city.buildings[b];
    Json solids = Json::array();
    for (const auto& levels : formats::levels_of(building, city.frame, options)) {
      const auto& model = levels.at(lod);
      if (model.solid.faces.empty()) continue;
      if (auto json = json_of(model); !json.is_null()) solids.push_back(std::move(json));
    }
    made[b] = {{"id", building.id}, {"solids", std::move(solids)}};
  });
  Json buildings = Json::array();
  for (auto& one : made) buildings.push_back(std::move(one));
  return {{"buildings", std::move(buildings)}};
}

auto other_model_json(const model::Model& model) -> Json {
  const auto surface = model::surface_of(model);
  Json buildings = Json::array(), positions = Json::array(), triangles = Json::array(), classes = Json::array();
  for (const auto& building : model.buildings) buildings.push_back(building.id);
  for (const auto& v : surface.mesh.vertices)
    for (const double c : {v.x, v.y, v.z}) positions.push_back(c);
  for (const auto& triangle : surface.mesh.triangles)
    for (const auto v : triangle) triangles.push_back(v);
  for (const auto kind : surface.classes) classes.push_back(std::string(model::to_string(kind)));
  return {{"lod", model.lod},
          {"buildings", std::move(buildings)},
          {"positions", std::move(positions)},
          {"triangles", std::move(triangles)},
          {"classes", std::move(classes)},
          {"building_of", surface.buildings},
          {"warnings", json_of(model.warnings)}};
}

auto placing_json(const std::optional<pipeline::Placing>& placing, const pipeline::Options& options) -> Json {
  if (!placing) return nullptr;
  Json reading = Json::object();
  if (!placing->crs.empty()) reading["ingest.crs"] = placing->crs;
  if (placing->offset != options.ingest.mesh_offset) {
    std::string text;
    for (const double value : placing->offset) text += (text.empty() ? "" : " ") + base::to_text(value);
    reading["ingest.mesh_offset"] = text;
  }
  return {{"reading", std::move(reading)},
          {"reason", pipeline::reason_in_words(*placing)},
          {"correlation", placing->match.correlation},
          {"next", placing->match.next},
          {"inside", placing->match.inside}};
}

}  // namespace mansard::server
