#include "mansard/sweep/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "sweep/town.hpp"

namespace mansard::sweep {
namespace {

auto house(double noise = 0.05, std::uint64_t seed = 1) -> Town {
  Town town(noise, seed);
  town.ground({-8, -8}, {22, 16});
  town.gabled({0, 0}, {14, 8}, 6, 9);
  town.footprint({0.3, 0.2}, {14.2, 8.1});
  return town;
}

/// Two houses along x that share the wall at x = 10, the second higher by `step`.
auto terrace(double step) -> Town {
  Town town(0.05);
  town.ground({-6, -6}, {26, 18});
  town.box({0, 0}, {10, 12}, 0, 7);
  town.wall({10, 0}, {20, 0}, 0, 7 + step);
  town.wall({20, 0}, {20, 12}, 0, 7 + step);
  town.wall({20, 12}, {10, 12}, 0, 7 + step);
  town.wall({10, 12}, {10, 0}, 7, 7 + step);
  town.flat({10, 0}, {20, 12}, 7 + step);
  town.footprint({0, 0}, {10, 12});
  town.footprint({10, 0}, {20, 12});
  return town;
}

TEST(FindEdges, gives_a_gabled_house_its_four_walls) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto found = edges_of(house(0.08, seed).block());
    EXPECT_EQ(found.edges.size(), 4u) << "seed " << seed;
    EXPECT_EQ(followers(found, {0, 8}, {14, 8}), 1) << "seed " << seed;
    EXPECT_EQ(followers(found, {14, 8}, {14, 0}), 1) << "seed " << seed;
    EXPECT_EQ(followers(found, {14, 0}, {0, 0}), 1) << "seed " << seed;
    EXPECT_EQ(followers(found, {0, 0}, {0, 8}), 1) << "seed " << seed;
    for (const auto& e : found.edges) {
      EXPECT_LT(e.low, 1.5);
      EXPECT_GT(e.high, 5);
    }
  }
}

TEST(FindEdges, works_at_any_angle) {
  for (const double turn : {0.1, 0.7, std::numbers::pi / 4, 1.5, 2.9, -2.0}) {
    const auto found = edges_of(house().block(turn));
    const auto at = [&](Point2 p) {
      return Point2{std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y};
    };
    EXPECT_EQ(found.edges.size(), 4u) << turn;
    EXPECT_EQ(followers(found, at({0, 8}), at({14, 8})), 1) << turn;
    EXPECT_EQ(followers(found, at({0, 0}), at({0, 8})), 1) << turn;
  }
}

TEST(FindEdges, is_the_same_a_few_kilometres_away) {
  const auto here = edges_of(house().block()), there = edges_of(house().block(0, {3000, -5000}));
  ASSERT_EQ(here.edges.size(), there.edges.size());
  for (std::size_t i = 0; i < here.edges.size(); ++i) {
    EXPECT_LT(length(here.edges[i].segment.start + Point2{3000, -5000} - there.edges[i].segment.start), 1e-3);
    EXPECT_LT(length(here.edges[i].segment.end + Point2{3000, -5000} - there.edges[i].segment.end), 1e-3);
  }
}

TEST(FindEdges, finds_the_step_between_terraced_houses) {
  const auto found = edges_of(terrace(1.2).block(), {.gamma = 9});
  EXPECT_EQ(followers(found, {10, 0}, {10, 12}, 0.3, 0.8), 1) << "outside is the lower house's";
  EXPECT_EQ(followers(edges_of(terrace(0.2).block(), {.gamma = 9}), {10, 0}, {10, 12}, 0.3, 0.5), 0);
}

TEST(FindEdges, keeps_the_area_promise_and_the_order) {  // guarantees 1 and 3
  for (const double gamma : {0.0, 5.0, 10.0, 40.0, 70.0}) {
    const auto found = edges_of(terrace(2).block(), {.gamma = gamma});
    for (const auto& e : found.edges) {
      ASSERT_LT(e.cluster, found.clusters.size());
      EXPECT_GE(found.clusters[e.cluster].area, gamma);
      EXPECT_GT(length(e.segment.end - e.segment.start), 0);
      EXPECT_LE(e.low, e.high);
    }
    for (const auto& c : found.clusters) {
      double sum = 0;
      for (const auto& l : c.lines) sum += 0.2 * length(l.segment.end - l.segment.start);
      EXPECT_NEAR(sum, c.area, 1e-6);
      EXPECT_TRUE(std::is_sorted(c.lines.begin(), c.lines.end(),
                                 [](const Line& a, const Line& b) { return a.slice < b.slice; }));
    }
    EXPECT_TRUE(std::is_sorted(found.edges.begin(), found.edges.end(), [](const SweepEdge& a, const SweepEdge& b) {
      return std::llround(100 * length(a.segment.end - a.segment.start)) >
             std::llround(100 * length(b.segment.end - b.segment.start));
    }));
  }
}

