#include "mansard/refine/detail/propose_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::refine::detail::carve {
namespace {

// Error bounds of sums over cells. Places are below 1e3 m and heights below 1e3 m, so a sum of squares over n cells is
// exact to n · 1e6 · 2⁻⁵³ ≈ n · 1e-10, and relative to its largest term to n · 2⁻⁵³ ≈ 1e-11 for 1e5 cells.
constexpr double singular = 1e-9;  ///< a determinant of less, relative to its terms, is rounding: all cells on one line
constexpr double half_a_cell = 0.5;  ///< counts are whole numbers in doubles
constexpr double infinite = std::numeric_limits<double>::infinity();

struct Bins {
  double first = 0;  ///< m, where the first bin begins
  std::vector<geometry::LineSums> inside, outside;
};

auto bins_of(const Raster& raster, const std::vector<std::uint8_t>& mask, geometry::Point2 along, double bin) -> Bins {
  // `along` and the raster's own axes, without turning every cell.
  const double cu = dot(along, raster.frame.axis), cv = dot(along, geometry::left_of(raster.frame.axis));
  const double w = raster.spacing * (raster.columns - 1), h = raster.spacing * (raster.rows - 1);
  Bins out;
  out.first = std::min(0.0, cu * w) + std::min(0.0, cv * h) - bin / 2;
  const double last = std::max(0.0, cu * w) + std::max(0.0, cv * h) + bin / 2;
  const auto count = static_cast<std::size_t>(std::ceil((last - out.first) / bin)) + 1;
  out.inside.resize(count);
  out.outside.resize(count);
  for (int j = 0; j < raster.rows; ++j)
    for (int i = 0; i < raster.columns; ++i) {
      const std::size_t k = raster.at(i, j);
      if (raster.state[k] != Cell::seen) continue;
      const double t = cu * raster.spacing * i + cv * raster.spacing * j;
      const auto b = static_cast<std::size_t>((t - out.first) / bin);
      (mask[k] ? out.inside : out.outside)[b].add(t, raster.z[k]);
    }
  return out;
}

auto ridge_over(const std::vector<geometry::LineSums>& bins, double first, const Options::Surfaces& options) -> double {
  std::vector<geometry::LineSums> sums(bins.size() + 1);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    sums[i + 1] = sums[i];
    sums[i + 1] += bins[i];
  }
  return best_ridge_error(sums, first, options.bin, options);
}

struct Pair {
  Moments inside, outside;
};

auto moments_of(const Raster& raster, const std::vector<std::uint8_t>& mask) -> Pair {
  Pair out;
  for (int j = 0; j < raster.rows; ++j)
    for (int i = 0; i < raster.columns; ++i) {
      const std::size_t k = raster.at(i, j);
      if (raster.state[k] != Cell::seen) continue;
      (mask[k] ? out.inside : out.outside).add(raster.spacing * i, raster.spacing * j, raster.z[k], raster.residual[k]);
    }
  return out;
}

}  // namespace

auto plane_of(const geometry::PlaneSums& sums) -> geometry::FittedPlane {
  const auto equations = sums.centred();
  const double det = equations.determinant();
  if (det > singular * equations.xx * equations.yy && det > 0) return sums.plane(equations.slopes());
  return sums.plane({});
}

void Moments::add(double px, double py, double pz, double pr) {
  PlaneSums::add(px, py, pz);
  zz += pz * pz, r += pr, rr += pr * pr;
}

auto Moments::operator+=(const Moments& o) -> Moments& {
  PlaneSums::operator+=(o);
  zz += o.zz, r += o.r, rr += o.rr;
  return *this;
}

auto Moments::operator-=(const Moments& o) -> Moments& {
  PlaneSums::operator-=(o);
  zz -= o.zz, r -= o.r, rr -= o.rr;
  return *this;
}

auto plain_error(const Moments& m) -> double {
  if (m.count < half_a_cell) return 0;
  const double lifted = m.rr - m.r * m.r / m.count, level = m.zz - m.z * m.z / m.count;
  double best = std::min({m.rr, lifted, level});
  const auto slope = plane_of(m).slope;
  const auto equations = m.centred();
  best = std::min(best, level - slope.x * equations.xz - slope.y * equations.yz);
  return std::max(0.0, best);
}

auto ridge_error(const geometry::LineSums& left, const geometry::LineSums& right, double knot, double max_slope)
    -> double {
  // Height at the ridge, and a fall per metre away from it on either side.
  const double n = left.weight + right.weight;
  const double a = knot * left.weight - left.x, aa = (knot * left.weight - 2 * left.x) * knot + left.xx;
  const double b = right.x - knot * right.weight, bb = right.xx - (2 * right.x - knot * right.weight) * knot;
  const double az = knot * left.z - left.xz, bz = right.xz - knot * right.z;
  if (aa < singular || bb < singular) return infinite;
  const double s = n - a * a / aa - b * b / bb;
  if (s < singular * n) return infinite;
  const double q = left.z + right.z - a * az / aa - b * bz / bb, top = q / s;
  const double left_rise = (az - a * top) / aa, right_rise = (bz - b * top) / bb;
  if (left_rise + right_rise > 0 || std::max(std::abs(left_rise), std::abs(right_rise)) > max_slope) return infinite;
  return std::max(0.0, left.zz + right.zz - az * az / aa - bz * bz / bb - q * top);
}

auto best_ridge_error(std::span<const geometry::LineSums> sums, double first_knot, double step,
                      const Options::Surfaces& options) -> double {
  double best = infinite;
  for (std::size_t i = 1; i + 1 < sums.size(); ++i) {
    const geometry::LineSums left = sums[i] - sums.front(), right = sums.back() - sums[i];
    if (left.weight < half_a_cell || right.weight < half_a_cell) continue;
    best = std::min(best, ridge_error(left, right, first_knot + step * static_cast<double>(i), options.max_slope));
  }
  return best;
}

auto gain_of(const Error& inside, const Error& outside, const Error& whole, const Options::Surfaces& options)
    -> double {
  const double refitted = whole.best - inside.best - outside.best;
  if (whole.best <= options.model_share * whole.model) return refitted;
  const Error& smaller = inside.count <= outside.count ? inside : outside;
  return std::max(refitted, smaller.model - smaller.best);
}

auto errors_of(const Raster& raster, const std::vector<std::uint8_t>& mask, const Frame& ridges,
               const Options::Surfaces& options) -> Errors {
  const auto [inside, outside] = moments_of(raster, mask);
  Moments all = inside;
  all += outside;
  Errors out{{inside.count, inside.rr, plain_error(inside)},
             {outside.count, outside.rr, plain_error(outside)},
             {all.count, all.rr, plain_error(all)}};
  const auto improve = [](Error& error, double by) { error.best = std::min(error.best, by); };
  for (const geometry::Point2 along : {ridges.axis, geometry::left_of(ridges.axis)}) {
    const Bins bins = bins_of(raster, mask, along, options.bin);
    if (inside.count > 0) improve(out.inside, ridge_over(bins.inside, bins.first, options));
    if (outside.count > 0) improve(out.outside, ridge_over(bins.outside, bins.first, options));
    std::vector<geometry::LineSums> both = bins.inside;
    for (std::size_t i = 0; i < both.size(); ++i) both[i] += bins.outside[i];
    improve(out.whole, ridge_over(both, bins.first, options));
  }
  return out;
}

}  // namespace mansard::refine::detail::carve
