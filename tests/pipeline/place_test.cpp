// A block's result gets the numbers of the features in the scene.
#include "mansard/pipeline/detail/place.hpp"

#include <gtest/gtest.h>

namespace mansard::pipeline::detail {
namespace {

TEST(Place, gives_every_feature_its_number_in_the_scene) {
  block::OwnFrame frame;
  frame.features = {7, 3};
  BlockResult result;
  result.parts.resize(2);
  result.parts[1].feature = 1;
  result.covered = {0};
  result.failed.emplace_back(1, base::warning("a", "b"));
  result.unchecked.emplace_back(0, base::warning("a", "b"));
  result.left_out.push_back({1, 2.5, "roof"});
  auto& segmentation = result.segmented.emplace().segmentation.emplace();
  segmentation.left_out.push_back({std::size_t{1}, 2.5, 3, "roof"});
  segmentation.left_out.push_back({std::nullopt, 2.5, 3, "roof"});
  place(result, frame);
  EXPECT_EQ(result.parts[0].feature, 3U);
  EXPECT_EQ(result.parts[1].feature, 7U);
  EXPECT_EQ(result.covered[0], 7U);
  EXPECT_EQ(result.failed[0].first, 3U);
  EXPECT_EQ(result.unchecked[0].first, 7U);
  EXPECT_EQ(result.left_out[0].feature, 3U);
  EXPECT_EQ(result.segmented->segmentation->left_out[0].feature, 3U);
  EXPECT_FALSE(result.segmented->segmentation->left_out[1].feature);
}

}  // namespace
}  // namespace mansard::pipeline::detail
