#include "mansard/formats/plans/plan_text.hpp"

namespace mansard::formats::detail {

void append_frame(JsonText& json, const model::Frame& frame) {
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

namespace {

/// What follows starts `deeper` levels below `level`, or goes on where that is negative.
auto line(JsonText& json, int level, int deeper) -> JsonText& { return json.line(level < 0 ? -1 : level + deeper); }

}  // namespace

void append_header(JsonText& json, const Header& header, int level) {
  line(json, level, 0).key("type").text(plan_type);
  line(json, level, 0).key("version").whole(plan_version);
  append_made_by(line(json, level, 0).key("made_by"), header.made_by);
  append_frame(line(json, level, 0).key("frame"), header.frame);
}

void append_building(JsonText& json, const model::Building& building, int level) {
  line(json, level, 0).begin_object();
  line(json, level, 1).key("id").text(building.id);
  append_attributes(line(json, level, 1).key("attributes").begin_object(), building.attributes);
  line(json.end_object(), level, 1).key("ground").number(building.ground);
  append_footprint(line(json, level, 1).key("footprint"), building.footprint);
  line(json, level, 1).key("parts").begin_array();
  for (const model::Part& part : building.parts) {
    line(json, level, 2).begin_object();
    line(json, level, 3).key("id").text(part.id);
    append_attributes(line(json, level, 3).key("attributes").begin_object(), part.attributes);
    append_plan(line(json.end_object(), level, 3).key("plan").begin_object(), part.plan, level < 0 ? -1 : level + 4);
    line(line(json, level, 3).end_object(), level, 2).end_object();
  }
  line(line(json, level, 1).end_array(), level, 0).end_object();
}

PlansText::PlansText(const Header& header, base::Sink& sink) : sink_(sink) {
  append_header(json_.begin_object(), header, 1);
  json_.line(1).key("buildings").begin_array();
}

void PlansText::add(const model::Building& building) {
  append_building(json_, building, 2);
  sink_.append(json_.take());
}

void PlansText::end() {
  json_.line(1).end_array().line(0).end_object();
  sink_.append(json_.take() + "\n");
}

}  // namespace mansard::formats::detail
