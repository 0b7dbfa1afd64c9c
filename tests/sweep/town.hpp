// Noisy meshes of simple houses to sweep over.
#pragma once

#include <cmath>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/slice/slice.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep {

using geometry::Point2;
using geometry::Point3;
using geometry::Segment2;

/// Collects patches: quadrilaterals split into small triangles with noise, unstitched to their neighbours as scans are.
class Town {
 public:
  explicit Town(double noise = 0.05, std::uint64_t seed = 1) : noise_(noise), random_(seed) {}

  /// Corners counter-clockwise seen from outside; two may coincide.
  void patch(Point3 a, Point3 b, Point3 c, Point3 d) {
    const auto steps = [](double l) { return std::max(1u, static_cast<std::uint32_t>(l / 0.6)); };
    const auto nu = steps(std::max(length(b - a), length(c - d)));
    const auto nv = steps(std::max(length(d - a), length(c - b)));
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::uint32_t j = 0; j <= nv; ++j)
      for (std::uint32_t i = 0; i <= nu; ++i) {
        const double s = static_cast<double>(i) / nu, t = static_cast<double>(j) / nv;
        const Point3 p = (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * d + s * c);
        const auto jitter = [&] {
          return 2 * noise_ * (random_.uniform() + random_.uniform() + random_.uniform() - 1.5);
        };
        const double x = jitter(), y = jitter(), z = jitter();
        mesh_.vertices.push_back(p + Point3{x, y, z});
      }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return first + j * (nu + 1) + i; };
    for (std::uint32_t j = 0; j < nv; ++j)
      for (std::uint32_t i = 0; i < nu; ++i) {
        mesh_.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh_.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  void wall(Point2 from, Point2 to, double low, double high) {  // interior on the left of from → to
    patch({from.x, from.y, low}, {to.x, to.y, low}, {to.x, to.y, high}, {from.x, from.y, high});
  }
  void flat(Point2 low, Point2 high, double z) {
    patch({low.x, low.y, z}, {high.x, low.y, z}, {high.x, high.y, z}, {low.x, high.y, z});
  }
  void box(Point2 low, Point2 high, double z0, double z1) {
    wall(low, {high.x, low.y}, z0, z1);
    wall({high.x, low.y}, high, z0, z1);
    wall(high, {low.x, high.y}, z0, z1);
    wall({low.x, high.y}, low, z0, z1);
    flat(low, high, z1);
  }
  /// Ridge along x.
  void gabled(Point2 low, Point2 high, double eaves, double ridge) {
    const double m = 0.5 * (low.y + high.y);
    wall(low, {high.x, low.y}, 0, eaves);
    wall(high, {low.x, high.y}, 0, eaves);
    wall({high.x, low.y}, high, 0, eaves);
    wall({low.x, high.y}, low, 0, eaves);
    patch({low.x, low.y, eaves}, {high.x, low.y, eaves}, {high.x, m, ridge}, {low.x, m, ridge});
    patch({high.x, high.y, eaves}, {low.x, high.y, eaves}, {low.x, m, ridge}, {high.x, m, ridge});
    patch({high.x, low.y, eaves}, {high.x, high.y, eaves}, {high.x, m, ridge}, {high.x, m, ridge});
    patch({low.x, high.y, eaves}, {low.x, low.y, eaves}, {low.x, m, ridge}, {low.x, m, ridge});
  }
  void ground(Point2 low, Point2 high) { flat(low, high, 0); }
  void footprint(Point2 low, Point2 high) { rings_.push_back({low, {high.x, low.y}, high, {low.x, high.y}}); }

  /// Everything turned about the origin, then moved.
  [[nodiscard]] auto block(double turn = 0, Point2 move = {}) const -> block::Block {
    const double c = std::cos(turn), s = std::sin(turn);
    const auto placed = [&](Point2 p) { return Point2{c * p.x - s * p.y, s * p.x + c * p.y} + move; };
    block::Block block;
    block.name = "town";
    block.mesh = mesh_;
    for (auto& v : block.mesh.vertices) {
      const Point2 p = placed({v.x, v.y});
      v = {p.x, p.y, v.z};
    }
    for (std::size_t i = 0; i < rings_.size(); ++i) {
      geometry::Polygon polygon;
      for (const Point2 p : rings_[i]) polygon.outer.push_back(placed(p));
      block.members.push_back({i, {polygon}, 0});
      block.outline.push_back(polygon);
    }
    return block;
  }

 private:
  geometry::Mesh mesh_;
  std::vector<geometry::Ring> rings_;
  double noise_;
  base::Random random_;
};

[[nodiscard]] inline auto edges_of(const block::Block& block, const Options& options = {}) -> SweepEdges {
  return find_edges(slice::cut(block, {}), block, options);
}

/// How many edges follow the wall from a to b (outside on the left) within a distance and over a share of its length.
[[nodiscard]] inline auto followers(const SweepEdges& found, Point2 a, Point2 b, double within = 0.25,
                                    double share = 0.85) -> int {
  const Point2 d = normalised(b - a);
  const double l = length(b - a);
  int count = 0;
  for (const auto& e : found.edges) {
    const Point2 s = e.segment.start - a, t = e.segment.end - a;
    if (dot(normalised(t - s), d) < 0.99 || std::abs(cross(d, s)) > within || std::abs(cross(d, t)) > within) continue;
    if (std::min(l, dot(d, t)) - std::max(0.0, dot(d, s)) >= share * l) ++count;
  }
  return count;
}

}  // namespace mansard::sweep