TEST(FindEdges, drops_more_as_gamma_grows) {
  const auto block = terrace(2).block();
  auto before = edges_of(block, {.gamma = 0}).edges.size();
  EXPECT_GE(before, 5u);
  for (const double gamma : {5.0, 15.0, 30.0, 75.0, 1000.0}) {
    const auto now = edges_of(block, {.gamma = gamma}).edges.size();
    EXPECT_LE(now, before);
    before = now;
  }
  EXPECT_EQ(before, 0u);
}

TEST(FindEdges, does_not_depend_on_the_order_of_triangles) {  // guarantee 2
  auto block = terrace(2).block();
  const auto before = edges_of(block);
  base::Random random(5);
  for (std::size_t i = block.mesh.triangles.size(); i > 1; --i)
    std::swap(block.mesh.triangles[i - 1], block.mesh.triangles[random.index(i)]);
  const auto after = edges_of(block);
  ASSERT_EQ(before.edges.size(), after.edges.size());
  for (std::size_t i = 0; i < before.edges.size(); ++i) EXPECT_EQ(before.edges[i].segment, after.edges[i].segment);
}

TEST(FindEdges, gives_the_same_at_any_number_of_threads) {  // guarantee 2
  const auto block = terrace(2).block();
  base::limit_threads(1);
  const auto one = edges_of(block);
  base::limit_threads(4);
  const auto four = edges_of(block);
  base::limit_threads(0);
  ASSERT_EQ(one.edges.size(), four.edges.size());
  for (std::size_t i = 0; i < one.edges.size(); ++i) {
    EXPECT_EQ(one.edges[i].segment, four.edges[i].segment);
    EXPECT_EQ(one.edges[i].area, four.edges[i].area);
    EXPECT_EQ(one.edges[i].low, four.edges[i].low);
    EXPECT_EQ(one.edges[i].high, four.edges[i].high);
  }
}

TEST(FindEdges, is_not_led_astray_by_buses_cars_and_fences) {
  auto town = house();
  town.box({2, -4.5}, {10, -2.2}, 0, 3.2);  // a bus before the house
  town.box({-2.5, 1}, {-0.9, 5}, 0, 1.5);   // a car beside it
  town.wall({14, 9.5}, {0, 9.5}, 0, 1.8);   // a fence behind it
  town.wall({0, 9.3}, {14, 9.3}, 0, 1.8);
  const auto found = edges_of(town.block());
  EXPECT_EQ(found.edges.size(), 4u);
  EXPECT_EQ(followers(found, {14, 0}, {0, 0}), 1);
  EXPECT_EQ(followers(found, {0, 0}, {0, 8}, 0.3), 1);
}

TEST(FindEdges, keeps_a_low_shed_that_has_a_footprint) {
  Town town(0.05);
  town.ground({-6, -6}, {14, 12});
  town.box({0, 0}, {8, 6}, 0, 2.6);
  town.footprint({0, 0}, {8, 6});
  EXPECT_EQ(edges_of(town.block(), {.gamma = 10}).edges.size(), 4u);
}

TEST(FindEdges, puts_the_foot_of_a_stepped_wall_at_its_lower_storeys) {
  Town town(0.05);  // the ground floor stands out by 0.6 m: one side, one foot, and the rest is a matter of its profile
  town.ground({-6, -6}, {18, 16});
  town.box({0, 0}, {12, 10}, 0, 4.5);
  town.box({0.6, 0.6}, {11.4, 9.4}, 4.5, 9);
  town.footprint({0, 0}, {12, 10});
  const auto found = edges_of(town.block());
  EXPECT_EQ(followers(found, {0, 10}, {12, 10}), 1);
  EXPECT_EQ(followers(found, {0, 0}, {0, 10}), 1);
}

