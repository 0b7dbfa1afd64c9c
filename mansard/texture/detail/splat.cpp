// Points have no normals. Whether one is on a surface that is parallel to a face is seen from its neighbours: how far
// they are spread along the face's normal. As with triangles, all decisions are in doubles relative to the building, in
// an order that depends on the points alone, and colours are summed as integers.
#include "mansard/texture/detail/splat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::texture::detail {
namespace {

/// Neighbours of which a surface is told; the same number as in a square of three by three, without its middle.
constexpr std::size_t neighbours = 8;
/// The neighbour up to which a point colours: on a level surface 1.4 times the mean distance between points, so that
/// discs cover it.
constexpr std::size_t covered = 6;
/// Neighbours whose spread has a determinant of more than this share of that of a ball are leaves, not a surface
/// (omnivariance: M. Weinmann et al., ISPRS Journal 105, 2015). A surface whose noise is a third of the distance
/// between points has 0.3.
constexpr double most_scattered = 0.5;
/// m; of two layers of points farther apart than this, the nearer one to the face is its picture.
constexpr double layer = 0.25;

struct InCube {
  std::array<std::int64_t, 3> cube{};
  Point3 position;
  Light colour{};
  friend auto operator<=>(const InCube&, const InCube&) = default;
};

/// The mean of the points of every cube: dense clouds have more points than texels.
auto thinned(const std::vector<ScanPoint>& scan, const Point3& origin, double side) -> std::vector<ScanPoint> {
  std::vector<InCube> points;
  const auto cube = [&](double c) { return static_cast<std::int64_t>(std::floor(c / side)); };
  for (const auto& given : scan) {
    if (given.ground) continue;
    const Point3 p = given.position - origin;
    points.push_back({{cube(p.x), cube(p.y), cube(p.z)}, p, given.colour});
  }
  std::ranges::sort(points);
  std::vector<ScanPoint> out;
  for (std::size_t first = 0, end = 0; first < points.size(); first = end) {
    Point3 sum{};
    std::array<std::uint64_t, 3> light{};
    for (; end < points.size() && points[end].cube == points[first].cube; ++end) {
      sum = sum + points[end].position;
      for (std::size_t c = 0; c < 3; ++c) light[c] += points[end].colour[c];
    }
    const std::uint64_t count = end - first;
    auto& one = out.emplace_back();
    one.position = (1.0 / static_cast<double>(count)) * sum;
    for (std::size_t c = 0; c < 3; ++c) one.colour[c] = static_cast<std::uint16_t>((light[c] + count / 2) / count);
  }
  return out;
}

/// Of the points; trace 1. Zero where they are at one place.
auto spread_of(const std::vector<Point3>& points) -> std::array<double, 6> {
  Point3 mean{};
  for (const Point3& p : points) mean = mean + p;
  mean = (1.0 / static_cast<double>(points.size())) * mean;
  std::array<double, 6> out{};
  for (const Point3& p : points) {
    const Point3 d = p - mean;
    const std::array<double, 6> more{d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += more[i];
  }
  const double trace = out[0] + out[3] + out[5];
  if (trace > 0)
    for (double& value : out) value /= trace;
  return out;
}

auto scattered(const std::array<double, 6>& s) -> double {
  const auto& [xx, xy, xz, yy, yz, zz] = s;
  const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  constexpr double of_ball = 1.0 / 27;
  return determinant / of_ball;
}

auto spread_along(const std::array<double, 6>& s, Point3 n) -> double {
  return n.x * n.x * s[0] + n.y * n.y * s[3] + n.z * n.z * s[5] +
         2 * (n.x * n.y * s[1] + n.x * n.z * s[2] + n.y * n.z * s[4]);
}

/// A splat in the plane of a face: texels, metres.
struct Disc {
  Point2 at;
  double ahead = 0, radius = 0;
  const Light* colour = nullptr;  ///< none of a point that is not on a parallel surface
};

/// visit(texel, distance as a share of the radius) for every texel whose middle is in the disc.
template <class Visit>
void each_texel(const Disc& disc, const FaceGrid& grid, Visit visit) {
  const auto bounds = [&](double middle, std::uint32_t count) {
    return std::pair(std::max(std::ceil(middle - disc.radius - 0.5), 0.0),
                     std::min(std::floor(middle + disc.radius - 0.5), static_cast<double>(count) - 1));
  };
  const auto [left, right] = bounds(disc.at.x, grid.columns);
  const auto [low, high] = bounds(disc.at.y, grid.rows);
  for (double row = low; row <= high; ++row)
    for (double column = left; column <= right; ++column) {
      const double share = length(Point2{column + 0.5, row + 0.5} - disc.at) / disc.radius;
      if (share < 1) visit(static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column), share);
    }
}

}  // namespace

