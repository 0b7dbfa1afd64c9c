#include "mansard/texture/detail/face.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/model/file_grid.hpp"

namespace mansard::texture::detail {
namespace {

/// Newell's normal: of the corners relative to the building, so that it has the same digits in every frame.
auto normal_of(const std::vector<std::uint32_t>& loop, const std::vector<Point3>& vertices) -> Point3 {
  Point3 sum;
  const Point3 first = vertices[loop[0]];
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    sum = sum + cross(vertices[loop[i]] - first, vertices[loop[i + 1]] - first);
  return geometry::normalised(sum);
}

/// Along the longest edge, the first of equals.
auto longest_edge(const std::vector<std::uint32_t>& loop, const std::vector<Point3>& vertices) -> Point3 {
  Point3 best;
  double most = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point3 edge = vertices[loop[(i + 1) % loop.size()]] - vertices[loop[i]];
    if (const double size = dot(edge, edge); size > most * (1 + 1e-9)) most = size, best = edge;
  }
  return best;
}

}  // namespace

auto placed(const std::vector<model::LabelledSolid>& solids) -> Placed {
  constexpr double grid = model::quanta_per_metre;
  const auto quanta = [](double metres) { return static_cast<std::int64_t>(std::floor(metres * grid + 0.5)); };
  std::array<std::int64_t, 3> least{};
  bool any = false;
  for (const auto& solid : solids)
    for (const Point3& v : solid.solid.vertices) {
      const std::array<std::int64_t, 3> q{quanta(v.x), quanta(v.y), quanta(v.z)};
      for (std::size_t i = 0; i < 3; ++i) least[i] = any ? std::min(least[i], q[i]) : q[i];
      any = true;
    }
  Placed out;
  std::array<std::int64_t, 3> origin{};
  constexpr auto metre = static_cast<std::int64_t>(grid);
  for (std::size_t i = 0; i < 3; ++i) {
    origin[i] = (least[i] >= 0 ? least[i] : least[i] - (metre - 1)) / metre;
    out.origin[i] = static_cast<double>(origin[i]);
  }
  for (const auto& solid : solids) {
    auto& points = out.vertices.emplace_back();
    const auto along = [&](double metres, std::size_t i) {
      return static_cast<double>(quanta(metres) - origin[i] * metre) / grid;
    };
    for (const Point3& v : solid.solid.vertices) points.push_back({along(v.x, 0), along(v.y, 1), along(v.z, 2)});
  }
  return out;
}

auto grid_of(const model::Face& face, model::FaceClass kind, const std::vector<Point3>& vertices, double size,
             std::uint32_t side) -> FaceGrid {
  FaceGrid out;
  out.kind = kind;
  out.texel = size;
  out.normal = normal_of(face.loops[0], vertices);
  if (!(length(out.normal) > 0.5)) return out;
  constexpr double level = 1e-3;  // rad from the horizontal, below which no eave can be told
  const double steep = std::hypot(out.normal.x, out.normal.y);
  if (steep > level) {
    out.up = geometry::normalised(Point3{0, 0, 1} - out.normal.z * out.normal);
  } else {
    const Point3 along = longest_edge(face.loops[0], vertices);
    out.up = geometry::normalised(cross(out.normal, along));
  }
  out.right = cross(out.up, out.normal);
  constexpr double far = std::numeric_limits<double>::infinity();
  double least_u = far, least_v = far, most_u = -far, most_v = -far;
  const Point3 anchor = vertices[face.loops[0][0]];
  for (const auto& loop : face.loops)
    for (const auto v : loop) {
      const Point3 p = vertices[v] - anchor;
      const double a = dot(out.right, p), b = dot(out.up, p);
      least_u = std::min(least_u, a), most_u = std::max(most_u, a);
      least_v = std::min(least_v, b), most_v = std::max(most_v, b);
    }
  const double width = most_u - least_u, height = most_v - least_v;
  if (!(width > 0) || !(height > 0)) return out;
  const double room = side - 1.0;  // of rounding up
  out.texel = std::max({size, width / room, height / room});
  constexpr double rounding = 1e-6;  // of a texel: a face as wide as so many texels has no more
  out.columns = static_cast<std::uint32_t>(std::max(1.0, std::ceil(width / out.texel - rounding)));
  out.rows = static_cast<std::uint32_t>(std::max(1.0, std::ceil(height / out.texel - rounding)));
  const double u0 = least_u - (out.columns * out.texel - width) / 2, v0 = least_v - (out.rows * out.texel - height) / 2;
  out.start = anchor + u0 * out.right + v0 * out.up;
  for (const auto& loop : face.loops) {
    auto& points = out.loops.emplace_back();
    for (const auto v : loop) {
      const Point3 p = vertices[v] - out.start;
      points.push_back({dot(out.right, p) / out.texel, dot(out.up, p) / out.texel});
    }
  }
  return out;
}

auto frame_of(const FaceGrid& grid, const std::array<double, 3>& origin) -> model::PictureFrame {
  const double per_metre = 1 / grid.texel;
  const Point3 start = grid.start + Point3{origin[0], origin[1], origin[2]};
  model::PictureFrame out;
  out.right = per_metre * grid.right;
  out.below = -per_metre * grid.up;
  out.start = {-dot(out.right, start), static_cast<double>(grid.rows) - dot(out.below, start)};
  return out;
}

auto spans_at(const std::vector<std::vector<Point2>>& loops, double v) -> std::vector<double> {
  std::vector<double> crossings;
  for (const auto& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point2 a = loop[i], b = loop[(i + 1) % loop.size()];
      if ((a.y > v) == (b.y > v)) continue;
      crossings.push_back(a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  std::ranges::sort(crossings);
  return crossings;
}

}  // namespace mansard::texture::detail
