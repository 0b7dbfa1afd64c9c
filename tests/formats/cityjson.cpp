#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "cities.hpp"
#include "mansard/base/run.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/codes.hpp"

namespace {

using namespace cities;
using Json = nlohmann::json;
using mansard::formats::cityjson;

auto parsed(const City& city) -> Json {
  const auto text = cityjson(city, mansard::formats::Solids::part);
  EXPECT_TRUE(text) << mansard::base::to_string(text.error());
  return Json::parse(*text);
}

auto point(const Json& file, std::size_t v) -> Point3 {
  const auto& q = file["vertices"][v];
  const auto& scale = file["transform"]["scale"];
  return {q[0].get<double>() * scale[0].get<double>(), q[1].get<double>() * scale[1].get<double>(),
          q[2].get<double>() * scale[2].get<double>()};
}

auto geometry_of(const Json& file, const std::string& object, const std::string& lod) -> Json {
  for (const auto& geometry : file["CityObjects"][object]["geometry"])
    if (geometry["lod"] == lod) return geometry;
  ADD_FAILURE() << object << " has no lod " << lod;
  return {};
}

/// Six times the signed volume under a loop, and twice its area vector.
void add_loop(const Json& file, const Json& loop, double& volume6, Point3& area2) {
  const Point3 a = point(file, loop[0]);
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Point3 b = point(file, loop[i]), c = point(file, loop[i + 1]);
    volume6 += dot(a, cross(b, c));
    area2 = area2 + cross(b - a, c - a);
  }
}

/// What a CityJSON validator asks of a solid: closed, manifold, outward, semantics in the shape of the boundaries.
void expect_valid_solid(const Json& file, const Json& solid, double volume) {
  ASSERT_EQ(solid["type"], "Solid");
  ASSERT_EQ(solid["boundaries"].size(), 1U) << "one outer shell";
  const auto& shell = solid["boundaries"][0];
  ASSERT_EQ(solid["semantics"]["values"].size(), 1U);
  ASSERT_EQ(solid["semantics"]["values"][0].size(), shell.size());

  std::map<std::pair<std::size_t, std::size_t>, int> edges;
  double volume6 = 0;
  for (std::size_t f = 0; f < shell.size(); ++f) {
    Point3 area2;
    for (const auto& loop : shell[f]) {
      ASSERT_GE(loop.size(), 3U);
      add_loop(file, loop, volume6, area2);
      for (std::size_t i = 0; i < loop.size(); ++i) {
        ASSERT_NE(loop[i], loop[(i + 1) % loop.size()]);
        ++edges[{loop[i], loop[(i + 1) % loop.size()]}];
      }
    }
    const Point3 n = normalised(area2);
    for (const auto& loop : shell[f])
      for (const auto& v : loop) EXPECT_NEAR(dot(n, point(file, v) - point(file, shell[f][0][0])), 0, 1e-4) << "planar";

    const auto& semantic = solid["semantics"]["surfaces"][solid["semantics"]["values"][0][f].get<std::size_t>()];
    if (semantic["type"] == "GroundSurface") {
      EXPECT_LT(n.z, -0.99);
    } else if (semantic["type"] == "WallSurface") {
      EXPECT_NEAR(n.z, 0, 0.01);
      EXPECT_TRUE(semantic["ms_party_wall"].is_boolean());
    } else {
      ASSERT_EQ(semantic["type"], "RoofSurface");
      EXPECT_NEAR(semantic["ms_slope"].get<double>(), std::acos(n.z) * 180 / M_PI, 0.1);
    }
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << "closed";
  }
  EXPECT_NEAR(volume6 / 6, volume, 2e-5 * volume) << "outward, and rounded by no more than 0.05 mm a side";
}

TEST(CityJson, says_its_version_transform_and_reference_system) {
  const Json file = parsed(street());
  EXPECT_EQ(file["type"], "CityJSON");
  EXPECT_EQ(file["version"], "2.0");
  EXPECT_EQ(file["transform"]["scale"], Json({0.0001, 0.0001, 0.0001}));
  EXPECT_EQ(file["transform"]["translate"], Json({84800.0, 447400.0, 0.0}));
  EXPECT_EQ(file["metadata"]["referenceSystem"], "https://www.opengis.net/def/crs/EPSG/0/28992");
  EXPECT_EQ(file["metadata"]["geographicalExtent"], Json({84801.0625, 447400.0, 0.5, 84845.0, 447420.0, 12.5}));
}

