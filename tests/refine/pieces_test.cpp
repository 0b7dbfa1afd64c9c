#include "mansard/refine/detail/pieces.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "scans.hpp"

namespace {

namespace geometry = mansard::geometry;

using namespace scans;
using refine::detail::cut;
using refine::detail::joined;

auto area_of(const std::vector<geometry::Polygon>& pieces) -> double {
  double sum = 0;
  for (const auto& piece : pieces) sum += geometry::area(piece);
  return sum;
}

TEST(Pieces, of_a_cut_cover_the_part) {
  const geometry::Polygon part{rectangle(0, 0, 12, 8), {}};
  const auto island = cut(part, {rectangle(4, 3, 3, 2), {}}, {});
  ASSERT_EQ(island.size(), 2U);
  EXPECT_EQ(island[0].holes.size(), 1U);
  EXPECT_NEAR(area_of(island), 96, 1e-9);
  const auto band = cut(part, {rectangle(5, -1, 2, 10), {}}, {});  // parts what is left
  ASSERT_EQ(band.size(), 3U);
  EXPECT_NEAR(area_of(band), 96, 1e-9);
}

TEST(Pieces, that_would_be_too_small_or_narrow_are_none) {
  const geometry::Polygon part{rectangle(0, 0, 12, 8), {}};
  EXPECT_TRUE(cut(part, {rectangle(4, 3, 1, 2), {}}, {}).empty());
  EXPECT_TRUE(cut(part, {rectangle(0, 0, 12, 0.5), {}}, {}).empty());
  EXPECT_TRUE(cut(part, {rectangle(20, 0, 12, 8), {}}, {}).empty());
}

/// Along the extension of one of the part's edges, moved aside; the rounding of 30° makes the two nearly collinear.
auto cut_along_an_edge(double aside) -> std::vector<geometry::Polygon> {
  const auto turned = [](double x, double y) {
    return geometry::Point2{std::sqrt(0.75) * x - 0.5 * y, 0.5 * x + std::sqrt(0.75) * y};
  };
  const geometry::Polygon part{{turned(0, 0), turned(12, 0), turned(12, 5), turned(5, 5), turned(5, 12), turned(0, 12)},
                               {}};
  const geometry::Polygon side{{turned(-50, 5 + aside), turned(50, 5 + aside), turned(50, 60), turned(-50, 60)}, {}};
  return cut(part, side, {});
}

TEST(Pieces, are_the_same_when_a_line_moves_by_less_than_a_millimetre) {
  const auto still = cut_along_an_edge(0);
  ASSERT_EQ(still.size(), 2U);
  EXPECT_EQ(still[0].outer.size(), 4U);
  EXPECT_EQ(still[1].outer.size(), 4U);
  for (const double aside : {1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-4, -1e-4}) {
    const auto moved = cut_along_an_edge(aside);
    ASSERT_EQ(moved.size(), still.size()) << aside;
    for (std::size_t k = 0; k < still.size(); ++k) {
      ASSERT_EQ(moved[k].outer.size(), still[k].outer.size()) << aside;
      for (std::size_t i = 0; i < still[k].outer.size(); ++i)
        EXPECT_LT(geometry::length(moved[k].outer[i] - still[k].outer[i]), 1e-3) << aside;
    }
  }
}

TEST(Pieces, have_neither_spikes_nor_slivers) {
  const geometry::Polygon spiked{{{0, 0}, {8, 0}, {8, 5}, {8.0001, 9}, {8.0002, 5}, {8, 6}, {0, 6}}, {}};
  const auto tidy = refine::detail::tidied({spiked, {rectangle(0, 0, 30, 0.005), {}}}, {});
  ASSERT_EQ(tidy.size(), 1U);
  EXPECT_EQ(tidy[0].outer.size(), 4U);
  EXPECT_NEAR(geometry::area(tidy[0]), 48, 0.01);
}

TEST(Pieces, that_touch_in_one_point_are_none) {
  const geometry::Polygon part{rectangle(0, 0, 12, 8), {}};
  EXPECT_TRUE(cut(part, {{{0, 4}, {4, 2}, {6, 5}, {4, 6}}, {}}, {}).empty());
}

auto turned_30(const geometry::Ring& ring, double shift) -> geometry::Polygon {
  geometry::Polygon out;
  for (const auto p : ring)
    out.outer.push_back({shift + std::sqrt(0.75) * p.x - 0.5 * p.y, 0.7 * shift + 0.5 * p.x + std::sqrt(0.75) * p.y});
  return out;
}

/// A tower in the middle of the south side whose head meets the north side in a point, moved by that much.
auto cut_to_a_point(double moved) -> std::vector<geometry::Polygon> {
  const auto part = turned_30(rectangle(0, 0, 24, 12), 61.7);
  return cut(part, turned_30({{8, 0}, {16, 0}, {16, 6}, {13, 12 + moved}, {8, 7}}, 61.7), {});
}

TEST(Pieces, are_two_where_a_nanometre_decides_whether_they_hang_together) {
  for (const double moved : {0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-4, -1e-4}) {
    const auto pieces = cut_to_a_point(moved);
    ASSERT_EQ(pieces.size(), 3U) << moved;
    EXPECT_NEAR(area_of(pieces), 288, 0.01) << moved;
    for (const auto& piece : pieces) EXPECT_TRUE(geometry::is_simple(piece)) << moved;
  }
}

/// Two halves of a part beside each other whose common side has a corner of one of them, moved aside.
auto joined_at_a_side(double aside) -> std::optional<geometry::Polygon> {
  return joined(turned_30({{0, 0}, {7, 0}, {7 + aside, 4}, {7, 9}, {0, 9}}, 61.7),
                turned_30({{7, 0}, {12, 0}, {12, 9}, {7, 9}}, 61.7), {});
}

TEST(Pieces, are_joined_where_a_corner_of_one_is_a_nanometre_off_the_side_of_the_other) {
  for (const double aside : {0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-4, -1e-4}) {
    const auto one = joined_at_a_side(aside);
    ASSERT_TRUE(one) << aside;
    EXPECT_EQ(one->outer.size(), 4U) << aside;
    EXPECT_TRUE(one->holes.empty()) << aside;
    EXPECT_NEAR(geometry::area(*one), 108, 0.01) << aside;
  }
}

TEST(Pieces, are_joined_where_they_share_an_edge) {
  const auto one = joined({rectangle(0, 0, 5, 8), {}}, {rectangle(5, 0, 7, 8), {}}, {});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->outer.size(), 4U);
  EXPECT_NEAR(geometry::area(*one), 96, 1e-9);
  EXPECT_FALSE(joined({rectangle(0, 0, 5, 8), {}}, {rectangle(6, 0, 5, 8), {}}, {}));
  EXPECT_FALSE(joined({rectangle(0, 0, 5, 8), {}}, {rectangle(5, 8, 5, 8), {}}, {}));  // a corner only
}

TEST(Pieces, that_overlap_are_not_joined) {
  EXPECT_FALSE(joined({rectangle(0, 0, 7, 8), {}}, {rectangle(5, 0, 7, 8), {}}, {}));
}

}  // namespace
