#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mansard/base/run.hpp"
#include "mansard/profile/detail/caps.hpp"
#include "mansard/profile/detail/pitches.hpp"
#include "mansard/profile/detail/refine.hpp"
#include "mansard/profile/detail/runs.hpp"

namespace {

using namespace mansard::profile::detail;  // NOLINT: the parts under test
using mansard::geometry::Polygon;
using mansard::model::Profile;

const double bin = mansard::profile::Options{}.column_width;

auto columns(std::size_t count, double (*height)(double), double noise = 0, std::uint64_t seed = 1)
    -> std::vector<Pooled> {
  mansard::base::Random random(seed);
  std::vector<Pooled> out;
  for (std::size_t b = 0; b < count; ++b) {
    const double u = (static_cast<double>(b) + 0.5) * bin;
    out.push_back({u, height(u) + random.uniform(-noise, noise), 10});
  }
  return out;
}

TEST(Fit_line, finds_one_pitch_and_no_more_under_noise) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto line = fit_line(columns(
                                   25, [](double u) { return 6 + 0.8 * u; }, 0.1, seed),
                               3);
    ASSERT_EQ(line.size(), 2U) << seed;
    EXPECT_NEAR(line[0].height, 6, 0.15);
    EXPECT_NEAR((line[1].height - line[0].height) / line[1].inward, 0.8, 0.05);
  }
}

TEST(Fit_line, finds_the_knots_of_two_and_three_pitches) {
  const auto two =
      fit_line(columns(
                   30, [](double u) { return 6 + 2 * std::min(u, 2.0) + 0.4 * std::max(0.0, u - 2); }, 0.05),
               3);
  ASSERT_EQ(two.size(), 3U);
  EXPECT_NEAR(two[1].inward, 2, 0.25);
  const auto three =
      fit_line(columns(
                   40,
                   [](double u) {
                     return 6 + 2.5 * std::min(u, 2.0) + 1.0 * std::clamp(u - 2, 0.0, 3.0) + 0.2 * std::max(0.0, u - 5);
                   },
                   0.03),
               3);
  ASSERT_EQ(three.size(), 4U);
  EXPECT_NEAR(three[1].inward, 2, 0.3);
  EXPECT_NEAR(three[2].inward, 5, 0.4);
}

TEST(Fit_line, keeps_to_the_number_of_pitches_allowed) {
  const auto bent = columns(30, [](double u) { return 6 + 2 * std::min(u, 2.0) + 0.4 * std::max(0.0, u - 2); });
  EXPECT_EQ(fit_line(bent, 1).size(), 2U);
  EXPECT_EQ(fit_line(bent, 2).size(), 3U);
}

TEST(Fit_line, is_the_least_squares_line_of_a_slow_solution) {
  mansard::base::Random random(9);
  std::vector<Pooled> data;
  for (int b = 0; b < 12; ++b)
    data.push_back({b * bin, 5 + 0.5 * b * bin + random.uniform(-0.05, 0.05), random.uniform(1, 10)});
  const auto line = fit_line(data, 1);
  const auto error = [&](double a, double s) {
    double sum = 0;
    for (const auto& c : data) sum += c.weight * std::pow(a + s * c.inward - c.height, 2);
    return sum;
  };
  const double a = line[0].height, s = (line[1].height - line[0].height) / line[1].inward;
  for (const double da : {-1e-3, 0.0, 1e-3})
    for (const double ds : {-1e-3, 0.0, 1e-3}) EXPECT_GE(error(a + da, s + ds), error(a, s) - 1e-12);
}

TEST(Fit_line, refuses_too_few_columns) {
  EXPECT_TRUE(fit_line(columns(3, [](double u) { return u; }), 3).empty());
}

TEST(Profile_from, makes_a_wall_and_pitches) {
  EXPECT_EQ(profile_from({{0, 6}, {2, 10}, {5, 11}}), (Profile{{0, 0}, {0, 6}, {2, 10}, {5, 11}}));
}

TEST(Profile_from, leaves_level_ends_to_the_cap) {
  const auto mansard = profile_from({{0, 6}, {2, 10}, {5, 10.05}});
  EXPECT_EQ(mansard, (Profile{{0, 0}, {0, 6}, {2, 10}}));
  EXPECT_EQ(profile_from({{0, 6}, {5, 6.1}}).back().inward, 0);
}

TEST(Profile_from, takes_what_gains_little_for_a_rounded_edge) {
  EXPECT_EQ(profile_from({{0, 6}, {1.5, 6.4}}), vertical_profile(6));
}

