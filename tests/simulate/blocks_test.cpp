#include <gmock/gmock.h>

#include "lab/simulate/simulate.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/solid/solid.hpp"
#include "simulate/apart.hpp"
#include "simulate/houses.hpp"

namespace mansard::simulate {
namespace {

struct Case {
  Kind kind;
  std::uint64_t seed;
};

class Block : public testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] static auto block(const BlockOptions& options = {}) -> Truth {
    auto truth = make_block(GetParam().kind, options, GetParam().seed);
    EXPECT_TRUE(truth) << base::to_string(truth.error());
    return std::move(*truth);
  }
};

TEST_P(Block, has_valid_solids_with_walls_and_roofs_only_where_they_are_meant) {  // guarantee 1
  const auto truth = block();
  EXPECT_GE(truth.city.buildings.size(), 2U);
  for (const auto& building : truth.city.buildings)
    for (const auto& part : building.parts) {
      EXPECT_THAT(solid::check(part.model.solid), testing::IsEmpty()) << part.id;
      ASSERT_EQ(part.model.classes.size(), part.model.solid.faces.size());
      for (std::size_t f = 0; f < part.model.classes.size(); ++f) {
        const auto kind = part.model.classes[f];
        const bool wall = kind == model::FaceClass::wall || kind == model::FaceClass::party_wall;
        EXPECT_EQ(wall, std::abs(part.model.solid.faces[f].normal.z) < 0.2) << part.id;
      }
    }
}

TEST_P(Block, has_buildings_that_do_not_overlap) {  // guarantee 2
  simulated::expect_apart(block().city.buildings);
}

TEST_P(Block, has_plausible_heights) {
  const auto truth = block();
  for (const auto& building : truth.city.buildings)
    for (const auto& part : building.parts) {
      double top = part.plan.base;
      for (const auto v : part.model.solid.vertices) top = std::max(top, v.z);
      EXPECT_GT(top - building.ground, 2.4) << part.id;
      EXPECT_LT(top - building.ground, 60) << part.id;
    }
}

TEST_P(Block, is_the_same_at_any_thread_count) {  // guarantee 3
  std::vector<std::string> texts;
  for (const std::size_t threads : {1, 2}) {
    base::limit_threads(threads);
    const auto truth = block();
    texts.push_back(formats::plans(truth.city) + *formats::cityjson(truth.city) + truth_json(truth, {}, {}, "test"));
  }
  base::limit_threads(0);
  EXPECT_EQ(texts[0], texts[1]);
}

auto cases() -> std::vector<Case> {
  std::vector<Case> all;
  for (const auto kind : {Kind::terrace, Kind::perimeter, Kind::courtyard, Kind::towers, Kind::detached})
    for (const std::uint64_t seed : {1, 2, 3}) all.push_back({kind, seed});
  return all;
}
INSTANTIATE_TEST_SUITE_P(Kinds, Block, testing::ValuesIn(cases()), [](const auto& of) {
  return std::string(to_string(of.param.kind)) + "_" + std::to_string(of.param.seed);
});

TEST(MakeBlock, is_another_block_with_another_seed_and_another_one_of_another_kind) {
  const auto text = [](Kind kind, std::uint64_t seed) { return formats::plans(make_block(kind, {}, seed)->city); };
  EXPECT_NE(text(Kind::terrace, 1), text(Kind::terrace, 2));
  EXPECT_NE(text(Kind::terrace, 1), text(Kind::perimeter, 1));
}

TEST(MakeBlock, turns_the_street_as_asked) {
  BlockOptions options;
  options.turn = 0;
  const auto along = make_block(Kind::towers, options, 1);
  options.turn = 0.5;
  const auto turned = make_block(Kind::towers, options, 1);
  const auto p = along->city.buildings[0].parts[0].plan.outer.points[0];
  const auto q = turned->city.buildings[0].parts[0].plan.outer.points[0];
  EXPECT_NEAR(q.x, std::cos(0.5) * p.x - std::sin(0.5) * p.y, 1e-9);
  EXPECT_NEAR(q.y, std::sin(0.5) * p.x + std::cos(0.5) * p.y, 1e-9);
}

TEST(MakeBlock, lets_the_street_fall) {
  BlockOptions options;
  options.turn = 0;
  options.slope = 0.1;
  const auto truth = make_block(Kind::detached, options, 1);
  for (const auto& building : truth->city.buildings) {
    const auto p = building.parts[0].plan.outer.points[0];
    EXPECT_NEAR(building.ground, 0.1 * p.x, 1.0) << building.id;
  }
}

/// Share of the party walls at which the walls of both are as high to 5 cm.
auto equal_share(double asked) -> double {
  BlockOptions options;
  options.equal_heights = asked;
  options.slope = 0;
  double equal = 0, all = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const auto truth = make_block(Kind::terrace, options, seed);
    for (const auto& wall : truth->party_walls) {
      all += 1;
      equal += std::abs(wall.first_top.value() - wall.second_top.value()) < 0.05 ? 1 : 0;
    }
  }
  return equal / all;
}

