#include "mansard/vegetation/detail/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mansard/geometry/fit.hpp"

namespace mansard::vegetation::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr double unseen = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
/// Cosine: what faces down by less than 15° is a wall with the noise of a scan.
constexpr double clearly_down = -0.25;
/// m: nearer below the top, an underside is the same sheet.
constexpr double sheet = 0.1;
/// Share of a square that must be known.
constexpr double known_share = 0.6;

/// Sums along a column of cells, its own middle being y = 0.
struct Column {
  double n = 0, y = 0, yy = 0, z = 0, yz = 0, zz = 0;
};

template <class Better>
auto extreme_around(const Grid& grid, const std::vector<double>& values, std::size_t half, Better better)
    -> std::vector<double> {
  std::vector<double> along(values.size()), out(values.size());
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const std::size_t first = column >= half ? column - half : 0, last = std::min(grid.columns, column + half + 1);
      double best = values[row * grid.columns + first];
      for (std::size_t c = first + 1; c < last; ++c) best = better(best, values[row * grid.columns + c]);
      along[row * grid.columns + column] = best;
    }
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const std::size_t first = row >= half ? row - half : 0, last = std::min(grid.rows, row + half + 1);
    for (std::size_t column = 0; column < grid.columns; ++column) {
      double best = along[first * grid.columns + column];
      for (std::size_t r = first + 1; r < last; ++r) best = better(best, along[r * grid.columns + column]);
      out[row * grid.columns + column] = best;
    }
  }
  return out;
}

/// Where a triangle covers the centres of cells: see(cell, z).
template <class See>
void each_covered(const std::array<Point3, 3>& t, const Grid& grid, See see) {
  const Point2 a = xy(t[0]), ab = xy(t[1]) - a, ac = xy(t[2]) - a;
  const double twice = ab.x * ac.y - ab.y * ac.x;
  if (twice == 0) return;
  const auto [west, east] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [south, north] = std::minmax({t[0].y, t[1].y, t[2].y});
  const auto index = [&](double v, std::int64_t from, std::size_t count) {
    return std::clamp(std::ceil(v / grid.spacing - 0.5) - static_cast<double>(from), 0.0, static_cast<double>(count));
  };
  const auto first_row = static_cast<std::size_t>(index(south, grid.row, grid.rows));
  const auto last_row = static_cast<std::size_t>(index(north, grid.row, grid.rows));
  const auto first = static_cast<std::size_t>(index(west, grid.column, grid.columns));
  const auto last = static_cast<std::size_t>(index(east, grid.column, grid.columns));
  for (std::size_t row = first_row; row < std::min(grid.rows, last_row + 1); ++row)
    for (std::size_t column = first; column < std::min(grid.columns, last + 1); ++column) {
      const std::size_t cell = row * grid.columns + column;
      const Point2 p = grid.centre(cell) - a;
      const double u = (p.x * ac.y - p.y * ac.x) / twice, v = (ab.x * p.y - ab.y * p.x) / twice;
      if (u < 0 || v < 0 || u + v > 1) continue;
      see(cell, t[0].z + u * (t[1].z - t[0].z) + v * (t[2].z - t[0].z));
    }
}

}  // namespace

auto surface_of(const geometry::Mesh& mesh, std::span<const std::uint32_t> triangles, const Grid& grid) -> Surface {
  Surface out{grid, std::vector<double>(grid.size(), unseen), std::vector<double>(grid.size(), unseen)};
  const auto corners = [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return std::array{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  };
  for (const auto t : triangles)
    each_covered(corners(t), grid, [&](std::size_t cell, double z) {
      if (!(out.top[cell] >= z)) out.top[cell] = z;
    });
  for (const auto t : triangles) {
    const auto points = corners(t);
    const Point3 normal = cross(points[1] - points[0], points[2] - points[0]);
    if (!(normal.z < clearly_down * length(normal))) continue;
    each_covered(points, grid, [&](std::size_t cell, double z) {
      if (z < out.top[cell] - sheet && !(out.under[cell] >= z)) out.under[cell] = z;
    });
  }
  return out;
}

auto planes_of(const Surface& surface, std::size_t half) -> std::vector<Fitted> {
  const auto& grid = surface.grid;
  const auto reach = static_cast<std::int64_t>(half);
  const double side = 2 * static_cast<double>(half) + 1;
  std::vector<Fitted> out(grid.size(), Fitted{infinite, {}, 0});
  std::vector<Column> columns(grid.columns);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const std::size_t first = row >= half ? row - half : 0, last = std::min(grid.rows, row + half + 1);
    for (std::size_t c = 0; c < grid.columns; ++c) {
      Column sums;
      for (std::size_t r = first; r < last; ++r) {
        const double z = surface.top[r * grid.columns + c], y = static_cast<double>(r) - static_cast<double>(row);
        if (std::isnan(z)) continue;
        sums.n += 1, sums.y += y, sums.yy += y * y, sums.z += z, sums.yz += y * z, sums.zz += z * z;
      }
      columns[c] = sums;
    }
    for (std::size_t c = 0; c < grid.columns; ++c) {
      geometry::PlaneSums sums;
      double zz = 0;
      for (std::int64_t d = -reach; d <= reach; ++d) {
        const std::int64_t at = static_cast<std::int64_t>(c) + d;
        if (at < 0 || at >= static_cast<std::int64_t>(grid.columns)) continue;
        const Column& of = columns[static_cast<std::size_t>(at)];
        const auto x = static_cast<double>(d);
        sums.count += of.n, sums.x += x * of.n, sums.y += of.y, sums.z += of.z;
        sums.xx += x * x * of.n, sums.xy += x * of.y, sums.yy += of.yy, sums.xz += x * of.z, sums.yz += of.yz;
        zz += of.zz;
      }
      if (sums.count < known_share * side * side) continue;
      const auto equations = sums.centred();
      // Sums of integers: exact, and 0 where all samples are on one line.
      if (!(equations.determinant() > 0.5)) continue;
      const Point2 slope = equations.slopes();
      const double rest = zz - sums.z * sums.z / sums.count - slope.x * equations.xz - slope.y * equations.yz;
      const Point2 rise = (1 / grid.spacing) * slope;
      out[row * grid.columns + c] = {std::sqrt(std::max(0.0, rest) / sums.count / (1 + dot(rise, rise))), rise,
                                     sums.plane(slope).at_zero};
    }
  }
  return out;
}

auto least_around(const Grid& grid, const std::vector<double>& values, std::size_t half) -> std::vector<double> {
  return extreme_around(grid, values, half, [](double a, double b) { return std::min(a, b); });
}
auto greatest_around(const Grid& grid, const std::vector<double>& values, std::size_t half) -> std::vector<double> {
  return extreme_around(grid, values, half, [](double a, double b) { return std::max(a, b); });
}

}  // namespace mansard::vegetation::detail
