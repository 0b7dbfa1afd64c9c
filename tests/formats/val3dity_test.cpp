// Two judges of solids that share nothing, on sound solids, on spoilt ones, and on real footprints.
#include <gmock/gmock.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <random>
#include <sstream>

#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/label/label.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/unite.hpp"
#include "val3dity_rules.hpp"

namespace {

using namespace cities;
using Json = nlohmann::json;
namespace base = mansard::base;

/// As it is, however broken, with whole tenths of millimetres.
auto as_cityjson(const Solid& solid) -> Json {
  Json city;
  city["transform"] = {{"scale", {1e-4, 1e-4, 1e-4}}, {"translate", {0, 0, 0}}};
  for (const auto& v : solid.vertices)
    city["vertices"].push_back({std::llround(v.x * 1e4), std::llround(v.y * 1e4), std::llround(v.z * 1e4)});
  Json shell = Json::array();
  for (const auto& face : solid.faces) shell.push_back(face.loops);
  city["CityObjects"]["it"]["geometry"] = {{{"type", "Solid"}, {"lod", "2.2"}, {"boundaries", {shell}}}};
  return city;
}

auto codes_of(const Json& city) -> std::set<int> {
  std::set<int> codes;
  for (const auto& finding : val3dity::findings(city)) codes.insert(finding.code);
  return codes;
}

auto faults_of(const Solid& solid) -> std::set<std::string> {
  std::set<std::string> codes;
  for (const auto& fault : mansard::solid::check(solid)) codes.insert(fault.code);
  return codes;
}

auto house() -> Solid { return gable(0, 0, 10, 8, 0, 6, 10).solid; }

auto with(Solid solid, const std::function<void(Solid&)>& change) -> Solid {
  change(solid);
  for (auto& face : solid.faces) {
    Point3 normal;
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        normal = normal + cross(solid.vertices[loop[i]], solid.vertices[loop[(i + 1) % loop.size()]]);
    face.normal = normalised(normal);
  }
  return solid;
}

auto both(Solid a, const Solid& b) -> Solid {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (auto face : b.faces) {
    for (auto& loop : face.loops)
      for (auto& v : loop) v += first;
    a.faces.push_back(face);
  }
  return a;
}

/// A lower and a higher box side by side in one solid. The lower one's front goes up to the corner of the higher and
/// down again, a tenth of a millimetre beside: a needle in a face that bends by half of that.
auto with_needle() -> Solid {
  const auto up = [](Ring ring, double z) {
    std::vector<Point3> points;
    for (const Point2 p : ring) points.push_back({p.x, p.y, z});
    return points;
  };
  Solid s;
  for (const auto& points :
       {up({{0, 0}, {5, 0}, {10, 0}, {10, 10}, {5, 10}, {0, 10}}, 0),
        up({{0, 0}, {4.9999, 0.0001}, {5, 10}, {0, 10}}, 5), up({{5, 0}, {10, 0}, {10, 10}, {5, 10}}, 10)})
    s.vertices.insert(s.vertices.end(), points.begin(), points.end());
  for (const std::vector<std::uint32_t>& loop :
       std::vector<std::vector<std::uint32_t>>{{0, 5, 4, 3, 2, 1},  // the floor
                                               {6, 7, 8, 9},
                                               {10, 11, 12, 13},  // the roofs
                                               {0, 1, 10, 7, 6},
                                               {1, 2, 11, 10},  // fronts: lower, higher
                                               {2, 3, 12, 11},
                                               {3, 4, 8, 13, 12},
                                               {4, 5, 9, 8},
                                               {5, 0, 6, 9},     // right, backs, left
                                               {7, 10, 13, 8}})  // the higher one's above the lower roof
    s.faces.push_back({{loop}, FaceKind::side, {}, {}});
  return with(s, [](Solid&) {});
}

/// A box with a hole in its top face, whatever that makes of it.
auto with_hole(const Ring& hole) -> Solid {
  return with(prism(rectangle(0, 0, 10, 10), 0, 5).solid, [&](Solid& s) {
    auto& loop = s.faces.back().loops.emplace_back();
    for (const auto& p : hole) {
      loop.push_back(static_cast<std::uint32_t>(s.vertices.size()));
      s.vertices.push_back({p.x, p.y, 5});
    }
  });
}

struct Case {
  std::string name;
  Solid solid;
  std::set<int> codes;           ///< of the rules
  std::set<std::string> faults;  ///< of solid::check()
};

auto spoilt() -> std::vector<Case> {
  using S = Solid&;
  Polygon court = rectangle(0, 0, 30, 30);
  court.holes = {{{10, 10}, {10, 20}, {20, 20}, {20, 10}}};
  std::vector<Case> cases{
      {"a house", house(), {}, {}},
      {"a court", prism(court, 0, 10).solid, {}, {}},
      {"a face missing", with(house(), [](S s) { s.faces.pop_back(); }), {302}, {"solid-open"}},
      {"two of three faces missing", with(house(), [](S s) { s.faces.resize(3); }), {301}, {"solid-open"}},
      {"a face twice", with(house(), [](S s) { s.faces.push_back(s.faces[2]); }), {303}, {"solid-non-manifold"}},
      {"a face turned", with(house(), [](S s) { std::ranges::reverse(s.faces[5].loops[0]); }), {307}, {"solid-open"}},
      {"inside out",
       with(house(),
            [](S s) {
              for (auto& f : s.faces) std::ranges::reverse(f.loops[0]);
            }),
       {307},
       {"solid-orientation"}},
      {"an eaves corner a centimetre up",
       with(house(), [](S s) { s.vertices[4].z += 0.01; }),
       {203},
       {"solid-not-planar"}},
      {"an eaves corner 0.3 mm up", with(house(), [](S s) { s.vertices[4].z += 0.0009; }), {203}, {"solid-not-planar"}},
      {"a needle up a wall", with_needle(), {204}, {"solid-needle"}},
      {"a corner twice",
       with(house(), [](S s) { s.faces[1].loops[0].insert(s.faces[1].loops[0].begin(), 0); }),
       {102},
       {"solid-degenerate"}},
      {"a face of two corners", with(house(), [](S s) { s.faces[1].loops[0].resize(2); }), {101}, {"solid-degenerate"}},
      {"a face crossing itself",
       with(house(), [](S s) { std::swap(s.faces[2].loops[0][1], s.faces[2].loops[0][2]); }),
       {104},
       {"solid-open", "solid-self-intersection"}},
      {"the ridge below the floor",
       with(house(), [](S s) { s.vertices[8].z = s.vertices[9].z = -2; }),
       {104},
       {"solid-self-intersection"}},
      {"a tip through a wall",
       both(house(), prism(rectangle(4, -1, 2, 3), 2, 3).solid),
       {305},
       {"solid-self-intersection"}},
      {"two apart", both(house(), prism(rectangle(20, 0, 5, 5), 0, 5).solid), {305}, {}},
      {"a hole that is no hole", with_hole({{2, 2}, {2, 4}, {4, 4}, {4, 2}}), {302}, {"solid-open"}},
      {"a hole outside",
       with_hole({{12, 2}, {12, 4}, {14, 4}, {14, 2}}),
       {206},
       {"solid-open", "solid-self-intersection"}},
      {"a hole turned as its face", with_hole({{2, 2}, {4, 2}, {4, 4}, {2, 4}}), {208}, {"solid-open"}},
      {"a hole across the boundary",
       with_hole({{8, 2}, {8, 4}, {14, 4}, {14, 2}}),
       {201},
       {"solid-open", "solid-self-intersection"}},
      {"a hole that parts the face",
       with_hole({{0, 5}, {5, 10}, {10, 5}, {5, 0}}),
       {205},
       {"solid-open", "solid-self-intersection"}},
  };
  // Two boxes that share an edge, and two that share a corner.
  for (const double z : {0.0, 5.0}) {
    auto pair = both(prism(rectangle(0, 0, 5, 5), 0, 5).solid, prism(rectangle(5, 5, 5, 5), z, z + 5).solid);
    for (auto& face : pair.faces)
      for (auto& v : face.loops[0])
        for (std::uint32_t w = 0; w < v; ++w)
          if (pair.vertices[w] == pair.vertices[v]) v = w;
    cases.push_back({z == 0 ? "an edge of four faces" : "a corner of two",
                     pair,
                     z == 0 ? std::set<int>{303} : std::set<int>{305},
                     {"solid-non-manifold"}});
  }
  // A box whose top is pushed down through its floor.
  cases.push_back({"a spike through the floor",
                   with(house(),
                        [](S s) {
                          s.faces.pop_back();
                          s.vertices.push_back({5, 6, -3});  // 10, over the face 6 7 8 9
                          const std::vector<std::uint32_t> ring{6, 7, 8, 9};
                          for (std::size_t i = 0; i < 4; ++i)
                            s.faces.push_back({{{ring[i], ring[(i + 1) % 4], 10}}, FaceKind::side, {}, {}});
                        }),
                   {306},
                   {"solid-self-intersection"}});
  return cases;
}

TEST(Val3dityRules, and_the_check_say_what_is_wrong_with_spoilt_solids) {
  for (const auto& [name, solid, codes, faults] : spoilt()) {
    EXPECT_EQ(codes_of(as_cityjson(solid)), codes) << name;
    const auto said = faults_of(solid);
    EXPECT_TRUE(std::ranges::includes(said, faults)) << name << ": " << testing::PrintToString(said);
    EXPECT_EQ(said.empty(), faults.empty()) << name << ": " << testing::PrintToString(said);
  }
}

/// Roofs over the footprints of one place.
auto roofs_over(const std::string& place) -> City {
  const auto scene =
      mansard::ingest::read_footprints(std::string(MANSARD_DATA) + "/" + place + "/footprints.geojson", {});
  EXPECT_TRUE(scene) << base::to_string(scene.error());
  City city{scene->frame, {}, {}};
  for (const auto& footprint : scene->footprints) {
    Building building{footprint.id, {}, footprint.polygons, 0, {}};
    for (const auto& polygon : footprint.polygons) {
      Plan plan = plan_of(polygon, 0, 9);
      plan.profiles[1] = plan.profiles[0];
      mansard::extrude::Options options;
      options.grid = 1e-4;
      const auto raised = mansard::extrude::raise(plan, options);
      EXPECT_TRUE(raised) << footprint.id;
      auto labelled = mansard::label::classify({raised->solid}, {});
      building.parts.push_back({footprint.id + "-" + std::to_string(building.parts.size()), plan, labelled[0], {}});
    }
    city.buildings.push_back(building);
  }
  return city;
}

/// One of the things that can go wrong with a solid, at a random place.
void spoil(Solid& solid, std::mt19937& random) {
  const auto any = [&](std::size_t count) { return static_cast<std::uint32_t>(random() % count); };
  auto& face = solid.faces[any(solid.faces.size())];
  auto& loop = face.loops[any(face.loops.size())];
  auto& corner = loop[any(loop.size())];
  switch (any(7)) {
    case 0: solid.faces.erase(solid.faces.begin() + any(solid.faces.size())); break;
    case 1: std::ranges::reverse(loop); break;
    case 2: solid.faces.push_back(solid.faces[any(solid.faces.size())]); break;
    case 3: solid.vertices[corner].z += 0.05 * (1 + any(40)); break;
    case 4: solid.vertices[corner].x -= 0.05 * (1 + any(40)); break;
    case 5: corner = loop[any(loop.size())]; break;
    default: std::swap(corner, loop[any(loop.size())]); break;
  }
}

TEST(Val3dityRules, and_the_check_agree_on_solids_spoilt_at_random) {
  constexpr unsigned seed = 20;
  std::mt19937 random(seed);
  std::size_t sound = 0, broken = 0;
  for (const auto& building : roofs_over("delft").buildings)
    for (const auto& part : building.parts)
      for (int i = 0; i < 4; ++i) {
        const Solid solid = with(part.model.solid, [&](Solid& s) { spoil(s, random); });
        const auto codes = codes_of(as_cityjson(solid));
        const auto faults = faults_of(solid);
        (faults.empty() ? sound : broken)++;
        EXPECT_EQ(codes.empty(), faults.empty()) << building.id << " " << i << ": " << testing::PrintToString(codes)
                                                 << " and " << testing::PrintToString(faults);
      }
  EXPECT_GT(broken, 300U);
  std::cout << sound << " sound still, " << broken << " broken\n";
}

TEST(Val3dityRules, find_solids_that_stand_in_each_other) {
  City city = street();
  EXPECT_TRUE(val3dity::overlaps(Json::parse(*mansard::formats::cityjson(city)), "2.2", 1e-6).empty());
  auto& parts = city.buildings[1].parts;
  auto& solids = city.buildings[1].solids;
  for (auto& v : parts[1].model.solid.vertices) v.x -= 0.5;
  for (std::size_t p = 0; p < parts.size(); ++p) solids.push_back({{p}, parts[p].model});  // as nobody unites them
  const auto found = val3dity::overlaps(Json::parse(*mansard::formats::cityjson(city)), "2.2", 1e-6);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].code, 601);
  EXPECT_NEAR(found[0].volume, 0.5 * 20 * 4, 1e-6);
}