TEST(Profile_from, turns_the_almost_vertical_upright_at_its_middle) {
  // A second wall, blurred over 0.4 m, stands 3 m in.
  const auto profile = profile_from({{0, 4}, {2.8, 5.4}, {3.2, 10}, {6, 11.4}});
  ASSERT_EQ(profile.size(), 5U);
  EXPECT_NEAR(profile[2].inward, 3, 1e-9);
  EXPECT_NEAR(profile[3].inward, 3, 1e-9);
  EXPECT_NEAR(profile[2].height, 5.5, 1e-9);
  EXPECT_NEAR(profile[3].height, 9.9, 1e-9);
  // At the foot it is the wall; at the end a wall that no roof follows.
  EXPECT_NEAR(profile_from({{0, 4}, {0.4, 9}, {3.4, 10.5}})[1].height, 8.8, 1e-9);
  EXPECT_EQ(profile_from({{0, 4}, {3, 6}, {3.2, 10}}).size(), 3U);
}

TEST(Profile_from, never_falls_and_wants_a_wall_below) {
  const auto profile = profile_from({{0, -1}, {4, 3}, {6, 2.5}, {8, 5}});
  EXPECT_GT(profile[1].height, 0);
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) EXPECT_LE(profile[i].height, profile[i + 1].height);
}

TEST(Supported, cuts_off_what_too_few_slices_show) {
  std::vector<SliceColumns> slices(10);
  for (std::size_t s = 0; s < slices.size(); ++s) {
    // All slices follow the lower pitch, one only the upper.
    slices[s].heights.resize(30);
    for (std::size_t b = 0; b < 30; ++b) {
      const double u = (static_cast<double>(b) + 0.5) * bin;
      slices[s].heights[b] = 6 + u + (s > 0 && u > 3 ? -1.5 : 0);
    }
    slices[s].last = 30;
  }
  const RoofLine line{{0, 6}, {3, 9}, {6, 12}};
  const mansard::profile::Options tenth{.support = 0.1};
  EXPECT_EQ(supported(line, slices, 0.3).size(), 2U);
  EXPECT_EQ(supported(line, slices, 0.3, tenth).size(), 3U);
  EXPECT_EQ(supported(line, slices, 2.0).size(), 3U);
  const RoofLine wrong{{0, 9}, {3, 12}};
  EXPECT_TRUE(supported(wrong, slices, 0.3).empty());
}

/// Twenty slices 8 m deep with that height over them.
auto slices_with(double (*height)(double)) -> std::vector<SliceColumns> {
  std::vector<SliceColumns> slices(20);
  for (std::size_t s = 0; s < slices.size(); ++s) {
    slices[s].along = 0.2 * static_cast<double>(s);
    for (std::size_t b = 0; b < 40; ++b) slices[s].heights.push_back(height((static_cast<double>(b) + 0.5) * bin));
  }
  return slices;
}

TEST(Setback, is_found_before_a_wall_and_taken_off) {
  const auto slices = slices_with([](double u) { return u < 2 ? 3.0 : 7 + 0.5 * u; });
  const auto found = find_setback(slices);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->depth, 2, 1e-9);
  EXPECT_NEAR(found->height, 3, 1e-9);
  const auto rest = behind(slices, *found);
  ASSERT_EQ(rest.size(), slices.size());
  EXPECT_EQ(rest[0].heights.size(), 40 - static_cast<std::size_t>(found->depth / bin + 0.5));
  EXPECT_EQ(rest[0].heights.back(), slices[0].heights.back());
}

TEST(Setback, is_no_pitch_parapet_yard_or_chimney) {
  EXPECT_FALSE(find_setback(slices_with([](double u) { return 6 + u; })));
  EXPECT_FALSE(find_setback(slices_with([](double u) { return u < 0.4 ? 9.0 : 8.0; })));
  EXPECT_FALSE(find_setback(slices_with([](double u) { return u < 3 ? 0.2 : 8.0; })));
  auto slices = slices_with([](double) { return 8.0; });
  for (std::size_t s = 0; s < 6; ++s)
    for (std::size_t b = 15; b < 20; ++b) slices[s].heights[b] = 11;
  EXPECT_FALSE(find_setback(slices));
}

