#include <gmock/gmock.h>

#include "simulate/houses.hpp"

namespace mansard::simulate {
namespace {

auto none() -> SurveyOptions { return {0, 0, 0, 0, 0}; }

auto drawn(const Truth& truth, const SurveyOptions& options, std::uint64_t seed = 1) -> std::vector<model::Footprint> {
  auto footprints = survey(truth, options, seed);
  EXPECT_TRUE(footprints);
  return std::move(*footprints);
}

auto total(const std::vector<model::Footprint>& footprints) -> double {
  double sum = 0;
  for (const auto& footprint : footprints)
    for (const auto& polygon : footprint.polygons) sum += geometry::area(polygon);
  return sum;
}

TEST(Survey, draws_the_truth_where_nothing_is_asked) {
  const auto truth = test::pair_of_houses();
  const auto footprints = drawn(truth, none());
  ASSERT_EQ(footprints.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(footprints[i].id, truth.city.buildings[i].id);
    EXPECT_EQ(footprints[i].polygons, truth.city.buildings[i].footprint);
  }
}

TEST(Survey, moves_all_outlines_by_the_same_way) {
  const auto truth = test::pair_of_houses();
  auto options = none();
  options.displacement = 0.7;
  const auto footprints = drawn(truth, options);
  const auto before = truth.city.buildings[0].footprint[0].outer;
  const auto step = footprints[0].polygons[0].outer[0] - before[0];
  EXPECT_NEAR(length(step), 0.7, 1e-9);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto moved = footprints[i].polygons[0].outer[k] - truth.city.buildings[i].footprint[0].outer[k];
      EXPECT_NEAR(length(moved - step), 0, 1e-9);
    }
}

TEST(Survey, moves_corners_of_neighbours_together) {
  const auto truth = test::pair_of_houses();
  auto options = none();
  options.jitter = 0.3;
  const auto footprints = drawn(truth, options);
  const auto &low = footprints[0].polygons[0].outer, &high = footprints[1].polygons[0].outer;
  EXPECT_EQ(low[1], high[0]);  // (12, 0)
  EXPECT_EQ(low[2], high[3]);  // (12, 10)
  const auto first = low[0], second = low[1] - geometry::Point2{12, 0};
  EXPECT_GT(length(first), 0);
  EXPECT_LE(length(first), 0.3);
  EXPECT_NE(first, second);
}

TEST(Survey, merges_neighbours_into_one_feature_that_names_both) {
  auto options = none();
  options.merged = 1;
  const auto footprints = drawn(test::pair_of_houses(), options);
  ASSERT_EQ(footprints.size(), 1U);
  EXPECT_NEAR(total(footprints), 240, 1e-3);
  EXPECT_EQ(footprints[0].attributes.back().second, model::Value(std::string("low high")));
}

TEST(Survey, draws_eaves_but_not_into_the_neighbour) {
  auto options = none();
  options.eaves = 0.5;
  const auto footprints = drawn(test::pair_of_houses(), options);
  EXPECT_NEAR(total(footprints), 25 * 11, 1e-6);  // 24 × 10 m, half a metre wider all around, and nothing twice
  for (const auto& footprint : footprints) EXPECT_GT(total({footprint}), 120);
}

TEST(Survey, leaves_out_corners_flatter_than_asked) {
  auto truth = test::truth_of({test::house("a", 0, 0, 10, 10, 5)});
  truth.city.buildings[0].footprint[0].outer = {{0, 0}, {5, -0.2}, {10, 0}, {10, 10}, {5, 10.6}, {0, 10}};
  auto options = none();
  options.generalise = 0.3;
  EXPECT_THAT(drawn(truth, options)[0].polygons[0].outer,
              testing::ElementsAre(geometry::Point2{0, 0}, geometry::Point2{10, 0}, geometry::Point2{10, 10},
                                   geometry::Point2{5, 10.6}, geometry::Point2{0, 10}));
}

TEST(Survey, gives_simple_outlines_for_every_kind_of_block) {
  SurveyOptions options;
  options.eaves = 0.3;
  for (const auto kind : {Kind::terrace, Kind::perimeter, Kind::courtyard, Kind::towers, Kind::detached})
    for (const auto footprints = drawn(*make_block(kind, {}, 5), options, 5); const auto& footprint : footprints) {
      EXPECT_FALSE(footprint.polygons.empty()) << to_string(kind) << " " << footprint.id;
      for (const auto& polygon : footprint.polygons)
        EXPECT_TRUE(geometry::is_simple(polygon)) << to_string(kind) << " " << footprint.id;
    }
}

}  // namespace
}  // namespace mansard::simulate
