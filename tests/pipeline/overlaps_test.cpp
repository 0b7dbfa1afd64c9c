// Solids that overlap are reported, and neighbours do not.
#include <gmock/gmock.h>

#include "mansard/pipeline/city.hpp"
#include "mansard/pipeline/compared.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/layers.hpp"
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

TEST(Overlaps, are_a_layer_with_the_ground_that_two_share) {
  model::Scene scene;
  scene.footprints.push_back(test::footprint("a", rectangle(0, 0, 10, 8)));
  scene.footprints.push_back(test::footprint("b", rectangle(9, 0, 19, 8)));
  scene.footprints.push_back(test::footprint("c", rectangle(19, 0, 30, 8)));
  const auto whole = raise_footprints(scene, {});
  const auto aside = raise_footprints_aside(scene, {});
  ASSERT_TRUE(whole && aside);
  for (const report::Summary* summary : {static_cast<const report::Summary*>(&*whole), &aside->summary}) {
    const auto layer = report::overlaps_layer(*summary);
    ASSERT_TRUE(layer);
    ASSERT_EQ(layer->features.size(), 1u);
    const auto& [lines, polygons, values] = layer->features[0];
    ASSERT_EQ(polygons.size(), 1u);
    const auto box = geometry::bounds(polygons[0].outer);
    EXPECT_NEAR(box.least.x, 9, 1e-3);
    EXPECT_NEAR(box.most.x, 10, 1e-3);
    EXPECT_EQ(values[0], model::Value(std::string("a-1")));
    EXPECT_EQ(values[1], model::Value(std::string("b-1")));
    EXPECT_NEAR(std::get<double>(values[2]), 8, 0.01);
    EXPECT_NEAR(std::get<double>(values[3]), 6, 0.01);  // both are as high as houses of unknown height
  }
  scene.footprints.erase(scene.footprints.begin() + 1);
  EXPECT_FALSE(report::overlaps_layer(*raise_footprints(scene, {})));
}

TEST(ComparedSolids, are_told_what_a_run_tells_of_them) {
  model::Scene scene;
  scene.footprints.push_back(test::footprint("a", rectangle(0, 0, 10, 8)));
  scene.footprints.push_back(test::footprint("b", rectangle(9, 0, 19, 8)));
  scene.footprints.push_back(test::footprint("c", rectangle(19, 0, 30, 8)));
  auto r = raise_footprints(scene, {});
  ASSERT_TRUE(r);
  auto compared = ComparedSolids::open();
  ASSERT_TRUE(compared);
  for (const auto& building : r->city.buildings) compared->add(building);
  const auto found = compared->overlapping({});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->of_each.size(), 2U);
  EXPECT_EQ(found->of_each[0].message, r->buildings[0].reasons.back().message);
  EXPECT_EQ(found->of_each[1].subject, "b-1");
  ASSERT_EQ(found->in_all.size(), 1U);
  EXPECT_THAT(found->in_all[0].message, HasSubstr("1 pair of solids overlap"));

  // Two parts of one building, which has no solids of its own.
  model::Building two = r->city.buildings[0];
  two.parts.push_back(r->city.buildings[1].parts[0]);
  two.solids.clear();
  auto within = ComparedSolids::open();
  ASSERT_TRUE(within);
  within->add(r->city.buildings[2]);
  within->add(two);
  const auto pair = within->overlapping({});
  ASSERT_TRUE(pair);
  ASSERT_EQ(pair->of_each.size(), 1U) << "told once of a building";
  EXPECT_EQ(pair->of_each[0].subject, "a-1");
  EXPECT_THAT(pair->of_each[0].message, HasSubstr("8.000 m² of ground"));
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
  for (const double apart : {0.0, 1e-4}) {
    EXPECT_THAT(pairs(apart).of_each, testing::IsEmpty()) << apart;
    EXPECT_THAT(pairs(apart).in_all, testing::IsEmpty()) << apart;
  }
  const auto some = pairs(-1e-4);
  ASSERT_EQ(some.of_each.size(), 2U);
  EXPECT_EQ(some.of_each[0].what.subject, "a-1");
  EXPECT_THAT(some.of_each[0].what.message, HasSubstr("it shares 0.00079"));  // m², 7.9 m by 0.1 mm
  EXPECT_THAT(some.of_each[0].what.message, HasSubstr("at most 0.00237"));    // m³, 3 m high
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

