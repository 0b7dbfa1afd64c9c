#include "mansard/label/detail/walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace mansard::label::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

/// A wall has so many strips: an estimate of its share needs a few dozen, and a wall of a hundred metres no more than
/// two thousand.
constexpr double fewest_strips = 32, most_strips = 2000;

/// A wall's outline before another wall's vertical plane.
struct Corner {
  double along = 0, height = 0, away = 0;  ///< m; `away` outward of the plane
};
using Outline = std::vector<std::vector<Corner>>;

struct Frame {
  Point2 origin, along, outward;
};

auto outline_in(const Frame& frame, const model::Solid& solid, const model::Face& face) -> Outline {
  Outline outline;
  for (const auto& loop : face.loops) {
    auto& ring = outline.emplace_back();
    for (const auto v : loop) {
      const Point3 p = solid.vertices[v];
      const Point2 q = geometry::xy(p) - frame.origin;
      ring.push_back({dot(q, frame.along), p.z, dot(q, frame.outward)});
    }
  }
  return outline;
}

using Interval = std::pair<double, double>;

/// Where the vertical line at `along` runs through the outline, no farther than `distance` from the plane.
void cross(const Outline& outline, double along, double distance, std::vector<Interval>& intervals) {
  std::vector<std::pair<double, double>> crossings;  // (height, away)
  for (const auto& ring : outline) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Corner& a = ring[i];
      const Corner& b = ring[(i + 1) % ring.size()];
      if ((a.along <= along) == (b.along <= along)) continue;
      const double t = (along - a.along) / (b.along - a.along);
      crossings.emplace_back(a.height + t * (b.height - a.height), a.away + t * (b.away - a.away));
    }
  }
  std::ranges::sort(crossings);
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    if (std::abs(crossings[i].second + crossings[i + 1].second) <= 2 * distance)
      intervals.emplace_back(crossings[i].first, crossings[i + 1].first);
}

/// Length of the intersection of two unions of intervals. Those of `a` are disjoint and sorted; `b` gets sorted.
auto common_length(const std::vector<Interval>& a, std::vector<Interval>& b) -> double {
  std::ranges::sort(b);
  double sum = 0;
  for (const auto& [low, high] : a) {
    double reached = low;
    for (const auto& [from, to] : b) {
      const double end = std::min(to, high), begin = std::max(from, reached);
      if (end <= begin) continue;
      sum += end - begin;
      reached = end;
    }
  }
  return sum;
}

}  // namespace

auto walls_of(std::span<const model::Solid> solids, const std::vector<std::vector<bool>>& is_wall)
    -> std::vector<Wall> {
  std::vector<Wall> walls;
  for (std::uint32_t s = 0; s < solids.size(); ++s) {
    for (std::uint32_t f = 0; f < solids[s].faces.size(); ++f) {
      const auto& face = solids[s].faces[f];
      if (!is_wall[s][f]) continue;
      Wall wall{s, f, {}, geometry::normalised(geometry::xy(face.normal))};
      for (const auto& loop : face.loops)
        for (const auto v : loop) wall.box.add(geometry::xy(solids[s].vertices[v]));
      if (!wall.box.empty()) walls.push_back(wall);
    }
  }
  std::ranges::sort(walls, {}, [](const Wall& w) { return std::tuple(w.box.least.x, w.solid, w.face); });
  return walls;
}

auto covered_share(const Wall& wall, std::span<const Wall> walls, std::span<const model::Solid> solids,
                   const Options& options) -> double {
  const double distance = options.party_distance;
  const auto& solid = solids[wall.solid];
  const auto& face = solid.faces[wall.face];
  const Point2 along{-wall.outward.y, wall.outward.x};
  const Frame frame{geometry::xy(solid.vertices[face.loops.front().front()]), along, wall.outward};

  std::vector<Outline> neighbours;
  const auto box = wall.box.grown(distance);
  const auto end = std::ranges::upper_bound(walls, box.most.x, {}, [](const Wall& w) { return w.box.least.x; });
  for (auto other = walls.begin(); other != end; ++other) {
    if (other->solid == wall.solid || !box.overlaps(other->box)) continue;
    if (dot(wall.outward, other->outward) > -options.party_cosine) continue;
    neighbours.push_back(outline_in(frame, solids[other->solid], solids[other->solid].faces[other->face]));
  }
  if (neighbours.empty()) return 0;

  const auto own = outline_in(frame, solid, face);
  double from = own[0][0].along, to = from;
  for (const Corner& c : own[0]) {
    from = std::min(from, c.along);
    to = std::max(to, c.along);
  }
  const auto strips =
      static_cast<std::size_t>(std::clamp((to - from) / options.party_strip, fewest_strips, most_strips));
  double area = 0, covered = 0;
  std::vector<Interval> here, there;
  for (std::size_t i = 0; i < strips; ++i) {
    const double at = from + (to - from) * (static_cast<double>(i) + 0.5) / static_cast<double>(strips);
    here.clear();
    there.clear();
    cross(own, at, std::numeric_limits<double>::infinity(), here);
    for (const auto& outline : neighbours) cross(outline, at, distance, there);
    for (const auto& [low, high] : here) area += high - low;
    covered += common_length(here, there);
  }
  return area > 0 ? covered / area : 0;
}

}  // namespace mansard::label::detail
