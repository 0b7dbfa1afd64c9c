#include "mansard/segment/detail/gis_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::segment::detail {
namespace {

using geometry::Box2, geometry::Point2, geometry::Segment2;

auto edges_of(const block::Member& member) -> std::vector<Segment2> {
  std::vector<Segment2> edges;
  const auto add = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
  };
  for (const auto& polygon : member.polygons) {
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
  }
  return edges;
}

/// The part of `edge`, from 0 to its length, where `other` runs along it; empty (from ≥ to) if none.
auto shared(const Segment2& edge, const Segment2& other, const Options& o) -> std::pair<double, double> {
  const Point2 a = edge.end - edge.start, b = other.end - other.start;
  const double la = geometry::length(a), lb = geometry::length(b);
  if (la == 0 || lb == 0 || std::abs(geometry::cross(a, b)) > o.gis_parallel_sine * la * lb) return {0, 0};
  double from = geometry::dot(other.start - edge.start, a) / la, to = geometry::dot(other.end - edge.start, a) / la;
  double aside_from = geometry::cross(a, other.start - edge.start) / la;
  double aside_to = geometry::cross(a, other.end - edge.start) / la;
  if (from > to) std::swap(from, to), std::swap(aside_from, aside_to);
  // Where the other's distance, linear along it, is within ±gis_near.
  const double slope = to > from ? (aside_to - aside_from) / (to - from) : 0;
  double low = from, high = to;
  if (slope != 0) {
    double one = from + (-o.gis_near - aside_from) / slope, two = from + (o.gis_near - aside_from) / slope;
    if (one > two) std::swap(one, two);
    low = std::max(low, one), high = std::min(high, two);
  } else if (std::abs(aside_from) > o.gis_near) {
    return {0, 0};
  }
  return {std::max(low, 0.0), std::min(high, la)};
}

/// Overlapping stretches, and those with less than `gap` between them, become one.
auto merged(std::vector<std::pair<double, double>> stretches, double gap) -> std::vector<std::pair<double, double>> {
  std::ranges::sort(stretches);
  std::vector<std::pair<double, double>> out;
  for (const auto& stretch : stretches)
    if (!out.empty() && stretch.first <= out.back().second + gap)
      out.back().second = std::max(out.back().second, stretch.second);
    else out.push_back(stretch);
  return out;
}

void add_piece(const Segment2& edge, double from, double to, double shortest, std::vector<Segment2>& lines) {
  const Point2 along = geometry::normalised(edge.end - edge.start);
  if (to - from >= shortest) lines.push_back({edge.start + from * along, edge.start + to * along});
}

auto longest_first(std::vector<Segment2> lines) -> std::vector<Segment2> {
  const auto squared = [](const Segment2& s) { return geometry::dot(s.end - s.start, s.end - s.start); };
  std::ranges::sort(lines, [&](const Segment2& a, const Segment2& b) {
    return std::pair(-squared(a), a) < std::pair(-squared(b), b);
  });
  return lines;
}

}  // namespace

auto party_lines(const block::Block& block, const Options& o) -> std::vector<Segment2> {
  std::vector<std::vector<Segment2>> edges;
  std::vector<Box2> boxes(block.members.size());
  for (std::size_t m = 0; m < block.members.size(); ++m) {
    edges.push_back(edges_of(block.members[m]));
    for (const Segment2& e : edges[m]) boxes[m].add(e.start);
  }
  std::vector<Segment2> lines;
  for (std::size_t m = 0; m < edges.size(); ++m) {
    std::vector<std::size_t> others;
    for (std::size_t n = m + 1; n < edges.size(); ++n)
      if (!boxes[m].empty() && !boxes[n].empty() && boxes[m].grown(o.gis_near).overlaps(boxes[n])) others.push_back(n);
    for (const Segment2& edge : edges[m]) {
      const Box2 box = Box2::of(edge).grown(o.gis_near);
      std::vector<std::pair<double, double>> stretches;
      for (const std::size_t n : others)
        for (const Segment2& other : edges[n]) {
          if (!box.overlaps(Box2::of(other))) continue;
          const auto stretch = shared(edge, other, o);
          if (stretch.first < stretch.second) stretches.push_back(stretch);
        }
      for (const auto& [from, to] : merged(std::move(stretches), o.gis_shortest))
        add_piece(edge, from, to, o.gis_shortest, lines);
    }
  }
  return longest_first(std::move(lines));
}

auto torn_lines(const block::Block& block, const sweep::SweepEdges& sweeps, const Options& o) -> std::vector<Segment2> {
  // Walls that may be known already: sweep-edges, which belong to no member, and the edges of all members.
  std::vector<Segment2> walls;
  std::vector<std::optional<std::size_t>> owners;
  for (const auto& sweep : sweeps.edges) walls.push_back(sweep.segment);
  owners.resize(walls.size());
  std::vector<std::vector<Segment2>> edges;
  for (const auto& member : block.members) {
    const auto& own = edges.emplace_back(edges_of(member));
    walls.insert(walls.end(), own.begin(), own.end());
    owners.resize(walls.size(), edges.size() - 1);
  }
  std::vector<Box2> boxes;
  boxes.reserve(walls.size());
  for (const Segment2& wall : walls) boxes.push_back(Box2::of(wall));
  const geometry::BoxIndex index(boxes);
  std::vector<Segment2> lines;
  for (std::size_t m = 0; m < edges.size(); ++m)
    for (const Segment2& edge : edges[m]) {
      std::vector<std::pair<double, double>> known;  // stretches along which the wall is known already
      for (const auto k : index.overlapping(Box2::of(edge).grown(o.gis_near))) {
        if (owners[k] == m) continue;
        const auto stretch = shared(edge, walls[k], o);
        if (stretch.first < stretch.second) known.push_back(stretch);
      }
      double from = 0;
      for (const auto& [first, last] : merged(std::move(known), o.gis_shortest)) {
        add_piece(edge, from, first, o.gis_shortest, lines);
        from = last;
      }
      add_piece(edge, from, geometry::length(edge.end - edge.start), o.gis_shortest, lines);
    }
  return longest_first(std::move(lines));
}

}  // namespace mansard::segment::detail
