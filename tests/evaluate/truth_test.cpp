#include "mansard/evaluate/truth.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluate/models.hpp"

namespace {

using namespace mansard::evaluate;
using mansard::model::surface_of;
using models::model_of;
using models::Point3;
using models::SurfaceClass;
using solids::box;
using solids::gable;

auto rectangle(double x0, double y0, double x1, double y1) -> Outline {
  return {{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}}};
}

TEST(Outline, is_the_ground_or_what_is_seen_from_above_without_one) {
  auto model = model_of({{box({0, 0}, {10, 8}, 0, 6), box({10, 0}, {20, 8}, 0, 6)}});
  EXPECT_NEAR(mansard::geometry::area(outline_of(model.buildings[0].parts)->at(0)), 160, 1e-9);
  for (auto& part : model.buildings[0].parts)
    std::erase_if(part.faces, [](const auto& face) { return face.kind == SurfaceClass::ground; });
  EXPECT_NEAR(mansard::geometry::area(outline_of(model.buildings[0].parts)->at(0)), 160, 1e-9);
}

TEST(Outline, of_faces_that_cannot_be_united_is_a_failure_and_not_empty) {
  auto model = model_of({{box({0, 0}, {10, 8}, 0, 6)}});
  for (auto& face : model.buildings[0].parts[0].faces)
    if (face.kind == SurfaceClass::ground) face.loops[0][1].x = std::nan("");
  const auto outline = outline_of(model.buildings[0].parts);
  ASSERT_FALSE(outline);
  EXPECT_EQ(outline.error().code, "geometry-boolean");
}

TEST(Partition, counts_the_pairs_that_cannot_be_intersected) {
  const Outline bow_tie{{{{0, 0}, {6, 10}, {6, 0}, {0, 10}}, {}}};
  EXPECT_FALSE(common_area(bow_tie, rectangle(0, 0, 6, 10)));
  const auto result = compare_partition(std::vector<Outline>{rectangle(0, 0, 6, 10), rectangle(8, 0, 14, 10)},
                                        std::vector<Outline>{bow_tie, rectangle(8, 0, 14, 10)});
  EXPECT_EQ(result.unchecked, 1U);
  EXPECT_EQ(result.matched, 1U);
  const std::vector<Outline> sound{rectangle(0, 0, 6, 10)};
  EXPECT_EQ(compare_partition(sound, sound).unchecked, 0U);
}

TEST(Partition, of_a_model_against_itself_is_perfect) {
  const std::vector<Outline> parts{rectangle(0, 0, 6, 10), rectangle(6, 0, 12, 10), rectangle(12, 0, 18, 10)};
  const auto result = compare_partition(parts, parts);
  EXPECT_EQ(result.truth, 3U);
  EXPECT_EQ(result.matched, 3U);
  EXPECT_DOUBLE_EQ(result.iou, 1);
  EXPECT_EQ(result.splits, 0U);
  EXPECT_EQ(result.merges, 0U);
}

TEST(Partition, counts_what_was_merged_what_was_split_and_what_is_missing) {
  const std::vector<Outline> three{rectangle(0, 0, 6, 10), rectangle(6, 0, 12, 10), rectangle(12, 0, 18, 10)};
  const std::vector<Outline> one{rectangle(0, 0, 18, 10)};
  const auto merged = compare_partition(three, one);
  EXPECT_EQ(merged.matched, 0U);
  EXPECT_EQ(merged.merges, 1U);
  EXPECT_EQ(merged.splits, 0U);
  const auto split = compare_partition(one, three);
  EXPECT_EQ(split.matched, 0U);
  EXPECT_EQ(split.splits, 1U);
  EXPECT_EQ(split.merges, 0U);
  const auto missing = compare_partition(three, std::vector<Outline>{three[0], {}});
  EXPECT_EQ(missing.truth, 3U);
  EXPECT_EQ(missing.model, 1U);
  EXPECT_EQ(missing.matched, 1U);
}

