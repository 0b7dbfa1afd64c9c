#include "lab/explore/detail/charts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "explore/helpers.hpp"
#include "lab/explore/detail/drawings.hpp"
#include "lab/explore/detail/svg.hpp"

namespace mansard::explore::detail {
namespace {

using test::Xml;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Escape, leaves_nothing_that_means_something_in_a_page) {
  EXPECT_EQ(escape("a<b>&\"c\"'d'"), "a&lt;b&gt;&amp;&quot;c&quot;'d'");
  EXPECT_EQ(escape("a\x01\n\x7f!"), "a   !");
  EXPECT_EQ(escape("γ²"), "γ²");
}

TEST(Ticks, are_round_and_reach_over_both_ends) {
  EXPECT_THAT(ticks(0, 10, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(ticks(0, 90, 8), ElementsAre(0, 20, 40, 60, 80, 100));
  EXPECT_THAT(ticks(-3, 7, 4), ElementsAre(-5, 0, 5, 10));
  EXPECT_THAT(ticks(4, 4, 5), ElementsAre(4));
  for (const double most : {0.013, 0.7, 1.0, 3.3, 999.0, 1.2e7}) {
    const auto all = ticks(0, most, 4);
    EXPECT_LE(all.front(), 0);
    EXPECT_GE(all.back(), most);
    EXPECT_THAT(all.size(), testing::AllOf(testing::Ge(3U), testing::Le(7U))) << most;
  }
}

TEST(LineChart, is_well_formed_and_escapes_names) {
  const LineChart chart{"a < b", "x & y", {}, {{"\"one\"", {{0, 1}, {10, 2}}}, {"<two>", {{0, 3}, {10, 4}}}}};
  const Xml svg(line_chart(chart));
  EXPECT_EQ(svg.error, "");
  EXPECT_EQ(svg.count("polyline"), 2U);
  EXPECT_EQ(svg.count("circle"), 4U);
  EXPECT_THAT(svg.words_of_all, testing::AllOf(HasSubstr("<two>"), HasSubstr("\"one\""), HasSubstr("x & y")));
  EXPECT_EQ(svg.elements.front().get("aria-label"), "a < b over x & y");
}

TEST(LineChart, leaves_a_gap_where_there_is_no_number) {
  const Xml svg(line_chart({"t", "x", {}, {{"s", {{0, 1}, {1, 2}, {2, nan}, {3, 4}, {4, 5}}}}}));
  EXPECT_EQ(svg.error, "");
  EXPECT_EQ(svg.count("polyline"), 2U);
  EXPECT_EQ(svg.count("circle"), 4U);
  EXPECT_THAT(line_chart({"t", "x", {}, {{"s", {{0, nan}}}}}), Not(HasSubstr("nan")));
}

TEST(LineChart, keeps_every_point_inside_the_picture) {
  const Xml svg(line_chart({"t", "x", {}, {{"s", {{-1e6, -5}, {0, 1e9}, {1e6, 3}}}}}));
  for (const auto& element : svg.elements) {
    if (element.name != "circle") continue;
    EXPECT_THAT(std::stod(element.get("cx")), testing::AllOf(testing::Ge(0), testing::Le(420)));
    EXPECT_THAT(std::stod(element.get("cy")), testing::AllOf(testing::Ge(0), testing::Le(300)));
  }
}

TEST(LineChart, puts_words_where_x_has_no_numbers) {
  const Xml svg(line_chart({"t", "quality", {"simple", "high"}, {{"s", {{0, 1}, {1, 2}}}}}));
  EXPECT_THAT(svg.words_of_all, testing::AllOf(HasSubstr("simple"), HasSubstr("high")));
}

TEST(HeatMap, has_a_cell_a_value_and_says_which_failed) {
  const Xml svg(heat_map({"t", "β", "α", {"1", "2"}, {"3", "4"}, {0, 1, 2, nan}, 1}));
  EXPECT_EQ(svg.error, "");
  EXPECT_EQ(svg.count("rect"), 4U);
  EXPECT_THAT(svg.words_of_all, testing::AllOf(HasSubstr("2.0"), HasSubstr("failed"), Not(HasSubstr("nan"))));
}

TEST(ScaleColour, grows_lighter_with_the_value) {
  const auto brightness = [](const std::string& colour) {
    const auto level = [&](std::size_t i) { return std::stoi(colour.substr(i, 2), nullptr, 16); };
    return 2126 * level(1) + 7152 * level(3) + 722 * level(5);
  };
  for (int i = 1; i <= 10; ++i) EXPECT_LT(brightness(scale_colour((i - 1) / 10.0)), brightness(scale_colour(i / 10.0)));
  EXPECT_EQ(scale_colour(nan), "none");
  EXPECT_EQ(scale_colour(-5), scale_colour(0));
}

TEST(PlanDrawing, gives_neighbours_different_colours_and_puts_north_up) {
  const auto square = [](double x, double y) {
    return geometry::Polygon{{{x, y}, {x + 10, y}, {x + 10, y + 10}, {x, y + 10}}, {}};
  };
  const std::vector parts{square(0, 0), square(10, 0), square(0, 10)};
  const Xml svg(plan_drawing(parts, parts, 300, "plan"));
  EXPECT_EQ(svg.error, "");
  std::set<std::string> fills;
  std::vector<double> y;
  for (const auto& element : svg.elements) {
    if (element.get("class") != "part") continue;
    fills.insert(element.get("fill"));
    const auto path = element.get("d");
    y.push_back(std::stod(path.substr(path.find(' ') + 1)));
  }
  EXPECT_EQ(fills.size(), 3U);
  ASSERT_EQ(y.size(), 3U);
  EXPECT_LT(y[2], y[0]);
}

TEST(PlanDrawing, draws_holes) {
  const geometry::Polygon ring{{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {{{3, 3}, {3, 6}, {6, 6}, {6, 3}}}};
  const auto svg = plan_drawing({ring}, {}, 300, "plan");
  EXPECT_EQ(Xml(svg).error, "");
  EXPECT_EQ(std::ranges::count(svg, 'Z'), 2);
}

TEST(KindOf, tells_gables_pitches_and_mansards_apart) {
  EXPECT_EQ(kind_of({{0, 0}, {0, 6}}), ProfileKind::vertical);
  EXPECT_EQ(kind_of({{0, 0}, {0, 6}, {0.04, 9}}), ProfileKind::vertical);
  EXPECT_EQ(kind_of({{0, 0}, {0, 6}, {4, 9}}), ProfileKind::one_pitch);
  EXPECT_EQ(kind_of({{0, 0}, {0, 6}, {1, 9}, {4, 10}}), ProfileKind::more);
}

TEST(ProfileDrawing, has_a_line_a_profile_and_counts_them_by_length) {
  const std::vector<Rise> rises{{{{0, 0}, {0, 6}}, 10, 0, 20}, {{{0, 0}, {0, 6}, {4, 9}}, 30, 15, 20}};
  const Xml svg(profile_drawing(rises, "profiles"));
  EXPECT_EQ(svg.error, "");
  EXPECT_EQ(svg.count("polyline"), 2U);
  const auto shares = shares_of(rises);
  EXPECT_EQ(shares.length, 40);
  EXPECT_THAT(shares.of_kind, ElementsAre(10, 30, 0));
  EXPECT_EQ(shares.unseen, 10);
  EXPECT_EQ(shares.slices, 15U);
  EXPECT_EQ(Xml(profile_drawing({}, "none")).error, "");
}

}  // namespace
}  // namespace mansard::explore::detail
