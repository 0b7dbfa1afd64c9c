#include "mansard/geometry/polygon.hpp"

#include "mansard/geometry/change.hpp"

#include <gmock/gmock.h>
#include <limits>

namespace mansard::geometry {
namespace {

const Polygon courtyard{{{0, 0}, {10, 0}, {10, 8}, {0, 8}}, {{{3, 3}, {3, 5}, {6, 5}, {6, 3}}}};

auto total(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& p : polygons) sum += area(p);
  return sum;
}

TEST(Area, takes_holes_off_and_keeps_its_digits_far_from_the_origin) {
  EXPECT_DOUBLE_EQ(area(courtyard), 80 - 6);
  Ring far{{1e8, 1e8}, {1e8 + 0.5, 1e8}, {1e8 + 0.5, 1e8 + 0.5}};
  EXPECT_DOUBLE_EQ(signed_area(far), 0.125);
  EXPECT_EQ(signed_area(Ring{{0, 0}, {1, 1}}), 0);
}

TEST(Contains, counts_the_boundary_in_and_the_hole_out) {
  EXPECT_TRUE(contains(courtyard, {1, 1}));
  EXPECT_TRUE(contains(courtyard, {0, 4}));
  EXPECT_TRUE(contains(courtyard, {10, 8}));
  EXPECT_TRUE(contains(courtyard, {3, 4}));
  EXPECT_FALSE(contains(courtyard, {4, 4}));
  EXPECT_FALSE(contains(courtyard, {-1e-12, 4}));
  EXPECT_FALSE(contains(courtyard, {11, 8}));  // level with a top edge
}

TEST(Distance, is_to_the_segment_not_to_its_line) {
  const Segment2 s{{0, 0}, {4, 0}};
  EXPECT_DOUBLE_EQ(distance(s, {2, 3}), 3);
  EXPECT_DOUBLE_EQ(distance(s, {7, 4}), 5);
  EXPECT_DOUBLE_EQ(parameter(s, {6, 1}), 1.5);
  EXPECT_DOUBLE_EQ(boundary_distance(courtyard, {4.5, 4}), 1);
}

TEST(IsSimple, refuses_what_touches_itself) {
  EXPECT_TRUE(is_simple(courtyard));
  EXPECT_FALSE(is_simple({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}, {}}));                          // bow-tie
  EXPECT_FALSE(is_simple({{{0, 0}, {4, 0}, {2, 0}, {2, 3}}, {}}));                          // folds back
  EXPECT_FALSE(is_simple({{{0, 0}, {4, 0}, {4, 4}, {4, 4}, {0, 4}}, {}}));                  // repeats a point
  EXPECT_FALSE(is_simple({{{0, 0}, {4, 0}, {2, 2}, {4, 4}, {0, 4}, {2, 2}}, {}}));          // pinched
  EXPECT_FALSE(is_simple({{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {{{0, 3}, {2, 4}, {2, 3}}}}));  // a hole on the outside
  EXPECT_FALSE(is_simple({{{0, 0}, {1, 1}}, {}}));
  EXPECT_TRUE(is_simple({{{0, 0}, {2, 0}, {4, 0}, {4, 4}}, {}}));  // a straight corner is no fault
}

TEST(Oriented, turns_every_ring_the_right_way) {
  Polygon wrong = courtyard;
  std::ranges::reverse(wrong.outer);
  std::ranges::reverse(wrong.holes[0]);
  EXPECT_GT(signed_area(oriented(wrong).outer), 0);
  EXPECT_LT(signed_area(oriented(wrong).holes[0]), 0);
  EXPECT_EQ(oriented(courtyard), courtyard);
}

TEST(Triangulate, covers_the_polygon_with_its_own_points) {
  const auto triangles = triangulate(courtyard);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), 8U);  // n + 2h − 2
  Ring points = courtyard.outer;
  points.insert(points.end(), courtyard.holes[0].begin(), courtyard.holes[0].end());
  double sum = 0;
  for (const auto& [a, b, c] : *triangles) {
    const double part = signed_area(Ring{points[a], points[b], points[c]});
    EXPECT_GT(part, 0);
    sum += part;
  }
  EXPECT_DOUBLE_EQ(sum, area(courtyard));
}

TEST(Triangulate, fails_on_what_has_no_area) {
  EXPECT_EQ(triangulate({{{0, 0}, {1, 0}, {2, 0}}, {}}).error().code, "geometry-triangulate");
}

TEST(Boolean, operations_agree_on_areas) {
  const Polygon square{{{8, 2}, {14, 2}, {14, 6}, {8, 6}}, {}};
  const auto both = intersect(courtyard, square), all = unite(std::vector{courtyard, square});
  const auto rest = subtract(courtyard, square), grown = buffer(square, 1), shrunk = buffer(square, -1);
  ASSERT_TRUE(both && all && rest && grown && shrunk);
  EXPECT_DOUBLE_EQ(total(*both), 8);
  EXPECT_DOUBLE_EQ(total(*all), 74 + 24 - 8);
  EXPECT_DOUBLE_EQ(total(*rest), 74 - 8);
  EXPECT_DOUBLE_EQ(total(*grown), 8 * 6);
  EXPECT_DOUBLE_EQ(total(*shrunk), 4 * 2);
  EXPECT_TRUE(intersect(square, Polygon{{{20, 0}, {21, 0}, {21, 1}}, {}})->empty());
  for (const auto& p : *all) EXPECT_TRUE(is_simple(p));
}