TEST(CityJson, keeps_a_plus_for_what_its_extension_declares) {
  City city = street();
  city.buildings[0].attributes = {{"+noise", std::int64_t{48}}, {"_+noise", std::int64_t{49}}, {"_", std::int64_t{50}}};
  const Json attributes = parsed(city)["CityObjects"]["house"]["attributes"];
  EXPECT_FALSE(attributes.contains("+noise"));
  EXPECT_EQ(attributes["_+noise"], 48);
  EXPECT_EQ(attributes["__+noise"], 49);
  EXPECT_EQ(attributes["_"], 50);
}

TEST(CityJson, tells_the_extent_of_every_building_with_its_parts) {
  const Json file = parsed(street());
  const Json& objects = file["CityObjects"];
  for (const auto& [id, object] : objects.items()) {
    if (object["type"] != "Building") {
      EXPECT_FALSE(object.contains("geographicalExtent")) << id;
      continue;
    }
    constexpr double most = 1e9;
    std::array<double, 6> found{most, most, most, -most, -most, -most};
    const auto look_at = [&](const Json& boundaries, const auto& self) -> void {
      if (boundaries.is_array()) {
        for (const auto& inner : boundaries) self(inner, self);
        return;
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double at = file["vertices"][boundaries.get<std::size_t>()][axis].get<double>() / 10000 +
                          file["transform"]["translate"][axis].get<double>();
        found[axis] = std::min(found[axis], at);
        found[axis + 3] = std::max(found[axis + 3], at);
      }
    };
    std::vector<std::string> family{id};
    for (const auto& child : object["children"]) family.push_back(child);
    for (const auto& member : family)
      for (const auto& geometry : objects[member]["geometry"]) look_at(geometry["boundaries"], look_at);
    ASSERT_EQ(object["geographicalExtent"].size(), 6U) << id;
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(object["geographicalExtent"][i].get<double>(), found[i], 1e-6) << id;
  }
}

TEST(CityJson, tells_no_extent_of_a_building_without_geometry) {
  City city = street();
  city.buildings.resize(1);
  city.buildings[0].footprint.clear();
  city.buildings[0].parts.clear();
  EXPECT_FALSE(parsed(city)["CityObjects"]["house"].contains("geographicalExtent"));
}

TEST(CityJson, says_how_it_was_made) {
  const Json made = parsed(street())["+mansard"]["made_by"];
  EXPECT_EQ(made["version"], "0.1.0");
  EXPECT_EQ(made["options"]["segment.alpha"], "40");
  EXPECT_EQ(made["inputs"][0]["sha256"], "abc0");
}

TEST(CityJson, has_only_members_that_the_specification_knows) {
  const Json file = parsed(street());
  const std::set<std::string> root{"type",     "version",     "extensions", "transform",
                                   "metadata", "CityObjects", "vertices",   "+mansard"};
  for (const auto& [key, value] : file.items()) EXPECT_TRUE(root.contains(key)) << key;
  const std::set<std::string> object{"type", "attributes", "geographicalExtent", "children", "parents", "geometry"};
  const std::set<std::string> geometry{"type", "lod", "boundaries", "semantics"};
  for (const auto& [id, each] : file["CityObjects"].items()) {
    for (const auto& [key, value] : each.items()) EXPECT_TRUE(object.contains(key)) << key;
    for (const auto& g : each["geometry"]) {
      EXPECT_TRUE(g["lod"].is_string());
      for (const auto& [key, value] : g.items()) EXPECT_TRUE(geometry.contains(key)) << key;
    }
  }
}

TEST(CityJson, names_no_reference_system_without_an_epsg_code) {
  for (const char* crs : {"", "PROJCS[\"mine\"]", "EPSG:", "EPSG:RD", "EPSG:-5"}) {
    City city = street();
    city.frame.crs = crs;
    EXPECT_FALSE(parsed(city)["metadata"].contains("referenceSystem")) << crs;
  }
}

