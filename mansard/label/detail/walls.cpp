#include "mansard/label/detail/walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
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

constexpr double circle = 2 * std::numbers::pi;

/// The part of the circle that a direction is in; none of no direction.
auto sector_of(Point2 direction, std::size_t sectors) -> std::optional<std::size_t> {
  if (!(dot(direction, direction) > 0)) return std::nullopt;
  const double turn = (std::atan2(direction.y, direction.x) + std::numbers::pi) / circle;
  return std::min(static_cast<std::size_t>(turn * static_cast<double>(sectors)), sectors - 1);
}

/// All walls that may face this one, by parts of the circle: many walls of one direction can be at one place.
auto opposite(const Wall& wall, const Walls& walls, const Options& options) -> std::vector<const Facing*> {
  const std::size_t sectors = walls.facing.size();
  const auto middle = sector_of(-1.0 * wall.outward, sectors);
  if (!middle) return {};
  // As many on each side as the angle covers, and one more for where in the middle one the direction is.
  const double width = circle / static_cast<double>(sectors);
  const auto beside =
      static_cast<std::size_t>(std::acos(std::clamp(options.party_cosine, -1.0, 1.0)) / width + 1e-9) + 1;
  std::vector<const Facing*> out;
  for (std::size_t i = 0; i < std::min(2 * beside + 1, sectors); ++i)
    out.push_back(&walls.facing[(*middle + sectors - beside + i) % sectors]);
  return out;
}

}  // namespace

auto walls_of(std::span<const model::Solid> solids, const std::vector<std::vector<bool>>& is_wall) -> Walls {
  Walls walls;
  for (std::uint32_t s = 0; s < solids.size(); ++s) {
    for (std::uint32_t f = 0; f < solids[s].faces.size(); ++f) {
      const auto& face = solids[s].faces[f];
      if (!is_wall[s][f]) continue;
      Wall wall{s, f, {}, geometry::normalised(geometry::xy(face.normal))};
      for (const auto& loop : face.loops)
        for (const auto v : loop) wall.box.add(geometry::xy(solids[s].vertices[v]));
      if (wall.box.empty()) continue;
      walls.all.push_back(wall);
    }
  }
  for (std::uint32_t i = 0; i < walls.all.size(); ++i)
    if (const auto sector = sector_of(walls.all[i].outward, walls.facing.size()))
      walls.facing[*sector].walls.push_back(i);
  for (auto& [numbers, places] : walls.facing) {
    std::vector<geometry::Box2> boxes;
    for (const auto i : numbers) boxes.push_back(walls.all[i].box);
    places = geometry::BoxIndex(boxes);
  }
  return walls;
}

auto covered_share(const Wall& wall, const Walls& walls, std::span<const model::Solid> solids, const Options& options)
    -> double {
  const double distance = options.party_distance;
  const auto& solid = solids[wall.solid];
  const auto& face = solid.faces[wall.face];
  const Point2 along{-wall.outward.y, wall.outward.x};
  const Frame frame{geometry::xy(solid.vertices[face.loops.front().front()]), along, wall.outward};

  std::vector<Outline> neighbours;
  for (const auto* facing : opposite(wall, walls, options))
    for (const auto near : facing->places.overlapping(wall.box.grown(distance))) {
      const Wall& other = walls.all[facing->walls[near]];
      if (other.solid == wall.solid || dot(wall.outward, other.outward) > -options.party_cosine) continue;
      neighbours.push_back(outline_in(frame, solids[other.solid], solids[other.solid].faces[other.face]));
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