TEST(MakeBlock, gives_more_neighbours_equal_heights_when_asked_to) {
  EXPECT_LT(equal_share(0), 0.2);
  EXPECT_GT(equal_share(0.9), 0.4);
}

TEST(MakeBlock, builds_no_annexes_when_asked_for_none) {
  BlockOptions options;
  const auto annexes = [&] {
    std::size_t count = 0;
    const auto truth = make_block(Kind::terrace, options, 1);
    for (const auto& building : truth->city.buildings)
      for (const auto& part : building.parts)
        count += part.attributes.front().second == model::Value(std::string("annex")) ? 1 : 0;
    return count;
  };
  EXPECT_GT(annexes(), 3U);
  options.annexes = 0;
  EXPECT_EQ(annexes(), 0U);
}

TEST(TruthOf, finds_the_party_wall_with_both_heights) {
  const auto truth = test::pair_of_houses();
  ASSERT_EQ(truth.party_walls.size(), 1U);
  const auto& wall = truth.party_walls[0];
  EXPECT_EQ(wall.first, 0U);
  EXPECT_EQ(wall.second, 1U);
  EXPECT_NEAR(wall.line.start.x, 12, 1e-6);
  EXPECT_NEAR(wall.line.end.x, 12, 1e-6);
  EXPECT_NEAR(wall.line.end.y - wall.line.start.y, 10, 1e-6);  // the first building on the left
  EXPECT_NEAR(wall.first_top.value(), 6, 1e-3);
  EXPECT_NEAR(wall.second_top.value(), 9, 1e-3);
}

TEST(TruthOf, measures_a_gable_only_over_the_shared_stretch) {
  // The gable of the second is 8 m at its middle, y = 5; the first touches it from y = 0 to 2, where it is 5 + 2 × 0.6.
  const auto truth = test::truth_of({test::house("a", 0, 0, 6, 2, 4), test::house("b", 6, 0, 16, 10, 5, 3)});
  ASSERT_EQ(truth.party_walls.size(), 1U);
  EXPECT_NEAR(truth.party_walls[0].first_top.value(), 4, 1e-3);
  EXPECT_NEAR(truth.party_walls[0].second_top.value(), 6.2, 1e-2);
}

TEST(TruthOf, finds_no_party_wall_where_a_gap_is) {
  const auto truth = test::truth_of({test::house("a", 0, 0, 10, 10, 6), test::house("b", 10.5, 0, 20, 10, 6)});
  EXPECT_TRUE(truth.party_walls.empty());
}

TEST(TruthOf, names_the_part_that_cannot_be_raised) {
  model::City city;
  city.buildings = {test::house("good", 0, 0, 5, 5, 3), test::house("bad", 9, 0, 9, 5, 3)};
  const auto truth = simulate::truth_of(city);
  ASSERT_FALSE(truth);
  EXPECT_EQ(truth.error().subject, "bad-1");
}

auto footprint(const std::string& id, geometry::Ring ring) -> model::Footprint {
  model::Footprint out;
  out.id = id;
  out.polygons.push_back({std::move(ring), {}});
  return out;
}

TEST(Furnish, raises_a_building_on_every_usable_footprint_and_says_which_are_not) {
  model::Scene scene;
  scene.footprints = {
      footprint("a", {{0, 0}, {8, 0}, {8, 10}, {0, 10}}), footprint("b", {{8, 0}, {15, 0}, {15, 9}, {8, 9}}), {}};
  scene.footprints[2].id = "c";
  scene.footprints[2].defect = base::error("ingest-footprint-geometry", "crosses itself", "c");
  std::vector<base::Diagnostic> warnings;
  const auto truth = furnish(scene, {}, 1, warnings);
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->city.buildings.size(), 2U);
  EXPECT_EQ(truth->party_walls.size(), 1U);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].subject, "c");
  EXPECT_EQ(warnings[0].severity, base::Severity::warning);
}

TEST(Furnish, gives_up_without_a_usable_footprint) {
  std::vector<base::Diagnostic> warnings;
  const auto truth = furnish({}, {}, 1, warnings);
  ASSERT_FALSE(truth);
  EXPECT_EQ(truth.error().code, "simulate-nothing");
}

TEST(Furnish, makes_valid_solids_of_regent_street) {
  const auto scene = ingest::read_footprints(
      std::filesystem::path(MANSARD_SHARED_DATA) / "regent_street/regent_st_200m_local.geojson", {});
  if (!scene) GTEST_SKIP() << "the footprints are not here";
  std::vector<base::Diagnostic> warnings;
  const auto truth = furnish(*scene, {}, 1, warnings);
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->city.buildings.size(), scene->footprints.size());
  EXPECT_GT(truth->party_walls.size(), 50U);
  for (const auto& building : truth->city.buildings)
    for (const auto& part : building.parts) EXPECT_THAT(solid::check(part.model.solid), testing::IsEmpty()) << part.id;
}

}  // namespace
}  // namespace mansard::simulate
