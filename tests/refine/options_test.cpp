#include "mansard/refine/options.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "mansard/refine/detail/pieces.hpp"
#include "mansard/refine/detail/wings.hpp"

namespace {

namespace base = mansard::base;
namespace detail = mansard::refine::detail;
using mansard::refine::Options;

auto is_number(const base::Option& option) -> bool {
  return option.kind == base::Option::Kind::number || option.kind == base::Option::Kind::integer;
}

TEST(RefineOptions, all_but_the_objective_are_advanced) {
  Options options;
  const auto list = option_list(options);
  const auto plain = std::ranges::count_if(list.options(), [](const auto& o) { return !o.advanced; });
  EXPECT_EQ(plain, 7);
  EXPECT_GT(std::ssize(list.options()), plain);
}

TEST(RefineOptions, each_says_what_it_means_and_where_its_default_comes_from) {
  Options options;
  const auto list = option_list(options);
  for (const auto& option : list.options()) {
    EXPECT_THAT(option.meaning, testing::EndsWith(".")) << option.name;
    EXPECT_THAT(option.meaning, testing::MatchesRegex("[A-Z].*")) << option.name;
    EXPECT_FALSE(option.source.empty()) << option.name;
  }
}

TEST(RefineOptions, each_number_has_a_range_that_holds_its_default) {
  Options options;
  const auto list = option_list(options);
  for (const auto& option : list.options()) {
    if (!is_number(option)) continue;
    EXPECT_GT(option.range.minimum, -1) << option.name;
    EXPECT_LT(option.range.maximum, 1e10) << option.name;
    EXPECT_TRUE(option.set(option.get())) << option.name;
  }
}

TEST(RefineOptions, each_is_bound_to_a_member_of_its_own) {
  Options options;
  const auto list = option_list(options);
  for (const auto& option : list.options()) {
    if (!is_number(option)) continue;
    const auto before = option.get();
    const auto other =
        base::to_text(before == base::to_text(option.range.minimum) ? option.range.maximum : option.range.minimum);
    ASSERT_TRUE(option.set(other)) << option.name;
    Options fresh;
    const auto defaults = option_list(fresh);
    for (const auto& one : list.options()) {
      if (one.name == option.name) continue;
      EXPECT_EQ(one.get(), defaults.find(one.name)->get()) << option.name;
    }
    ASSERT_TRUE(option.set(before));
  }
}

TEST(RefineOptions, reach_the_search) {
  const mansard::geometry::Polygon part{{{0, 0}, {12, 0}, {12, 8}, {0, 8}}, {}};
  const mansard::geometry::Polygon strip{{{0, 0}, {12, 0}, {12, 0.5}, {0, 0.5}}, {}};
  Options options;
  EXPECT_THAT(detail::cut(part, strip, options), testing::IsEmpty());
  options.pieces.min_width = 0.4;
  EXPECT_THAT(detail::cut(part, strip, options), testing::SizeIs(2));

  const mansard::geometry::Polygon bent{{{0, 0}, {12, 0}, {12, 5}, {5, 5}, {5, 12}, {0, 12}}, {}};
  EXPECT_FALSE(detail::wing_lines_of(bent, options).empty());
  options.wings.reflex_sine = 1;
  EXPECT_TRUE(detail::wing_lines_of(bent, options).empty());
}

}  // namespace
