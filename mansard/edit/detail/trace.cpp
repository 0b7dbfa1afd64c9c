#include "mansard/edit/detail/trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "mansard/geometry/predicates.hpp"

namespace mansard::edit::detail {
namespace {

using geometry::Point2;

/// Whether turning clockwise from `back` about `at` one meets a before b. Straight back comes last.
auto earlier(Point2 at, Point2 back, Point2 a, Point2 b) -> bool {
  const auto quarter = [&](Point2 p) {
    const int side = geometry::orientation(at, back, p);
    if (side != 0) return side < 0 ? 0 : 2;
    return dot(back - at, p - at) < 0 ? 1 : 3;
  };
  const int of_a = quarter(a), of_b = quarter(b);
  return of_a != of_b ? of_a < of_b : geometry::orientation(at, a, b) < 0;
}

void use(model::PlanRing& ring, const std::vector<std::uint32_t>& index_of) {
  for (auto& profile : ring.profile_of_edge) profile = index_of[profile];
}

}  // namespace

auto cycles_of(std::span<const Edge> edges) -> std::optional<std::vector<Cycle>> {
  std::map<Point2, std::vector<std::size_t>> leaving;
  for (std::size_t i = 0; i < edges.size(); ++i) leaving[edges[i].from].push_back(i);

  std::vector<std::size_t> next(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto found = leaving.find(edges[i].to);
    if (found == leaving.end()) return std::nullopt;
    next[i] = *std::ranges::min_element(found->second, [&](std::size_t a, std::size_t b) {
      return earlier(edges[i].to, edges[i].from, edges[a].to, edges[b].to);
    });
  }

  std::vector<Cycle> cycles;
  std::vector<bool> seen(edges.size(), false);
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (seen[first]) continue;
    auto& cycle = cycles.emplace_back();
    std::size_t i = first;
    for (; !seen[i]; i = next[i]) {
      seen[i] = true;
      cycle.push_back(i);
    }
    if (i != first) return std::nullopt;  // two edges go on with the same one
  }
  return cycles;
}

auto ring_of(std::span<const Edge> edges, const Cycle& cycle) -> model::PlanRing {
  model::PlanRing ring;
  for (const auto i : cycle) {
    ring.points.push_back(edges[i].from);
    ring.profile_of_edge.push_back(edges[i].label);
  }
  return ring;
}

auto outlines_of(std::span<const Edge> edges, const std::vector<Cycle>& cycles) -> std::optional<std::vector<Outline>> {
  std::vector<Outline> outlines;
  std::vector<model::PlanRing> holes;
  for (const auto& cycle : cycles) {
    auto ring = ring_of(edges, cycle);
    if (geometry::signed_area(ring.points) > 0) outlines.push_back({std::move(ring), {}});
    else holes.push_back(std::move(ring));
  }
  for (auto& hole : holes) {
    Outline* around = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (auto& outline : outlines) {
      const double area = geometry::signed_area(outline.outer.points);
      if (area >= least || !geometry::contains(outline.outer.points, hole.points.front())) continue;
      around = &outline;
      least = area;
    }
    if (around == nullptr) return std::nullopt;
    around->holes.push_back(std::move(hole));
  }
  return outlines;
}

auto plan_of(Outline outline, const std::vector<model::Profile>& profiles, double base, double cap) -> model::Plan {
  std::vector<bool> used(profiles.size(), false);
  const auto note = [&](const model::PlanRing& ring) {
    for (const auto profile : ring.profile_of_edge) used[profile] = true;
  };
  note(outline.outer);
  for (const auto& hole : outline.holes) note(hole);

  model::Plan plan;
  plan.base = base;
  plan.cap = cap;
  std::vector<std::uint32_t> index_of(profiles.size(), 0);
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    if (!used[i]) continue;
    index_of[i] = static_cast<std::uint32_t>(plan.profiles.size());
    plan.profiles.push_back(profiles[i]);
  }
  plan.outer = std::move(outline.outer);
  plan.holes = std::move(outline.holes);
  use(plan.outer, index_of);
  for (auto& hole : plan.holes) use(hole, index_of);
  return plan;
}

namespace {

/// In one direction, within a hundredth.
auto parallel(Point2 a, Point2 b) -> bool { return dot(a, b) > 0 && std::abs(cross(a, b)) <= 0.01 * dot(a, b); }

}  // namespace

void keep_overhangs(std::span<const model::Plan* const> from, model::Plan& plan) {
  const auto each_ring = [](auto& of, auto visit) {
    visit(of.outer);
    for (auto& hole : of.holes) visit(hole);
  };
  /// Of the edge from a to b; 0 where it is part of none that overhangs.
  const auto overhang_of = [&](Point2 a, Point2 b) {
    double found = 0;
    for (const auto* other : from)
      each_ring(*other, [&](const model::PlanRing& ring) {
        for (std::size_t i = 0; i < ring.overhang_of_edge.size(); ++i) {
          const geometry::Segment2 edge{ring.points[i], ring.points[(i + 1) % ring.points.size()]};
          if (parallel(edge.end - edge.start, b - a) && geometry::distance(edge, 0.5 * (a + b)) <= snap)
            found = std::max(found, ring.overhang_of_edge[i]);
        }
      });
    return found;
  };
  each_ring(plan, [&](model::PlanRing& ring) {
    std::vector<double> overhangs;
    for (std::size_t i = 0; i < ring.points.size(); ++i)
      overhangs.push_back(overhang_of(ring.points[i], ring.points[(i + 1) % ring.points.size()]));
    const bool any = std::ranges::any_of(overhangs, [](double o) { return o > 0; });
    ring.overhang_of_edge = any ? std::move(overhangs) : std::vector<double>();
  });
}

auto edges_of(const model::Plan& plan) -> std::vector<Edge> {
  std::vector<Edge> edges;
  const auto add = [&](const model::PlanRing& ring) {
    for (std::size_t i = 0; i < ring.points.size(); ++i)
      edges.push_back({ring.points[i], ring.points[(i + 1) % ring.points.size()], ring.profile_of_edge[i]});
  };
  add(plan.outer);
  for (const auto& hole : plan.holes) add(hole);
  return edges;
}

auto broken_at(std::span<const Edge> edges, std::vector<std::vector<geometry::Point2>> on) -> std::vector<Edge> {
  std::vector<Edge> out;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const geometry::Segment2 edge{edges[i].from, edges[i].to};
    std::ranges::sort(on[i], {}, [&](geometry::Point2 p) { return std::pair(geometry::parameter(edge, p), p); });
    on[i].erase(std::ranges::unique(on[i]).begin(), on[i].end());
    geometry::Point2 from = edges[i].from;
    for (const geometry::Point2 p : on[i]) {
      out.push_back({from, p, edges[i].label});
      from = p;
    }
    out.push_back({from, edges[i].to, edges[i].label});
  }
  return out;
}

auto overlap(const geometry::Polygon& a, const geometry::Polygon& b) -> base::Result<double> {
  if (!geometry::bounds(a.outer).overlaps(geometry::bounds(b.outer))) return 0.0;
  const auto common = geometry::intersect(a, b);
  if (!common) return common.failure();
  double sum = 0;
  for (const auto& piece : *common) {
    if (geometry::area(piece) <= least_area) continue;
    const auto core = geometry::buffer(piece, -snap);
    if (!core) return core.failure();
    for (const auto& polygon : *core) sum += geometry::area(polygon);
  }
  return sum;
}

}  // namespace mansard::edit::detail