TEST(CityJson, restores_the_origin_exactly) {
  const Json file = parsed(street());
  const Json footprint = geometry_of(file, "house", "0");
  const auto& loop = footprint["boundaries"][0][0];
  const auto& v = file["vertices"][loop[0].get<std::size_t>()];
  EXPECT_EQ(v, Json({10625, 21250, 12500}));
  // What a reader computes is what was put in: 84801.0625 and 447402.125 are exact in binary.
  EXPECT_DOUBLE_EQ(v[0].get<double>() * 0.0001 + 84800.0, 84801.0625);
  EXPECT_DOUBLE_EQ(v[1].get<double>() * 0.0001 + 447400.0, 447402.125);
}

TEST(CityJson, holds_every_vertex_once_and_uses_all) {
  const Json file = parsed(street());
  std::set<Json> distinct;
  for (const auto& v : file["vertices"]) {
    for (const auto& c : v) EXPECT_TRUE(c.is_number_integer());
    EXPECT_TRUE(distinct.insert(v).second) << v << " twice";
  }
  std::set<std::size_t> used;
  const std::function<void(const Json&)> walk = [&](const Json& boundaries) {
    if (boundaries.is_array())
      for (const auto& inner : boundaries) walk(inner);
    else used.insert(boundaries.get<std::size_t>());
  };
  for (const auto& [id, object] : file["CityObjects"].items())
    for (const auto& geometry : object["geometry"]) walk(geometry["boundaries"]);
  EXPECT_EQ(used.size(), file["vertices"].size());
  EXPECT_EQ(*used.rbegin(), file["vertices"].size() - 1);
}

TEST(CityJson, keeps_features_as_buildings_and_footprints_as_their_parts) {
  const Json objects = parsed(street())["CityObjects"];
  ASSERT_EQ(objects.size(), 5U);
  EXPECT_EQ(objects["block"]["type"], "Building");
  EXPECT_EQ(objects["block"]["children"], Json({"block-1", "block-2"}));
  for (const auto* part : {"block-1", "block-2"}) {
    EXPECT_EQ(objects[part]["type"], "BuildingPart");
    EXPECT_EQ(objects[part]["parents"], Json({"block"}));
  }
}

TEST(CityJson, keeps_attributes_with_their_types) {
  const Json attributes = parsed(street())["CityObjects"]["house"]["attributes"];
  EXPECT_EQ(attributes["name"], "Haus \"Zur Rose\"");
  EXPECT_TRUE(attributes["year"].is_number_integer());
  EXPECT_EQ(attributes["year"], 1893);
  EXPECT_TRUE(attributes["height"].is_number_float()) << "12.0 stays a real number";
  EXPECT_EQ(attributes["listed"], true);
  EXPECT_TRUE(attributes["none"].is_null());
}

TEST(CityJson, gives_the_footprint_as_lod_0_with_its_courtyard) {
  const Json file = parsed(street());
  const auto footprint = geometry_of(file, "block", "0");
  EXPECT_EQ(footprint["type"], "MultiSurface");
  ASSERT_EQ(footprint["boundaries"].size(), 2U);
  EXPECT_EQ(footprint["boundaries"][0].size(), 2U);
  for (const auto& surface : footprint["boundaries"])
    for (const auto& loop : surface)
      for (const auto& v : loop) EXPECT_EQ(file["vertices"][v.get<std::size_t>()][2], 5000);
}

TEST(CityJson, writes_valid_solids_at_both_levels_of_detail) {
  const Json file = parsed(street());
  expect_valid_solid(file, geometry_of(file, "house-1", "2.2"), 10 * 8 * 6 + 10 * 8 * 4 / 2.);
  expect_valid_solid(file, geometry_of(file, "house-1", "1.2"), 10 * 8 * 8);  // half-way from 7.25 to 11.25
  expect_valid_solid(file, geometry_of(file, "block-1", "2.2"), 300 * 12);
  expect_valid_solid(file, geometry_of(file, "block-1", "1.2"), 300 * 11.9);  // ms_h_roof_70p
  expect_valid_solid(file, geometry_of(file, "block-2", "2.2"), 100 * 4);
  expect_valid_solid(file, geometry_of(file, "block-2", "1.2"), 100 * 4);
}