TEST(Partition, has_the_intersection_over_union_that_a_hand_computes) {
  // Moved by 2 of 10: 80 in common, 120 together.
  const auto result =
      compare_partition(std::vector<Outline>{rectangle(0, 0, 10, 10)}, std::vector<Outline>{rectangle(2, 0, 12, 10)});
  EXPECT_EQ(result.matched, 1U);
  EXPECT_NEAR(result.iou, 80.0 / 120, 1e-12);
  EXPECT_EQ(
      compare_partition(std::vector<Outline>{rectangle(0, 0, 10, 10)}, std::vector<Outline>{rectangle(4, 0, 14, 10)})
          .matched,
      0U);
}

TEST(Partition, of_parts_that_overlap_is_perfect_against_itself_and_each_matches_once) {
  const std::vector<Outline> tower{rectangle(0, 0, 20, 20), rectangle(5, 5, 10, 10), rectangle(10, 5, 15, 10)};
  const auto same = compare_partition(tower, tower);
  EXPECT_EQ(same.matched, 3U);
  EXPECT_EQ(same.splits, 0U);
  EXPECT_EQ(same.merges, 0U);
  // Two that lie over one: the better matches, the other is left over, and a piece of it.
  const std::vector<Outline> one{rectangle(0, 0, 10, 10)}, two{rectangle(0, 0, 8, 10), rectangle(0, 0, 9, 10)};
  const auto once = compare_partition(one, two);
  EXPECT_EQ(once.matched, 1U);
  EXPECT_DOUBLE_EQ(once.iou, 0.9);
  EXPECT_EQ(once.splits, 1U);
}

TEST(Party_walls, are_found_within_half_a_metre) {
  const std::vector<Outline> truth{rectangle(0, 0, 6, 10), rectangle(6, 0, 12, 10)};
  const auto moved = [](double x) { return std::vector<Outline>{rectangle(0, 0, x, 10), rectangle(x, 0, 12, 10)}; };
  const auto exact = compare_party_walls(truth, truth);
  EXPECT_NEAR(exact.truth, 20, 0.6);  // 10 m from both sides; up to 10 cm round every corner
  EXPECT_DOUBLE_EQ(exact.found, exact.truth);
  EXPECT_DOUBLE_EQ(exact.right, exact.model);
  EXPECT_GT(compare_party_walls(truth, moved(6.45)).found, 0.97 * exact.truth);
  EXPECT_EQ(compare_party_walls(truth, moved(6.7)).found, 0);
  EXPECT_EQ(compare_party_walls(truth, moved(6.7)).right, 0);
  // The outer wall of one house is no party wall of the model, though it stands there.
  EXPECT_EQ(compare_party_walls(truth, std::vector<Outline>{rectangle(0, 0, 6, 10)}).found, 0);
}

TEST(Roofs, of_a_model_against_itself_are_all_found) {
  const auto model = model_of({{gable({0, 0}, {10, 8}, 0, 6, 9)}});
  const auto result = compare_roofs(model, model, 0.25);
  EXPECT_EQ(result.planes, 2U);
  EXPECT_EQ(result.found, 2U);
  EXPECT_EQ(result.places, 40U * 32U);
  EXPECT_EQ(result.bare, 0U);
  EXPECT_NEAR(result.right, 1, 1e-12);
  EXPECT_NEAR(result.angle_mean, 0, 1e-6);
}

TEST(Roofs, that_are_lifted_by_a_metre_have_the_right_angle_and_the_wrong_height) {
  const auto truth = model_of({{gable({0, 0}, {10, 8}, 0, 6, 9)}});
  const auto result = compare_roofs(truth, model_of({{gable({0, 0}, {10, 8}, 0, 7, 10)}}), 0.25);
  EXPECT_NEAR(result.right_angle, 1, 1e-12);
  EXPECT_EQ(result.right_height, 0);
  EXPECT_EQ(result.found, 0U);
  EXPECT_NEAR(result.offset_median, 1, 1e-4);
  EXPECT_NEAR(result.offset_p95_absolute, 1, 1e-4);
}

