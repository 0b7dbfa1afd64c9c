#include "models.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace mansard::bench {
namespace {

using segment::Candidate;
using segment::Segmentation;
using solver::Program;
using Terms = std::vector<std::pair<std::uint32_t, double>>;

constexpr double infinity = std::numeric_limits<double>::infinity();

auto add_variable(Program& program, double cost, bool whole, double least = 0) -> std::uint32_t {
  program.variables.push_back({cost, least, 1, whole});
  return static_cast<std::uint32_t>(program.variables.size() - 1);
}

void add_row(Program& program, Terms terms, double least, double most) {
  program.rows.push_back({std::move(terms), least, most});
}

/// The first of each inside face's `colours` variables, by face; every face has one colour, the first face the first.
auto add_colours(Program& program, const Segmentation& s, std::uint32_t colours, bool fix_first)
    -> std::map<std::uint32_t, std::uint32_t> {
  std::map<std::uint32_t, std::uint32_t> first;
  for (std::uint32_t f = 0; f < s.faces.size(); ++f) {
    if (!s.faces[f].inside) continue;
    const bool fixed = fix_first && first.empty();
    Terms one;
    for (std::uint32_t c = 0; c < colours; ++c)
      one.emplace_back(add_variable(program, 0, true, fixed && c == 0 ? 1 : 0), 1);
    first.emplace(f, one.front().first);
    add_row(program, std::move(one), 1, 1);
  }
  return first;
}

/// A cost per half-edge, whole, and what is then left over of the sum.
struct Shares {
  double each = 0, rest = 0;
};
auto shared(double whole, std::size_t among) -> Shares {
  const double each = std::floor(whole / static_cast<double>(among));
  return {each, whole - each * static_cast<double>(among)};
}

/// A half-edge's variables and rows. Being an edge costs `edge`, being one without a profile `unsupported`, and not
/// being one with a profile `unused`.
auto add_half_edge(Program& program, std::uint32_t left, std::uint32_t right, bool forced, double edge,
                   double unsupported, double unused) -> std::uint32_t {
  constexpr std::uint32_t colours = 6;
  const std::uint32_t is_edge = add_variable(program, edge, true, forced ? 1 : 0);
  const std::uint32_t edge_no_profile = add_variable(program, unsupported, true);
  const std::uint32_t profile_no_edge = add_variable(program, unused, true);
  if (unsupported != 0) add_row(program, {{edge_no_profile, 1}, {is_edge, -1}}, 0, 0);
  else add_row(program, {{edge_no_profile, 1}}, 0, 0);
  if (unused != 0) add_row(program, {{profile_no_edge, 1}, {is_edge, 1}}, 1, 1);
  else add_row(program, {{profile_no_edge, 1}}, 0, 0);

  Terms differ{{is_edge, -2}};
  for (std::uint32_t c = 0; c < colours; ++c) {
    const std::uint32_t either = add_variable(program, 0, true), a = left + c, b = right + c;
    add_row(program, {{either, 1}, {a, -1}, {b, -1}}, -infinity, 0);
    add_row(program, {{either, 1}, {a, -1}, {b, 1}}, 0, infinity);
    add_row(program, {{either, 1}, {a, 1}, {b, -1}}, 0, infinity);
    add_row(program, {{either, 1}, {a, 1}, {b, 1}}, -infinity, 2);
    differ.emplace_back(either, 1);
  }
  add_row(program, std::move(differ), -1.5, 0.5);
  return is_edge;
}

/// Pairs of candidates that conflict, with their penalty: the y of the multicut's program, in its order.
struct Pair {
  std::uint32_t first = 0, second = 0;
  double penalty = 0;
};
auto pairs_of(const Segmentation& s, const Program& multicut) -> std::vector<Pair> {
  std::vector<Pair> pairs;
  for (const auto& conflict : s.conflicts)
    if (conflict.second)
      pairs.push_back({conflict.first, *conflict.second, multicut.variables[s.candidates.size() + pairs.size()].cost});
  return pairs;
}

/// Whether no edge of the set has the same piece on both sides.
auto is_multicut(const Segmentation& s, std::uint32_t set) -> bool {
  std::vector<std::size_t> root(s.faces.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::size_t f) {
    while (root[f] != f) f = root[f];
    return f;
  };
  const auto is_cut = [&](std::size_t i) { return (set >> i & 1U) != 0; };
  for (std::size_t i = 0; i < s.candidates.size(); ++i)
    if (!is_cut(i)) root[find(s.candidates[i].left)] = find(s.candidates[i].right);
  for (std::size_t i = 0; i < s.candidates.size(); ++i)
    if (is_cut(i) && find(s.candidates[i].left) == find(s.candidates[i].right)) return false;
  return true;
}

}  // namespace

