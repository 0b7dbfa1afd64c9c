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

/// Several sums over each cell of a row.
template <std::size_t Count>
class Rows {
 public:
  explicit Rows(std::size_t columns) : columns_(columns), sums_(Count * columns) {}
  void clear() { std::ranges::fill(sums_, 0.0); }
  [[nodiscard]] auto operator[](std::size_t sum) -> double* { return &sums_[sum * columns_]; }

 private:
  std::size_t columns_;
  std::vector<double> sums_;
};

/// A row y of cells to the sums along columns: of 1, y, y², z, y z, z².
void add_row(const double* known, const double* height, std::size_t count, double y, Rows<6>& columns) {
  double* __restrict n = columns[0], * __restrict sum_y = columns[1], * __restrict yy = columns[2];
  double* __restrict z = columns[3], * __restrict yz = columns[4], * __restrict zz = columns[5];
  for (std::size_t c = 0; c < count; ++c) {
    n[c] += known[c], sum_y[c] += y * known[c], yy[c] += y * y * known[c];
    z[c] += height[c], yz[c] += y * height[c], zz[c] += height[c] * height[c];
  }
}

/// The columns x = d beside every cell to the sums over squares: of 1, x, y, z, x², x y, y², x z, y z, z².
void add_columns(Rows<6>& columns, std::ptrdiff_t d, std::size_t count, Rows<10>& squares) {
  const auto beside = static_cast<std::size_t>(std::abs(d));
  if (beside >= count) return;
  const std::size_t from = d < 0 ? 0 : beside, to = d < 0 ? beside : 0;
  const auto x = static_cast<double>(d);
  const auto add = [&](std::size_t sum, double factor, std::size_t of) {
    const double* in = columns[of] + from;
    double* __restrict out = squares[sum] + to;
    for (std::size_t c = 0; c < count - beside; ++c) out[c] += factor * in[c];
  };
  add(0, 1, 0), add(1, x, 0), add(2, 1, 1), add(3, 1, 3);
  add(4, x * x, 0), add(5, x, 1), add(6, 1, 2), add(7, x, 3), add(8, 1, 4), add(9, 1, 5);
}

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
      const Point2 p = grid.centre(column, row) - a;
      const double u = (p.x * ac.y - p.y * ac.x) / twice, v = (ab.x * p.y - ab.y * p.x) / twice;
      if (u < 0 || v < 0 || u + v > 1) continue;
      see(row * grid.columns + column, t[0].z + u * (t[1].z - t[0].z) + v * (t[2].z - t[0].z));
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
  const double side = 2 * static_cast<double>(half) + 1;
  std::vector<Fitted> out(grid.size(), Fitted{infinite, {}, 0});
  // An unseen cell adds nothing to any sum. Every sum is a row of its own: the compiler takes several cells at a time.
  std::vector<double> known(grid.size()), height(grid.size());
  for (std::size_t c = 0; c < grid.size(); ++c) {
    known[c] = std::isnan(surface.top[c]) ? 0 : 1;
    height[c] = std::isnan(surface.top[c]) ? 0 : surface.top[c];
  }
  Rows<6> columns(grid.columns);
  Rows<10> squares(grid.columns);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    columns.clear();
    const std::size_t first = row >= half ? row - half : 0, last = std::min(grid.rows, row + half + 1);
    for (std::size_t r = first; r < last; ++r)
      add_row(&known[r * grid.columns], &height[r * grid.columns], grid.columns,
              static_cast<double>(r) - static_cast<double>(row), columns);
    squares.clear();
    const auto reach = static_cast<std::ptrdiff_t>(half);
    for (std::ptrdiff_t d = -reach; d <= reach; ++d) add_columns(columns, d, grid.columns, squares);
    for (std::size_t c = 0; c < grid.columns; ++c) {
      const auto at = [&](std::size_t sum) { return squares[sum][c]; };
      const geometry::PlaneSums sums{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)};
      const double zz = at(9);
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
