#include "mansard/segment/detail/multicut.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/segment/detail/local_search.hpp"
#include "mansard/solver/solver.hpp"

namespace mansard::segment::detail {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

using Pieces = base::DisjointSets;

auto numbered(Pieces& pieces, std::uint32_t nodes) -> Labels {
  Labels labels(nodes), number(nodes, none);
  std::uint32_t count = 0;
  for (std::uint32_t v = 0; v < nodes; ++v) {
    auto& n = number[pieces.of(v)];
    if (n == none) n = count++;
    labels[v] = n;
  }
  return labels;
}

/// One connected part of the problem, with the numbers its nodes and edges had in the whole. What forced edges cost and
/// what they do to others is in the part's costs and constant where they leave it.
struct Subproblem {
  Multicut problem;
  std::vector<std::uint32_t> nodes, edges;
};

/// Splits where only forced edges connect: those are cut whatever the labels, so that their pairs become linear.
auto split(const Multicut& whole, std::int64_t& constant) -> std::vector<Subproblem> {
  Pieces pieces(whole.nodes);
  for (const MulticutEdge& e : whole.edges)
    if (!e.forced) pieces.join(e.a, e.b);
  // A pair of free edges belongs to one program; those of one face do anyway.
  for (const MulticutPair& pair : whole.pairs)
    if (!whole.edges[pair.first].forced && !whole.edges[pair.second].forced)
      pieces.join(whole.edges[pair.first].a, whole.edges[pair.second].a);
  const Labels part_of = numbered(pieces, whole.nodes);
  const std::size_t count = part_of.empty() ? 0 : std::ranges::max(part_of) + 1U;
  std::vector<Subproblem> parts(count);
  std::vector<std::uint32_t> inner_node(whole.nodes), inner_edge(whole.edges.size(), none);
  for (std::uint32_t v = 0; v < whole.nodes; ++v) {
    Subproblem& part = parts[part_of[v]];
    inner_node[v] = part.problem.nodes++;
    part.nodes.push_back(v);
  }
  for (std::uint32_t e = 0; e < whole.edges.size(); ++e) {
    const MulticutEdge& edge = whole.edges[e];
    if (part_of[edge.a] != part_of[edge.b]) {
      constant += edge.cost;
      continue;
    }
    Subproblem& part = parts[part_of[edge.a]];
    inner_edge[e] = static_cast<std::uint32_t>(part.edges.size());
    part.edges.push_back(e);
    part.problem.edges.push_back({inner_node[edge.a], inner_node[edge.b], edge.cost, edge.forced});
  }
  for (const MulticutPair& pair : whole.pairs) {
    const std::uint32_t i = inner_edge[pair.first], j = inner_edge[pair.second];
    const MulticutEdge &one = whole.edges[pair.first], &other = whole.edges[pair.second];
    const bool inside = i != none && j != none;
    if (inside && part_of[one.a] == part_of[other.a]) {
      parts[part_of[one.a]].problem.pairs.push_back({i, j, pair.penalty});
    } else if (inside ? one.forced && other.forced : i == none && j == none) {
      constant += pair.penalty;
    } else {  // one of them is cut in any case
      const std::uint32_t free = (inside ? one.forced : i == none) ? pair.second : pair.first;
      parts[part_of[whole.edges[free].a]].problem.edges[inner_edge[free]].cost += pair.penalty;
    }
  }
  for (const auto& star : whole.stars) {
    if (std::ranges::any_of(star, [&](std::uint32_t e) { return inner_edge[e] == none; })) continue;
    std::vector<std::uint32_t> inner;
    for (const std::uint32_t e : star) inner.push_back(inner_edge[e]);
    parts[part_of[whole.edges[star.front()].a]].problem.stars.push_back(std::move(inner));
  }
  return parts;
}

constexpr double infinity = std::numeric_limits<double>::infinity();

auto row_of(const CycleRow& cycle) -> solver::Row {
  solver::Row row{{{cycle.edge, 1.0}}, -infinity, 0};
  for (const std::uint32_t f : cycle.path) row.terms.emplace_back(f, -1.0);
  return row;
}

/// Sets of three and more edges that are all in pairs with each other, every pair in one set at most: greedily, lowest
/// edge first.
void add_clique_rows(const Multicut& problem, solver::Program& program) {
  const auto count = static_cast<std::uint32_t>(problem.edges.size());
  std::vector<std::map<std::uint32_t, std::uint32_t>> partners(count);  // higher edge → pair
  for (std::uint32_t p = 0; p < problem.pairs.size(); ++p) {
    const auto [low, high] = std::minmax(problem.pairs[p].first, problem.pairs[p].second);
    partners[low].emplace(high, p);
  }
  std::vector<bool> used(problem.pairs.size(), false);
  for (std::uint32_t e = 0; e < count; ++e) {
    std::vector<std::uint32_t> clique{e}, pairs;
    for (const auto& [f, p] : partners[e]) {
      std::vector<std::uint32_t> links;
      for (const std::uint32_t g : clique)
        if (const auto link = partners[g].find(f); link != partners[g].end() && !used[link->second])
          links.push_back(link->second);
      if (links.size() < clique.size()) continue;
      clique.push_back(f);
      pairs.insert(pairs.end(), links.begin(), links.end());
    }
    if (clique.size() < 3) continue;
    solver::Row row{{}, -infinity, 1};
    for (const std::uint32_t f : clique) row.terms.emplace_back(f, 1.0);
    for (const std::uint32_t p : pairs) {
      used[p] = true;
      row.terms.emplace_back(count + p, -1.0);
    }
    program.rows.push_back(std::move(row));
  }
}

auto values_of(const Multicut& problem, const Labels& labels) -> std::vector<double> {
  std::vector<double> values;
  for (const MulticutEdge& e : problem.edges) values.push_back(labels[e.a] != labels[e.b] ? 1.0 : 0.0);
  for (const MulticutPair& pair : problem.pairs) values.push_back(values[pair.first] * values[pair.second]);
  return values;
}

/// Cycle rows that the cut breaks: for every chosen edge with both ends in one piece, the shortest way around it.
auto broken_cycles(const Multicut& problem, const std::vector<bool>& chosen) -> std::vector<CycleRow> {
  Pieces pieces(problem.nodes);
  std::vector<std::vector<std::uint32_t>> edges_of(problem.nodes);
  for (std::uint32_t e = 0; e < problem.edges.size(); ++e) {
    if (chosen[e]) continue;
    pieces.join(problem.edges[e].a, problem.edges[e].b);
    edges_of[problem.edges[e].a].push_back(e);
    edges_of[problem.edges[e].b].push_back(e);
  }
  std::vector<CycleRow> rows;
  std::vector<std::uint32_t> reached_by(problem.nodes), seen_in(problem.nodes, none);
  for (std::uint32_t bridge = 0; bridge < problem.edges.size(); ++bridge) {
    const auto [from, to] = std::pair(problem.edges[bridge].a, problem.edges[bridge].b);
    if (!chosen[bridge] || pieces.of(from) != pieces.of(to)) continue;
    std::queue<std::uint32_t> open;
    open.push(from);
    seen_in[from] = bridge;
    while (seen_in[to] != bridge) {
      const std::uint32_t v = open.front();
      open.pop();
      for (const std::uint32_t e : edges_of[v]) {
        const std::uint32_t w = problem.edges[e].a == v ? problem.edges[e].b : problem.edges[e].a;
        if (seen_in[w] == bridge) continue;
        seen_in[w] = bridge, reached_by[w] = e;
        open.push(w);
      }
    }
    std::vector<std::uint32_t> path;
    for (std::uint32_t v = to; v != from;) {
      const MulticutEdge& e = problem.edges[reached_by[v]];
      path.push_back(reached_by[v]);
      v = e.a == v ? e.b : e.a;
    }
    std::ranges::sort(path);
    rows.push_back({bridge, std::move(path)});
  }
  return rows;
}

struct Deadline {
  std::optional<Clock::time_point> at;
  [[nodiscard]] auto left() const -> std::optional<double> {
    if (!at) return std::nullopt;
    return std::chrono::duration<double>(*at - Clock::now()).count();
  }
};

/// What the solver's bound may be too high by. CBC accepts rows and reduced costs that are violated by up to 1e-7 (its
/// primal and dual tolerances): ten thousand rows of unit coefficients add up to 1e-3. Sums of costs carry a relative
/// error of 2⁻⁵³ a term: with up to four million terms under 1e-9.
constexpr double bound_slack = 1e-3, relative_bound_slack = 1e-9;

/// Costs are whole, so a proven bound may be rounded up.
auto rounded_up(double bound) -> std::int64_t {
  return static_cast<std::int64_t>(std::ceil(bound - bound_slack - relative_bound_slack * std::abs(bound)));
}

/// Edges of the relaxation under the threshold are joined: three starts more for the search. They change what is found
/// before the optimum is proven, not the optimum.
constexpr std::array relaxed_thresholds{0.3, 0.5, 0.7};
/// Costs are whole: what is less than one unit from the bound is the optimum. A hundredth is left for rounding.
constexpr double whole_gap = 0.99;
/// Half-way between that and the next gap that a labelling of whole cost can have, 1.99.
constexpr double next_gap = 1.5;

/// How many nodes a program of that size may take in all its rounds.
auto most_nodes(const solver::Program& program, double node_work) -> std::int64_t {
  double coefficients = 1;
  for (const solver::Row& row : program.rows) coefficients += static_cast<double>(row.terms.size());
  return static_cast<std::int64_t>(std::min(1e9, node_work / (coefficients * coefficients)));
}
/// A root, with its rounds of cuts, is as much work as ten nodes.
constexpr std::int64_t nodes_of_root = 10;

auto solve_part(const Multicut& problem, const MulticutLimits& limits, const Deadline& deadline, const base::Run& run)
    -> MulticutAnswer {
  MulticutAnswer answer;
  answer.labels = improved(problem, greedy(problem), limits.search);
  answer.objective = cost_of(problem, answer.labels).value();
  const auto offer = [&](const Labels& labels) {
    if (const auto cost = cost_of(problem, labels); cost && *cost < answer.objective)
      answer.objective = *cost, answer.labels = labels;
  };
  if (const Labels together(problem.nodes, 0); cost_of(problem, together))
    offer(improved(problem, together, limits.search));
  answer.bound = trivial_bound(problem);

  solver::Program program = integer_program(problem, star_rows(problem), limits.cliques);
  answer.variables = program.variables.size();
  if (answer.bound < answer.objective && deadline.left().value_or(1) > 0 && !run.cancelled()) {
    for (auto& variable : program.variables) variable.whole = false;
    const auto relaxed = solver::minimise(program, {.seconds = deadline.left(), .nodes = std::nullopt, .gap = 0});
    for (std::size_t e = 0; e < problem.edges.size(); ++e) program.variables[e].whole = true;
    if (relaxed && relaxed->status == solver::Status::optimal) {
      answer.bound = std::max(answer.bound, std::min(rounded_up(relaxed->bound), answer.objective));
      for (const double threshold : relaxed_thresholds) {
        Pieces pieces(problem.nodes);
        for (std::size_t e = 0; e < problem.edges.size(); ++e)
          if (relaxed->values[e] < threshold) pieces.join(problem.edges[e].a, problem.edges[e].b);
        if (const Labels near = numbered(pieces, problem.nodes); cost_of(problem, near))
          offer(improved(problem, near, limits.search));
      }
    }
  }
  while (answer.bound < answer.objective) {
    const auto left = deadline.left();
    if ((left && *left <= 0) || run.cancelled()) break;
    const std::int64_t nodes_left =
        most_nodes(program, limits.node_work) - answer.nodes - nodes_of_root * answer.rounds;
    if (nodes_left <= 0 && answer.rounds > 0) break;
    const auto solution = solver::minimise(
        program,
        {.seconds = left, .nodes = std::min(limits.nodes, std::max<std::int64_t>(nodes_left, 0)), .gap = whole_gap},
        values_of(problem, answer.labels));
    ++answer.rounds;
    if (!solution) {
      answer.warnings.push_back(base::warning("segment-solver", solution.error().message));
      break;
    }
    answer.nodes += solution->nodes;
    if (solution->values.empty()) break;
    answer.bound = std::max(answer.bound, std::min(rounded_up(solution->bound), answer.objective));

    std::vector<bool> chosen(problem.edges.size());
    Pieces pieces(problem.nodes);
    for (std::uint32_t e = 0; e < problem.edges.size(); ++e) {
      chosen[e] = solution->values[e] > 0.5;
      if (!chosen[e]) pieces.join(problem.edges[e].a, problem.edges[e].b);
    }
    // Joining across what bridges remain always gives a labelling, if not one that cuts every forced edge.
    const Labels labels = numbered(pieces, problem.nodes);
    offer(labels);
    std::vector<CycleRow> rows = broken_cycles(problem, chosen);
    if (!rows.empty() && cost_of(problem, labels)) offer(improved(problem, labels, limits.search));
    if (solution->status != solver::Status::optimal) break;
    if (rows.empty()) {
      // The program's optimum is a labelling: nothing is cheaper.
      if (static_cast<double>(answer.objective) - solution->bound < next_gap) answer.bound = answer.objective;
      break;
    }
    for (auto& row : rows) {
      program.rows.push_back(row_of(row));
      answer.rows.push_back(std::move(row));
    }
  }
  answer.optimal = answer.bound >= answer.objective;
  if (answer.optimal) answer.bound = answer.objective;
  return answer;
}

}  // namespace

