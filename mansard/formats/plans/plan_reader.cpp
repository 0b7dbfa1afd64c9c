// Reads plan + profiles. Every complaint says where in the file, in the manner of buildings[3].parts[0].plan.cap.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/cityjson/cityjson.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/formats/plans/plan_items.hpp"
#include "mansard/formats/plans/plan_text.hpp"
#include "mansard/model/move.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Point2;

auto read_ring(const Item& item) -> geometry::Ring {
  geometry::Ring ring;
  item.each([&](const Item& point) {
    const auto [x, y] = point.numbers<2>();
    if (std::max(std::abs(x), std::abs(y)) > farthest)
      point.refuse("within " + base::to_text(farthest, 0) + " m of the origin");
    ring.push_back({x, y});
  });
  if (ring.size() < 3) item.refuse("a ring of at least 3 points");
  return ring;
}

auto read_polygon(const Item& item) -> geometry::Polygon {
  item.object({"outer", "holes"});
  geometry::Polygon polygon{read_ring(item.member("outer")), {}};
  if (item.has("holes")) item.member("holes").each([&](const Item& hole) { polygon.holes.push_back(read_ring(hole)); });
  return polygon;
}

auto read_plan_ring(const Item& item, std::size_t profiles) -> model::PlanRing {
  item.object({"points", "profile_of_edge", "overhang_of_edge"});
  model::PlanRing ring;
  ring.points = read_ring(item.member("points"));
  const Item edges = item.member("profile_of_edge");
  edges.each([&](const Item& edge) {
    const std::int64_t profile = edge.whole();
    if (profile < 0 || static_cast<std::uint64_t>(profile) >= profiles)
      throw Defect{"write-plan-profile", edge.where() + " names profile " + std::to_string(profile) +
                                             ", but there are " + std::to_string(profiles) + " (numbered from 0)"};
    ring.profile_of_edge.push_back(static_cast<std::uint32_t>(profile));
  });
  if (ring.profile_of_edge.size() != ring.points.size())
    throw Defect{"write-plan-value", edges.where() + " has " + std::to_string(ring.profile_of_edge.size()) +
                                         " entries for " + std::to_string(ring.points.size()) +
                                         " points; give one profile per edge"};
  if (!item.has("overhang_of_edge")) return ring;
  const Item overhangs = item.member("overhang_of_edge");
  overhangs.each([&](const Item& overhang) {
    const double metres = overhang.number();
    if (!(metres >= 0 && metres <= farthest_overhang))
      overhang.refuse("an overhang of 0 to " + base::to_text(farthest_overhang, 0) + " m");
    ring.overhang_of_edge.push_back(metres);
  });
  if (ring.overhang_of_edge.size() != ring.points.size())
    throw Defect{"write-plan-value", overhangs.where() + " has " + std::to_string(ring.overhang_of_edge.size()) +
                                         " entries for " + std::to_string(ring.points.size()) +
                                         " points; give one overhang per edge, 0 where nothing overhangs"};
  return ring;
}

auto read_profile(const Item& item) -> model::Profile {
  model::Profile profile;
  item.each([&](const Item& point) {
    const auto [inward, height] = point.numbers<2>();
    profile.push_back({inward, height});
  });
  const auto refuse = [&](const std::string& what) { throw Defect{"write-plan-profile", item.where() + " " + what}; };
  if (profile.size() < 2) refuse("must have at least 2 points");
  if (profile.front() != model::ProfilePoint{0, 0}) refuse("must start at [0, 0]");
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const auto& a = profile[i - 1];
    const auto& b = profile[i];
    if (std::max(b.inward, b.height) > longest_profile)
      refuse("reaches beyond " + base::to_text(longest_profile, 0) + " m at point " + std::to_string(i));
    if (a == b) refuse("repeats point " + std::to_string(i - 1));
    if (b.inward < a.inward) refuse("goes outward at point " + std::to_string(i) + "; overhangs are not possible");
    if (b.height < a.height) refuse("goes down at point " + std::to_string(i) + "; heights must not decrease");
  }
  return profile;
}

constexpr std::initializer_list<const char*> plan_members{"base", "cap", "outer", "holes", "profiles"};

/// The members of a plan; the caller has looked for unknown ones.
auto read_plan(const Item& item) -> model::Plan {
  model::Plan plan;
  plan.base = item.member("base").number_up_to(farthest);
  const Item cap = item.member("cap");
  if (plan.cap = cap.number(); !(plan.cap > 0 && plan.cap <= highest_cap))
    cap.refuse("a height above the base, more than 0 and up to " + base::to_text(highest_cap, 0) + " m");
  item.member("profiles").each([&](const Item& profile) { plan.profiles.push_back(read_profile(profile)); });
  plan.outer = read_plan_ring(item.member("outer"), plan.profiles.size());
  item.member("holes").each(
      [&](const Item& hole) { plan.holes.push_back(read_plan_ring(hole, plan.profiles.size())); });
  return plan;
}