TEST(Val3dityRules, hold_for_roofs_over_real_footprints) {
  for (const char* place : {"delft", "regent_street", "b9", "hall"})
    for (const auto& finding : val3dity::findings(Json::parse(*mansard::formats::cityjson(roofs_over(place)))))
      ADD_FAILURE() << place << " " << finding.object << ": " << finding.code << " " << finding.what;
}

TEST(Val3dityRules, hold_for_flat_models_over_ground_at_several_heights) {
  City city = street();
  city.buildings.resize(1);
  auto& parts = city.buildings[0].parts;
  parts.clear();
  const std::array<std::pair<Polygon, double>, 3> plots{
      std::pair{rectangle(0, 0, 10, 20), 0.0}, {rectangle(10, 5, 5, 8), -1.0}, {rectangle(3, 20, 4, 6), 0.5}};
  for (const auto& [plot, base] : plots)
    parts.push_back({"house-" + std::to_string(parts.size() + 1), plan_of(plot, base, 9), prism(plot, base, 9), {}});
  const Json file = Json::parse(*mansard::formats::cityjson(city));
  EXPECT_EQ(file["CityObjects"]["house"]["geometry"].size(), 4U) << "LoD 0, 1.2, 1.3 and 2.2 of one solid";
  for (const auto& finding : val3dity::findings(file)) ADD_FAILURE() << finding.code << " " << finding.what;
}