TEST(Setback, has_a_level_column_before_what_the_scan_smears_whatever_the_options_say) {
  // A wall after the first columns, so that options with fewer columns before the wall than it smears meet it.
  for (const std::size_t blur : {1, 2, 4, 8})
    for (const std::size_t depth : {1, 2, 4, 8})
      for (std::size_t columns = 0; columns < 12; ++columns) {
        auto slices = slices_with([](double) { return 8.0; });
        for (auto& slice : slices)
          for (std::size_t b = 0; b < columns; ++b) slice.heights[b] = 3;
        const auto found = find_setback(slices, {.setback_blur = blur, .setback_depth = depth});
        EXPECT_EQ(found.has_value(), columns >= std::max(depth, blur + 1)) << blur << " " << depth << " " << columns;
        if (found) {
          EXPECT_NEAR(found->depth, static_cast<double>(columns) * bin, 1e-9);
        }
      }
}

TEST(Rising, belongs_to_the_run_only_where_it_rises_inward_and_hardly_along) {
  auto slices = slices_with([](double u) { return 6 + 0.7 * u; });
  find_rising(slices);
  for (const auto& slice : slices) EXPECT_GT(slice.last - slice.first, 30U);
  // The same roof seen from its gable end: as steep along the run, level inward; and seen askew.
  for (const double across : {0.0, 0.35}) {
    auto gable = slices_with([](double) { return 6.0; });
    for (auto& slice : gable)
      for (std::size_t b = 0; b < slice.heights.size(); ++b)
        slice.heights[b] += 0.7 * slice.along + across * static_cast<double>(b) * bin;
    find_rising(gable);
    for (const auto& slice : gable) EXPECT_EQ(slice.first, slice.last);
  }
}

TEST(Rising, stops_at_the_ridge) {
  auto slices = slices_with([](double u) { return 10 - 0.7 * std::abs(u - 4); });
  find_rising(slices);
  for (const auto& slice : slices) {
    EXPECT_GT(static_cast<double>(slice.last) * bin, 3);
    EXPECT_LE(static_cast<double>(slice.last) * bin, 4.2);
  }
}

TEST(Runs, end_where_a_curve_begins) {
  Polygon church;  // a nave, and twelve chords of a half circle
  for (int i = 0; i <= 12; ++i) {
    const double angle = 3.14159265358979 * (i / 12.0 - 0.5);
    church.outer.push_back({20 + 5 * std::cos(angle), 5 + 5 * std::sin(angle)});
  }
  church.outer.push_back({0, 10});
  church.outer.push_back({0, 0});
  const auto runs = runs_of(church, 0.1);
  ASSERT_EQ(runs.size(), 4U);
  std::vector<std::size_t> lengths;
  for (const auto& run : runs) lengths.push_back(run.edges.size());
  std::ranges::sort(lengths);
  EXPECT_EQ(lengths, (std::vector<std::size_t>{1, 1, 1, 12}));
}

TEST(Runs, know_the_neighbours_they_hardly_turn_from) {
  const Polygon polygon{{{0, 0}, {9, 0}, {10, 0.3}, {10, 8}, {0, 8}}, {}};
  const auto runs = runs_of(polygon, 0.1);
  ASSERT_EQ(runs.size(), 5U);
  EXPECT_EQ(gentle_neighbours(polygon, runs, 1), (std::vector<std::size_t>{0}));
  EXPECT_EQ(gentle_neighbours(polygon, runs, 0), (std::vector<std::size_t>{1}));
  EXPECT_TRUE(gentle_neighbours(polygon, runs, 3).empty());
}

TEST(Caps, put_the_commonest_level_first_for_flat_roofs) {
  std::vector<double> heights;
  for (int i = 0; i < 100; ++i) heights.push_back(i < 10 ? 3.0 : i < 80 ? 9.0 + 0.001 * i : 12.0);
  const std::vector<double> tops{9.8, 9.7};
  const auto caps = caps_from(heights, tops, false, 3);
  EXPECT_NEAR(caps.front(), 9.05, 0.1);
  for (const double cap : caps) {
    EXPECT_GE(cap, 3);
    EXPECT_LE(cap, 12);
  }
}

