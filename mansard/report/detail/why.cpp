#include "mansard/report/detail/why.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mansard/base/metres.hpp"
#include "mansard/base/text.hpp"

namespace mansard::report::detail {
namespace {

using Amounts = std::vector<std::pair<double, std::string>>;

/// Whole from 10 on, where a decimal would be of no interest.
auto rounded(double cost) -> std::string {
  constexpr double least = 0.05;  // less would be written 0.0
  return cost < least ? "under 0.1" : base::to_text(cost, cost < 10 ? 1 : 0);
}

/// "nothing", "480 for this", or "576 = 480 for this + 96 for that".
auto listed(const Amounts& amounts) -> std::string {
  std::string text;
  double total = 0;
  std::size_t count = 0;
  for (const auto& [cost, reason] : amounts) {
    if (!(cost > 0)) continue;
    text += (text.empty() ? "" : " + ") + rounded(cost) + " for " + reason;
    total += cost;
    ++count;
  }
  if (count == 0) return "nothing";
  return count == 1 ? text : rounded(total) + " = " + text;
}

/// What refinement made of a wall; "" where that is not known.
auto told(const std::optional<Later>& later) -> std::string {
  if (!later) return "";
  const double length = later->kept + later->moved + later->dropped;
  constexpr double all = 0.95;  // of the length: corners move along with other walls
  const std::string by = " by " + base::to_text(later->by, 2) + " m";
  if (later->kept >= all * length) return "; refinement kept it";
  if (later->moved >= all * length) return "; refinement moved it" + by;
  if (later->dropped >= all * length) return "; refinement dropped it";
  std::string text;
  const auto add = [&text](double metres_of_it, const std::string& what) {
    if (metres_of_it > 0) text += (text.empty() ? "" : ", ") + what;
  };
  add(later->kept, "kept " + base::metres(later->kept));
  add(later->moved, "moved " + base::metres(later->moved) + by);
  add(later->dropped, "dropped " + base::metres(later->dropped));
  return "; refinement " + text;
}

auto paid(const segment::Candidate& c, segment::Paid when) -> Amounts {
  Amounts amounts;
  for (const auto& info : segment::terms())
    if (info.paid == when) amounts.emplace_back(c.costs[info.term], info.reason(c.amounts[info.term]));
  return amounts;
}

auto if_cut(const segment::Candidate& c, std::size_t walls, double phi) -> Amounts {
  auto amounts = paid(c, segment::Paid::cut);
  amounts.emplace_back(
      static_cast<double>(walls) * phi,
      walls == 1 ? "its conflict with another wall" : "its conflicts with " + std::to_string(walls) + " other walls");
  return amounts;
}

}  // namespace

auto walls_in_conflict(const segment::Segmentation& segmentation) -> std::vector<std::size_t> {
  std::vector<std::size_t> walls(segmentation.candidates.size(), 0);
  for (const auto& [first, second] : segmentation.conflicts) {
    if (!second) continue;
    if (segmentation.candidates[first].solved) ++walls[*second];
    if (segmentation.candidates[*second].solved) ++walls[first];
  }
  return walls;
}

auto parallel_sweep_edge(std::span<const geometry::Segment2> edge, std::span<const sweep::SweepEdge> sweep_edges)
    -> std::optional<double> {
  using geometry::dot;
  constexpr double near = 0.5;      // m; farther away another wall is meant
  constexpr double parallel = 0.1;  // sine: 6°
  double length = 0;
  for (const auto& [a, b] : edge) length += geometry::length(b - a);
  std::optional<double> nearest;
  for (const auto& sweep_edge : sweep_edges) {
    const auto& [from, to] = sweep_edge.segment;
    const double reach = geometry::length(to - from);
    if (!(reach > 0)) continue;
    const auto along = (1 / reach) * (to - from), across = geometry::left_of(along);
    double beside = 0, off = 0;  // m of the edge, and its distance times that
    for (const auto& [a, b] : edge) {
      const double own = geometry::length(b - a), aside = std::abs(dot(0.5 * (a + b) - from, across));
      if (aside > near || std::abs(cross(b - a, along)) > parallel * own) continue;
      const double s = dot(a - from, along), t = dot(b - from, along);
      const double common = std::max(0.0, std::min(reach, std::max(s, t)) - std::max(0.0, std::min(s, t)));
      beside += common;
      off += common * aside;
    }
    if (beside > length / 2 && (!nearest || off / beside < *nearest)) nearest = off / beside;
  }
  return nearest;
}

auto why(const segment::Candidate& c, const Beside& beside) -> std::string {
  if (c.solved && !c.chosen)
    return "cut by the program, but one side is too small or narrow for a part: joined or left out";
  if (c.forced) return "cut: between two features" + told(beside.later);
  const double cut = c.costs.sum(segment::Paid::cut) + static_cast<double>(beside.walls) * beside.phi,
               uncut = c.costs.sum(segment::Paid::uncut);
  const std::string cutting = "cutting costs " + listed(if_cut(c, beside.walls, beside.phi)),
                    joining = "joining costs " + listed(paid(c, segment::Paid::uncut));
  std::string text;
  if (c.solved && cut <= uncut) text = "cut: " + joining + "; " + cutting;
  else if (c.solved) text = "cut though dearer by itself: " + cutting + "; " + joining + "; its ends need a wall";
  else if (cut >= uncut) text = "not cut: " + cutting + "; " + joining;
  else
    text = "not cut though cheaper by itself: " + cutting + "; " + joining + "; the walls that its ends need cost more";
  if (beside.sweep_edge)
    text += "; a sweep-edge runs parallel to it, " + base::to_text(*beside.sweep_edge, 2) + " m away";
  return text + told(beside.later);
}

}  // namespace mansard::report::detail