/// Three parts with ground at two heights that meet in points, of which no prisms can be one solid (a random building).
TEST(Val3dityRules, hold_for_flat_models_over_ground_that_meets_in_points) {
  City city = street();
  city.buildings.resize(1);
  auto& parts = city.buildings[0].parts;
  parts.clear();
  const std::array<std::tuple<Ring, double, double>, 3> plots{
      std::tuple{Ring{{32, 15.071}, {12.8, 15.071}, {12.8, 30.142}, {10.242, 30.142}, {0.001, 0}, {32, 0}}, 2.4, 9.9},
      {Ring{{4.866, 30.142}, {0, 30.142}, {0, 0}, {0.001, 0}}, 2.4, 3.4},
      {Ring{{4.866, 30.139}, {6.732, 19.81}, {10.242, 30.142}, {4.866, 30.142}}, 2.1, 17}};
  for (const auto& [ring, base, top] : plots) {
    const Polygon plot{ring, {}};
    parts.push_back({"house-" + std::to_string(parts.size() + 1), plan_of(plot, base, 9), prism(plot, base, top), {}});
  }
  for (const auto& finding : val3dity::findings(Json::parse(*mansard::formats::cityjson(city))))
    ADD_FAILURE() << finding.object << ": " << finding.code << " " << finding.what;
}

