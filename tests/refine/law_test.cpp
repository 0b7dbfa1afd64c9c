#include <gtest/gtest.h>

#include <cmath>

#include "mansard/refine/law.hpp"

namespace mansard::refine {
namespace {

auto scan(double noise, double area, double blur, double edge) -> model::Accuracy {
  model::Accuracy out;
  out.noise = noise, out.correlated_area = area, out.blur = blur, out.edge_noise = edge;
  return out;
}

TEST(Law, prices_grow_with_the_variance_of_the_noise_and_the_area_of_one_error) {
  const auto coarse = decided_by({}, scan(0.2, 10, 0.25, 0.1)), fine = decided_by({}, scan(0.1, 10, 0.25, 0.1));
  EXPECT_DOUBLE_EQ(coarse.face_price, 4 * fine.face_price);
  EXPECT_DOUBLE_EQ(fine.value_price, 0.1 * 0.1 * 10 * std::log(4.0));
  EXPECT_DOUBLE_EQ(fine.face_price, 3 * fine.value_price);
  EXPECT_GT(decided_by({}, scan(0.1, 40, 0.25, 0.1)).face_price, fine.face_price);
}

TEST(Law, of_a_perfect_scan_is_the_smallest_detail_alone) {
  Options asked;
  const auto small = decided_by(asked, scan(0, 1, 0, 0));
  EXPECT_DOUBLE_EQ(small.value_price, 0.1 * 0.1 * 4 / 14);
  asked.detail = 0.5;
  EXPECT_DOUBLE_EQ(decided_by(asked, scan(0, 1, 0, 0)).value_price, 25 * small.value_price);
  EXPECT_EQ(small.margin, 0);
  EXPECT_EQ(small.samples.blur, 0);
  EXPECT_EQ(small.samples.melt, small.grid / 2);
  EXPECT_LT(small.same_cost, small.value_price);
}

TEST(Law, margins_are_those_of_the_scans_edges_and_leave_something_of_narrow_roofs) {
  EXPECT_DOUBLE_EQ(decided_by({}, scan(0.03, 0.05, 0, 0.1)).margin, 0.25);
  EXPECT_DOUBLE_EQ(decided_by({}, scan(0.03, 0.05, 0, 0.1)).samples.margin_weight, 0.05);
  const auto blurred = decided_by({}, scan(0.1, 10, 0.8, 0.1));
  EXPECT_EQ(blurred.margin, 0.4);
  EXPECT_EQ(blurred.samples.melt, 0.5);
  EXPECT_EQ(blurred.samples.blur, 0.25);
  EXPECT_NEAR(blurred.samples.margin_weight, 0.2, 0.01);
}

TEST(Law, heights_have_a_bias_where_edges_are_rounded) {
  EXPECT_EQ(decided_by({}, scan(0.1, 10, 0, 0.1)).alike.bias, 0);
  EXPECT_DOUBLE_EQ(decided_by({}, scan(0.1, 10, 0.4, 0.1)).alike.bias, 0.06);
  auto points = scan(0.03, 0.05, 0.4, 0);
  points.point_area = 0.05;
  EXPECT_EQ(decided_by({}, points).alike.bias, 0);
}

TEST(Law, makes_nothing_smaller_than_the_scan_shows) {
  const auto exact = decided_by({}, scan(0, 1, 0, 0)), blurred = decided_by({}, scan(0.1, 10, 0.25, 0.1));
  EXPECT_DOUBLE_EQ(exact.cuts.min_step, 0.15);  // one and a half of the smallest detail
  EXPECT_DOUBLE_EQ(exact.cuts.min_width, 0.3);
  EXPECT_DOUBLE_EQ(exact.cuts.min_area, 1);
  EXPECT_DOUBLE_EQ(blurred.cuts.min_area, 4);
  EXPECT_DOUBLE_EQ(exact.mansard.min_depth, 0.3);
  EXPECT_DOUBLE_EQ(blurred.cuts.min_step, 0.5);
  EXPECT_DOUBLE_EQ(blurred.cuts.min_width, 0.8);
  EXPECT_DOUBLE_EQ(blurred.cuts.line_min_width, 1.25);
  EXPECT_DOUBLE_EQ(blurred.mansard.min_depth, 0.7);
  EXPECT_DOUBLE_EQ(blurred.bare.noise, 0.15);
  Options asked;
  asked.detail = 1;
  EXPECT_DOUBLE_EQ(decided_by(asked, scan(0, 1, 0, 0)).cuts.min_step, 1.5);
  asked.least_area = 3;
  EXPECT_DOUBLE_EQ(decided_by(asked, scan(0, 1, 0, 0)).cuts.min_area, 3);
  asked.least_area = 20;
  EXPECT_DOUBLE_EQ(decided_by(asked, scan(0.1, 10, 0.25, 0.1)).cuts.min_area, 20);
  auto points = scan(0.03, 0.05, 0, 0.1);
  points.point_area = 0.05, points.spacing = std::sqrt(0.05);
  EXPECT_NEAR(decided_by({}, points).cuts.min_area, 60 * 0.05, 1e-9);
  // Between two points an edge may be anywhere. Of a surface its edges are measured, and a large triangle is even.
  auto sparse = points, coarse = scan(0.1, 10, 0, 0);
  sparse.noise = 0.1, sparse.point_area = 1, sparse.spacing = 1, coarse.spacing = 2;
  EXPECT_GT(decided_by({}, sparse).cuts.min_width, decided_by({}, points).cuts.min_width);
  EXPECT_DOUBLE_EQ(decided_by({}, coarse).cuts.min_width, exact.cuts.min_width);
}

TEST(Law, asks_for_more_where_the_user_does) {
  Options asked;
  asked.significance = 3;
  const auto strict = decided_by(asked, scan(0.1, 10, 0.25, 0.1)), usual = decided_by({}, scan(0.1, 10, 0.25, 0.1));
  EXPECT_DOUBLE_EQ(strict.part_price, 3 * usual.part_price);
  asked.dormers.wanted = false;
  EXPECT_EQ(decided_by(asked, scan(0.1, 10, 0.25, 0.1)).dormers.price, 0);
}

}  // namespace
}  // namespace mansard::refine
