#include "mansard/derive/detail/outline.hpp"

#include <gtest/gtest.h>
#include <algorithm>

#include "mansard/base/run.hpp"

namespace mansard::derive::detail {
namespace {

/// Two buildings side by side in a field of `cells` by `cells`.
auto numbers(std::size_t cells) -> std::vector<std::int32_t> {
  std::vector<std::int32_t> of(cells * cells, 0);
  for (std::size_t row = 5; row < cells - 5; ++row)
    for (std::size_t column = 5; column < cells - 5; ++column) of[row * cells + column] = column < cells / 2 ? 1 : 2;
  return of;
}

TEST(Outlines, follow_the_sides_of_the_cells) {
  const Place place{{100, 200}, 0.5, 40, 40};
  const auto outlines = polygons_of(place, numbers(40), 3);
  ASSERT_TRUE(outlines) << outlines.error().message;
  ASSERT_EQ(outlines->size(), 3U);
  EXPECT_TRUE((*outlines)[0].empty());
  ASSERT_EQ((*outlines)[1].size(), 1U);
  EXPECT_DOUBLE_EQ(geometry::area((*outlines)[1][0]), 15 * 30 * 0.25);
  const auto box = geometry::bounds((*outlines)[2].at(0).outer);
  EXPECT_EQ(box.least, (geometry::Point2{110, 202.5}));
  EXPECT_EQ(box.most, (geometry::Point2{117.5, 217.5}));
}

// Registering GDAL's drivers at every call, as was once done, damages the heap when two threads do it at once: 3 runs
// of 12 of this test were then aborted.
TEST(Outlines, are_drawn_by_many_threads_at_once) {
  const auto of = numbers(40);
  constexpr std::size_t count = 8000;
  std::vector<char> right(count, 0);
  base::parallel_for(count, [&](std::size_t i) {
    const auto outlines = polygons_of({{0, 0}, 0.5, 40, 40}, of, 3);
    right[i] = outlines && (*outlines)[1].size() == 1 && (*outlines)[2].size() == 1 ? 1 : 0;
  });
  EXPECT_EQ(std::ranges::count(right, 1), static_cast<std::ptrdiff_t>(count));
}

}  // namespace
}  // namespace mansard::derive::detail
