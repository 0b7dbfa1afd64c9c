#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "mansard/geometry/fit.hpp"
#include "mansard/vegetation/detail/surface.hpp"

namespace mansard::vegetation::detail {
namespace {

using geometry::Point2;

/// Steeper slopes than this say no more of a direction.
constexpr double steep = 3.0;
/// Rise per metre: flatter ones have no direction.
constexpr double flat = 0.2;

template <class Go>
void each_beside(const Grid& grid, std::size_t cell, Go go) {
  const std::size_t column = cell % grid.columns, row = cell / grid.columns;
  if (column > 0) go(cell - 1);
  if (column + 1 < grid.columns) go(cell + 1);
  if (row > 0) go(cell - grid.columns);
  if (row + 1 < grid.rows) go(cell + grid.columns);
}

auto cells_of(double metres, double spacing) -> std::size_t {
  return static_cast<std::size_t>(std::max(1.0, std::round(metres / spacing)));
}

/// Only what a square of 2 · half + 1 cells can sweep over.
auto opened(const Grid& grid, const std::vector<std::uint8_t>& mask, std::size_t half) -> std::vector<std::uint8_t> {
  const std::vector<double> values(mask.begin(), mask.end());
  const auto swept = greatest_around(grid, least_around(grid, values, half), half);
  std::vector<std::uint8_t> out(mask.size());
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = mask[c] != 0 && swept[c] > 0 ? 1 : 0;
  return out;
}

/// What is rough over the least width of a crown.
auto rough_cells(const Surface& surface, const std::vector<double>& roughness, const std::vector<double>& squareness,
                 const Options& options) -> std::vector<std::uint8_t> {
  std::vector<std::uint8_t> rough(surface.grid.size());
  for (std::size_t c = 0; c < rough.size(); ++c)
    rough[c] =
        !std::isnan(surface.top[c]) && roughness[c] > options.roughness && squareness[c] < options.local_squareness;
  return opened(surface.grid, rough, cells_of(options.width, surface.grid.spacing) / 2);
}

/// Grows planes over the surface, to find the roof beside a crown where it is narrower than the squares.
class Planes {
 public:
  Planes(const Surface& surface, const std::vector<Fitted>& slopes, const Options& options)
      : surface_(surface), slopes_(slopes), options_(options), mark_(surface.grid.size(), 0) {}

  /// Takes off what is rough only because the square that was compared is too large for it: what is in a plane of
  /// `plane_area` or more. The most even places first.
  void take_off(std::vector<std::uint8_t>& rough) {
    std::vector<std::pair<double, std::size_t>> seeds;
    for (std::size_t cell = 0; cell < rough.size(); ++cell)
      if (rough[cell] != 0 && slopes_[cell].rms < options_.even) seeds.emplace_back(slopes_[cell].rms, cell);
    std::ranges::sort(seeds);
    const double cell_area = surface_.grid.spacing * surface_.grid.spacing;
    for (const auto& [rms, seed] : seeds) {
      if (rough[seed] == 0) continue;
      const auto& patch = grown(seed);
      if (static_cast<double>(patch.size()) * cell_area < options_.plane_area) continue;
      for (const auto cell : patch) rough[cell] = 0;
    }
  }

 private:
  auto grown(std::size_t seed) -> const std::vector<std::size_t>& {
    const auto& grid = surface_.grid;
    const Point2 middle = grid.centre(seed);
    const double z0 = surface_.top[seed];
    geometry::FittedPlane plane{slopes_[seed].middle - z0, slopes_[seed].slope};
    geometry::PlaneSums sums;
    double next_fit = first_fit;
    ++round_;
    patch_.assign(1, seed);
    mark_[seed] = round_;
    for (std::size_t i = 0; i < patch_.size(); ++i) {
      const Point2 at = grid.centre(patch_[i]) - middle;
      sums.add(at.x, at.y, surface_.top[patch_[i]] - z0);
      if (sums.count >= next_fit) {
        next_fit *= 2;
        const auto equations = sums.centred();
        if (equations.determinant() > on_a_line * equations.xx * equations.yy) plane = sums.plane(equations.slopes());
      }
      const double allowed = options_.plane_distance * std::sqrt(1 + dot(plane.slope, plane.slope));
      each_beside(grid, patch_[i], [&](std::size_t next) {
        if (mark_[next] == round_ || std::isnan(surface_.top[next])) return;
        const Point2 there = grid.centre(next) - middle;
        if (std::max(std::abs(there.x), std::abs(there.y)) > patch_reach) return;
        if (std::abs(surface_.top[next] - z0 - plane.at(there.x, there.y)) > allowed) return;
        mark_[next] = round_;
        patch_.push_back(next);
      });
    }
    return patch_;
  }

  static constexpr double first_fit = 24;    // samples: before, a plane is that of the small square
  static constexpr double on_a_line = 1e-6;  // relative determinant: rounding
  static constexpr double patch_reach = 4;   // m: far enough for every plane_area that makes sense

  const Surface& surface_;
  const std::vector<Fitted>& slopes_;
  const Options& options_;
  std::vector<std::uint32_t> mark_;
  std::uint32_t round_ = 0;
  std::vector<std::size_t> patch_;
};

/// Sums over the squares of 2 · half + 1 cells around every cell.
auto sums_around(const Grid& grid, const std::vector<double>& values, std::size_t half) -> std::vector<double> {
  std::vector<double> along(values.size()), out(values.size());
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      double sum = 0;
      for (std::size_t c = column >= half ? column - half : 0; c < std::min(grid.columns, column + half + 1); ++c)
        sum += values[row * grid.columns + c];
      along[row * grid.columns + column] = sum;
    }
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t r = row >= half ? row - half : 0; r < std::min(grid.rows, row + half + 1); ++r)
      for (std::size_t column = 0; column < grid.columns; ++column)
        out[row * grid.columns + column] += along[r * grid.columns + column];
  return out;
}

