#include "mansard/solver/solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/base/run.hpp"

namespace mansard::solver {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Up to `rows` random knapsack rows over `n` binaries, costs to be made as negative as possible.
auto random_program(std::uint64_t seed, std::size_t n, std::size_t rows) -> Program {
  base::Random random(seed);
  Program program;
  for (std::size_t i = 0; i < n; ++i) program.variables.push_back({std::floor(random.uniform(-100, 20)), 0, 1, true});
  for (std::size_t r = 0; r < rows; ++r) {
    Row row{{}, -infinity, 0};
    for (std::uint32_t i = 0; i < n; ++i)
      if (random.uniform() < 0.6) row.terms.emplace_back(i, std::floor(random.uniform(1, 40)));
    for (const auto& term : row.terms) row.most += std::floor(term.second * 0.4);
    program.rows.push_back(std::move(row));
  }
  program.constant = 7;
  return program;
}

auto by_trying_all(const Program& program) -> double {
  double best = infinity;
  const std::size_t n = program.variables.size();
  for (std::size_t mask = 0; mask < (std::size_t{1} << n); ++mask) {
    const auto value = [&](std::size_t i) { return (mask >> i & 1U) != 0 ? 1.0 : 0.0; };
    const bool feasible = std::ranges::all_of(program.rows, [&](const Row& row) {
      double sum = 0;
      for (const auto& [i, c] : row.terms) sum += c * value(i);
      return sum >= row.least && sum <= row.most;
    });
    if (!feasible) continue;
    double cost = program.constant;
    for (std::size_t i = 0; i < n; ++i) cost += program.variables[i].cost * value(i);
    best = std::min(best, cost);
  }
  return best;
}

TEST(Solver, agrees_with_trying_all_points_of_small_knapsacks) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Program program = random_program(seed, 11, 3);
    const auto solution = minimise(program, {});
    ASSERT_TRUE(solution) << seed;
    EXPECT_EQ(solution->status, Status::optimal) << seed;
    EXPECT_DOUBLE_EQ(solution->objective, by_trying_all(program)) << seed;
    EXPECT_DOUBLE_EQ(solution->bound, solution->objective) << seed;
  }
}

TEST(Solver, gives_the_objective_of_the_values_it_returns_and_keeps_to_the_rows) {
  const Program program = random_program(99, 60, 8);
  const auto solution = minimise(program, {});
  ASSERT_TRUE(solution);
  double cost = program.constant;
  for (std::size_t i = 0; i < 60; ++i) cost += program.variables[i].cost * solution->values[i];
  EXPECT_DOUBLE_EQ(cost, solution->objective);
  for (const Row& row : program.rows) {
    double sum = 0;
    for (const auto& [i, c] : row.terms) sum += c * solution->values[i];
    EXPECT_LE(sum, row.most + 1e-6);
  }
}

TEST(Solver, says_so_when_no_point_satisfies_the_rows) {
  Program program;
  program.variables = {{1, 0, 1, true}, {1, 0, 1, true}};
  program.rows = {{{{0, 1}, {1, 1}}, 3, infinity}};
  const auto solution = minimise(program, {});
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->status, Status::infeasible);
  EXPECT_TRUE(solution->values.empty());
}

TEST(Solver, says_so_when_only_whole_points_are_missing) {
  Program program;  // 2x + 2y = 3 has a solution between the integers only
  program.variables = {{1, 0, 5, true}, {1, 0, 5, true}};
  program.rows = {{{{0, 2}, {1, 2}}, 3, 3}};
  const auto solution = minimise(program, {});
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->status, Status::infeasible);
}

TEST(Solver, solves_linear_programs_and_mixed_ones) {
  Program program;  // x + y ≥ 1.5 with x cheaper but at most 1
  program.variables = {{1, 0, 1, false}, {2, 0, 10, false}};
  program.rows = {{{{0, 1}, {1, 1}}, 1.5, infinity}};
  const auto relaxed = minimise(program, {});
  ASSERT_TRUE(relaxed);
  EXPECT_NEAR(relaxed->objective, 2, 1e-9);
  program.variables[1].whole = true;
  const auto mixed = minimise(program, {});
  ASSERT_TRUE(mixed);
  EXPECT_NEAR(mixed->objective, 2.5, 1e-9);
}

TEST(Solver, answers_a_program_without_variables) {
  Program program;
  program.constant = 3;
  EXPECT_EQ(minimise(program, {})->objective, 3);
  program.rows = {{{}, 1, 2}};
  EXPECT_EQ(minimise(program, {})->status, Status::infeasible);
}