auto lean_colours(const Segmentation& s) -> Program {
  constexpr std::uint32_t colours = 4;
  const Program multicut = segment::program_of(s);
  Program program;
  program.constant = multicut.constant;
  const auto colour = add_colours(program, s, colours, true);
  std::vector<std::uint32_t> edge;
  for (std::size_t i = 0; i < s.candidates.size(); ++i) {
    const Candidate& c = s.candidates[i];
    edge.push_back(add_variable(program, multicut.variables[i].cost, true, c.forced ? 1 : 0));
    for (std::uint32_t k = 0; k < colours; ++k) {
      const std::uint32_t a = colour.at(c.left) + k, b = colour.at(c.right) + k;
      add_row(program, {{edge.back(), 1}, {a, -1}, {b, 1}}, 0, infinity);
      add_row(program, {{edge.back(), 1}, {a, 1}, {b, -1}}, 0, infinity);
      add_row(program, {{edge.back(), 1}, {a, 1}, {b, 1}}, -infinity, 2);
    }
  }
  for (const Pair& p : pairs_of(s, multicut)) {
    const std::uint32_t both = add_variable(program, p.penalty, false);
    add_row(program, {{edge[p.first], 1}, {edge[p.second], 1}, {both, -1}}, -infinity, 1);
  }
  return program;
}

auto half_edges(const Segmentation& s) -> Program {
  const Program multicut = segment::program_of(s);
  Program program;
  program.constant = multicut.constant;
  const auto colour = add_colours(program, s, 6, false);
  std::vector<std::uint32_t> edge;
  for (std::size_t i = 0; i < s.candidates.size(); ++i) {
    const Candidate& c = s.candidates[i];
    const std::size_t sides = 2 * c.half_edges.size();
    const double unsupported = std::round(1000 * c.costs[segment::Term::unsupported]),
                 unused = std::round(1000 * c.costs[segment::Term::sweep_unused]);
    // What is neither of O1 costs or saves by being an edge: O2, conflicts with the outline, rounding.
    const Shares b = shared(unsupported, sides), a = shared(unused, sides),
                 rest = shared(multicut.variables[i].cost - unsupported + unused, sides);
    program.constant -= unused;
    for (std::size_t h = 0; h < sides; ++h) {
      const double first = h == 0 ? 1 : 0;
      const std::uint32_t is_edge =
          add_half_edge(program, colour.at(h % 2 == 0 ? c.left : c.right), colour.at(h % 2 == 0 ? c.right : c.left),
                        c.forced, rest.each + first * rest.rest, b.each + first * b.rest, a.each + first * a.rest);
      if (h == 0) edge.push_back(is_edge);
    }
  }
  for (const Pair& p : pairs_of(s, multicut)) {
    const std::uint32_t bad = add_variable(program, p.penalty, true);
    add_row(program, {{edge[p.first], 1}, {edge[p.second], 1}, {bad, -2}}, -0.5, 1);
  }
  return program;
}

auto by_trying_all(const Segmentation& s) -> std::optional<double> {
  const std::size_t n = s.candidates.size();
  if (n > 18) return std::nullopt;
  const Program multicut = segment::program_of(s);
  const auto pairs = pairs_of(s, multicut);
  double least = infinity;
  for (std::uint32_t set = 0; set < (1U << n); ++set) {
    const auto is_cut = [&](std::size_t i) { return (set >> i & 1U) != 0; };
    double cost = multicut.constant;
    bool allowed = true;
    for (std::size_t i = 0; i < n; ++i) {
      allowed = allowed && (is_cut(i) || !s.candidates[i].forced);
      if (is_cut(i)) cost += multicut.variables[i].cost;
    }
    for (const Pair& p : pairs)
      if (is_cut(p.first) && is_cut(p.second)) cost += p.penalty;
    if (allowed && cost < least && is_multicut(s, set)) least = cost;
  }
  return least;
}

}  // namespace mansard::bench
