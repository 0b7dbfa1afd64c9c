// The page about a run.
#include "mansard/report/page.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace mansard::report {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

auto block_with(double mse, double cells) -> RunScores {
  RunScores out;
  out.vertical = MeanSquare{mse, cells};
  return out;
}

TEST(Page, the_standard_error_is_that_of_a_ratio_over_blocks) {
  // Of blocks of one size that of a mean: deviations ±1, sqrt(2 / 1 / 2²).
  EXPECT_NEAR(*standard_error({block_with(1, 50), block_with(3, 50)}, &RunScores::vertical), 1, 1e-12);
  // Of four: sqrt(4 / (4 · 3)).
  EXPECT_NEAR(
      *standard_error({block_with(1, 7), block_with(3, 7), block_with(1, 7), block_with(3, 7)}, &RunScores::vertical),
      std::sqrt(1.0 / 3), 1e-12);
  // A block of hardly any cells says hardly anything.
  EXPECT_NEAR(*standard_error({block_with(1, 1000), block_with(1, 1000), block_with(100, 1e-6)}, &RunScores::vertical),
              0, 1e-6);
  EXPECT_FALSE(standard_error({block_with(1, 50)}, &RunScores::vertical));
  EXPECT_FALSE(standard_error({block_with(1, 50), RunScores()}, &RunScores::vertical));
}

TEST(Page, says_what_files_say_without_taking_it_for_markup) {
  const std::string bad = "<b>\"&'";
  RunPage page;
  page.title = page.name = bad;
  page.run.inputs = {{bad, 3, "0f"}};
  page.run.warnings[bad] = {1, bad};
  page.worst.push_back({{bad, "full", {{"code", bad}}, 0.5, 0.1, 0.2}, "png", 2, 1, true});
  page.without_model["code"] = {1, bad};
  page.without_model_first.push_back({bad, "refused", {{"code", bad}}, {}, {}, {}});
  page.reviewed.known = true;
  page.reviewed.lapsed = 1;
  page.reviewed.by_reviewer[bad] = {1, 0, 0};
  page.changed = {bad, {{bad, 1}}, {{bad, 1}}};
  const auto html = page_html(page);
  EXPECT_THAT(html,
              AllOf(Not(HasSubstr("<b>")), HasSubstr("&lt;b&gt;&quot;&amp;'"), HasSubstr("<html lang=\"en\">"),
                    HasSubstr("<title>&lt;b&gt;"), HasSubstr("base64,cG5n"), HasSubstr("alt=\"Building &lt;b&gt;")));
}

TEST(Page, needs_nothing_else) {
  const auto html = page_html({});
  EXPECT_THAT(
      html, AllOf(Not(HasSubstr("<script")), Not(HasSubstr("<link")), Not(HasSubstr("http")), Not(HasSubstr("url("))));
}

TEST(CityMap, has_every_building_however_small_and_one_element_for_each_colour) {
  CityMap map;
  const auto square = [](double x, double y, double side) {
    return std::vector<geometry::Polygon>{{{{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}}, {}}};
  };
  map.add(square(0, 0, 10), 0);
  map.add(square(1e6, 0, 10), 1);  // a millionth of the map
  map.add(square(1e6, 20, 10), 1);
  map.add({}, 1);
  map.mark({5, 5}, "<1>");
  const auto svg = map.svg({{"a", "#111111"}, {"b", "#222222"}}, "two \"colours\"");
  const auto count = [&](const std::string& what) {
    std::size_t n = 0;
    for (auto at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("<path"), 2U);
  EXPECT_EQ(count("h3v3h-3z"), 3U);
  EXPECT_THAT(svg, AllOf(HasSubstr("&lt;1&gt;"), HasSubstr("aria-label=\"two &quot;colours&quot;\""),
                         HasSubstr("200 km, north up")));
  EXPECT_EQ(CityMap().svg({}, ""), "");
}

TEST(CityMap, is_north_up_and_keeps_its_proportions) {
  CityMap map;
  map.add({{{{0, 0}, {100, 0}, {100, 50}, {0, 50}}, {}}}, 0);
  // 9,700 of 10,000 units for 100 m, and 150 around.
  EXPECT_THAT(map.svg({{"a", "#111111"}}, ""),
              AllOf(HasSubstr("viewBox=\"0 0 10000 5150\""), HasSubstr("d=\"M150 5000l9700 0 0 -4850 -9700 0z\"")));
}

}  // namespace
}  // namespace mansard::report
