// The list of shapes: names as files have them, and what is made instead.
#include "mansard/roof/detail/shape_list.hpp"

#include <gtest/gtest.h>

#include <set>

#include "mansard/roof/detail/tags.hpp"

namespace mansard::roof::detail {
namespace {

TEST(ShapeList, reads_every_shape_by_each_of_its_names) {
  for (const ShapeInfo& info : shapes()) {
    EXPECT_EQ(to_string(info.shape), info.name);
    const auto expect = [&](std::string_view name, bool exact) {
      const auto read = shape_of(name);
      ASSERT_TRUE(read) << name;
      EXPECT_EQ(read->shape, info.shape) << name;
      EXPECT_EQ(read->exact, exact) << name;
    };
    expect(info.name, true);
    for (const auto name : info.same) expect(name, true);
    for (const auto name : info.similar) expect(name, false);
  }
  EXPECT_FALSE(shape_of("roundabout"));
}

TEST(ShapeList, has_no_name_twice) {
  std::set<std::string_view> names;
  std::size_t count = 0;
  for (const ShapeInfo& info : shapes())
    for (const auto& list : {info.same, info.similar})
      for (const auto name : list) names.insert(name), ++count;
  EXPECT_EQ(names.size(), count);
}

TEST(ShapeList, falls_back_to_a_shape_that_needs_no_end) {
  for (const ShapeInfo& info : shapes()) {
    if (info.ends != Ends::upright && info.ends != Ends::half_upright) continue;
    EXPECT_EQ(info_of(info.without_ends).ends, Ends::move) << info.name;
  }
}

}  // namespace
}  // namespace mansard::roof::detail