auto splats_of(const std::vector<ScanPoint>& points, const std::array<double, 3>& origin, const Options& options)
    -> std::vector<Splat> {
  const PointTree tree(thinned(points, {origin[0], origin[1], origin[2]}, options.size));
  const auto& all = tree.points();
  std::vector<Splat> out(all.size());
  base::parallel_for(all.size(), [&](std::size_t i) {
    const auto near = tree.nearest(all[i].position, neighbours + 1, options.point_reach);  // itself among them
    std::vector<Point3> places;
    for (const auto& one : near) places.push_back(all[one.point].position);
    auto& splat = out[i];
    splat.at = all[i].position;
    splat.colour = all[i].colour;
    splat.radius = std::max(std::sqrt(near[std::min(covered, near.size() - 1)].squared), options.size);
    splat.spread = spread_of(places);
    splat.surface = near.size() > neighbours / 2 && scattered(splat.spread) <= most_scattered;
  });
  return out;
}

auto splatted(const FaceGrid& grid, const std::vector<const Splat*>& splats, const Options& options)
    -> std::vector<std::optional<Light>> {
  const std::size_t texels = std::size_t{grid.columns} * grid.rows;
  std::vector<std::optional<Light>> out(texels);
  // Points do not tell which side of a surface was seen, and roofs are near what looks down below them.
  constexpr double down = -0.5;  // 60°
  if (grid.normal.z < down) return out;
  // Of a level surface that is turned by an angle, the spread along the normal is this share of all.
  const double facing = std::sin(options.angle) * std::sin(options.angle) / 2;
  std::vector<Disc> discs;
  for (const auto* splat : splats) {
    const Point3 p = splat->at - grid.start;
    const double ahead = dot(grid.normal, p);
    if (ahead > options.outward || ahead < -options.inward) continue;
    const bool parallel = splat->surface && spread_along(splat->spread, grid.normal) <= facing;
    discs.push_back({(1 / grid.texel) * Point2{dot(grid.right, p), dot(grid.up, p)}, std::abs(ahead),
                     std::max(splat->radius / grid.texel, 1.0), parallel ? &splat->colour : nullptr});
  }
  if (discs.empty()) return out;
  std::vector<double> nearest(texels, std::numeric_limits<double>::infinity());
  for (const auto& disc : discs)
    if (disc.colour != nullptr)
      each_texel(disc, grid, [&](std::size_t t, double) { nearest[t] = std::min(nearest[t], disc.ahead); });
  struct Sum {
    std::uint64_t weight = 0, against = 0;
    std::array<std::uint64_t, 3> light{};
  };
  std::vector<Sum> sums(texels);
  for (const auto& disc : discs)
    each_texel(disc, grid, [&](std::size_t t, double share) {
      if (disc.ahead > nearest[t] + layer) return;
      // R. Franke and G. Nielson, Smooth interpolation of large sets of scattered data, 1980: the nearer by far.
      constexpr double flat = 0.1, unit = 1000;
      const double ratio = (1 - share) / (share + flat);
      const auto weight = 1 + static_cast<std::uint64_t>(unit * ratio * ratio);
      if (disc.colour == nullptr) {
        sums[t].against += weight;
        return;
      }
      sums[t].weight += weight;
      for (std::size_t c = 0; c < 3; ++c) sums[t].light[c] += weight * (*disc.colour)[c];
    });
  for (std::size_t t = 0; t < texels; ++t) {
    const auto& [weight, against, light] = sums[t];
    if (weight == 0 || weight < against) continue;
    auto& colour = out[t].emplace();
    for (std::size_t c = 0; c < 3; ++c) colour[c] = static_cast<std::uint16_t>((light[c] + weight / 2) / weight);
  }
  return out;
}

}  // namespace mansard::texture::detail
