// Reads plan + profiles. Every complaint says where in the file, in the manner of buildings[3].parts[0].plan.cap.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "mansard/base/options.hpp"
#include "mansard/write/detail/plan_text.hpp"

namespace mansard::write::detail {
namespace {

using Json = nlohmann::ordered_json;
using geometry::Point2;

/// Thrown and caught inside this file.
struct Defect {
  std::string code, message;
};

/// A place in the document; made on the way down, put into words only for a complaint.
struct Place {
  const Place* parent = nullptr;
  std::string_view name;  ///< of a member; of an item when empty
  std::size_t index = 0;

  [[nodiscard]] auto words() const -> std::string {
    const std::string before = parent != nullptr ? parent->words() : std::string();
    if (parent == nullptr) return {};
    if (name.empty()) return before + "[" + std::to_string(index) + "]";
    return before.empty() ? std::string(name) : before + "." + std::string(name);
  }
};

/// A value and its place.
struct Item {
  const Json& json;
  Place place;

  [[nodiscard]] auto where() const -> std::string {
    const std::string words = place.words();
    return words.empty() ? "the file" : words;
  }
  [[noreturn]] void refuse(const std::string& wanted) const {
    throw Defect{"write-plan-value", where() + " must be " + wanted + ", not " + shown()};
  }
  [[nodiscard]] auto shown() const -> std::string {
    if (json.is_object()) return "an object";
    if (json.is_array()) return "an array of " + std::to_string(json.size());
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() <= 40 ? text : text.substr(0, 37) + "…";
  }

  [[nodiscard]] auto member(std::string_view name) const -> Item {
    const auto found = json.find(name);
    if (found == json.end())
      throw Defect{"write-plan-missing", where() + " has no \"" + std::string(name) + "\"; add it"};
    return {*found, {&place, name, 0}};
  }
  [[nodiscard]] auto has(std::string_view name) const -> bool { return json.contains(name); }

  /// An object with no members but these.
  auto object(std::initializer_list<const char*> names) const -> const Item& {
    if (!json.is_object()) refuse("an object");
    const std::vector<std::string> known(names.begin(), names.end());
    for (const auto& [key, value] : json.items())
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        const auto meant = base::nearest_word(key, known);
        throw Defect{"write-plan-key", where() + " has an unknown member \"" + key + "\"" +
                                           (meant ? "; did you mean \"" + *meant + "\"?" : "; take it out")};
      }
    return *this;
  }

  /// Calls `work` with every item of an array.
  template <class Work>
  void each(Work work) const {
    if (!json.is_array()) refuse("an array");
    for (std::size_t i = 0; i < json.size(); ++i) work(Item{json[i], {&place, {}, i}});
  }

  [[nodiscard]] auto text() const -> std::string {
    if (!json.is_string()) refuse("a text");
    return json.get<std::string>();
  }
  [[nodiscard]] auto number() const -> double {
    if (!json.is_number()) refuse("a number");
    return json.get<double>();
  }
  [[nodiscard]] auto whole() const -> std::int64_t {
    const bool fits =
        json.is_number_integer() &&
        (!json.is_number_unsigned() ||
         json.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
    if (!fits) refuse("a whole number");
    return json.get<std::int64_t>();
  }
  template <std::size_t n>
  [[nodiscard]] auto numbers() const -> std::array<double, n> {
    std::array<double, n> values{};
    if (!json.is_array() || json.size() != n) refuse("an array of " + std::to_string(n) + " numbers");
    each([&](const Item& item) { values[item.place.index] = item.number(); });
    return values;
  }
};

auto read_attributes(const Item& item) -> ingest::Attributes {
  if (!item.json.is_object()) item.refuse("an object");
  ingest::Attributes attributes;
  for (const auto& [key, value] : item.json.items()) {
    ingest::Value out;
    if (value.is_boolean())
      out = value.get<bool>();
    else if (value.is_string())
      out = value.get<std::string>();
    else if (value.is_number_float())
      out = value.get<double>();
    else if (value.is_number())
      out = Item{value, {&item.place, key, 0}}.whole();
    else if (!value.is_null())
      Item{value, {&item.place, key, 0}}.refuse("a text, a number, true, false or null");
    attributes.emplace_back(key, std::move(out));
  }
  return attributes;
}

auto read_made_by(const Item& item) -> MadeBy {
  item.object({"generator", "version", "options", "inputs"});
  MadeBy made_by;
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
      made_by.inputs.push_back({input.member("path").text(), static_cast<std::uint64_t>(size),
                                input.member("sha256").text()});
    });
  return made_by;
}

