#include "mansard/write/detail/plan_text.hpp"

namespace mansard::write::detail {
namespace {

void append_frame(JsonText& json, const ingest::Frame& frame) {
  json.begin_object().key("origin").begin_array();
  for (const auto metres : frame.origin) json.whole(metres);
  json.end_array().key("crs").text(frame.crs).end_object();
}

void append_footprint(JsonText& json, const std::vector<geometry::Polygon>& footprint) {
  json.begin_array();
  for (const auto& polygon : footprint) {
    append_ring(json.begin_object().key("outer"), polygon.outer);
    json.key("holes").begin_array();
    for (const auto& hole : polygon.holes) append_ring(json, hole);
    json.end_array().end_object();
  }
  json.end_array();
}

}  // namespace

auto plan_text(const City& city) -> std::string {
  JsonText json;
  json.begin_object().line(1).key("type").text(plan_type).line(1).key("version").whole(plan_version);
  append_made_by(json.line(1).key("made_by"), city.made_by);
  append_frame(json.line(1).key("frame"), city.frame);
  json.line(1).key("buildings").begin_array();
  for (const Building& building : city.buildings) {
    json.line(2).begin_object().line(3).key("id").text(building.id);
    append_attributes(json.line(3).key("attributes").begin_object(), building.attributes);
    json.end_object().line(3).key("ground").number(building.ground);
    append_footprint(json.line(3).key("footprint"), building.footprint);
    json.line(3).key("parts").begin_array();
    for (const Part& part : building.parts) {
      json.line(4).begin_object().line(5).key("id").text(part.id);
      append_attributes(json.line(5).key("attributes").begin_object(), part.attributes);
      append_plan(json.end_object().line(5).key("plan").begin_object(), part.plan, 6);
      json.line(5).end_object().line(4).end_object();
    }
    json.line(3).end_array().line(2).end_object();
  }
  json.line(1).end_array().line(0).end_object();
  return std::move(json).str() + "\n";
}

}  // namespace mansard::write::detail