void check_version(const Item& owner) {
  if (const Item version = owner.member("version"); version.whole() != plan_version)
    throw Defect{"write-plan-version", "this is version " + version.shown() + " of the format, but only version " +
                                           std::to_string(plan_version) + " is known; use a newer mansard"};
}

auto new_id(const Item& owner, std::set<std::string>& taken) -> std::string {
  const Item item = owner.member("id");
  std::string id = item.text();
  if (!taken.insert(id).second) item.refuse("an id that no other has");
  return id;
}

auto is_of_type(const Json& json, std::string_view type) -> bool {
  return json.is_object() && json.contains("type") && json["type"] == type;
}

auto read_part(const Item& item, std::set<std::string>& ids) -> model::Part {
  item.object({"id", "attributes", "plan"});
  model::Part part;
  part.id = new_id(item, ids);
  if (item.has("attributes")) part.attributes = read_attributes(item.member("attributes"));
  part.plan = read_plan_item(item.member("plan"));
  return part;
}

/// Everything that is placed by whole metres elsewhere.
void move(model::City& city, const std::array<std::int64_t, 3>& by) {
  const auto before = city.frame;
  for (std::size_t axis = 0; axis < 3; ++axis) city.frame.origin[axis] += by[axis];
  for (auto& building : city.buildings) model::move(building, model::between(before, city.frame));
}

/// Plans whose middle is far from their origin get one near it, as footprints do: models are kept in single precision
/// in some files. Differences of doubles that are near to each other are exact, so that no coordinate changes in the
/// world.
void bring_near(model::City& city) {
  constexpr double far = 1e5;  // m; single precision is 8 mm there
  std::array<double, 3> least{}, most{};
  bool any = false;
  for (const auto& building : city.buildings)
    for (const auto& part : building.parts)
      for (const Point2 p : part.plan.outer.points) {
        const std::array<double, 3> at{p.x, p.y, part.plan.base};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          least[axis] = any ? std::min(least[axis], at[axis]) : at[axis];
          most[axis] = any ? std::max(most[axis], at[axis]) : at[axis];
        }
        any = true;
      }
  std::array<std::int64_t, 3> by{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const double middle = 0.5 * (least[axis] + most[axis]); std::abs(middle) > far) by[axis] = std::llround(middle);
  if (by != std::array<std::int64_t, 3>{}) move(city, by);
}

auto read_city(const Item& file, std::vector<base::Diagnostic>& refused) -> model::City {
  auto header = read_header(file, {"buildings"});
  model::City city{std::move(header.frame), std::move(header.made_by), {}};
  std::set<std::string> ids;
  file.member("buildings").each([&](const Item& item) {
    city.buildings.push_back(read_building(item, &refused));
    (void)new_id(item, ids);
  });
  bring_near(city);
  return city;
}

}  // namespace

auto read_attributes(const Item& item) -> model::Attributes {
  if (!item.json.is_object()) item.refuse("an object");
  model::Attributes attributes;
  for (const auto& [key, value] : item.json.items()) {
    model::Value out;
    if (value.is_boolean()) out = value.get<bool>();
    else if (value.is_string()) out = value.get<std::string>();
    else if (value.is_number_float()) out = value.get<double>();
    else if (value.is_number_unsigned() && value.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max())
      out = value.dump();  // as it is written: no 64 bits with a sign hold it
    else if (value.is_number()) out = Item{value, {&item.place, key, 0}}.whole();
    else if (!value.is_null()) Item{value, {&item.place, key, 0}}.refuse("a text, a number, true, false or null");
    attributes.emplace_back(key, std::move(out));
  }
  return attributes;
}

auto read_made_by(const Item& item) -> model::MadeBy {
  item.object({"generator", "version", "options", "inputs"});
  model::MadeBy made_by;
  if (item.has("version")) made_by.version = item.member("version").text();
  if (item.has("options")) {
    const Item options = item.member("options");
    if (!options.json.is_object()) options.refuse("an object");
    for (const auto& [key, value] : options.json.items())
      made_by.options.emplace_back(key, Item{value, {&options.place, key, 0}}.text());
  }
  if (item.has("inputs"))
    item.member("inputs").each([&](const Item& input) {
      input.object({"path", "bytes", "sha256"});
      const Item bytes = input.member("bytes");
      const std::int64_t size = bytes.whole();
      if (size < 0) bytes.refuse("a number of bytes");
      made_by.inputs.push_back(
          {input.member("path").text(), static_cast<std::uint64_t>(size), input.member("sha256").text()});
    });
  return made_by;
}