TEST(CityJson, keeps_polygons_whole_with_their_holes) {
  const Json file = parsed(street());
  const auto shell = geometry_of(file, "block-1", "2.2")["boundaries"][0];
  ASSERT_EQ(shell.size(), 10U) << "8 walls, roof, ground: polygons and not triangles";
  EXPECT_EQ(std::count_if(shell.begin(), shell.end(), [](const Json& face) { return face.size() == 2; }), 2);
}

TEST(CityJson, gives_slope_and_azimuth_of_roofs_in_degrees) {
  const Json file = parsed(street());
  const auto solid = geometry_of(file, "house-1", "2.2");
  std::set<double> azimuths;
  for (const auto& surface : solid["semantics"]["surfaces"])
    if (surface["type"] == "RoofSurface") {
      EXPECT_NEAR(surface["ms_slope"].get<double>(), 45, 0.01);
      azimuths.insert(surface["ms_azimuth"].get<double>());
    }
  EXPECT_EQ(azimuths, (std::set<double>{0, 180}));
  const auto flat = geometry_of(file, "house-1", "1.2");
  for (const auto& surface : flat["semantics"]["surfaces"]) EXPECT_FALSE(surface.contains("ms_azimuth")) << "flat";
}

TEST(CityJson, marks_party_walls_at_both_levels_of_detail) {
  const Json file = parsed(street());
  for (const char* lod : {"1.2", "2.2"}) {
    const auto solid = geometry_of(file, "block-2", lod);
    int party = 0;
    for (std::size_t f = 0; f < solid["boundaries"][0].size(); ++f) {
      const auto& semantic = solid["semantics"]["surfaces"][solid["semantics"]["values"][0][f].get<std::size_t>()];
      if (semantic["type"] != "WallSurface" || semantic["ms_party_wall"] == false) continue;
      ++party;
      for (const auto& v : solid["boundaries"][0][f][0]) EXPECT_DOUBLE_EQ(point(file, v).x, 40) << "the west side";
    }
    EXPECT_EQ(party, 1) << lod;
  }
}

TEST(CityJson, carries_the_plan_of_every_part) {
  const Json plan = parsed(street())["CityObjects"]["block-1"]["attributes"]["+ms_plan"];
  EXPECT_EQ(plan["type"], "mansard-plan");
  EXPECT_EQ(plan["version"], 1);
  EXPECT_EQ(plan["origin"], Json({84800, 447400, 0}));
  EXPECT_EQ(plan["base"], 0.5);
  EXPECT_EQ(plan["outer"]["points"][1], Json({40, 0}));
  EXPECT_EQ(plan["holes"][0]["profile_of_edge"], Json({1, 1, 1, 1}));
  EXPECT_EQ(plan["profiles"][0], Json({{0, 0}, {0, 6}, {3, 9}}));
}

TEST(CityJson, ignores_a_roof_height_that_lies_outside_the_model) {
  for (const double wrong : {0.5, -3.0, 12.6, 500.0, std::nan("")}) {
    City city = street();
    city.buildings[1].parts[0].attributes = {{"ms_h_roof_70p", wrong}};
    const Json file = parsed(city);
    expect_valid_solid(file, geometry_of(file, "block-1", "1.2"), 300 * 12);
  }
}

TEST(CityJson, measures_the_roof_height_in_the_frame_of_the_file) {
  City city = street();
  city.frame.origin[2] = 100;
  city.buildings[1].parts[0].attributes = {{"ms_h_roof_70p", 110.5}};
  const Json file = parsed(city);
  expect_valid_solid(file, geometry_of(file, "block-1", "1.2"), 300 * 10);
}

TEST(CityJson, stays_closed_where_rounding_makes_vertices_meet) {
  // The south wall is split by an edge that is 0.04 mm beside the corner: it vanishes on a grid of 0.1 mm.
  Polygon polygon = rectangle(0, 0, 10, 8);
  polygon.outer.insert(polygon.outer.begin() + 1, {9.99997, 0});
  City city;
  Building building;
  building.id = "b";
  building.parts = {Part{"b-1", plan_of(polygon, 0, 5), prism(polygon, 0, 5), {}}};
  city.buildings = {building};
  const Json file = parsed(city);
  EXPECT_EQ(file["vertices"].size(), 8U);
  const auto solid = geometry_of(file, "b-1", "2.2");
  EXPECT_EQ(solid["boundaries"][0].size(), 6U);
  expect_valid_solid(file, solid, 400);
  expect_valid_solid(file, geometry_of(file, "b-1", "1.2"), 400);
}