TEST(Caps, let_pitched_roofs_close_first) {
  std::vector<double> heights;
  for (int i = 0; i < 1000; ++i) heights.push_back(6 + 0.004 * i);
  const std::vector<double> tops{9.5, 9.6};
  const auto caps = caps_from(heights, tops, true, 3);
  EXPECT_GT(caps.front(), 9.8);
  for (std::size_t i = 0; i < caps.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(std::abs(caps[i] - caps[j]), 0.1);
}

TEST(Caps, assume_a_height_where_nothing_was_seen) { EXPECT_EQ(caps_from({}, {}, false, 3), std::vector<double>{3}); }

TEST(Runs, join_edges_that_hardly_turn_and_start_at_a_corner) {
  //   5---4---3
  //   |       |
  //   0---1---2      the ring begins in the middle of the south side
  const Polygon polygon{{{5, 0}, {10, 0}, {10, 8}, {5, 8.1}, {0, 8}, {0, 0}}, {}};
  const auto runs = runs_of(polygon, 0.1);
  ASSERT_EQ(runs.size(), 4U);
  EXPECT_EQ(runs[0].edges, (std::vector<std::size_t>{1}));
  EXPECT_EQ(runs[1].edges, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(runs[3].edges, (std::vector<std::size_t>{5, 0}));
  EXPECT_NEAR(length_of(polygon, runs[3]), 10, 1e-12);
}

TEST(Runs, make_one_of_a_circle_and_see_a_spike_turn) {
  Polygon circle;
  for (int i = 0; i < 100; ++i) circle.outer.push_back({std::cos(0.0628318 * i), std::sin(0.0628318 * i)});
  EXPECT_EQ(runs_of(circle, 0.1).size(), 1U);
  const Polygon spike{{{0, 0}, {10, 0}, {0, 0.01}}, {}};
  EXPECT_EQ(runs_of(spike, 0.1).size(), 3U);
}

TEST(Runs, slice_only_as_deep_as_the_polygon_goes) {
  const Polygon polygon{{{0, 0}, {10, 0}, {10, 8}, {0, 8}}, {{{4, 3}, {4, 5}, {6, 5}, {6, 3}}}};
  const auto samples = samples_of(polygon, {0, {0}});
  ASSERT_GT(samples.size(), 40U);
  for (const auto& sample : samples) {
    EXPECT_GE(sample.along, 0.3);
    EXPECT_LE(sample.along, 9.7);
    if (std::abs(std::abs(sample.foot.x - 5) - 1) < 1e-9) continue;  // before a corner of the hole either will do
    const bool before_hole = sample.foot.x > 4 && sample.foot.x < 6;
    EXPECT_NEAR(sample.reach, before_hole ? 3 : 8, 1e-9) << sample.foot.x;
  }
  // The hole's south side looks south.
  const auto hole = samples_of(polygon, {1, {3}});
  for (const auto& sample : hole) EXPECT_NEAR(sample.reach, 3, 1e-9);
}

TEST(Runs, slice_long_edges_a_hundred_times_at_most_and_short_ones_once) {
  const Polygon polygon{{{0, 0}, {300, 0}, {300, 0.1}, {0, 0.1}}, {}};
  EXPECT_EQ(samples_of(polygon, {0, {0}}).size(), 100U);
  EXPECT_EQ(samples_of(polygon, {0, {1}}).size(), 1U);
}

TEST(Refine, drops_a_pitch_that_the_scan_contradicts) {
  const Polygon polygon{{{0, 0}, {10, 0}, {10, 8}, {0, 8}}, {}};
  const auto runs = runs_of(polygon, 0.1);
  const Profile wall{{0, 0}, {0, 6}}, pitch{{0, 0}, {0, 6}, {4, 9}};
  std::vector<RoofSample> gable, flat;
  for (double x = 0.25; x < 10; x += 0.5)
    for (double y = 0.25; y < 8; y += 0.5) {
      gable.push_back({{x, y}, 6 + 0.75 * std::min(y, 8 - y)});
      flat.push_back({{x, y}, 6});
    }
  // South, east, north, west: all think they have a roof of their own.
  const std::vector<Choices> choices(4, {{pitch, wall}, 10});
  const std::vector<double> caps{9, 6};
  EXPECT_EQ(refine(polygon, runs, choices, gable, caps).chosen, (std::vector<std::size_t>{0, 1, 0, 1}));
  const auto level = refine(polygon, runs, choices, flat, caps);
  EXPECT_NEAR(level.errors[1], 0, 1e-9);
  // What agrees stays as it is.
  const std::vector<Choices> right{{{pitch, wall}, 8}, {{wall, pitch}, 10}, {{pitch, wall}, 8}, {{wall, pitch}, 10}};
  EXPECT_EQ(refine(polygon, runs, right, gable, caps).chosen, (std::vector<std::size_t>{0, 0, 0, 0}));
  EXPECT_NEAR(refine(polygon, runs, right, gable, caps).errors[0], 0, 1e-9);
}

}  // namespace