auto read_origin(const Item& item) -> std::array<std::int64_t, 3> {
  std::array<std::int64_t, 3> origin{};
  if (!item.json.is_array() || item.json.size() != 3) item.refuse("an array of 3 whole numbers");
  item.each([&](const Item& metres) { origin[metres.place.index] = metres.whole(); });
  return origin;
}

auto read_frame(const Item& item) -> ingest::Frame {
  item.object({"origin", "crs"});
  ingest::Frame frame;
  frame.origin = read_origin(item.member("origin"));
  if (item.has("crs")) frame.crs = item.member("crs").text();
  return frame;
}

auto read_ring(const Item& item) -> geometry::Ring {
  geometry::Ring ring;
  item.each([&](const Item& point) {
    const auto [x, y] = point.numbers<2>();
    ring.push_back({x, y});
  });
  if (ring.size() < 3) item.refuse("a ring of at least 3 points");
  return ring;
}

auto read_polygon(const Item& item) -> geometry::Polygon {
  item.object({"outer", "holes"});
  geometry::Polygon polygon{read_ring(item.member("outer")), {}};
  if (item.has("holes"))
    item.member("holes").each([&](const Item& hole) { polygon.holes.push_back(read_ring(hole)); });
  return polygon;
}

auto read_plan_ring(const Item& item, std::size_t profiles) -> geometry::PlanRing {
  item.object({"points", "profile_of_edge"});
  geometry::PlanRing ring;
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
  return ring;
}

auto read_profile(const Item& item) -> geometry::Profile {
  geometry::Profile profile;
  item.each([&](const Item& point) {
    const auto [inward, height] = point.numbers<2>();
    profile.push_back({inward, height});
  });
  const auto refuse = [&](const std::string& what) {
    throw Defect{"write-plan-profile", item.where() + " " + what};
  };
  if (profile.size() < 2) refuse("must have at least 2 points");
  if (profile.front() != geometry::ProfilePoint{0, 0}) refuse("must start at [0, 0]");
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const auto& a = profile[i - 1];
    const auto& b = profile[i];
    if (a == b) refuse("repeats point " + std::to_string(i - 1));
    if (b.inward < a.inward) refuse("goes outward at point " + std::to_string(i) + "; overhangs are not possible");
    if (b.height < a.height) refuse("goes down at point " + std::to_string(i) + "; heights must not decrease");
  }
  return profile;
}

constexpr std::initializer_list<const char*> plan_members{"base", "cap", "outer", "holes", "profiles"};