TEST(CityJson, drops_spikes_that_rounding_makes) {
  Polygon polygon{{{0, 0}, {10, 0}, {15, 0.00002}, {10, 0.00004}, {10, 8}, {0, 8}}, {}};
  City city;
  Building building;
  building.id = "b";
  building.footprint = {polygon};
  city.buildings = {building};
  const Json file = parsed(city);
  EXPECT_EQ(geometry_of(file, "b", "0")["boundaries"][0][0].size(), 4U);
  EXPECT_EQ(file["vertices"].size(), 4U);
}

TEST(CityJson, shares_ground_vertices_between_neighbours) {
  const Json file = parsed(street());
  // block-1 and block-2 meet along x = 40; (40, 0, 0.5) is one vertex for footprint, ring and annex.
  EXPECT_EQ(std::count(file["vertices"].begin(), file["vertices"].end(), Json({400000, 0, 5000})), 1);
}

TEST(CityJson, writes_a_feature_without_parts_and_an_empty_city) {
  City city = street();
  city.buildings[0].parts.clear();
  city.buildings[0].footprint.clear();
  const Json house = parsed(city)["CityObjects"]["house"];
  EXPECT_EQ(house["geometry"], Json::array());
  EXPECT_FALSE(house.contains("children"));
  const Json nothing = parsed(City{});
  EXPECT_EQ(nothing["CityObjects"], Json::object());
  EXPECT_EQ(nothing["vertices"], Json::array());
}

TEST(CityJson, gives_a_building_one_solid_at_each_level_of_detail_and_its_parts_none) {
  const Json file = Json::parse(*cityjson(street()));
  for (const char* lod : {"1.2", "2.2"}) {
    const Json solid = geometry_of(file, "block", lod);
    EXPECT_EQ(solid["type"], "Solid");
    EXPECT_EQ(solid["boundaries"].size(), 1U);
  }
  expect_valid_solid(file, geometry_of(file, "block", "2.2"), 300 * 12 + 100 * 4);
  for (const char* part : {"house-1", "block-1", "block-2"}) {
    EXPECT_FALSE(file["CityObjects"][part].contains("geometry"));
    EXPECT_TRUE(file["CityObjects"][part]["attributes"].contains("+ms_plan"));
  }
  EXPECT_EQ(file["+mansard"]["solids"], "building");
}

TEST(CityJson, refuses_two_buildings_of_one_id) {
  City city = street();
  city.buildings[1].id = "house";
  const auto text = cityjson(city);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, "write-duplicate-id");
  EXPECT_EQ(text.error().subject, "house");
}

TEST(CityJson, renames_a_part_whose_id_is_a_building) {
  City city = street();
  city.buildings[0].id = "block-1";
  const Json objects = parsed(city)["CityObjects"];
  EXPECT_EQ(objects["block-1"]["type"], "Building");
  EXPECT_EQ(objects["block-1-part"]["parents"], Json({"block"}));
  EXPECT_EQ(objects["block"]["children"], Json({"block-1-part", "block-2"}));
}

TEST(CityJson, keeps_the_last_of_attributes_with_one_name) {
  City city = street();
  city.buildings[0].attributes = {{"ms_volume", 1.0}, {"name", std::string("a")}, {"ms_volume", 2.5}};
  const auto text = *cityjson(city);
  EXPECT_EQ(Json::parse(text)["CityObjects"]["house"]["attributes"]["ms_volume"], 2.5);
  EXPECT_EQ(text.find("\"ms_volume\""), text.rfind("\"ms_volume\""));
}

