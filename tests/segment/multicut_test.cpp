#include "mansard/segment/detail/multicut.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "mansard/segment/detail/local_search.hpp"
#include "planar.hpp"

namespace mansard::segment {
namespace {

using detail::cost_of, detail::Labels, detail::Multicut, detail::MulticutAnswer;
using testing::random_grid, testing::Weights;

void expect_sound(const Multicut& problem, const MulticutAnswer& answer) {
  ASSERT_EQ(answer.labels.size(), problem.nodes);
  ASSERT_TRUE(cost_of(problem, answer.labels).has_value());
  EXPECT_EQ(*cost_of(problem, answer.labels), answer.objective);
  EXPECT_LE(answer.bound, answer.objective);
  EXPECT_EQ(answer.optimal, answer.bound == answer.objective);
  EXPECT_EQ(detail::canonical(problem, answer.labels), answer.labels) << "every label is one connected piece";
}

TEST(Multicut, equals_the_best_of_all_partitions) {
  base::Random random(7);
  using Size = std::pair<std::uint32_t, std::uint32_t>;
  const std::vector<Size> sizes{{1, 1}, {2, 1}, {2, 2}, {5, 1}, {3, 2}, {4, 2}, {3, 3}};
  for (int round = 0; round < 12; ++round)
    for (const auto& [columns, rows] : sizes)
      for (const double forced : {0.0, 0.15}) {
        const Weights weights{1000, static_cast<std::int64_t>(random.index(3000)), 0.7, forced};
        const Multicut problem = random_grid(columns, rows, weights, random);
        const MulticutAnswer answer = detail::solve(problem, {});
        SCOPED_TRACE("round " + std::to_string(round) + ", " + std::to_string(columns) + " by " + std::to_string(rows));
        expect_sound(problem, answer);
        EXPECT_TRUE(answer.optimal);
        EXPECT_EQ(answer.objective, testing::least_by_trying_all(problem));
      }
}

TEST(Multicut, equals_the_best_of_all_partitions_without_star_rows) {
  base::Random random(8);
  for (int round = 0; round < 25; ++round) {
    Multicut problem = random_grid(3, 3, {1000, 800, 0.5, round % 2 == 0 ? 0.0 : 0.2}, random);
    problem.stars.clear();  // cycle rows alone must do
    const MulticutAnswer answer = detail::solve(problem, {});
    expect_sound(problem, answer);
    EXPECT_EQ(answer.objective, testing::least_by_trying_all(problem)) << round;
  }
}

TEST(Multicut, adds_cycle_rows_until_no_wall_has_one_piece_on_both_sides) {
  base::Random random(11);
  std::int64_t most_rounds = 0;
  for (int round = 0; round < 40; ++round) {
    Multicut problem = random_grid(5, 5, {1000, 0, 0, 0}, random);
    problem.stars.clear();
    const MulticutAnswer answer = detail::solve(problem, {});
    expect_sound(problem, answer);
    EXPECT_TRUE(answer.optimal);
    most_rounds = std::max(most_rounds, answer.rounds);
  }
  EXPECT_GT(most_rounds, 1) << "the rounds are exercised";
}

TEST(Multicut, equals_the_four_colour_model_on_larger_grids) {
  base::Random random(21);
  for (const auto& [columns, rows] : {std::pair{5U, 4U}, {5U, 5U}, {6U, 4U}}) {
    const Multicut problem = random_grid(columns, rows, {1000, 700, 0.4, 0.03}, random);
    const MulticutAnswer answer = detail::solve(problem, {});
    expect_sound(problem, answer);
    EXPECT_TRUE(answer.optimal);
    EXPECT_EQ(answer.objective, testing::least_by_four_colours(problem));
  }
}

TEST(Multicut, does_not_depend_on_the_order_of_nodes_and_edges) {
  base::Random random(31);
  for (int round = 0; round < 10; ++round) {
    const Multicut problem = random_grid(6, 5, {1000, 900, 0.6, 0.05}, random);
    std::vector<std::uint32_t> node(problem.nodes), edge(problem.edges.size());
    std::iota(node.begin(), node.end(), 0U);
    std::iota(edge.begin(), edge.end(), 0U);
    for (auto* order : {&node, &edge})
      for (std::size_t i = order->size(); i-- > 1;) std::swap((*order)[i], (*order)[random.index(i + 1)]);
    Multicut shuffled = problem;
    for (std::size_t e = 0; e < edge.size(); ++e) {
      const auto& old = problem.edges[e];
      shuffled.edges[edge[e]] = {node[old.b], node[old.a], old.cost, old.forced};
    }
    for (auto& pair : shuffled.pairs) pair = {edge[pair.second], edge[pair.first], pair.penalty};
    for (auto& star : shuffled.stars)
      for (auto& e : star) e = edge[e];
    EXPECT_EQ(detail::solve(problem, {}).objective, detail::solve(shuffled, {}).objective) << round;
  }
}

TEST(Multicut, recovers_a_planted_partition) {
  base::Random random(41);
  for (int round = 0; round < 10; ++round) {
    Multicut problem = random_grid(8, 8, {1000, 0, 0, 0}, random);
    Labels planted(problem.nodes);
    for (std::uint32_t v = 0; v < problem.nodes; ++v) planted[v] = (v % 8 / 3) * 10 + v / 8 / 3;
    for (auto& e : problem.edges)
      e.cost = static_cast<std::int64_t>(random.uniform(100, 1000)) * (planted[e.a] == planted[e.b] ? 1 : -1);
    const MulticutAnswer answer = detail::solve(problem, {});
    EXPECT_EQ(answer.labels, detail::canonical(problem, planted));
    EXPECT_TRUE(answer.optimal);
  }
}

TEST(Multicut, joins_everything_or_nothing_at_the_limits) {
  base::Random random(51);
  Multicut problem = random_grid(7, 6, {1000, 0, 0, 0}, random);
  for (auto& e : problem.edges) e.cost = std::abs(e.cost) + 1;
  EXPECT_THAT(detail::solve(problem, {}).labels, ::testing::Each(0U));
  for (auto& e : problem.edges) e.cost = -e.cost;
  const Labels apart = detail::solve(problem, {}).labels;
  EXPECT_EQ(std::ranges::max(apart), problem.nodes - 1);
  for (auto& e : problem.edges) e.cost = 0;
  EXPECT_THAT(detail::solve(problem, {}).labels, ::testing::Each(0U)) << "what costs nothing to join is joined";
}

TEST(Multicut, splits_at_forced_edges_and_keeps_them_cut) {
  base::Random random(61);
  Multicut problem = random_grid(8, 4, {1000, 2000, 0.8, 0}, random);
  for (auto& e : problem.edges) e.forced = (e.a % 8 < 4) != (e.b % 8 < 4);
  const MulticutAnswer answer = detail::solve(problem, {});
  expect_sound(problem, answer);
  EXPECT_TRUE(answer.optimal);
  for (const auto& e : problem.edges)
    if (e.forced) {
      EXPECT_NE(answer.labels[e.a], answer.labels[e.b]);
    }
}

TEST(Multicut, is_valid_with_a_true_bound_when_given_no_time) {
  base::Random random(71);
  for (int round = 0; round < 20; ++round) {
    const Multicut problem = random_grid(3, 3, {1000, 1500, 0.7, round % 2 == 0 ? 0.0 : 0.1}, random);
    const std::int64_t best = testing::least_by_trying_all(problem);
    const MulticutAnswer none = detail::solve(problem, {.seconds = 0.0, .nodes = 1000, .search = {}});
    expect_sound(problem, none);
    EXPECT_LE(none.bound, best);
    EXPECT_GE(none.objective, best);
    EXPECT_EQ(none.rounds, 0);
  }
  for (int round = 0; round < 5; ++round) {
    const Multicut problem = random_grid(6, 6, {1000, 1500, 0.9, 0.02}, random);
    const std::int64_t best = detail::solve(problem, {}).objective;
    for (const std::int64_t nodes : {0, 1, 3}) {
      const MulticutAnswer few = detail::solve(problem, {.seconds = std::nullopt, .nodes = nodes, .search = {}});
      expect_sound(problem, few);
      EXPECT_LE(few.bound, best);
      EXPECT_GE(few.objective, best);
    }
  }
}

TEST(Multicut, stops_with_a_valid_answer_when_the_run_is_cancelled) {
  base::Random random(81);
  const Multicut problem = random_grid(9, 9, {1000, 1500, 0.9, 0}, random);
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  expect_sound(problem, detail::solve(problem, {}, run));
}

TEST(Multicut, takes_no_more_nodes_than_its_work_allows) {
  base::Random random(5);
  const Multicut problem = random_grid(12, 12, {1000, 2500, 0.9, 0.02}, random);
  detail::MulticutLimits limits;
  limits.node_work = 1;
  const MulticutAnswer free = detail::solve(problem, {}), bounded = detail::solve(problem, limits);
  expect_sound(problem, bounded);
  EXPECT_GT(free.rounds, 0) << "else nothing is bounded";
  EXPECT_EQ(bounded.rounds, 1) << "one solve in any case";
  EXPECT_EQ(bounded.nodes, 0);
  EXPECT_GE(bounded.objective, free.objective);
}

TEST(Multicut, gives_the_same_labels_twice) {
  base::Random random(91);
  for (int round = 0; round < 5; ++round) {
    const Multicut problem = random_grid(8, 7, {1000, 1200, 0.6, 0}, random);
    const MulticutAnswer one = detail::solve(problem, {}), two = detail::solve(problem, {});
    EXPECT_EQ(one.labels, two.labels);
    EXPECT_EQ(one.nodes, two.nodes);
  }
}

TEST(LocalSearch, keeps_forced_edges_cut_and_comes_near_the_optimum) {
  base::Random random(101);
  double worst = 0;
  for (int round = 0; round < 15; ++round) {
    const Multicut problem = random_grid(7, 7, {1000, 800, 0.5, 0.05}, random);
    const Labels start = detail::greedy(problem), better = detail::improved(problem, start);
    ASSERT_TRUE(cost_of(problem, start) && cost_of(problem, better));
    EXPECT_LE(*cost_of(problem, better), *cost_of(problem, start));
    const auto best = static_cast<double>(detail::solve(problem, {}).objective);
    worst = std::max(worst, (static_cast<double>(*cost_of(problem, better)) - best) / std::abs(best));
  }
  EXPECT_LT(worst, 0.15);
  RecordProperty("worst_gap_percent", static_cast<int>(100 * worst));
}

TEST(LocalSearch, never_worsens_any_start) {
  base::Random random(111);
  for (int round = 0; round < 30; ++round) {
    const Multicut problem = random_grid(6, 6, {1000, 1500, 0.8, 0}, random);
    Labels labels(problem.nodes);
    for (auto& l : labels) l = static_cast<std::uint32_t>(random.index(6));
    EXPECT_LE(*cost_of(problem, detail::improved(problem, labels)), *cost_of(problem, labels));
  }
}

}  // namespace
}  // namespace mansard::segment