/// Two parts of a random building that are no one solid. Corners of their common wall are inside the straight eaves of
/// the lower roof, by less than a tenth of a millimetre: cut there, it would hang over the wall of the other one.
TEST(Val3dityRules, hold_for_eaves_along_the_wall_of_another_part) {
  const auto plan = [](Ring ring, double base, double cap, std::vector<mansard::model::Profile> profiles,
                       std::vector<std::uint32_t> of = {}) {
    of.resize(ring.size(), 0);
    return Plan{{std::move(ring), std::move(of)}, {}, std::move(profiles), base, cap};
  };
  const mansard::model::Profile wall{{0, 0}, {0, 40}};
  const std::vector<Plan> plans{
      plan({{25.2562, 50.0002}, {25.2562, 61.1668}, {23.9429, 60.3432}, {23.9429, 50.0002}}, 0.0011, 60,
           {{{0, 0}, {0, 5.5}, {1, 6}}}),
      plan({{37.9211, 69.109}, {31.2295, 72.207}, {23.9429, 72.207}, {23.9429, 60.3432}}, 0.001, 60,
           {{{0, 0}, {0, 3}, {1, 4}}, wall}, {1, 0, 1, 0}),
      plan({{25.2562, 50.0002}, {38.0917, 50.0002}, {29.4427, 63.7922}, {25.2562, 61.1668}}, 0.0005, 3, {wall}),
      plan({{59.8574, 58.9532}, {59.8574, 72.207}, {31.2295, 72.207}}, 0.3, 8.004, {wall}),
      plan({{23.9429, 72.207}, {23.9429, 94.414}, {0, 94.414}, {0, 50}, {23.9429, 50}}, 0.0005, 1, {wall})};
  std::vector<LabelledSolid> parts;
  for (const Plan& one : plans) {
    mansard::extrude::Options options;
    options.grid = 1e-4;
    const auto raised = mansard::extrude::raise(one, options);
    ASSERT_TRUE(raised) << raised.error().message;
    parts.push_back(mansard::label::classify({raised->solid}, {}).front());
  }
  const std::vector<std::vector<const LabelledSolid*>> buildings{
      {&parts[0], &parts[1]}, {&parts[2]}, {&parts[3]}, {&parts[4]}};
  for (const auto& made : mansard::solid::unite_all(buildings))
    for (const auto& one : made.solids)
      for (std::size_t f = 0; f < one.model.classes.size(); ++f) {
        if (one.model.classes[f] != FaceClass::roof) continue;
        double area = 0;
        const auto& loop = one.model.solid.faces[f].loops[0];
        const auto at = [&](std::size_t i) { return one.model.solid.vertices[loop[i % loop.size()]]; };
        for (std::size_t i = 0; i < loop.size(); ++i) area += cross(xy(at(i) - at(0)), xy(at(i + 1) - at(0)));
        EXPECT_GE(area, 0) << "face " << f;
      }
}

