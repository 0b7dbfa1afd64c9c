// Which walls there are, and which of them can be seen.
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "layout.hpp"

namespace mansard::planted {
namespace {

using geometry::Point2;
using geometry::Segment2;

struct Edge {
  std::size_t house = 0;
  Segment2 segment;
};

auto edges_of(const std::vector<House>& houses) -> std::vector<Edge> {
  std::vector<Edge> edges;
  for (std::size_t h = 0; h < houses.size(); ++h) {
    const auto& ring = houses[h].polygon.outer;
    for (std::size_t k = 0; k < ring.size(); ++k) edges.push_back({h, {ring[k], ring[(k + 1) % ring.size()]}});
  }
  return edges;
}

auto at(const Segment2& s, double t) -> Point2 { return s.start + t * (s.end - s.start); }
auto length(const Segment2& s) -> double { return geometry::length(s.end - s.start); }

/// The stretch of `a` along which `b` runs back, as parameters of `a`; from = to where it does not.
auto shared(const Segment2& a, const Segment2& b) -> std::pair<double, double> {
  const Point2 along = a.end - a.start;
  if (geometry::dot(along, b.end - b.start) >= 0 || std::abs(geometry::cross(along, b.start - a.start)) > 1e-9 ||
      std::abs(geometry::cross(along, b.end - a.start)) > 1e-9)
    return {0, 0};
  const double from = std::max(0.0, geometry::parameter(a, b.end)), to = std::min(1.0, geometry::parameter(a, b.start));
  return {from, std::max(from, to)};
}

/// Mean height of one roof over another along a line.
auto mean_step(const House& left, const House& right, const Segment2& wall) -> double {
  double sum = 0;
  constexpr int samples = 16;
  for (int k = 0; k < samples; ++k) {
    const Point2 p = at(wall, (k + 0.5) / samples);
    sum += top(left, p) - top(right, p);
  }
  return sum / samples;
}

/// The stretches of the houses' edges without a neighbour, outside on the left.
auto outside_walls(const std::vector<House>& houses) -> std::vector<Visible> {
  const auto edges = edges_of(houses);
  std::vector<Visible> walls;
  for (const Edge& e : edges) {
    std::map<double, double> covered;
    for (const Edge& f : edges) {
      if (f.house == e.house) continue;
      const auto [from, to] = shared(e.segment, f.segment);
      if (to > from) covered[from] = to;
    }
    const double eaves = houses[e.house].eaves;
    const auto add = [&](double from, double to) {
      if ((to - from) * length(e.segment) < 1e-6) return;
      const Segment2 wall{at(e.segment, to), at(e.segment, from)};
      walls.push_back({wall, 0, eaves, eaves * length(wall)});
    };
    double done = 0;
    for (const auto& [from, to] : covered) {
      add(done, from);
      done = std::max(done, to);
    }
    add(done, 1);
  }
  return walls;
}

/// A point and a direction, so that walls which continue each other find each other.
using Place = std::array<long long, 4>;
auto place(Point2 p, const Segment2& s) -> Place {
  const Point2 d = geometry::normalised(s.end - s.start);
  return {std::llround(1e4 * p.x), std::llround(1e4 * p.y), std::llround(1e4 * d.x), std::llround(1e4 * d.y)};
}

auto joined(const std::vector<Visible>& walls) -> std::vector<Visible> {
  std::map<Place, std::size_t> starting, ending;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    starting.emplace(place(walls[k].segment.start, walls[k].segment), k);
    ending.emplace(place(walls[k].segment.end, walls[k].segment), k);
  }
  std::vector<Visible> chains;
  for (const Visible& first : walls) {
    if (ending.contains(place(first.segment.start, first.segment))) continue;  // part of a chain that starts before
    Visible chain = first;
    for (auto next = starting.find(place(chain.segment.end, chain.segment)); next != starting.end();
         next = starting.find(place(chain.segment.end, chain.segment))) {
      const Visible& more = walls[next->second];
      chain = {{chain.segment.start, more.segment.end},
               std::min(chain.low, more.low),
               std::max(chain.high, more.high),
               chain.area + more.area};
    }
    chains.push_back(chain);
  }
  return chains;
}

}  // namespace

auto walls_between(const std::vector<House>& houses) -> std::vector<Wall> {
  const auto edges = edges_of(houses);
  std::vector<Wall> walls;
  for (const Edge& e : edges)
    for (const Edge& f : edges) {
      if (e.house >= f.house) continue;
      const auto [from, to] = shared(e.segment, f.segment);
      if ((to - from) * length(e.segment) < 1e-6) continue;
      const Segment2 wall{at(e.segment, from), at(e.segment, to)};
      walls.push_back({wall, e.house, f.house, mean_step(houses[e.house], houses[f.house], wall)});
    }
  return walls;
}

auto visible_walls(const std::vector<House>& houses, const std::vector<Wall>& walls, double seen_step)
    -> std::vector<Visible> {
  std::vector<Visible> visible = outside_walls(houses);
  for (const Wall& w : walls) {
    if (std::abs(w.step) < seen_step) continue;
    const bool left_is_higher = w.step > 0;
    const double low = houses[left_is_higher ? w.right : w.left].eaves;
    const Segment2 seen = left_is_higher ? Segment2{w.segment.end, w.segment.start} : w.segment;
    visible.push_back({seen, low, low + std::abs(w.step), std::abs(w.step) * length(w.segment)});
  }
  return joined(visible);
}

}  // namespace mansard::planted