auto cost_of(const Multicut& problem, const Labels& labels) -> std::optional<std::int64_t> {
  const auto cut = [&](const MulticutEdge& e) { return labels[e.a] != labels[e.b]; };
  std::int64_t sum = 0;
  for (const MulticutEdge& e : problem.edges) {
    if (cut(e)) sum += e.cost;
    else if (e.forced) return std::nullopt;
  }
  for (const MulticutPair& pair : problem.pairs)
    if (cut(problem.edges[pair.first]) && cut(problem.edges[pair.second])) sum += pair.penalty;
  return sum;
}

auto trivial_bound(const Multicut& problem) -> std::int64_t {
  std::int64_t sum = 0;
  for (const MulticutEdge& e : problem.edges) sum += e.forced ? e.cost : std::min<std::int64_t>(e.cost, 0);
  for (const MulticutPair& pair : problem.pairs)
    if (problem.edges[pair.first].forced && problem.edges[pair.second].forced) sum += pair.penalty;
  return sum;
}

auto canonical(const Multicut& problem, const Labels& labels) -> Labels {
  Pieces pieces(problem.nodes);
  for (const MulticutEdge& e : problem.edges)
    if (labels[e.a] == labels[e.b]) pieces.join(e.a, e.b);
  return numbered(pieces, problem.nodes);
}

