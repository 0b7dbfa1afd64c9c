#include "lab/simulate/detail/party.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mansard::simulate::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Segment2;

constexpr double shortest = 0.2;  // m

/// What of `of` lies beside `other`, if it runs the opposite way close by.
auto beside(const Segment2& of, const Segment2& other, double apart) -> std::optional<Segment2> {
  const double long_one = length(of.end - of.start), back = length(other.end - other.start);
  if (long_one < shortest || back < shortest) return std::nullopt;
  const Point2 u = (1 / long_one) * (of.end - of.start), v = (1 / back) * (other.end - other.start);
  constexpr double opposite = -0.999;
  if (dot(u, v) > opposite) return std::nullopt;
  const double s = dot(other.end - of.start, u), t = dot(other.start - of.start, u);
  const double from = std::max(0.0, s), to = std::min(long_one, t);
  if (to - from < shortest) return std::nullopt;
  const double middle = (from + to) / 2;
  const Point2 p = of.start + middle * u;
  if (geometry::distance(other, p) > apart) return std::nullopt;
  return Segment2{of.start + from * u, of.start + to * u};
}

/// z of the highest point of the walls along the line, if there are any.
auto wall_top(const std::vector<std::vector<Point3>>& walls, const Segment2& line) -> std::optional<double> {
  const Point2 middle = 0.5 * (line.start + line.end), u = normalised(line.end - line.start);
  const double half = length(line.end - line.start) / 2;
  std::optional<double> top;
  for (const auto& loop : walls) {
    constexpr double near = 0.1;
    if (!std::ranges::all_of(loop, [&](Point3 p) { return std::abs(dot(xy(p) - middle, left_of(u))) < near; }))
      continue;
    // Of a longer wall only what stands over the line; its top there by the edges of its outline.
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3 a = loop[i], b = loop[(i + 1) % loop.size()];
      const double s = dot(xy(a) - middle, u), t = dot(xy(b) - middle, u);
      if (std::max(s, t) < -half || std::min(s, t) > half) continue;
      const auto z = [&](double at) {
        return s == t ? std::max(a.z, b.z) : a.z + std::clamp((at - s) / (t - s), 0.0, 1.0) * (b.z - a.z);
      };
      const double here = std::max(z(std::max(-half, std::min(s, t))), z(std::min(half, std::max(s, t))));
      top = std::max(top.value_or(here), here);
    }
  }
  return top;
}

}  // namespace

void add_sides(const geometry::Polygon& polygon, std::size_t owner, std::vector<Side>& sides) {
  const auto add = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) sides.push_back({{ring[i], ring[(i + 1) % ring.size()]}, owner});
  };
  add(polygon.outer);
  for (const auto& hole : polygon.holes) add(hole);
}

auto shared_sides(const std::vector<Side>& sides, double apart) -> std::vector<Shared> {
  // From left to right: those that begin before another ends.
  std::vector<std::size_t> order(sides.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto least = [&](std::size_t s) { return std::min(sides[s].line.start.x, sides[s].line.end.x) - apart; };
  const auto most = [&](std::size_t s) { return std::max(sides[s].line.start.x, sides[s].line.end.x); };
  std::ranges::sort(order,
                    [&](std::size_t a, std::size_t b) { return std::pair(least(a), a) < std::pair(least(b), b); });
  std::vector<Shared> shared;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && least(order[j]) <= most(order[i]); ++j) {
      auto a = order[i], b = order[j];
      if (sides[a].owner == sides[b].owner) continue;
      if (sides[a].owner > sides[b].owner) std::swap(a, b);
      if (const auto line = beside(sides[a].line, sides[b].line, apart)) shared.push_back({a, b, *line});
    }
  std::ranges::sort(shared, [](const Shared& a, const Shared& b) { return std::tie(a.a, a.b) < std::tie(b.a, b.b); });
  return shared;
}

auto standing_of(const model::Building& building) -> Standing {
  Standing out;
  for (const auto& part : building.parts) {
    constexpr double storey = 2.5;  // m; what begins higher stands on another part
    if (part.plan.base <= building.ground + storey) out.outlines.push_back(model::polygon_of(part.plan));
    const auto& solid = part.model.solid;
    for (std::size_t f = 0; f < solid.faces.size(); ++f) {
      if (part.model.classes[f] != model::FaceClass::wall && part.model.classes[f] != model::FaceClass::party_wall)
        continue;
      auto& wall = out.walls.emplace_back();
      for (const auto v : solid.faces[f].loops.front()) wall.push_back(solid.vertices[v]);
    }
  }
  return out;
}

auto party_walls_of(const std::vector<Standing>& buildings, double apart) -> std::vector<PartyWall> {
  std::vector<Side> sides;
  for (std::size_t b = 0; b < buildings.size(); ++b)
    for (const auto& outline : buildings[b].outlines) add_sides(outline, b, sides);
  std::vector<PartyWall> walls;
  for (const auto& [a, b, line] : shared_sides(sides, apart)) {
    const auto first = sides[a].owner, second = sides[b].owner;
    walls.push_back(
        {line, first, second, wall_top(buildings[first].walls, line), wall_top(buildings[second].walls, line)});
  }
  std::ranges::sort(walls, [](const PartyWall& a, const PartyWall& b) {
    return std::tie(a.first, a.second, a.line) < std::tie(b.first, b.second, b.line);
  });
  return walls;
}

}  // namespace mansard::simulate::detail