auto read_origin(const Item& item) -> std::array<std::int64_t, 3> {
  std::array<std::int64_t, 3> origin{};
  if (!item.json.is_array() || item.json.size() != 3) item.refuse("an array of 3 whole numbers");
  item.each([&](const Item& metres) {
    (void)metres.number_up_to(farthest_origin);
    origin[metres.place.index] = metres.whole();
  });
  return origin;
}

auto read_frame(const Item& item) -> model::Frame {
  item.object({"origin", "crs"});
  model::Frame frame;
  frame.origin = read_origin(item.member("origin"));
  if (item.has("crs")) frame.crs = item.member("crs").text();
  return frame;
}

auto read_footprint(const Item& item) -> std::vector<geometry::Polygon> {
  std::vector<geometry::Polygon> polygons;
  item.each([&](const Item& polygon) { polygons.push_back(read_polygon(polygon)); });
  return polygons;
}

auto offset_between(const std::array<std::int64_t, 3>& own, const std::array<std::int64_t, 3>& origin)
    -> geometry::Point3 {
  const auto metres = [&](std::size_t axis) {
    return static_cast<double>(own[axis]) - static_cast<double>(origin[axis]);
  };
  return {metres(0), metres(1), metres(2)};
}

auto read_plan_item(const Item& item) -> model::Plan { return read_plan(item.object(plan_members)); }

auto read_embedded_plan(const Item& item, const std::array<std::int64_t, 3>& origin) -> model::Plan {
  check_version(item);
  item.object({"type", "version", "origin", "base", "cap", "outer", "holes", "profiles"});
  model::Plan plan = read_plan(item);
  const auto own = read_origin(item.member("origin"));
  if (own == origin) return plan;
  const auto offset = offset_between(own, origin);
  plan.base += offset.z;
  const auto move = [&](model::PlanRing& ring) {
    for (Point2& p : ring.points) p = p + Point2{offset.x, offset.y};
  };
  move(plan.outer);
  for (auto& hole : plan.holes) move(hole);
  return plan;
}

auto read_header(const Item& item, std::initializer_list<const char*> others) -> Header {
  if (!is_of_type(item.json, plan_type))
    throw Defect{"write-plan-type", "this is JSON but not plan + profiles: \"type\" must be \"" +
                                        std::string(plan_type) +
                                        "\" (or \"CityJSON\", with plans); give a file that mansard wrote"};
  check_version(item);
  std::vector<std::string> known{"type", "version", "made_by", "frame"};
  known.insert(known.end(), others.begin(), others.end());
  item.object(known);
  Header header;
  if (item.has("made_by")) header.made_by = read_made_by(item.member("made_by"));
  header.frame = read_frame(item.member("frame"));
  return header;
}

auto read_building(const Item& item, std::vector<base::Diagnostic>* refused) -> model::Building {
  item.object({"id", "attributes", "ground", "footprint", "parts"});
  model::Building building;
  building.id = item.member("id").text();
  if (item.has("attributes")) building.attributes = read_attributes(item.member("attributes"));
  if (item.has("ground")) building.ground = item.member("ground").number_up_to(farthest);
  if (item.has("footprint")) building.footprint = read_footprint(item.member("footprint"));
  std::set<std::string> part_ids;
  item.member("parts").each([&](const Item& each) {
    try {
      building.parts.push_back(read_part(each, part_ids));
    } catch (const Defect& defect) {
      if (refused == nullptr) throw;
      refused->push_back(base::error(defect.code, defect.message));
    }
  });
  return building;
}

auto parse_plans(std::string_view text, const std::string& name, std::vector<base::Diagnostic>& refused)
    -> base::Result<model::City> {
  auto city = parsed<model::City>(text, name, [&](const Item& file) {
    return is_of_type(file.json, "CityJSON") ? read_cityjson_plans(file) : read_city(file, refused);
  });
  for (auto& part : refused) part.subject = name;
  return city;
}

auto parse_plan(std::string_view text, const std::string& name) -> base::Result<model::Plan> {
  return parsed<model::Plan>(text, name, read_plan_item);
}

auto plans_reader(const Path& path) -> ReaderResult {
  if (auto large = large_plans_reader(path)) return ReaderResult(std::move(large));
  const auto text = base::read_file(path);
  if (!text) return text.failure();
  std::vector<base::Diagnostic> refused;
  auto city = parse_plans(*text, path.string(), refused);
  if (!city) return city.failure();
  return ReaderResult(whole_reader(*std::move(city), Models::none, std::move(refused)));
}

}  // namespace mansard::formats::detail