auto star_rows(const Multicut& problem) -> std::vector<CycleRow> {
  std::vector<CycleRow> rows;
  for (const auto& star : problem.stars) {
    for (const std::uint32_t e : star) {
      std::vector<std::uint32_t> others;
      for (const std::uint32_t f : star)
        if (f != e) others.push_back(f);
      // Where the same two faces meet twice at a vertex, s_e ≤ s_e + … says nothing.
      if (others.size() + 1 != star.size() || others.empty()) continue;
      std::ranges::sort(others);
      others.erase(std::ranges::unique(others).begin(), others.end());
      rows.push_back({e, std::move(others)});
    }
  }
  return rows;
}

auto integer_program(const Multicut& problem, const std::vector<CycleRow>& rows, bool cliques) -> solver::Program {
  solver::Program program;
  for (const MulticutEdge& e : problem.edges)
    program.variables.push_back({static_cast<double>(e.cost), e.forced ? 1.0 : 0.0, 1.0, true});
  for (const MulticutPair& pair : problem.pairs) {
    const auto y = static_cast<std::uint32_t>(program.variables.size());
    program.variables.push_back({static_cast<double>(pair.penalty), 0.0, 1.0, false});
    program.rows.push_back({{{pair.first, 1.0}, {pair.second, 1.0}, {y, -1.0}}, -infinity, 1});
  }
  for (const CycleRow& row : rows) program.rows.push_back(row_of(row));
  if (cliques) add_clique_rows(problem, program);
  return program;
}

