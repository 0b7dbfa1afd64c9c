// Strips whose heights differ by what was planted.
#include "mansard/cloud/strips.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mansard/base/run.hpp"
#include "mansard/cloud/cloud.hpp"

namespace mansard::cloud {
namespace {

using testing::HasSubstr;

/// Normal errors with this standard deviation (Box and Muller).
auto noise(base::Random& random, double deviation) -> double {
  const double r = std::sqrt(-2 * std::log(1 - random.uniform()));
  return deviation * r * std::cos(2 * std::numbers::pi * random.uniform());
}

struct Strip {
  std::uint16_t number = 0;
  double offset = 0;  ///< m, of its heights
  double west = 0, east = 60;
};

/// `density` points/m² of each strip, with errors of 0.03 m, on ground that rises by `slope`.
auto scan_of(const std::vector<Strip>& strips, double density, double slope, std::uint64_t seed = 1)
    -> std::vector<Sample> {
  base::Random random(seed);
  std::vector<Sample> out;
  for (const auto& [number, offset, west, east] : strips)
    for (double left = density * (east - west) * 60; left > 0; --left) {
      const double x = random.uniform(west, east), y = random.uniform(0, 60);
      out.push_back({{x, y, 2 + slope * x + offset + noise(random, 0.03)}, 2, 1, 1, number});
    }
  return out;
}

auto overlaps_of(const std::vector<Sample>& samples, double cell = 0.5) -> StripOverlaps {
  auto surface = Surface::open(cell, {});
  EXPECT_TRUE(surface);
  (*surface)->add(samples, std::nullopt);
  StripOverlaps out;
  for (const auto& tile : (*surface)->tiles()) out.include((*surface)->make(tile)->strips);
  return out;
}

TEST(Strips, that_differ_by_a_decimetre_are_found_within_a_centimetre) {
  for (const double slope : {0.0, 0.1}) {
    const auto found = strip_differences(overlaps_of(scan_of({{11, 0, 0, 40}, {12, 0.1, 20, 60}}, 8, slope)));
    ASSERT_EQ(found.size(), 1U) << slope;
    EXPECT_EQ(found[0].above, 12);
    EXPECT_EQ(found[0].below, 11);
    EXPECT_NEAR(found[0].height, 0.1, 0.01);
    EXPECT_NEAR(static_cast<double>(found[0].area), 20 * 60, 80);  // where both have three points
    // Of planes through eight points each: 0.03 m · √(2 / 8) a square metre and more, of which the median.
    EXPECT_NEAR(found[0].error, 1.2533 * 0.03 * std::sqrt(2.0 / 8) / std::sqrt(1200.0), 2e-4);
    EXPECT_THAT(differences_in_words(found), HasSubstr("strip 12 is 0."));
    EXPECT_THAT(differences_in_words(found), HasSubstr(" ± 0.001 m above strip 11, over 1"));
  }
}

TEST(Strips, that_are_lower_are_named_the_other_way_round) {
  const auto found = strip_differences(overlaps_of(scan_of({{11, 0, 0, 40}, {12, -0.08, 20, 60}}, 8, 0)));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].above, 11);
  EXPECT_NEAR(found[0].height, 0.08, 0.01);
}

TEST(Strips, that_are_one_strip_cut_in_two_do_not_differ) {
  auto samples = scan_of({{11, 0}}, 16, 0.05);
  for (std::size_t i = 0; i < samples.size(); i += 2) samples[i].strip = 12;
  const auto overlaps = overlaps_of(samples);
  ASSERT_EQ(overlaps.pairs().size(), 1U);
  EXPECT_THAT(strip_differences(overlaps), testing::IsEmpty());
}

TEST(Strips, are_compared_alike_whatever_the_order_of_points_and_the_tiles) {
  auto samples = scan_of({{11, 0, 0, 40}, {12, 0.1, 20, 60}, {40, 0.03, 0, 60}}, 6, 0.05);
  const auto expected = overlaps_of(samples);
  EXPECT_EQ(expected.pairs().size(), 3U);
  std::ranges::reverse(samples);
  EXPECT_EQ(overlaps_of(samples).pairs(), expected.pairs());
  EXPECT_EQ(overlaps_of(samples, 0.0625).pairs(), expected.pairs());
}