TEST(Roofs, that_are_tilted_have_the_angle_between_the_planes) {
  // Flat at 6 in truth; a gable of 1 in 4 in the model, which is 6 at a quarter of the depth.
  const auto result =
      compare_roofs(model_of({{box({0, 0}, {10, 8}, 0, 6)}}), model_of({{gable({0, 0}, {10, 8}, 0, 5.5, 6.5)}}), 0.25);
  EXPECT_NEAR(result.angle_mean, std::atan(0.25), 1e-6);
  EXPECT_NEAR(result.angle_median, std::atan(0.25), 1e-6);
  EXPECT_EQ(result.right_angle, 0);
  EXPECT_NEAR(result.offset_median, 0, 0.04);
  EXPECT_NEAR(result.right_height, 0.5, 1e-9);  // |d| ≤ 0.25 over the middle half of each slope
}

TEST(Roofs, that_are_missing_count_as_not_found) {
  const auto truth = model_of({{box({0, 0}, {10, 8}, 0, 6)}, {box({20, 0}, {30, 8}, 0, 6)}});
  const auto result = compare_roofs(truth, model_of({{box({0, 0}, {10, 8}, 0, 6)}}), 0.25);
  EXPECT_EQ(result.planes, 2U);
  EXPECT_EQ(result.found, 1U);
  EXPECT_EQ(result.bare, 40U * 32U);
  EXPECT_NEAR(result.right, 0.5, 1e-12);
}

TEST(Roofs, leave_small_planes_out) {
  const auto truth = model_of({{box({0, 0}, {10, 8}, 0, 6)}, {box({20, 0}, {21.3, 1.5}, 0, 6)}});
  EXPECT_EQ(compare_roofs(truth, truth, 0.25).planes, 1U);
}

TEST(Roofs, narrower_than_three_places_are_not_broad) {
  // A parapet of 0.3 m beside a roof, and one of 0.9 m.
  for (const double width : {0.3, 0.9}) {
    const auto truth = model_of({{box({0, 0}, {10, 8}, 0, 6), box({10, 0}, {10 + width, 8}, 0, 6.7)}});
    const auto result = compare_roofs(truth, model_of({{box({0, 0}, {10 + width, 8}, 0, 6)}}), 0.25);
    EXPECT_EQ(result.planes, 2U);
    EXPECT_EQ(result.found, 1U);
    EXPECT_EQ(result.broad, width < 0.75 ? 1U : 2U);
    EXPECT_EQ(result.broad_found, 1U);
  }
}

TEST(Classes, of_a_model_against_itself_are_all_right) {
  const auto surface = surface_of(model_of({{gable({0, 0}, {10, 8}, 0, 6, 9)}}));
  const auto result = compare_classes(surface, surface, {}, 1);
  EXPECT_NEAR(result.accuracy(), 1, 1e-12);
  EXPECT_NEAR(result.area[0][0], 2 * 60 + 2 * (48 + 12), 2);
  EXPECT_NEAR(result.area[1][1], 100, 2);
  EXPECT_NEAR(result.area[2][2], 80, 2);
  EXPECT_EQ(result.beyond, 0);
}

TEST(Classes, that_are_wrong_stand_beside_the_diagonal) {
  const auto truth = model_of({{box({0, 0}, {10, 8}, 0, 6)}});
  auto wrong = truth;
  for (auto& face : wrong.buildings[0].parts[0].faces)
    if (face.kind == SurfaceClass::roof) face.kind = SurfaceClass::wall;
  const auto result = compare_classes(surface_of(truth), surface_of(wrong), {}, 1);
  EXPECT_NEAR(result.area[1][0], 80, 2);
  EXPECT_EQ(result.area[1][1], 0);
  EXPECT_NEAR(result.accuracy(), 1 - 80.0 / 376, 0.01);
  const auto far = surface_of(model_of({{box({50, 0}, {60, 8}, 0, 6)}}));
  EXPECT_NEAR(compare_classes(surface_of(truth), far, {}, 1).beyond, 376, 1);
}

}  // namespace