TEST(Boolean, operations_give_the_same_whatever_was_asked_before) {
  const Polygon square{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {}};
  const auto piece = [](int i) { return Polygon{{{0.5 * i, 1}, {20, 1}, {20, 5.0 + i}}, {}}; };
  std::vector<std::vector<Polygon>> inside, outside;
  for (int i = 0; i < 16; ++i) {
    inside.push_back(*intersect(square, piece(i)));
    outside.push_back(*subtract(square, piece(i)));
    double all = 0;
    for (const auto* side : {&inside.back(), &outside.back()})
      for (const auto& polygon : *side) all += area(polygon);
    EXPECT_NEAR(all, 100, 1e-9);
  }
  for (const int i : {15, 3, 3, 14, 0, 15, 3}) {
    EXPECT_EQ(*subtract(square, piece(i)), outside[i]);
    EXPECT_EQ(*intersect(square, piece(i)), inside[i]);
    EXPECT_NE(*subtract(piece(i), square), outside[i]);
  }
}

TEST(Boolean, operations_divide_a_polygon_that_touches_along_a_line_up_to_rounding) {
  // GEOS 3.11 alone leaves all of the piece in the difference.
  const Polygon part{{{0, 0},
                      {10.295365028199225, -2.9636435733108684},
                      {13.068611847903082, 6.6703045098073357},
                      {7.9209293338034703, 8.1521262964627699},
                      {9.7697605469393753, 14.574758351874905},
                      {4.622078032839763, 16.056580138530339}},
                     {}};
  const Polygon piece{{{1.8529534795589477, -0.53339475155058313},
                       {9.5681570678747505, -2.7543080915505778},
                       {10.026437709399637, -1.1622925967233517},
                       {2.3112341210838343, 1.0586207432766412}},
                      {}};
  const auto beyond = subtract(piece, part), within = intersect(piece, part), rest = subtract(part, piece);
  ASSERT_TRUE(beyond && within && rest);
  EXPECT_NEAR(total(*beyond), 0, 1e-9);
  EXPECT_NEAR(total(*within), area(piece), 1e-9);
  EXPECT_NEAR(total(*rest), area(part) - area(piece), 1e-9);
}

TEST(Boolean, operations_fail_on_polygons_that_cross_themselves_rather_than_find_nothing) {
  const Polygon square{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {}}, bow_tie{{{0, 0}, {10, 10}, {10, 0}, {0, 10}}, {}};
  const Polygon other{{{5, 5}, {15, 5}, {15, 15}, {5, 15}}, {}};
  for (const auto& result : {intersect(bow_tie, other), subtract(square, bow_tie), subtract(bow_tie, other),
                             unite(std::vector{square, bow_tie})}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, "geometry-boolean");
    EXPECT_FALSE(result.error().message.empty());
  }
}

TEST(Boolean, operations_fail_on_coordinates_that_are_not_finite_or_too_large) {
  const Polygon square{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {}};
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 1e308, -1e200})
    for (const bool in_hole : {false, true}) {
      Polygon wrong = square;
      wrong.holes.push_back({{2, 2}, {2, 4}, {4, 4}, {4, 2}});
      (in_hole ? wrong.holes[0] : wrong.outer)[1].y = bad;
      for (const auto& result :
           {intersect(square, wrong), intersect(wrong, square), subtract(square, wrong), subtract(wrong, square),
            unite(std::vector{square, wrong}), buffer(wrong, 1), make_valid(wrong)}) {
        ASSERT_FALSE(result) << bad;
        EXPECT_EQ(result.error().code, "geometry-boolean");
      }
      EXPECT_EQ(triangulate(wrong).error().code, "geometry-triangulate");
    }
  EXPECT_FALSE(buffer(square, infinity));
  EXPECT_FALSE(buffer(square, std::numeric_limits<double>::quiet_NaN()));
}

TEST(SimplePieces, of_rings_that_touch_are_separated_and_of_a_simple_polygon_are_itself) {
  EXPECT_EQ(*simple_pieces(courtyard, 0.01), std::vector{courtyard});
  const Polygon touching{{{0, 0}, {20, 0}, {20, 10}, {0, 10}}, {{{10, 0}, {8, 3}, {10, 6}, {12, 3}}}};
  ASSERT_FALSE(is_simple(touching));
  const auto pieces = simple_pieces(touching, 0.01);
  ASSERT_TRUE(pieces);
  EXPECT_NEAR(total(*pieces), area(touching), 1);
  for (const auto& piece : *pieces) EXPECT_TRUE(is_simple(piece));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(simple_pieces(touching, nan));
}

TEST(MakeValid, opens_a_bow_tie_into_its_two_wings) {
  const auto wings = make_valid({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}, {}});
  ASSERT_TRUE(wings);
  EXPECT_EQ(wings->size(), 2U);
  EXPECT_DOUBLE_EQ(total(*wings), 8);
}

TEST(Move, shifts_outer_ring_and_holes) {
  Polygon moved = courtyard;
  move(moved, {100, -2});
  EXPECT_EQ(moved.outer[2], (Point2{110, 6}));
  EXPECT_EQ(moved.holes[0][0], (Point2{103, 1}));
  change_corners(moved, [](Point2 p) { return p - Point2{100, -2}; });
  EXPECT_EQ(moved, courtyard);
}

}  // namespace
}  // namespace mansard::geometry
