#include "planar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "mansard/solver/solver.hpp"

namespace mansard::segment::testing {

using detail::Labels, detail::Multicut;

auto random_grid(std::uint32_t columns, std::uint32_t rows, const Weights& weights, base::Random& random) -> Multicut {
  Multicut problem;
  problem.nodes = columns * rows;
  const auto cost = [&] {
    return static_cast<std::int64_t>(std::floor(random.uniform(-1, 1) * static_cast<double>(weights.cost)));
  };
  std::vector<std::uint32_t> east(problem.nodes), north(problem.nodes);
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    problem.edges.push_back({a, b, cost(), random.uniform() < weights.forced});
    return static_cast<std::uint32_t>(problem.edges.size() - 1);
  };
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t v = y * columns + x;
      if (x + 1 < columns) east[v] = add(v, v + 1);
      if (y + 1 < rows) north[v] = add(v, v + columns);
    }
  for (std::uint32_t y = 0; y + 1 < rows; ++y)
    for (std::uint32_t x = 0; x + 1 < columns; ++x) {
      const std::uint32_t v = y * columns + x;
      problem.stars.push_back({east[v], north[v + 1], east[v + columns], north[v]});
    }
  // Pairs are edges of one face.
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (std::uint32_t i = 0; i < problem.edges.size(); ++i)
    for (std::uint32_t j = i + 1; j < problem.edges.size(); ++j) {
      const auto& [a, b] = std::pair(problem.edges[i], problem.edges[j]);
      const bool meet = a.a == b.a || a.a == b.b || a.b == b.a || a.b == b.b;
      if (meet && random.uniform() < weights.pairs / 3) problem.pairs.push_back({i, j, weights.penalty});
    }
  return problem;
}

namespace {

void try_all(const Multicut& problem, Labels& labels, std::uint32_t at, std::uint32_t used, std::int64_t& best) {
  if (at == problem.nodes) {
    if (const auto cost = detail::cost_of(problem, labels)) best = std::min(best, *cost);
    return;
  }
  for (std::uint32_t label = 0; label <= used; ++label) {
    labels[at] = label;
    try_all(problem, labels, at + 1, std::max(used, label + 1), best);
  }
}

}  // namespace

auto least_by_trying_all(const Multicut& problem) -> std::int64_t {
  Labels labels(problem.nodes);
  std::int64_t best = std::numeric_limits<std::int64_t>::max();
  try_all(problem, labels, 0, 0, best);
  return best;
}

auto least_by_four_colours(const Multicut& problem) -> std::int64_t {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr std::uint32_t colours = 4;
  solver::Program program;
  const auto colour = [](std::uint32_t v, std::uint32_t c) { return v * colours + c; };
  for (std::uint32_t v = 0; v < problem.nodes; ++v) {
    solver::Row one{{}, 1, 1};
    for (std::uint32_t c = 0; c < colours; ++c) {
      // Colours are interchangeable: the first node takes the first, the second one of the first two.
      program.variables.push_back({0, 0, c > v ? 0.0 : 1.0, true});
      one.terms.emplace_back(colour(v, c), 1.0);
    }
    program.rows.push_back(std::move(one));
  }
  const auto first = static_cast<std::uint32_t>(program.variables.size());
  for (std::uint32_t e = 0; e < problem.edges.size(); ++e) {
    const auto& edge = problem.edges[e];
    program.variables.push_back({static_cast<double>(edge.cost), edge.forced ? 1.0 : 0.0, 1, true});
    for (std::uint32_t c = 0; c < colours; ++c) {
      program.rows.push_back({{{first + e, 1.0}, {colour(edge.a, c), -1.0}, {colour(edge.b, c), 1.0}}, 0, infinity});
      program.rows.push_back({{{first + e, 1.0}, {colour(edge.a, c), 1.0}, {colour(edge.b, c), -1.0}}, 0, infinity});
      program.rows.push_back({{{first + e, 1.0}, {colour(edge.a, c), 1.0}, {colour(edge.b, c), 1.0}}, -infinity, 2});
    }
  }
  for (const auto& pair : problem.pairs) {
    const auto y = static_cast<std::uint32_t>(program.variables.size());
    program.variables.push_back({static_cast<double>(pair.penalty), 0, 1, true});
    program.rows.push_back({{{first + pair.first, 1.0}, {first + pair.second, 1.0}, {y, -1.0}}, -infinity, 1});
  }
  const auto solution = solver::minimise(program, {.seconds = std::nullopt, .nodes = std::nullopt, .gap = 0});
  return std::llround(solution.value().objective);
}

}  // namespace mansard::segment::testing
