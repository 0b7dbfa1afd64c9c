#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
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
/// Relative determinant of points that are on a line but for rounding.
constexpr double on_a_line = 1e-6;

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

  static constexpr double first_fit = 24;   // samples: before, a plane is that of the small square
  static constexpr double patch_reach = 4;  // m: far enough for every plane_area that makes sense

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

/// Where the border of a region turns, in cells: 4 π · area / border² is 0.79 for a square or a disc of cells.
auto roundness_of(const std::vector<std::uint32_t>& cells, const Grid& grid) -> double {
  std::size_t border = 0;
  for (const auto c : cells) {
    std::size_t beside = 0;
    each_beside(grid, c, [&](std::size_t next) {
      beside += std::ranges::binary_search(cells, static_cast<std::uint32_t>(next)) ? 1 : 0;
    });
    border += 4 - beside;
  }
  const auto side = static_cast<double>(border) / 4;
  return static_cast<double>(cells.size()) / (side * side);
}

/// z = c + tilt · p + bend · p², by least squares.
struct Dome {
  double tilt = 0;       ///< rise per metre in the middle of the region
  double bend = 0;       ///< per metre; negative for a dome
  double explained = 0;  ///< share of the squared distances from the best plane
};

auto dome_of(const std::vector<std::uint32_t>& cells, const Surface& surface) -> Dome {
  const auto count = static_cast<double>(cells.size());
  Point2 middle;
  double height = 0;
  for (const auto c : cells) middle = middle + (1 / count) * surface.grid.centre(c), height += surface.top[c] / count;
  double square = 0;
  for (const auto c : cells) {
    const Point2 at = surface.grid.centre(c) - middle;
    square += dot(at, at) / count;
  }
  // About the means: the slopes, and what p² has that is no plane.
  geometry::SlopeEquations plane, curved;
  double qq = 0, qz = 0, zz = 0;
  for (const auto c : cells) {
    const Point2 at = surface.grid.centre(c) - middle;
    const double z = surface.top[c] - height, q = dot(at, at) - square;
    plane.add(at.x, at.y, z, 1);
    curved.add(at.x, at.y, q, 1);
    qq += q * q, qz += q * z, zz += z * z;
  }
  if (!(plane.determinant() > on_a_line * plane.xx * plane.yy)) return {};
  const Point2 slope = plane.slopes(), lean = curved.slopes();
  const double rest_q = qq - lean.x * curved.xz - lean.y * curved.yz,
               rest_z = zz - slope.x * plane.xz - slope.y * plane.yz;
  const double joint = qz - lean.x * plane.xz - lean.y * plane.yz;
  if (!(rest_q > 0) || !(rest_z > 0)) return {};
  const double bend = joint / rest_q;
  return {length(slope - bend * lean), bend, joint * joint / (rest_q * rest_z)};
}

/// −bend by the radius of a disc as large: the height of a dome by its radius.
auto height_by_radius(const Dome& dome, const Crown& seen) -> double {
  return -dome.bend * std::sqrt(seen.area / std::numbers::pi);
}

/// Whether it hangs over something as what is built does, mostly over a building: it is no larger than one crown but
/// not higher in its middle. Of 16 such regions in simulated scans, odd seeds, 14 have a height by radius of 0.34 and
/// more; parapets above balconies and what else was taken for crowns on the roofs of Zhongshan have 0.09 and less:
/// docs/decisions/0108.
auto is_built(const Crown& seen, const Dome& dome) -> bool {
  constexpr double one_crown = 16;      // m²: a radius of 2.3 m
  constexpr double hanging = 0.15;      // share with a visible underside: a crown that is half in the roof has less
  constexpr double least_bulge = 0.25;  // height by radius
  return seen.inside > 0.5 * seen.area && seen.area <= one_crown && seen.overhang >= hanging &&
         height_by_radius(dome, seen) < least_bulge;
}

/// Whether enough of it has a visible underside, and it rises enough, for a crown.
auto hangs_over(const Crown& seen, const Options& options) -> bool {
  const bool beside = seen.area - seen.inside >= options.beyond * seen.area;
  return beside ? seen.overhang >= options.overhang && seen.rise >= options.rise_beside
                : seen.overhang >= options.overhang && seen.rise >= options.rise_within;
}

