#include "mansard/refine/detail/wings.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/refine/detail/pieces.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;
using geometry::Segment2;

/// Error bound: metres, and shares of an edge. Coordinates below 1e4 m are exact to 1e-12 m, a line that crosses an
/// edge at 20° or more is off by some 1e-11 m, and a clip's corner by as little; the shortest edge is 1 mm, so that a
/// share of it is off by 1e-8. Two real corners are never so near.
constexpr double same_place = 1e-6;

template <class See>
void each_ring(const Polygon& polygon, See see) {
  see(polygon.outer);
  for (const auto& hole : polygon.holes) see(hole);
}

/// From a reflex corner straight on through the part to its boundary.
auto line_on(const Polygon& part, Point2 from, Point2 direction) -> std::optional<Segment2> {
  double nearest = -1;
  each_ring(part, [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], edge = ring[(i + 1) % ring.size()] - a;
      const double turned = cross(direction, edge);
      if (turned == 0) continue;
      const double t = cross(a - from, edge) / turned, s = cross(a - from, direction) / turned;
      if (t > same_place && s >= -same_place && s <= 1 + same_place && (nearest < 0 || t < nearest)) nearest = t;
    }
  });
  if (nearest < 0) return std::nullopt;
  return Segment2{from, from + nearest * direction};
}

/// The pieces of the part on the left of a line that lie along one of the new lines.
auto side_of(const Polygon& part, Point2 on, Point2 along, const std::vector<Segment2>& lines,
             const Options::Pieces& options) -> std::vector<Polygon> {
  const auto box = geometry::bounds(part.outer);
  const double far = 2 * geometry::length(box.most - box.least) + geometry::length(on - box.least);
  const Point2 a = on - far * along, b = on + far * along, up = far * geometry::left_of(along);
  const auto [whole, half] = fitted(part, Polygon{{a, b, b + up, a + up}, {}}, options);
  auto pieces = geometry::intersect(whole, half);
  std::vector<Polygon> out;
  if (!pieces) return out;
  for (auto& piece : tidied(std::move(*pieces), options))
    if (std::ranges::any_of(lines, [&](const Segment2& line) {
          return geometry::boundary_distance(piece, 0.5 * (line.start + line.end)) < 2 * options.straight;
        }))
      out.push_back(std::move(piece));
  return out;
}

auto length_of(const Segment2& line) -> double { return geometry::length(line.end - line.start); }

/// One side of the lines with a wedge beyond each: where slopes of one pitch meet at right angles, the valley runs at
/// 45°. The wedge reaches a little into the side, so that no rounding leaves a slit between the two.
auto with_wedges(const std::vector<Polygon>& side, Point2 along, const std::vector<Segment2>& lines,
                 const Options::Pieces& options) -> std::vector<Polygon> {
  constexpr double overlap = 0.01;  // of the line's length: 1°, far less than any inner corner
  std::vector<Polygon> all = side;
  for (const Segment2& line : lines) {
    const Point2 middle = 0.5 * (line.start + line.end), up = length_of(line) * geometry::left_of(along);
    all.push_back(geometry::oriented({{line.start, middle + overlap * up, line.end, middle - 0.5 * up}, {}}));
  }
  auto united = geometry::unite(all);
  return united ? tidied(std::move(*united), options) : std::vector<Polygon>{};
}

}  // namespace

auto wing_lines_of(const Polygon& part, const Options& options) -> std::vector<WingLine> {
  std::vector<WingLine> out;
  const auto reflex = [&](Point2 before, Point2 after) { return cross(before, after) < -options.wings.reflex_sine; };
  each_ring(part, [&](const Ring& ring) {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto direction = [&](std::size_t k) { return geometry::normalised(ring[(k + 1) % n] - ring[k % n]); };
      const Point2 along = direction(i);
      std::vector<Segment2> lines;
      if (reflex(along, direction(i + 1)))
        if (const auto line = line_on(part, ring[(i + 1) % n], along)) lines.push_back(*line);
      if (reflex(direction(i + n - 1), along))
        if (const auto line = line_on(part, ring[i], -1 * along)) lines.push_back(*line);
      if (!lines.empty()) out.push_back({ring[i], along, std::move(lines)});
    }
  });
  return out;
}

auto WingLine::longest() const -> const Segment2& { return *std::ranges::max_element(lines, {}, length_of); }
auto WingLine::middle() const -> Point2 { return 0.5 * (longest().start + longest().end); }
auto WingLine::length() const -> double { return length_of(longest()); }

auto wings_along(const Polygon& part, const WingLine& line, const Options& options) -> std::vector<Polygon> {
  std::vector<Polygon> out;
  const auto add = [&](const std::vector<Polygon>& pieces) {
    if (pieces.size() != 1) return false;
    out.push_back(pieces.front());
    return true;
  };
  bool straight = false;  // the other side of a line is the same cut
  for (const Point2 way : {line.along, -1 * line.along}) {
    const auto side = side_of(part, line.on, way, line.lines, options.pieces);
    straight = straight || add(side);
    add(with_wedges(side, way, line.lines, options.pieces));
  }
  return out;
}

}  // namespace mansard::refine::detail
