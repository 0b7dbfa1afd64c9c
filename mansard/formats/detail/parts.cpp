#include "mansard/formats/detail/parts.hpp"

#include <cmath>
#include <set>

namespace mansard::formats::detail {

using geometry::Point3;

auto keys_of(const model::City& city) -> base::Result<Keys> {
  std::set<std::string> taken;
  Keys keys;
  for (const model::Building& building : city.buildings) {
    if (!taken.insert(building.id).second)
      return base::error("write-duplicate-id", "two buildings have this id; name an attribute that tells them apart",
                         building.id);
    keys.buildings.push_back(building.id);
  }
  for (const model::Building& building : city.buildings) {
    auto& parts = keys.parts.emplace_back();
    for (const model::Part& part : building.parts) {
      std::string key = part.id;
      while (!taken.insert(key).second) key += "-part";
      parts.push_back(std::move(key));
    }
  }
  return keys;
}

auto check_models(const model::City& city) -> base::Result<void> {
  for (const model::Building& building : city.buildings)
    if (auto sound = check_model(building); !sound) return sound;
  return {};
}

auto check_model(const model::Building& building) -> base::Result<void> {
  // m; plans reach 1e8 m from an origin that may move by as much. Doubles are 6e-8 m apart here, files have 1e-4 m.
  constexpr double far = 4e8;
  const auto sound = [&](double v) { return std::abs(v) <= far; };
  for (const model::Part& part : building.parts) {
    const auto& [vertices, faces] = part.model.solid;
    const auto give_up = [&](const char* what) {
      return base::error("write-model", std::string("the model ") + what + "; this is a bug, please report it",
                         part.id);
    };
    for (const Point3& v : vertices)
      if (!sound(v.x) || !sound(v.y) || !sound(v.z)) return give_up("has a coordinate that is not finite or too far");
    if (part.model.classes.size() != faces.size()) return give_up("does not have one class per face");
    for (const auto& face : faces) {
      if (face.loops.empty()) return give_up("has a face without a loop");
      if (!(std::abs(geometry::length(face.normal) - 1) < 1e-3)) return give_up("has a normal that is not of length 1");
      for (const auto& loop : face.loops)
        for (const auto vertex : loop)
          if (vertex >= vertices.size()) return give_up("names a vertex that does not exist");
    }
  }
  return {};
}

auto class_name(model::FaceClass c) -> std::string_view {
  constexpr std::array<std::string_view, class_count> names{"wall", "party_wall", "roof", "ground", "soffit"};
  return names[static_cast<std::size_t>(c)];
}

auto in_file_frame(const model::Frame& frame, Point3 p) -> Point3 {
  const auto& o = frame.origin;
  return p + Point3{static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2])};
}

void append_made_by(JsonText& json, const model::MadeBy& made_by) {
  json.begin_object().key("generator").text("mansard").key("version").text(made_by.version);
  json.key("options").begin_object();
  for (const auto& [name, value] : made_by.options) json.key(name).text(value);
  json.end_object().key("inputs").begin_array();
  for (const auto& input : made_by.inputs)
    json.begin_object()
        .key("path")
        .text(input.path)
        .key("bytes")
        .whole(static_cast<std::int64_t>(input.bytes))
        .key("sha256")
        .text(input.sha256)
        .end_object();
  json.end_array().end_object();
}

void append_value(JsonText& json, const model::Value& value) {
  struct Append {
    JsonText& json;
    void operator()(std::monostate) const { json.null(); }
    void operator()(bool v) const { json.flag(v); }
    void operator()(std::int64_t v) const { json.whole(v); }
    void operator()(double v) const { json.real(v); }
    void operator()(const std::string& v) const { json.text(v); }
  };
  std::visit(Append{json}, value);
}

void append_attributes(JsonText& json, const model::Attributes& attributes) {
  std::set<std::string_view> seen;
  std::vector<bool> last(attributes.size());
  for (std::size_t i = attributes.size(); i-- > 0;) last[i] = seen.insert(attributes[i].first).second;
  for (std::size_t i = 0; i < attributes.size(); ++i)
    if (last[i]) append_value(json.key(attributes[i].first), attributes[i].second);
}

void append_ring(JsonText& json, const geometry::Ring& ring) {
  json.begin_array();
  for (const auto& p : ring) json.begin_array().number(p.x).number(p.y).end_array();
  json.end_array();
}

void append_plan(JsonText& json, const model::Plan& plan, int level) {
  const auto line = [&](int deeper = 0) -> JsonText& { return level < 0 ? json : json.line(level + deeper); };
  const auto append = [&](const model::PlanRing& ring) {
    append_ring(json.begin_object().key("points"), ring.points);
    json.key("profile_of_edge").begin_array();
    for (const auto profile : ring.profile_of_edge) json.whole(profile);
    json.end_array();
    if (!ring.overhang_of_edge.empty()) {
      json.key("overhang_of_edge").begin_array();
      for (const double overhang : ring.overhang_of_edge) json.number(overhang);
      json.end_array();
    }
    json.end_object();
  };
  line().key("base").number(plan.base);
  line().key("cap").number(plan.cap);
  line().key("outer");
  append(plan.outer);
  line().key("holes").begin_array();
  for (const auto& hole : plan.holes) {
    line(1);
    append(hole);
  }
  json.end_array();
  line().key("profiles").begin_array();
  for (const auto& profile : plan.profiles) {
    line(1).begin_array();
    for (const auto& point : profile) json.begin_array().number(point.inward).number(point.height).end_array();
    json.end_array();
  }
  json.end_array();
}

}  // namespace mansard::formats::detail
