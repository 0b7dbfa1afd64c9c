#include "mansard/refine/detail/pieces.hpp"

#include <gmock/gmock.h>

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

TEST(Pieces, that_touch_in_one_point_are_none) {
  const geometry::Polygon part{rectangle(0, 0, 12, 8), {}};
  EXPECT_TRUE(cut(part, {{{0, 4}, {4, 2}, {6, 5}, {4, 6}}, {}}, {}).empty());
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