/// The shape of a crown, whatever is below it. Each limit is between what crowns and roofs were measured to have, on
/// simulated crowns of odd seeds and on the real inputs: docs/decisions/0071. The smaller a region, and the less it
/// rises, the more clearly it must be a dome: docs/decisions/0086.
auto is_dome(const Crown& seen, const Dome& dome, const std::vector<std::uint32_t>& cells, const Grid& grid) -> bool {
  constexpr double most_area = 32;                  // m²; roofs have more
  constexpr double flattest = 0.4, steepest = 1.6;  // height by radius; spires have more
  constexpr double most_tilt = 0.7;                 // ends of ridges have more
  constexpr double least_explained = 0.55;          // share of the squared distances from a plane
  constexpr double least_round = 0.59;              // of roundness_of; dormers and ends of ridges have less
  if (seen.area > most_area) return false;
  const double slender = height_by_radius(dome, seen);
  const double round = roundness_of(cells, grid);
  if (dome.explained < least_explained || slender < flattest || slender > steepest || dome.tilt > most_tilt ||
      round < least_round)
    return false;
  const auto has = [&](double area, double rise, double squareness) {
    return seen.area >= area && seen.rise >= rise && seen.squareness <= squareness;
  };
  const bool is_large = has(5.8, 1.7, 0.33) && round >= 0.6;  // m², m; dormers have less
  const bool hangs = has(3.5, 1.3, 0.42) && seen.overhang >= 0.06 && dome.explained >= 0.7 && slender >= 0.6;
  const bool is_clear = has(3.5, 1.0, 0.42) && dome.explained >= 0.78 && round >= 0.7 && dome.tilt <= 0.3 &&
                        slender >= 0.6 && slender <= 1.3;
  return is_large || hangs || is_clear;
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
      if (geometry::contains(outline, at)) seen.inside += cell_area;
    }
    const auto count = static_cast<double>(blob.cells.size());
    seen.centre = (1 / count) * seen.centre;
    seen.roughness /= count;
    seen.rise = seen.top - lowest;
    seen.overhang = static_cast<double>(hanging) / count;
    seen.squareness = squareness_of(blob.cells, slopes);
    const auto dome = dome_of(blob.cells, surface);
    blob.hangs = hangs_over(seen, options) && !is_built(seen, dome);
    blob.dome = !blob.hangs && is_dome(seen, dome, blob.cells, grid);
    blob.too_long = blob.cells.back() / grid.columns - row >= halo || east - west >= halo;
    out.push_back(std::move(blob));
  }
  return out;
}

auto is_crown(const Blob& blob, const Options& options) -> bool {
  const auto& seen = blob.seen;
  if (blob.too_long || seen.inside < options.min_inside || seen.squareness > options.squareness) return false;
  return blob.dome || blob.hangs;
}

auto covers_any(const Blob& blob, const Grid& grid, std::span<const std::vector<geometry::Polygon>> footprints)
    -> bool {
  geometry::Box2 box;
  for (const auto c : blob.cells) box.add(grid.centre(c));
  return std::ranges::any_of(footprints, [&](const auto& footprint) {
    double half = 0;
    for (const auto& polygon : footprint) half += geometry::area(polygon) / 2;
    if (blob.seen.inside <= half || !geometry::bounds(footprint).overlaps(box)) return false;
    const auto cells =
        std::ranges::count_if(blob.cells, [&](auto cell) { return geometry::contains(footprint, grid.centre(cell)); });
    return static_cast<double>(cells) * grid.spacing * grid.spacing > half;
  });
}

auto is_annex(const Blob& blob, const Surface& surface, std::span<const geometry::Polygon> outline) -> bool {
  // Each limit is between what annexes and planted crowns were measured to have: docs/decisions/0117.
  constexpr double least_inside = 0.8;                       // share of it over the outline
  constexpr double most_hanging = 0.15;                      // share of it with a visible underside
  constexpr double around = 1;                               // m; what is beside it
  constexpr double least_outside = 0.25, least_high = 0.05;  // shares of that: beyond the outline, higher than its top
  if (blob.seen.inside < least_inside * blob.seen.area || blob.seen.overhang > most_hanging) return false;
  const auto& grid = surface.grid;
  const auto reach = static_cast<std::int64_t>(std::round(around / grid.spacing));
  std::vector<std::uint8_t> counted(grid.size(), 0);
  for (const auto c : blob.cells) counted[c] = 1;
  std::size_t beside = 0, outside = 0, high = 0;
  for (const auto c : blob.cells)
    each_around(grid, c, reach, [&](std::size_t cell, std::int64_t x, std::int64_t y) {
      if (x * x + y * y > reach * reach || counted[cell] != 0) return;
      counted[cell] = 1;
      ++beside;
      if (!geometry::contains(outline, grid.centre(cell))) ++outside;
      else if (surface.top[cell] > blob.seen.top) ++high;
    });
  const auto all = static_cast<double>(beside);
  return static_cast<double>(outside) >= least_outside * all && static_cast<double>(high) >= least_high * all;
}

}  // namespace mansard::vegetation::detail