/// The members of a plan; the caller has looked for unknown ones.
auto read_plan(const Item& item) -> geometry::Plan {
  geometry::Plan plan;
  plan.base = item.member("base").number();
  const Item cap = item.member("cap");
  if (plan.cap = cap.number(); plan.cap <= 0) cap.refuse("a height above the base, more than 0");
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

auto read_city(const Item& file) -> City {
  check_version(file);
  file.object({"type", "version", "made_by", "frame", "buildings"});

  City city;
  const auto new_id = [](const Item& owner, std::set<std::string>& taken) {
    const Item item = owner.member("id");
    std::string id = item.text();
    if (!taken.insert(id).second) item.refuse("an id that no other has");
    return id;
  };
  std::set<std::string> building_ids;
  if (file.has("made_by")) city.made_by = read_made_by(file.member("made_by"));
  city.frame = read_frame(file.member("frame"));
  file.member("buildings").each([&](const Item& item) {
    item.object({"id", "attributes", "ground", "footprint", "parts"});
    Building building;
    building.id = new_id(item, building_ids);
    if (item.has("attributes")) building.attributes = read_attributes(item.member("attributes"));
    if (item.has("ground")) building.ground = item.member("ground").number();
    if (item.has("footprint"))
      item.member("footprint").each([&](const Item& p) { building.footprint.push_back(read_polygon(p)); });
    std::set<std::string> part_ids;
    item.member("parts").each([&](const Item& each) {
      each.object({"id", "attributes", "plan"});
      Part part;
      part.id = new_id(each, part_ids);
      if (each.has("attributes")) part.attributes = read_attributes(each.member("attributes"));
      part.plan = read_plan(each.member("plan").object(plan_members));
      building.parts.push_back(std::move(part));
    });
    city.buildings.push_back(std::move(building));
  });
  return city;
}

// ---- plans that travel in CityJSON ----------------------------------------------------------------------------------

/// The attributes that have a type of ours, without the plan; other tools may have put in anything.
auto read_plain_attributes(const Json& object) -> ingest::Attributes {
  Json plain = Json::object();
  if (const auto found = object.find("attributes"); found != object.end() && found->is_object())
    for (const auto& [key, value] : found->items())
      if (!value.is_structured()) plain[key] = value;
  return read_attributes({plain, {}});
}

/// The plan of a part, relative to `origin`: files put together from several may have plans of several origins.
auto read_embedded_plan(const Item& item, const std::array<std::int64_t, 3>& origin) -> geometry::Plan {
  check_version(item);
  item.object({"type", "version", "origin", "base", "cap", "outer", "holes", "profiles"});
  geometry::Plan plan = read_plan(item);
  const auto own = read_origin(item.member("origin"));
  if (own == origin) return plan;
  const auto offset = [&](std::size_t axis) {
    return static_cast<double>(own[axis]) - static_cast<double>(origin[axis]);
  };
  plan.base += offset(2);
  const auto move = [&](geometry::PlanRing& ring) {
    for (Point2& p : ring.points) p = p + Point2{offset(0), offset(1)};
  };
  move(plan.outer);
  for (auto& hole : plan.holes) move(hole);
  return plan;
}

/// The footprint of LoD 0 and the ground it lies on.
void read_footprint(const Item& file, const Item& object, Building& building,
                    const std::array<std::int64_t, 3>& origin) {
  if (!object.has("geometry")) return;
  const Item transform = file.member("transform"), vertices = file.member("vertices");
  const auto scale = transform.member("scale").numbers<3>(), translate = transform.member("translate").numbers<3>();
  const auto coordinate = [&](const Item& vertex, std::size_t axis) {
    return vertex.numbers<3>()[axis] * scale[axis] + (translate[axis] - static_cast<double>(origin[axis]));
  };
  object.member("geometry").each([&](const Item& geometry) {
    if (!geometry.has("lod") || geometry.member("lod").json != "0") return;
    if (geometry.member("type").json != "MultiSurface") return;
    geometry.member("boundaries").each([&](const Item& surface) {
      geometry::Polygon polygon;
      surface.each([&](const Item& loop) {
        auto& ring = loop.place.index == 0 ? polygon.outer : polygon.holes.emplace_back();
        loop.each([&](const Item& item) {
          const std::int64_t index = item.whole();
          if (index < 0 || static_cast<std::uint64_t>(index) >= vertices.json.size())
            item.refuse("the number of a vertex");
          const Item vertex{vertices.json[static_cast<std::size_t>(index)],
                            {&vertices.place, {}, static_cast<std::size_t>(index)}};
          ring.push_back({coordinate(vertex, 0), coordinate(vertex, 1)});
          building.ground = coordinate(vertex, 2);
        });
      });
      building.footprint.push_back(std::move(polygon));
    });
  });
}

auto read_cityjson(const Item& file) -> City {
  const Item objects = file.member("CityObjects");
  if (!objects.json.is_object()) objects.refuse("an object");
  std::map<std::string_view, const Json*> object_of;
  for (const auto& [id, object] : objects.json.items()) object_of.emplace(id, &object);
  const auto plan_in = [](const Json& object) -> const Json* {
    const auto attributes = object.find("attributes");
    if (attributes == object.end() || !attributes->is_object() || !attributes->contains("ms_plan")) return nullptr;
    const Json& plan = (*attributes)["ms_plan"];
    // A feature may have an attribute of this name from elsewhere; a plan of ours is an object.
    return plan.is_object() ? &plan : nullptr;
  };

  City city;
  bool any = false;
  for (const auto& [id, object] : objects.json.items())
    if (const Json* plan = plan_in(object); plan != nullptr && !any) {
      const Place place{&objects.place, id, 0}, inner{&place, "ms_plan", 0};
      city.frame.origin = read_origin(Item{*plan, inner}.member("origin"));
      any = true;
    }
  if (!any)
    throw Defect{"write-plan-type",
                 "this CityJSON carries no plans (no part has an attribute \"ms_plan\"); give a file "
                 "that mansard wrote"};
  if (file.has("metadata")) {
    const Item metadata = file.member("metadata");
    if (metadata.has("mansard")) city.made_by = read_made_by(metadata.member("mansard"));
    if (metadata.has("referenceSystem")) {
      const std::string system = metadata.member("referenceSystem").text();
      if (const auto at = system.find("/EPSG/"); at != std::string::npos)
        city.frame.crs = "EPSG:" + system.substr(system.rfind('/') + 1);
    }
  }
  for (const auto& [id, json] : objects.json.items()) {
    const Item object{json, {&objects.place, id, 0}};
    if (!json.is_object() || !object.has("type") || object.member("type").json != "Building") continue;
    Building building;
    building.id = id;
    building.attributes = read_plain_attributes(json);
    read_footprint(file, object, building, city.frame.origin);
    if (object.has("children"))
      object.member("children").each([&](const Item& child) {
        const std::string key = child.text();
        const auto found = object_of.find(key);
        if (found == object_of.end()) child.refuse("the id of a city object");
        const Json* plan = plan_in(*found->second);
        if (plan == nullptr) return;
        const Place place{&objects.place, key, 0};
        building.parts.push_back({key, read_embedded_plan({*plan, {&place, "ms_plan", 0}}, city.frame.origin), {},
                                  read_plain_attributes(*found->second)});
      });
    city.buildings.push_back(std::move(building));
  }
  return city;
}

auto read_any(const Item& file) -> City {
  const auto is = [&](std::string_view type) {
    return file.json.is_object() && file.has("type") && file.json["type"] == type;
  };
  if (is(plan_type)) return read_city(file);
  if (is("CityJSON")) return read_cityjson(file);
  throw Defect{"write-plan-type", "this is JSON but not plan + profiles: \"type\" must be \"" + std::string(plan_type) +
                                      "\" (or \"CityJSON\", with plans); give a file that mansard wrote"};
}

/// What `read` makes of the JSON, with the file's faults as diagnostics.
template <class Value, class Read>
auto parsed(std::string_view text, const std::string& name, const Read& read) -> base::Result<Value> {
  try {
    const Json json = Json::parse(text);
    return read(Item{json, {}});
  } catch (const Json::parse_error& e) {
    return base::error("write-plan-json",
                       "this is not JSON: it goes wrong at byte " + std::to_string(e.byte) + "; is the file whole?",
                       name);
  } catch (const Json::exception&) {  // a number that no double can hold
    return base::error("write-plan-json", "this is not JSON that can be read: it has a number out of range", name);
  } catch (const Defect& defect) {
    return base::error(defect.code, defect.message, name);
  }
}

}  // namespace

auto parse_plans(std::string_view text, const std::string& name) -> base::Result<City> {
  return parsed<City>(text, name, read_any);
}

auto parse_plan(std::string_view text, const std::string& name) -> base::Result<geometry::Plan> {
  return parsed<geometry::Plan>(text, name, [](const Item& item) { return read_plan(item.object(plan_members)); });
}

}  // namespace mansard::write::detail