TEST(FindEdges, gives_a_tower_on_a_broad_base_walls_of_its_own) {
  Town town(0.05);
  town.ground({-6, -6}, {26, 26});
  town.box({0, 0}, {20, 20}, 0, 5);
  town.box({5, 5}, {15, 15}, 5, 15);
  town.footprint({0, 0}, {20, 20});
  const auto found = edges_of(town.block());
  EXPECT_EQ(followers(found, {0, 20}, {20, 20}), 1);
  EXPECT_EQ(followers(found, {5, 15}, {15, 15}), 1);
  EXPECT_EQ(found.edges.size(), 8u);
}

TEST(FindEdges, finds_the_gutters_of_a_roof_whose_walls_were_not_seen) {
  Town town(0.05);
  town.ground({-8, -8}, {22, 16});
  town.patch({0, 0, 6}, {14, 0, 6}, {14, 4, 9}, {0, 4, 9});
  town.patch({14, 8, 6}, {0, 8, 6}, {0, 4, 9}, {14, 4, 9});
  town.footprint({0, 0}, {14, 8});
  const auto found = edges_of(town.block());
  EXPECT_EQ(found.edges.size(), 2u);
  EXPECT_EQ(followers(found, {0, 8}, {14, 8}, 0.5), 1);
  EXPECT_EQ(followers(found, {14, 0}, {0, 0}, 0.5), 1);
}

TEST(FindEdges, runs_one_edge_along_a_facade_with_a_narrow_recess) {
  Town town(0.05);
  town.ground({-6, -6}, {22, 16});
  town.box({0, 0}, {7, 10}, 0, 8);
  town.box({8.4, 0}, {16, 10}, 0, 8);
  town.box({6, 4}, {9, 10}, 0, 8);
  town.footprint({0, 0}, {16, 10});
  const auto found = edges_of(town.block());
  EXPECT_EQ(followers(found, {16, 0}, {0, 0}), 1);
}

TEST(FindEdges, leaves_out_what_stands_far_from_the_footprints) {
  auto town = house();
  town.box({0, 30}, {14, 38}, 0, 6);
  EXPECT_EQ(edges_of(town.block()).edges.size(), 4u);
}

TEST(FindEdges, takes_a_block_without_footprints_as_it_is) {
  Town town(0.05);
  town.box({0, 0}, {12, 10}, 0, 8);
  EXPECT_EQ(edges_of(town.block()).edges.size(), 4u);
}

TEST(FindEdges, shrugs_off_stray_vertices) {
  auto block = house().block();
  const auto before = edges_of(block);
  block.mesh.vertices.push_back({1e9, -3e8, 7});
  block.mesh.vertices.push_back({4e8, 4e8, -2e7});
  const auto n = static_cast<std::uint32_t>(block.mesh.vertices.size());
  block.mesh.triangles.push_back({0, n - 2, n - 1});
  const auto after = edges_of(block);
  ASSERT_EQ(before.edges.size(), after.edges.size());
  for (std::size_t i = 0; i < before.edges.size(); ++i) EXPECT_EQ(before.edges[i].segment, after.edges[i].segment);
}

TEST(FindEdges, of_nothing_is_empty) {
  const auto found = edges_of(block::Block{});
  EXPECT_TRUE(found.edges.empty());
  EXPECT_TRUE(found.clusters.empty());
  EXPECT_TRUE(find_edges({}, house().block(), {}).edges.empty());
}

TEST(FindEdges, stops_when_asked) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  const auto block = house().block();
  EXPECT_TRUE(find_edges(slice::cut(block, {}), block, {}, run).edges.empty());
}

TEST(FindEdges, reports_its_progress_in_order) {
  std::vector<double> seen;
  base::Run run;
  run.progress = [&](std::string_view stage, std::string_view subject, double fraction) {
    EXPECT_EQ(stage, "sweep");
    EXPECT_EQ(subject, "town");
    seen.push_back(fraction);
  };
  const auto block = house().block();
  (void)find_edges(slice::cut(block, {}), block, {}, run);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back(), 1.0);
}

TEST(SweepOptions, are_listed_with_their_defaults) {
  Options options;
  const auto list = option_list(options);
  EXPECT_EQ(std::ranges::count(list.options(), false, &base::Option::advanced), 10);
  EXPECT_EQ(list.find("gamma")->get(), "10");
  EXPECT_EQ(list.find("gamma")->alias, "gamma");
  EXPECT_TRUE(list.find("gamma")->set("30"));
  EXPECT_EQ(options.gamma, 30);
  for (const auto& o : list.options()) EXPECT_TRUE(o.set(o.get())) << o.name << ": the default must be in range";
}

}  // namespace
}  // namespace mansard::sweep
