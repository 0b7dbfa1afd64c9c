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
    if (info.ends == Ends::own || info.ends == Ends::move) continue;
    const ShapeInfo* to = &info_of(info.without_ends);
    // Shapes of which two sides differ become gabled ones over wings, and these hipped ones where there is no end.
    if (info.opposite != Opposite::same) to = &info_of(to->without_ends);
    EXPECT_TRUE(to->ends == Ends::move || to == &info) << info.name;
    EXPECT_NE(to->profile, nullptr) << info.name;
  }
}

}  // namespace
}  // namespace mansard::roof::detail