TEST(CityJson, escapes_text_and_mends_what_is_not_utf8) {
  City city = street();
  city.buildings[0].attributes = {{"a", std::string("tab\t newline\n bell\a \\ Café \xF0\x9F\x8F\xA0")},
                                  {"b", std::string("latin-1 \xE9.")},
                                  {"c", std::string("cut \xE2\x82")},
                                  {"d", std::string("overlong \xC0\xAF, surrogate \xED\xA0\x80")},
                                  {"e", std::nan("")}};
  const Json attributes = parsed(city)["CityObjects"]["house"]["attributes"];
  EXPECT_EQ(attributes["a"], "tab\t newline\n bell\a \\ Café \xF0\x9F\x8F\xA0");
  EXPECT_EQ(attributes["b"], "latin-1 \uFFFD.");
  EXPECT_EQ(attributes["c"], "cut \uFFFD\uFFFD");
  EXPECT_EQ(attributes["d"], "overlong \uFFFD\uFFFD, surrogate \uFFFD\uFFFD\uFFFD");
  EXPECT_TRUE(attributes["e"].is_null());
}

TEST(CityJson, refuses_broken_models) {
  const auto code_after = [](auto&& spoil) {
    City city = street();
    spoil(city.buildings[1].parts[1].model);
    const auto text = cityjson(city, mansard::formats::Solids::part);
    EXPECT_FALSE(text);
    if (!text) {
      EXPECT_EQ(text.error().subject, "block-2");
    }
    return text ? std::string() : text.error().code;
  };
  EXPECT_EQ(code_after([](auto& m) { m.solid.vertices[2].y = std::nan(""); }), "write-model");
  EXPECT_EQ(code_after([](auto& m) { m.solid.vertices[2].z = HUGE_VAL; }), "write-model");
  EXPECT_EQ(code_after([](auto& m) { m.solid.faces[0].loops[0][1] = 999; }), "write-model");
  EXPECT_EQ(code_after([](auto& m) { m.solid.faces[0].loops.clear(); }), "write-model");
  EXPECT_EQ(code_after([](auto& m) { m.solid.faces[0].normal = {}; }), "write-model");
  EXPECT_EQ(code_after([](auto& m) { m.classes.pop_back(); }), "write-model");
}

TEST(CityJson, is_the_same_in_every_locale) {
  const std::string before = *cityjson(street());
  struct Restore {
    std::string name = std::setlocale(LC_ALL, nullptr);
    ~Restore() { std::setlocale(LC_ALL, name.c_str()); }
  } restore;
  struct Comma : std::numpunct<char> {
    auto do_decimal_point() const -> char override { return ','; }
    auto do_thousands_sep() const -> char override { return '.'; }
    auto do_grouping() const -> std::string override { return "\3"; }
  };
  const auto old = std::locale::global(std::locale(std::locale::classic(), new Comma));
  const std::string during = *cityjson(street());
  std::locale::global(old);
  EXPECT_EQ(before, during);
}

TEST(CityJson, is_closed_for_random_prisms_of_any_shape) {
  mansard::base::Random random(7);
  for (int round = 0; round < 60; ++round) {
    // A star-shaped polygon about a centre somewhere, and a smaller one inside it as a hole.
    const double cx = random.uniform(-500, 500), cy = random.uniform(-500, 500), base = random.uniform(-5, 90);
    Polygon polygon;
    const std::size_t n = 5 + random.index(12);
    polygon.holes.resize(1);
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * (static_cast<double>(i) + random.uniform(0, 0.7)) / static_cast<double>(n);
      const double r = random.uniform(8, 12);
      polygon.outer.push_back({cx + r * std::cos(angle), cy + r * std::sin(angle)});
      polygon.holes[0].insert(polygon.holes[0].begin(),
                              {cx + 0.3 * r * std::cos(angle), cy + 0.3 * r * std::sin(angle)});
    }
    City city;
    Building building;
    building.id = "b";
    building.parts = {Part{"b-1", plan_of(polygon, base, 9), prism(polygon, base, base + 9), {}}};
    city.buildings = {building};
    const Json file = parsed(city);
    const double volume = 9 * mansard::geometry::area(polygon);
    expect_valid_solid(file, geometry_of(file, "b-1", "2.2"), volume);
    expect_valid_solid(file, geometry_of(file, "b-1", "1.2"), volume);
  }
}

TEST(Codes, all_have_a_cause_and_a_remedy) {
  std::set<std::string> seen;
  for (const auto& code : mansard::formats::codes()) {
    EXPECT_TRUE(code.code.starts_with("write-"));
    EXPECT_TRUE(seen.insert(code.code).second);
    EXPECT_FALSE(code.cause.empty());
    EXPECT_FALSE(code.remedy.empty());
  }
}

}  // namespace
