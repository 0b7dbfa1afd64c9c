#include "mansard/geometry/box_index.hpp"

#include <gmock/gmock.h>
#include <cmath>

#include "mansard/base/run.hpp"

namespace {

using mansard::geometry::Box2;
using mansard::geometry::BoxIndex;
using mansard::geometry::Point2;

auto random_boxes(std::size_t count, std::uint64_t seed, double largest) -> std::vector<Box2> {
  mansard::base::Random random(seed);
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    // Whole numbers, so that many boxes only touch, and some are the same.
    const Point2 at{std::floor(random.uniform(0, 40)), std::floor(random.uniform(0, 40))};
    boxes.push_back({at, at + Point2{std::floor(random.uniform(0, largest)), std::floor(random.uniform(0, largest))}});
    if (i % 17 == 0) boxes.back() = {};
  }
  return boxes;
}

auto one_by_one(const std::vector<Box2>& boxes, const Box2& box) -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].empty() && boxes[i].overlaps(box)) found.push_back(i);
  return found;
}

TEST(BoxIndex, finds_what_a_search_of_all_boxes_finds) {
  for (const std::uint64_t seed : {1, 2, 3})
    for (const std::size_t count : {0, 1, 8, 9, 500})
      for (const double largest : {1.0, 4.0, 60.0}) {
        const auto boxes = random_boxes(count, seed, largest);
        const BoxIndex index(boxes);
        for (const auto& box : random_boxes(40, seed + 100, largest)) {
          auto all = box.empty() ? std::vector<std::uint32_t>() : one_by_one(boxes, box);
          EXPECT_EQ(index.overlapping(box), all) << "seed " << seed << ", " << count << " boxes up to " << largest;
          const auto even = [](std::uint32_t i) { return i % 2 == 0; };
          std::erase_if(all, [&](std::uint32_t i) { return !even(i); });
          for (const std::size_t most : {0, 1, 5, 1000}) {
            auto first = all;
            first.resize(std::min(first.size(), most));
            EXPECT_EQ(index.first_overlapping(box, most, even), first)
                << "seed " << seed << ", " << most << " of " << count;
          }
        }
      }
}

TEST(BoxIndex, of_nothing_finds_nothing) {
  const Box2 box{{0, 0}, {1, 1}};
  EXPECT_THAT(BoxIndex().overlapping(box), testing::IsEmpty());
  EXPECT_THAT(BoxIndex().first_overlapping(box, 3, [](std::uint32_t) { return true; }), testing::IsEmpty());
}

}  // namespace
