#include "mansard/picture/plans.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace {

using namespace mansard::picture;
using mansard::geometry::Polygon;

constexpr Colour red{200, 30, 30}, blue{30, 30, 200}, panel{249, 249, 250};

auto rectangle(double x0, double y0, double x1, double y1) -> Polygon {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

auto pixels_of(const Image& image, Colour colour) -> std::size_t {
  std::size_t n = 0;
  for (std::size_t i = 0; i < image.width * image.height; ++i)
    n += std::equal(colour.begin(), colour.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i)) ? 1 : 0;
  return n;
}

auto sheet_of(std::vector<PlanArea> left, std::vector<PlanArea> right = {}) -> PlanSheet {
  PlanSheet sheet;
  sheet.groups = {
      {"a building", "what is known of it", {{"left", std::move(left), ""}, {"right", std::move(right), ""}}}};
  return sheet;
}

TEST(PlanSheet, draws_areas_of_one_group_at_one_scale) {
  // The larger area has 412 pixels for its 20 m, so the smaller one has a quarter of its pixels.
  const Image image =
      plan_sheet(sheet_of({{{rectangle(0, 0, 20, 10)}, red, {}}}, {{{rectangle(0, 0, 10, 5)}, blue, {}}}));
  const auto large = static_cast<double>(pixels_of(image, red)), small = static_cast<double>(pixels_of(image, blue));
  EXPECT_NEAR(large, 412 * 206, 3000);
  EXPECT_NEAR(small / large, 0.25, 0.02);
}

TEST(PlanSheet, leaves_holes_empty_and_shows_what_is_on_top) {
  Polygon ring = rectangle(0, 0, 10, 10);
  ring.holes.push_back({{2, 2}, {2, 8}, {8, 8}, {8, 2}});
  const auto with_hole = pixels_of(plan_sheet(sheet_of({{{ring}, red, {}}})), red);
  const auto covered =
      pixels_of(plan_sheet(sheet_of({{{rectangle(0, 0, 10, 10)}, red, {}}, {{rectangle(2, 2, 8, 8)}, blue, {}}})), red);
  EXPECT_NEAR(static_cast<double>(with_hole), 0.64 * 332 * 332, 4000);
  EXPECT_EQ(covered, with_hole);
}

TEST(PlanSheet, writes_the_first_label_that_fits_and_beside_the_areas_where_none_does) {
  const std::vector<std::vector<std::string>> labels{{std::string(200, 'x')}, {"38°", "7.2 m"}, {"38°"}};
  const auto drawn = [&](double width, const std::vector<std::vector<std::string>>& texts) {
    // A field of 20 m keeps the scale: about 21 pixels per metre.
    return plan_sheet(
        sheet_of({{{rectangle(0, 0, 20, 10)}, blue, {}}, {{rectangle(8, 2, 8 + width, 2 + width)}, red, texts}}));
  };
  const auto written = [&](double width, Colour colour) {
    return pixels_of(drawn(width, {}), colour) - pixels_of(drawn(width, labels), colour);
  };
  EXPECT_EQ(drawn(6, labels).pixels, drawn(6, {labels[1]}).pixels);
  EXPECT_EQ(drawn(1.2, labels).pixels, drawn(1.2, {labels[2]}).pixels);
  EXPECT_GT(written(6, red), written(1.2, red));
  EXPECT_GT(written(1.2, red), 0U);
  EXPECT_EQ(written(1.2, panel), 0U);
  EXPECT_GT(written(0.5, panel), 0U);
  EXPECT_EQ(drawn(0.5, labels).pixels, drawn(0.5, {labels[1]}).pixels);
  EXPECT_EQ(drawn(0.5, {labels[0]}).pixels, drawn(0.5, {}).pixels);
}

TEST(PlanSheet, has_as_many_columns_as_asked_for_and_one_width) {
  PlanSheet sheet = sheet_of({{{rectangle(0, 0, 20, 10)}, red, {}}});
  const Image one = plan_sheet(sheet);
  sheet.groups.resize(5, sheet.groups.front());
  const Image five = plan_sheet(sheet);
  EXPECT_GT(five.width, one.width + one.width / 2);
  EXPECT_GT(five.height, 2 * one.height);
  sheet.groups[0].title = std::string(1000, 'x') + "é";
  const Image named = plan_sheet(sheet);
  EXPECT_EQ(named.width, five.width);
  EXPECT_EQ(named.height, five.height);
  EXPECT_EQ(plan_sheet(sheet).pixels, named.pixels);
}

TEST(PlanSheet, takes_groups_without_areas_areas_without_extent_and_no_groups) {
  EXPECT_GT(plan_sheet({}).pixels.size(), 0U);
  EXPECT_GT(plan_sheet(sheet_of({})).pixels.size(), 0U);
  const Polygon point{{{5, 5}, {5, 5}, {5, 5}}, {}};
  EXPECT_GT(plan_sheet(sheet_of({{{point}, red, {{"x"}}}, {{}, red, {{"x"}}}})).pixels.size(), 0U);
  EXPECT_GT(plan_sheet(sheet_of({{{rectangle(0, 0, 1e7, 1e7)}, red, {}}})).pixels.size(), 0U);
}

}  // namespace