/// Solids of one corner, each larger than the one before by a metre.
auto stacked(int count) -> std::vector<model::Building> {
  std::vector<model::Building> buildings;
  for (int i = 0; i < count; ++i) {
    const double side = 10 + i;
    buildings.push_back(building_on("s" + std::to_string(i), {{0, 0}, {side, 0}, {side, side}, {0, side}}));
  }
  return buildings;
}

TEST(Overlaps, of_many_solids_with_one_are_told_by_the_largest_and_a_number) {
  report::Reconstruction r;
  r.city.buildings = stacked(1);
  for (int i = 0; i < 24; ++i) {  // in a row on the first: the one numbered i shares (i + 1) · 0.04 m²
    const double from = 0.4 * i;
    const double to = from + 0.2, top = 0.2 * (i + 1);
    r.city.buildings.push_back(building_on("b" + std::to_string(i), {{from, -1}, {to, -1}, {to, top}, {from, top}}));
  }
  r.buildings.resize(25);
  detail::report_overlaps(r);
  const auto& reasons = r.buildings[0].reasons;
  ASSERT_EQ(reasons.size(), 21U);
  EXPECT_THAT(reasons[0].message, HasSubstr("0.200 m² of ground"));  // the largest twenty, in the source's order
  EXPECT_THAT(reasons[0].message, HasSubstr("with b4-1"));
  EXPECT_THAT(reasons[19].message, HasSubstr("with b23-1"));
  EXPECT_THAT(reasons[20].message, HasSubstr("it overlaps 4 more solids"));
  for (std::size_t i = 1; i < 25; ++i) EXPECT_EQ(r.buildings[i].reasons.size(), 1U) << i;
  ASSERT_EQ(r.warnings.size(), 1U);
  EXPECT_THAT(r.warnings[0].message, testing::StartsWith("24 pairs"));
}

TEST(Overlaps, of_a_stack_are_counted_as_far_as_they_were_compared_and_need_bounded_space) {
  constexpr std::size_t count = 200;
  report::Reconstruction r;
  r.city.buildings = stacked(count);
  r.buildings.resize(count);
  detail::report_overlaps(r);
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(r.buildings[i].reasons.size(), 21U) << i;
    EXPECT_THAT(r.buildings[i].reasons[20].message, HasSubstr("at least ")) << i;
  }
  ASSERT_EQ(r.warnings.size(), 1U);
  // Every solid with the first 32 others: 33 among themselves, and each of the others with 32.
  EXPECT_THAT(r.warnings[0].message, testing::StartsWith("at least 5872 pairs of solids overlap"));
}

TEST(Overlaps, of_solids_at_different_heights_are_none_and_do_not_count_as_compared) {
  auto buildings = stacked(2);
  for (int i = 0; i < 100; ++i) {
    auto& above = *buildings.insert(buildings.begin(), building_on("c" + std::to_string(i), {{0, 0}, {9, 0}, {9, 9}}));
    for (auto& v : above.solids[0].model.solid.vertices) v.z += 10 + 4 * i;
  }
  const auto found = detail::overlaps(buildings);
  ASSERT_EQ(found.in_all.size(), 1U);
  EXPECT_THAT(found.in_all[0].message, testing::StartsWith("1 pair of solids"));
}

TEST(Overlaps, are_not_looked_for_once_the_run_is_cancelled) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  const auto found = detail::overlaps(stacked(5), run);
  EXPECT_THAT(found.of_each, testing::IsEmpty());
  EXPECT_THAT(found.in_all, testing::IsEmpty());
}

}  // namespace
}  // namespace mansard::pipeline
