#include "mansard/extrude/detail/grid.hpp"

#include <cmath>

namespace mansard::extrude::detail {

using geometry::Box2;
using geometry::Point2;

namespace {

/// Exact for coordinates beyond 2^16, which have no digits below the grid.
auto snapped(double metres) -> double {
  return std::abs(metres) < 0x1.0p16 ? std::nearbyint(metres / grid_step) * grid_step : metres;
}

auto box_of(GridPoint a, GridPoint b) -> Box2 {
  // Conversion is monotone: boxes that overlap still do.
  return Box2::of(geometry::Segment2{{static_cast<double>(a.x), static_cast<double>(a.y)},
                                     {static_cast<double>(b.x), static_cast<double>(b.y)}});
}

auto within(GridPoint a, GridPoint b, GridPoint p) -> bool {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

struct Found {
  Meeting::Kind kind;
  Point2 at;
};

/// What two edges without a common corner have in common.
auto meeting_of(GridPoint a, GridPoint b, GridPoint c, GridPoint d) -> std::optional<Found> {
  const Int128 at_c = cross(b - a, c - a), at_d = cross(b - a, d - a);
  const int c_side = sign(at_c), d_side = sign(at_d);
  if (c_side * d_side > 0) return std::nullopt;
  const int a_side = turn(c, d, a), b_side = turn(c, d, b);
  if (a_side * b_side > 0) return std::nullopt;
  if (c_side * d_side < 0 && a_side * b_side < 0) {
    const double from = std::abs(static_cast<double>(at_c)), to = std::abs(static_cast<double>(at_d));
    return Found{Meeting::Kind::crossing, metres(c) + from / (from + to) * (metres(d) - metres(c))};
  }
  const bool on_c = c_side == 0 && within(a, b, c), on_d = d_side == 0 && within(a, b, d);
  const bool on_a = a_side == 0 && within(c, d, a), on_b = b_side == 0 && within(c, d, b);
  if (!(on_a || on_b || on_c || on_d)) return std::nullopt;
  const Point2 at = metres(on_c ? c : on_d ? d : on_a ? a : b);
  const bool one_line = c_side == 0 && d_side == 0;
  const bool stretch = one_line && std::max(std::min(a, b), std::min(c, d)) < std::min(std::max(a, b), std::max(c, d));
  return Found{stretch ? Meeting::Kind::overlap : Meeting::Kind::touch, at};
}

}  // namespace

auto origin_of(const Box2& box) -> Point2 {
  // Round-half-even on twice the centre: a quarter metre goes to the whole one on either side of zero.
  const auto middle = [](double least, double most) { return std::nearbyint(snapped(least) + snapped(most)) / 2; };
  return {middle(box.least.x, box.most.x), middle(box.least.y, box.most.y)};
}

auto on_fine_grid(std::span<const Point2> ring, Point2 origin) -> GridRing {
  GridRing out;
  out.reserve(ring.size());
  for (const Point2 p : ring)
    out.push_back({static_cast<std::int64_t>(std::nearbyint((snapped(p.x) - origin.x) / grid_step)),
                   static_cast<std::int64_t>(std::nearbyint((snapped(p.y) - origin.y) / grid_step))});
  return out;
}

auto meetings_of(std::span<const GridRing> rings, std::size_t most) -> Meetings {
  struct Edge {
    GridPoint from, to;
    Meeting::Edge name;
  };
  std::vector<Edge> edges;
  std::vector<Box2> boxes;
  std::size_t count = 0;
  for (const auto& ring : rings) count += ring.size();
  edges.reserve(count);
  boxes.reserve(count);
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (std::size_t i = 0; i < rings[r].size(); ++i) {
      const GridPoint from = rings[r][i], to = rings[r][i + 1 < rings[r].size() ? i + 1 : 0];
      edges.push_back({from, to, {r, i}});
      boxes.push_back(box_of(from, to));
    }
  Meetings out;
  for_each_overlap(boxes, [&](std::size_t i, std::size_t j) {
    const Edge &p = edges[i], &q = edges[j];
    const std::size_t size = rings[p.name.ring].size();
    const auto next = [size](std::size_t k) { return k + 1 < size ? k + 1 : 0; };
    const bool one_ring = p.name.ring == q.name.ring;
    std::optional<Found> found;
    if (one_ring && (next(p.name.index) == q.name.index || next(q.name.index) == p.name.index)) {
      const Edge &first = next(p.name.index) == q.name.index ? p : q, &second = &first == &p ? q : p;
      // Consecutive edges may only share their corner: not fold back onto each other.
      if (turn(first.from, second.from, second.to) != 0 || dot(first.to - first.from, second.to - second.from) > 0)
        return true;
      found = {Meeting::Kind::spike, metres(second.from)};
    } else {
      found = meeting_of(p.from, p.to, q.from, q.to);
    }
    if (!found) return true;
    const Meeting meeting{found->kind, std::min(p.name, q.name), std::max(p.name, q.name), found->at};
    if (!out.first || meeting < *out.first) out.first = meeting;
    return ++out.count < most;
  });
  return out;
}

auto contains(const GridRing& ring, GridPoint p) -> bool {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const GridPoint a = ring[i], b = ring[i + 1 < ring.size() ? i + 1 : 0];
    if (std::max(a.y, b.y) < p.y || std::min(a.y, b.y) > p.y) continue;
    const int side = turn(a, b, p);
    if (side == 0 && within(a, b, p)) return true;
    if ((a.y > p.y) != (b.y > p.y) && (side > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside;
}

auto twice_area(const GridRing& ring) -> double {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum += static_cast<double>(cross(ring[i] - ring[0], ring[i + 1] - ring[0]));
  return sum;
}

}  // namespace mansard::extrude::detail