/// Per cell the same of the squares around it.
auto squareness_around(const Grid& grid, const std::vector<Fitted>& slopes, std::size_t half) -> std::vector<double> {
  std::vector<double> real(grid.size(), 0), imaginary(grid.size(), 0), total(grid.size(), 0);
  for (std::size_t c = 0; c < grid.size(); ++c) {
    const std::complex<double> slope(slopes[c].slope.x, slopes[c].slope.y);
    const double size = std::abs(slope);
    if (std::isinf(slopes[c].rms) || size < flat) continue;
    const std::complex<double> unit = slope / size, twice = unit * unit, four = std::min(size, steep) * twice * twice;
    real[c] = four.real(), imaginary[c] = four.imag(), total[c] = std::min(size, steep);
  }
  real = sums_around(grid, real, half), imaginary = sums_around(grid, imaginary, half);
  total = sums_around(grid, total, half);
  for (std::size_t c = 0; c < grid.size(); ++c)
    total[c] = total[c] > 0 ? std::hypot(real[c], imaginary[c]) / total[c] : 1;
  return total;
}

/// Agreement of the slopes on two directions at right angles: 1 for a box or a gabled roof, near 0 for a dome.
auto squareness_of(const std::vector<std::uint32_t>& cells, const std::vector<Fitted>& slopes) -> double {
  std::complex<double> sum = 0;
  double total = 0;
  for (const auto c : cells) {
    const std::complex<double> slope(slopes[c].slope.x, slopes[c].slope.y);
    const double size = std::abs(slope);
    if (std::isinf(slopes[c].rms) || size < flat) continue;
    const std::complex<double> unit = slope / size, twice = unit * unit;
    sum += std::min(size, steep) * twice * twice;
    total += std::min(size, steep);
  }
  return total > 0 ? std::abs(sum) / total : 1;
}

}  // namespace

auto blobs_of(const Surface& surface, std::size_t halo, std::span<const geometry::Polygon> outline,
              const Options& options) -> std::vector<Blob> {
  const auto& grid = surface.grid;
  const auto half = cells_of(options.window, grid.spacing) / 2;
  std::vector<double> roughness(grid.size());
  const auto planes = planes_of(surface, half);
  for (std::size_t c = 0; c < planes.size(); ++c) roughness[c] = planes[c].rms;
  // Of all squares that contain a sample, the most even one: beside an edge one lies on each side of it.
  roughness = least_around(grid, roughness, half);
  const auto slopes = planes_of(surface, half / 2);
  auto rough = rough_cells(surface, roughness, squareness_around(grid, slopes, half), options);
  Planes(surface, slopes, options).take_off(rough);
  rough = opened(grid, rough, 1);

  std::vector<Blob> out;
  std::vector<std::uint8_t> taken(grid.size(), 0);
  for (std::size_t first = 0; first < grid.size(); ++first) {
    if (rough[first] == 0 || taken[first] != 0) continue;
    Blob blob;
    taken[first] = 1;
    blob.cells.push_back(static_cast<std::uint32_t>(first));
    for (std::size_t i = 0; i < blob.cells.size(); ++i) {
      const std::size_t cell = blob.cells[i];
      each_beside(grid, cell, [&](std::size_t next) {
        if (rough[next] == 0 || taken[next] != 0) return;
        if (std::abs(surface.top[next] - surface.top[cell]) > options.step) return;
        taken[next] = 1;
        blob.cells.push_back(static_cast<std::uint32_t>(next));
      });
    }
    std::ranges::sort(blob.cells);
    const std::size_t row = first / grid.columns, column = first % grid.columns;
    if (row < halo || column < halo || row + halo >= grid.rows || column + halo >= grid.columns) continue;
    const double cell_area = grid.spacing * grid.spacing;
    auto& seen = blob.seen;
    seen.area = static_cast<double>(blob.cells.size()) * cell_area;
    if (seen.area < options.min_area || seen.area > options.max_area) continue;
    std::size_t hanging = 0, west = grid.columns, east = 0;
    seen.top = surface.top[first];
    double lowest = seen.top;
    for (const auto c : blob.cells) {
      const Point2 at = grid.centre(c);
      seen.centre = seen.centre + at;
      seen.roughness += std::min(roughness[c], 1.0);
      seen.top = std::max(seen.top, surface.top[c]);
      lowest = std::min(lowest, surface.top[c]);
      hanging += std::isnan(surface.under[c]) ? 0 : 1;
      west = std::min(west, c % grid.columns);
      east = std::max(east, c % grid.columns);
      if (std::ranges::any_of(outline, [&](const auto& polygon) { return geometry::contains(polygon, at); }))
        seen.inside += cell_area;
    }
    const auto count = static_cast<double>(blob.cells.size());
    seen.centre = (1 / count) * seen.centre;
    seen.roughness /= count;
    seen.rise = seen.top - lowest;
    seen.overhang = static_cast<double>(hanging) / count;
    seen.squareness = squareness_of(blob.cells, slopes);
    blob.too_long = blob.cells.back() / grid.columns - row >= halo || east - west >= halo;
    out.push_back(std::move(blob));
  }
  return out;
}

auto is_crown(const Blob& blob, const Options& options) -> bool {
  const auto& seen = blob.seen;
  if (blob.too_long || seen.inside < options.min_inside || seen.squareness > options.squareness) return false;
  const bool beside = seen.area - seen.inside >= options.beyond * seen.area;
  return beside ? seen.overhang >= options.overhang && seen.rise >= options.rise_beside
                : seen.overhang >= options.overhang_within && seen.rise >= options.rise_within;
}

}  // namespace mansard::vegetation::detail