TEST(Solver, refuses_what_is_no_number) {
  Program program;
  program.variables = {{std::nan(""), 0, 1, true}};
  const auto solution = minimise(program, {});
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.error().code, "solver-failed");
  program.variables = {{1, 0, 1, true}};
  program.rows = {{{{5, 1.0}}, 0, 1}};
  EXPECT_FALSE(minimise(program, {}));
}

TEST(Solver, never_gives_a_bound_above_the_optimum_when_stopped_early) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Program program = random_program(1000 + seed, 32, 8);
    const auto full = minimise(program, {});
    ASSERT_TRUE(full);
    ASSERT_EQ(full->status, Status::optimal);
    const std::vector<double> nothing(32, 0.0);
    for (const std::int64_t nodes : {0, 1, 5, 40}) {
      const auto early = minimise(program, {.seconds = std::nullopt, .nodes = nodes, .gap = 0}, nothing);
      ASSERT_TRUE(early);
      ASSERT_FALSE(early->values.empty());
      EXPECT_LE(early->bound, full->objective + 1e-6) << seed << " after " << nodes;
      EXPECT_GE(early->objective, full->objective - 1e-6) << seed << " after " << nodes;
      if (early->status == Status::optimal) {
        EXPECT_NEAR(early->objective, full->objective, 1e-6);
      }
    }
  }
}

TEST(Solver, stops_within_the_gap_allowed_with_a_bound_that_holds) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Program program = random_program(2000 + seed, 30, 8);
    const double best = minimise(program, {})->objective;
    const auto loose = minimise(program, {.seconds = std::nullopt, .nodes = std::nullopt, .gap = 50});
    ASSERT_TRUE(loose);
    EXPECT_LE(loose->objective, best + 50 + 1e-6);
    EXPECT_LE(loose->bound, best + 1e-6);
    EXPECT_LE(loose->objective - loose->bound, 50 + 1e-6);
  }
}

TEST(Solver, returns_at_least_the_incumbent_when_given_no_time) {
  const Program program = random_program(5, 80, 20);
  const std::vector<double> nothing(80, 0.0);
  const auto solution = minimise(program, {.seconds = 0.0, .nodes = std::nullopt, .gap = 0}, nothing);
  ASSERT_TRUE(solution);
  ASSERT_EQ(solution->values.size(), 80U);
  EXPECT_LE(solution->objective, program.constant);
  EXPECT_LE(solution->bound, solution->objective);
}

TEST(Solver, proves_an_incumbent_that_is_optimal_already) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Program program = random_program(seed, 11, 3);
    const auto first = minimise(program, {});
    const auto again = minimise(program, {.seconds = std::nullopt, .nodes = std::nullopt, .gap = 0.99}, first->values);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->status, Status::optimal);
    EXPECT_EQ(again->objective, first->objective);
    EXPECT_GT(again->bound, first->objective - 1);
    EXPECT_LE(again->bound, first->objective);
  }
}

TEST(Solver, gives_the_same_solution_twice) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Program program = random_program(3000 + seed, 35, 8);
    const auto one = minimise(program, {}), two = minimise(program, {});
    EXPECT_EQ(one->values, two->values);
    EXPECT_EQ(one->nodes, two->nodes);
    EXPECT_EQ(one->bound, two->bound);
  }
}

TEST(Solver, gives_the_same_solutions_from_many_threads_at_once) {
  std::vector<Solution> alone(16), together(16);
  for (std::size_t i = 0; i < 16; ++i) alone[i] = *minimise(random_program(4000 + i, 30, 6), {});
  base::parallel_for(16, [&](std::size_t i) { together[i] = *minimise(random_program(4000 + i, 30, 6), {}); });
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(alone[i].values, together[i].values) << i;
}

TEST(Solver, prints_nothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Program impossible;
  impossible.variables = {{1, 0, 1, true}};
  impossible.rows = {{{{0, 1}}, 2, 3}};
  (void)minimise(impossible, {});
  const Program program = random_program(8, 60, 12);
  (void)minimise(program, {}, std::vector<double>(60, 0.0));
  (void)minimise(program, {.seconds = 0.001, .nodes = 3, .gap = 0});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Solver, explains_its_codes) {
  ASSERT_EQ(codes().size(), 2U);
  EXPECT_EQ(codes()[0].code, "solver-failed");
  EXPECT_EQ(codes()[1].code, "solver-mps");
}

}  // namespace
}  // namespace mansard::solver
