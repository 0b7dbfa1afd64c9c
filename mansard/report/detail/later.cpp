#include "mansard/report/detail/later.hpp"
#include "mansard/geometry/edges.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace mansard::report::detail {
namespace {

using geometry::Point2;
using geometry::Segment2;

constexpr double kept_within = 0.05;  // m; what docs/robustness.md counts as a change is more
constexpr double farthest = 1;        // m; refine.outlines_max_move: no step of the refinement moves a wall farther
constexpr double spacing = 0.25;      // m; the grid of the heights that refinement goes by
constexpr double cell = 4;            // m; decides about the time of the search alone

/// Two parts have the same wall where their outlines are nearer than this: guarantee 3 of `segment` is 1 cm.
constexpr double same_wall = 0.02;  // m

auto index(double v) -> std::int64_t { return static_cast<std::int64_t>(std::floor(v / cell)); }

template <class See>
void each_cell(const geometry::Box2& box, See see) {
  for (auto i = index(box.least.x); i <= index(box.most.x); ++i)
    for (auto j = index(box.least.y); j <= index(box.most.y); ++j) see(std::pair(i, j));
}

}  // namespace

FinalWalls::FinalWalls(std::span<const model::Building> buildings) {
  std::size_t part = 0;
  for (const auto& building : buildings)
    for (const auto& one : building.parts) {
      geometry::each_edge(model::polygon_of(one.plan), [&](auto from, auto to) {
        edges_.push_back({{from, to}, part});
      });
      ++part;
    }
  for (std::size_t i = 0; i < edges_.size(); ++i)
    each_cell(geometry::Box2::of(edges_[i].segment), [&](Cell at) { near_[at].push_back(i); });
}

auto FinalWalls::nearest(Point2 at, Point2 across) const -> double {
  const Segment2 look{at - farthest * across, at + farthest * across};
  std::set<std::size_t> near;
  each_cell(geometry::Box2::of(look), [&](Cell c) {
    if (const auto found = near_.find(c); found != near_.end()) near.insert(found->second.begin(), found->second.end());
  });
  struct Crossing {
    double off = 0;  // m
    std::size_t part = 0;
  };
  std::vector<Crossing> crossings;
  for (const std::size_t i : near) {
    const auto& [a, b] = edges_[i].segment;
    const double turned = cross(across, b - a);
    if (turned == 0) continue;
    const double off = cross(a - at, b - a) / turned, along = cross(a - at, across) / turned;
    if (std::abs(off) <= farthest && along >= 0 && along <= 1) crossings.push_back({off, edges_[i].part});
  }
  double best = -1;
  for (const auto& one : crossings) {
    const double off = std::abs(one.off);
    const bool between = std::ranges::any_of(crossings, [&](const Crossing& other) {
      return other.part != one.part && std::abs(other.off - one.off) <= same_wall;
    });
    if ((between || off <= kept_within) && (best < 0 || off < best)) best = off;
  }
  return best;
}

auto FinalWalls::later(std::span<const Segment2> wall) const -> Later {
  Later out;
  for (const auto& [a, b] : wall) {
    const double length = geometry::length(b - a);
    const auto samples = static_cast<std::size_t>(std::ceil(length / spacing));
    const Point2 across = geometry::left_of(geometry::normalised(b - a));
    for (std::size_t i = 0; i < samples; ++i) {
      const double each = length / static_cast<double>(samples);
      const double off = nearest(a + (static_cast<double>(i) + 0.5) / static_cast<double>(samples) * (b - a), across);
      if (off < 0) out.dropped += each;
      else if (off <= kept_within) out.kept += each;
      else out.moved += each, out.by += each * off;
    }
  }
  if (out.moved > 0) out.by /= out.moved;
  return out;
}

}  // namespace mansard::report::detail