TEST(Strips, are_compared_on_flat_and_solid_places_only) {
  const auto area = [](std::vector<Sample> samples, const auto& change) {
    base::Random random(5);
    for (auto& s : samples) change(s, random);
    std::uint64_t sum = 0;
    const auto overlaps = overlaps_of(samples);
    for (const auto& [pair, heights] : overlaps.pairs())
      for (const auto& [height, metres] : heights) sum += metres;
    return sum;
  };
  const auto as_it_is = [](Sample&, base::Random&) {};
  const std::vector<Strip> two{{11, 0}, {12, 0.1}};
  const auto flat = scan_of(two, 8, 0);
  constexpr std::uint64_t most = 3300, few = 40;  // of 3,600 m²
  EXPECT_GT(area(flat, as_it_is), most);
  EXPECT_LT(area(scan_of(two, 8, 0.3), as_it_is), few) << "steeper than 10°";
  EXPECT_LT(area(flat, [](Sample& s, base::Random& random) { s.position.z += random.uniform(0, 2); }), few) << "rough";
  EXPECT_EQ(area(flat, [](Sample& s, base::Random&) { s.classification = 5; }), 0U) << "vegetation";
  EXPECT_EQ(area(flat, [](Sample& s, base::Random&) { s.classification = 1, s.returns = 2; }), 0U) << "not solid";
  EXPECT_GT(area(flat, [](Sample& s, base::Random&) { s.classification = 1; }), most) << "only returns";
  EXPECT_EQ(area(flat, [](Sample& s, base::Random&) { s.strip = s.strip == 11 ? 0 : 12; }), 0U) << "not known";
}

TEST(Strips, of_more_pairs_than_a_survey_has_are_not_compared) {
  StripOverlaps all;
  for (std::uint16_t i = 1; i <= 2000; ++i) all.add({0, i}, 0.5);
  EXPECT_EQ(all.pairs().size(), 2000U);
  StripOverlaps more;
  more.add({1, 2}, 0.5);
  all.include(more);
  EXPECT_TRUE(all.pairs().empty());
  all.add({1, 2}, 0.5);
  EXPECT_TRUE(all.pairs().empty()) << "for good";
}

TEST(Strips, whose_difference_is_small_or_over_little_area_are_not_told) {
  const auto told = [](double height, int area) {
    StripOverlaps overlaps;
    for (int i = 0; i < area; ++i) overlaps.add({1, 2}, height + 0.001 * (i % 5 - 2));
    return strip_differences(overlaps).size();
  };
  EXPECT_EQ(told(0.05, 100), 1U);
  EXPECT_EQ(told(0.018, 100), 0U);
  EXPECT_EQ(told(0.05, 20), 0U);
  StripOverlaps wide;  // 0.03 m, and a standard error of 0.02 m
  for (int i = 0; i < 400; ++i) wide.add({1, 2}, 0.03 + 0.002 * (i - 200));
  EXPECT_THAT(strip_differences(wide), testing::IsEmpty());
}

TEST(Strips, are_told_with_the_largest_differences_first) {
  StripOverlaps overlaps;
  for (std::uint16_t k = 2; k < 9; ++k)
    for (int i = 0; i < 40; ++i) overlaps.add({1, k}, 0.01 * k);
  const auto words = differences_in_words(strip_differences(overlaps));
  EXPECT_TRUE(words.starts_with("strip 8 is 0.080 ± 0.001 m above strip 1, over 40 m²; strip 7 is 0.070")) << words;
  EXPECT_TRUE(words.ends_with("; and 1 more")) << words;
  EXPECT_EQ(differences_in_words({}), "");
}

}  // namespace
}  // namespace mansard::cloud
