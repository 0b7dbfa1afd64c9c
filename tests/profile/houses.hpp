// Synthetic scans of houses: a rectangle with walls, a roof given as a height over it, ground around, and noise.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/profile/profile.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/segment/segment.hpp"

namespace houses {

using mansard::geometry::Mesh;
using mansard::geometry::Point2;
using mansard::geometry::Point3;
using mansard::geometry::Polygon;

/// Height above ground at (x, y) of the house's own frame, metres.
using Roof = std::function<double(double, double)>;

/// Gutter at 6 m, ridge along x.
inline auto gable(double width, double pitch) -> Roof {
  return [=](double, double y) { return 6 + std::tan(pitch) * std::min(y, width - y); };
}
inline auto hip(double length, double width, double pitch) -> Roof {
  return [=](double x, double y) { return 6 + std::tan(pitch) * std::min({x, length - x, y, width - y}); };
}
/// 70° for 1.5 m inward, then 25°.
inline auto mansard_roof(double length, double width) -> Roof {
  return [=](double x, double y) {
    const double in = std::min({x, length - x, y, width - y});
    constexpr double degree = 3.14159265358979323846 / 180;
    return 6 + std::tan(70 * degree) * std::min(in, 1.5) + std::tan(25 * degree) * std::max(0.0, in - 1.5);
  };
}
inline auto flat_with_parapet(double length, double width) -> Roof {
  return [=](double x, double y) { return std::min({x, length - x, y, width - y}) < 0.35 ? 9.8 : 9.0; };
}
inline auto shed(double pitch) -> Roof {
  return [=](double, double y) { return 4 + std::tan(pitch) * y; };
}

struct House {
  double length = 14, width = 9;  ///< m, along x and y
  Roof roof;
  double noise = 0.05;  ///< m, uniform in ± this, every coordinate
  bool walls = true;
  double turned = 0.4;  ///< rad
  Point2 at{100, 50};
  double ground = 12.5;  ///< z
  double edge = 0.4;     ///< m; of the scan's triangles
  std::uint64_t seed = 7;
};

inline auto placed(const House& house, double x, double y) -> Point2 {
  const double c = std::cos(house.turned), s = std::sin(house.turned);
  return house.at + Point2{c * x - s * y, s * x + c * y};
}

class Scan {
 public:
  explicit Scan(const House& house) : house_(house), random_(house.seed) {}

  /// A sheet of triangles over [0, 1]²; `skip` leaves cells out.
  void sheet(std::size_t columns, std::size_t rows, const std::function<Point3(double, double)>& at,
             const std::function<bool(double, double)>& skip = {}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::size_t j = 0; j <= rows; ++j)
      for (std::size_t i = 0; i <= columns; ++i) {
        const Point3 p = at(static_cast<double>(i) / static_cast<double>(columns),
                            static_cast<double>(j) / static_cast<double>(rows));
        const Point2 q = placed(house_, p.x + noise(), p.y + noise());
        mesh.vertices.push_back({q.x, q.y, house_.ground + p.z + noise()});
      }
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t i = 0; i < columns; ++i) {
        if (skip && skip((i + 0.5) / static_cast<double>(columns), (j + 0.5) / static_cast<double>(rows))) continue;
        const std::uint32_t a = first + j * stride + i, b = a + 1, c = a + stride, d = c + 1;
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      }
  }

  Mesh mesh;

 private:
  auto noise() -> double { return house_.noise > 0 ? random_.uniform(-house_.noise, house_.noise) : 0; }
  House house_;
  mansard::base::Random random_;
};

inline auto cells(double size, double edge) -> std::size_t {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::round(size / edge)));
}

inline auto scan(const House& house) -> Mesh {
  Scan scan(house);
  const double l = house.length, w = house.width, e = house.edge;
  scan.sheet(cells(l, e), cells(w, e), [&](double s, double t) {
    return Point3{s * l, t * w, house.roof(s * l, t * w)};
  });
  constexpr double yard = 5;
  scan.sheet(
      cells(l + 2 * yard, 1.0), cells(w + 2 * yard, 1.0),
      [&](double s, double t) {
        return Point3{s * (l + 2 * yard) - yard, t * (w + 2 * yard) - yard, 0};
      },
      [&](double s, double t) {
        const double x = s * (l + 2 * yard) - yard, y = t * (w + 2 * yard) - yard;
        return x > 0 && x < l && y > 0 && y < w;
      });
  if (!house.walls) return scan.mesh;
  const auto wall = [&](Point2 a, Point2 b) {
    const double size = mansard::geometry::length(b - a);
    scan.sheet(cells(size, e), cells(6, e), [&](double s, double t) {
      const Point2 p = a + s * (b - a);
      return Point3{p.x, p.y, t * house.roof(p.x, p.y)};
    });
  };
  wall({0, 0}, {l, 0});
  wall({l, 0}, {l, w});
  wall({l, w}, {0, w});
  wall({0, w}, {0, 0});
  return scan.mesh;
}

/// South, east, north and west edges in the house's frame, counter-clockwise.
inline auto outline(const House& house) -> Polygon {
  const double l = house.length, w = house.width;
  return {{placed(house, 0, 0), placed(house, l, 0), placed(house, l, w), placed(house, 0, w)}, {}};
}

inline auto part_of(const Polygon& polygon) -> mansard::segment::Part {
  mansard::segment::Part part;
  part.polygon = polygon;
  part.feature = 0;
  return part;
}

inline auto block_of(Mesh mesh, const std::vector<Polygon>& polygons, double ground) -> mansard::block::Block {
  mansard::block::Block block;
  block.name = "block-0";
  block.members.push_back({0, polygons, ground});
  block.outline = polygons;
  block.mesh = std::move(mesh);
  block.ground = ground;
  return block;
}

inline auto fit(const Mesh& mesh, const std::vector<Polygon>& parts, double ground,
                const mansard::profile::Options& options = {}) -> std::vector<mansard::profile::ProfiledFootprint> {
  const auto block = block_of(mesh, parts, ground);
  mansard::segment::Segmentation segmentation;
  for (const auto& polygon : parts) segmentation.parts.push_back(part_of(polygon));
  return mansard::profile::fit(segmentation, block, mansard::rays::Scene(mesh), options);
}

inline auto fit(const House& house, const mansard::profile::Options& options = {})
    -> mansard::profile::ProfiledFootprint {
  return fit(scan(house), {outline(house)}, house.ground, options).front();
}

inline auto profile_of(const mansard::profile::ProfiledFootprint& footprint, std::size_t edge)
    -> const mansard::model::Profile& {
  return footprint.plan.profiles[footprint.plan.outer.profile_of_edge[edge]];
}

inline auto is_vertical(const mansard::model::Profile& profile) -> bool { return profile.back().inward == 0; }

/// Angle above the horizon of the profile's part between points `part` and `part` + 1, degrees.
inline auto pitch_of(const mansard::model::Profile& profile, std::size_t part) -> double {
  const auto& a = profile[part];
  const auto& b = profile[part + 1];
  return std::atan2(b.height - a.height, b.inward - a.inward) * 180 / 3.14159265358979323846;
}

}  // namespace houses
