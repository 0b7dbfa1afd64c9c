// Solids that overlap are reported, and neighbours do not.
#include <gmock/gmock.h>

#include "mansard/pipeline/detail/overlaps.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

using test::rectangle;
using testing::HasSubstr;

auto codes_of(const std::vector<base::Diagnostic>& all) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& d : all) out.push_back(d.code);
  return out;
}

TEST(Overlaps, are_told_in_both_buildings_and_once) {
  model::Scene scene;
  scene.footprints.push_back(test::footprint("a", rectangle(0, 0, 10, 8)));
  scene.footprints.push_back(test::footprint("b", rectangle(9, 0, 19, 8)));  // 8 m² in a
  scene.footprints.push_back(test::footprint("c", rectangle(19, 0, 30, 8)));
  const auto r = raise_footprints(scene, {});
  ASSERT_TRUE(r);
  EXPECT_THAT(codes_of(r->warnings), testing::Contains("pipeline-overlap").Times(1));
  EXPECT_THAT(codes_of(r->buildings[0].reasons), testing::Contains("pipeline-overlap").Times(1));
  EXPECT_THAT(codes_of(r->buildings[1].reasons), testing::Contains("pipeline-overlap").Times(1));
  EXPECT_THAT(codes_of(r->buildings[2].reasons), testing::Not(testing::Contains("pipeline-overlap")));
  EXPECT_THAT(r->buildings[0].reasons.back().message, HasSubstr("8.000 m² of ground"));
  EXPECT_THAT(r->buildings[0].reasons.back().message, HasSubstr("with b-1"));
  EXPECT_EQ(r->buildings[0].outcome, report::Outcome::full);
}

TEST(Overlaps, are_none_between_neighbours_that_straighten_their_wall_by_themselves) {
  model::Scene scene;
  scene.footprints.push_back(test::footprint("a", rectangle(0, -9, 20, 0)));
  scene.footprints.push_back(test::footprint("b", {{{0, 0}, {11, -0.008}, {11, 9}, {0, 9}}, {}}));
  scene.footprints.push_back(test::footprint("c", {{{11, -0.008}, {20, 0}, {20, 9}, {11, 9}}, {}}));
  const auto r = raise_footprints(scene, {});
  ASSERT_TRUE(r);
  EXPECT_THAT(codes_of(r->warnings), testing::Not(testing::Contains("pipeline-overlap")));
  EXPECT_NEAR(r->city.buildings[1].parts[0].plan.outer.points[1].y, 0, 1e-4);
}

/// A building of one solid with nothing but a ground face, 3 m high.
auto building_on(const std::string& id, const geometry::Ring& ring) -> model::Building {
  model::Building building;
  building.id = id;
  building.parts.emplace_back().id = id + "-1";
  model::Solid& solid = building.solids.emplace_back().model.solid;
  building.solids[0].parts = {0};
  model::Face face;
  face.kind = model::FaceKind::base;
  face.loops.emplace_back();
  for (const auto p : ring) {
    face.loops[0].push_back(static_cast<std::uint32_t>(solid.vertices.size()));
    solid.vertices.push_back({p.x, p.y, 0});
  }
  solid.vertices.push_back({ring[0].x, ring[0].y, 3});
  solid.faces.push_back(face);
  return building;
}

TEST(Overlaps, are_told_of_a_tenth_of_a_millimetre_and_not_of_walls_that_coincide) {
  const auto pairs = [](double wall) {
    const geometry::Ring slanted{{0.1, 0.3}, {10.7, 0.4}, {10.2001, 8.3003}, {0.1, 8.1}};
    geometry::Ring next{{10.7, 0.4}, {20, 0.4}, {20, 8}, {10.2001, 8.3003}};
    next[0].x += wall, next[3].x += wall;
    return detail::overlaps({building_on("a", slanted), building_on("b", next)});
  };
  EXPECT_THAT(pairs(0), testing::IsEmpty());
  EXPECT_THAT(pairs(1e-4), testing::IsEmpty());
  const auto some = pairs(-1e-4);
  ASSERT_EQ(some.size(), 1U);
  EXPECT_EQ(some[0].first.subject, "a-1");
  EXPECT_NEAR(some[0].volume.value(), 7.9 * 1e-4 * 3, 1e-4);
}

TEST(Overlaps, that_cannot_be_computed_are_reported_in_both_buildings_and_once) {
  report::Reconstruction r;
  r.buildings.resize(3);
  r.city.buildings.push_back(building_on("a", {{0, 0}, {10, 10}, {10, 0}, {0, 10}}));  // crosses itself
  r.city.buildings.push_back(building_on("b", {{5, 5}, {15, 5}, {15, 15}, {5, 15}}));
  r.city.buildings.push_back(building_on("c", {{14, 5}, {24, 5}, {24, 15}, {14, 15}}));  // 10 m² in b
  detail::report_overlaps(r);
  EXPECT_THAT(codes_of(r.warnings), testing::ElementsAre("pipeline-overlap-unchecked", "pipeline-overlap"));
  EXPECT_THAT(r.warnings[1].message, HasSubstr("1 pair "));
  EXPECT_THAT(codes_of(r.buildings[0].reasons), testing::ElementsAre("pipeline-overlap-unchecked"));
  EXPECT_THAT(codes_of(r.buildings[1].reasons), testing::ElementsAre("pipeline-overlap-unchecked", "pipeline-overlap"));
  EXPECT_THAT(codes_of(r.buildings[2].reasons), testing::ElementsAre("pipeline-overlap"));
  EXPECT_THAT(r.buildings[1].reasons[0].message, HasSubstr("with a-1 could not be computed"));
}

}  // namespace
}  // namespace mansard::pipeline