auto solve(const Multicut& problem, const MulticutLimits& limits, const base::Run& run) -> MulticutAnswer {
  Deadline deadline;
  if (limits.seconds)
    deadline.at = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(std::min(*limits.seconds, 1e8)));
  MulticutAnswer whole;
  whole.optimal = true;
  whole.labels.resize(problem.nodes);
  std::uint32_t used = 0;
  const std::vector<Subproblem> parts = split(problem, whole.objective);
  whole.bound = whole.objective;
  for (const Subproblem& part : parts) {
    MulticutAnswer answer = solve_part(part.problem, limits, deadline, run);
    std::uint32_t most = 0;
    for (std::size_t i = 0; i < part.nodes.size(); ++i) {
      whole.labels[part.nodes[i]] = used + answer.labels[i];
      most = std::max(most, answer.labels[i] + 1);
    }
    used += most;
    whole.objective += answer.objective;
    whole.bound += answer.bound;
    whole.optimal = whole.optimal && answer.optimal;
    whole.rounds = std::max(whole.rounds, answer.rounds);
    whole.nodes += answer.nodes;
    whole.variables += answer.variables;
    for (CycleRow& row : answer.rows) {
      row.edge = part.edges[row.edge];
      for (std::uint32_t& e : row.path) e = part.edges[e];
      whole.rows.push_back(std::move(row));
    }
    for (auto& w : answer.warnings) whole.warnings.push_back(std::move(w));
  }
  whole.labels = joined_where_free(problem, whole.labels);
  whole.objective = cost_of(problem, whole.labels).value();
  return whole;
}

}  // namespace mansard::segment::detail