/// For files made elsewhere: MANSARD_JUDGE=a.city.json:b.city.json.
TEST(Val3dityRules, hold_for_files_that_are_given) {
  const char* given = std::getenv("MANSARD_JUDGE");  // NOLINT
  if (given == nullptr) GTEST_SKIP() << "MANSARD_JUDGE names no files";
  std::istringstream names(given);
  for (std::string name; std::getline(names, name, ':');) {
    const auto text = base::read_file(name);
    ASSERT_TRUE(text) << name;
    const Json city = Json::parse(*text);
    std::size_t solids = 0;
    for (const auto& [key, object] : city["CityObjects"].items())
      if (object.contains("geometry"))
        for (const auto& geometry : object["geometry"]) solids += geometry["type"] == "Solid" ? 1 : 0;
    const auto found = val3dity::findings(city);
    for (const auto& finding : found)
      ADD_FAILURE() << name << " " << finding.object << ": " << finding.code << " " << finding.what;
    struct Worst {
      int count = 0;
      double volume = 0, width = 0;
    };
    std::map<int, Worst> pairs;
    for (const char* lod : {"1.2", "1.3", "2.0", "2.2"})
      for (const auto& overlap : val3dity::overlaps(city, lod, 1e-3)) {
        auto& [count, volume, width] = pairs[overlap.code];
        ++count, volume = std::max(volume, overlap.volume), width = std::max(width, overlap.width);
        if (overlap.volume > 0.5)
          std::cout << "  LoD " << lod << ": " << overlap.first << " and " << overlap.second << ": " << overlap.area
                    << " m²\n";
      }
    std::cout << name << ": " << solids << " solids, " << found.size() << " findings";
    for (const auto& [code, worst] : pairs)
      std::cout << "; " << code << ": " << worst.count << " pairs over a litre, at most " << worst.volume << " m³, "
                << 1000 * worst.width << " mm wide";
    std::cout << "\n";
  }
}

}  // namespace
