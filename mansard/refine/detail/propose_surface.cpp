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
  std::vector<LineMoments> inside, outside;
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

auto ridge_over(const std::vector<LineMoments>& bins, double first, const Options::Surfaces& options) -> double {
  std::vector<LineMoments> sums(bins.size() + 1);
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

struct Plane {
  double level = 0, x = 0, y = 0;  // z = level + x·x + y·y
  [[nodiscard]] auto at(double px, double py) const -> double { return level + x * px + y * py; }
};

auto plane_of(const Moments& m) -> Plane {
  const double xx = m.xx - m.x * m.x / m.n, xy = m.xy - m.x * m.y / m.n, yy = m.yy - m.y * m.y / m.n;
  const double xz = m.xz - m.x * m.z / m.n, yz = m.yz - m.y * m.z / m.n;
  const double det = xx * yy - xy * xy;
  Plane out;
  if (det > singular * xx * yy && det > 0) {
    out.x = (xz * yy - yz * xy) / det;
    out.y = (yz * xx - xz * xy) / det;
  }
  out.level = (m.z - out.x * m.x - out.y * m.y) / m.n;
  return out;
}

/// From the median height to a plane, taking in what comes near it, closer each time.
auto share_on_plane(const Raster& raster, const std::vector<std::uint8_t>& mask, double tolerance,
                    const Options::Surfaces& options) -> double {
  std::vector<float> heights;
  for (std::size_t k = 0; k < mask.size(); ++k)
    if (mask[k] && raster.state[k] == Cell::seen) heights.push_back(raster.z[k]);
  if (heights.empty()) return 0;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::ranges::nth_element(heights, middle);
  Plane plane{*middle, 0, 0};
  double share = 0;
  for (std::int64_t round = options.plane_rounds; round-- > 0;) {
    const double near = std::ldexp(tolerance, static_cast<int>(round));
    Moments m;
    for (int j = 0; j < raster.rows; ++j)
      for (int i = 0; i < raster.columns; ++i) {
        const std::size_t k = raster.at(i, j);
        const double x = raster.spacing * i, y = raster.spacing * j;
        if (mask[k] && raster.state[k] == Cell::seen && std::abs(raster.z[k] - plane.at(x, y)) <= near)
          m.add(x, y, raster.z[k], 0);
      }
    if (m.n < 1) return 0;
    share = m.n / static_cast<double>(heights.size());
    plane = plane_of(m);
  }
  return share;
}

}  // namespace

void Moments::add(double px, double py, double pz, double pr) {
  n += 1, x += px, y += py, xx += px * px, xy += px * py, yy += py * py;
  z += pz, xz += px * pz, yz += py * pz, zz += pz * pz, r += pr, rr += pr * pr;
}

auto Moments::operator+=(const Moments& o) -> Moments& {
  n += o.n, x += o.x, y += o.y, xx += o.xx, xy += o.xy, yy += o.yy;
  z += o.z, xz += o.xz, yz += o.yz, zz += o.zz, r += o.r, rr += o.rr;
  return *this;
}

auto Moments::operator-=(const Moments& o) -> Moments& {
  n -= o.n, x -= o.x, y -= o.y, xx -= o.xx, xy -= o.xy, yy -= o.yy;
  z -= o.z, xz -= o.xz, yz -= o.yz, zz -= o.zz, r -= o.r, rr -= o.rr;
  return *this;
}

void LineMoments::add(double pt, double pz) { n += 1, t += pt, tt += pt * pt, z += pz, tz += pt * pz, zz += pz * pz; }

auto LineMoments::operator+=(const LineMoments& o) -> LineMoments& {
  n += o.n, t += o.t, tt += o.tt, z += o.z, tz += o.tz, zz += o.zz;
  return *this;
}

auto operator-(LineMoments a, const LineMoments& b) -> LineMoments {
  a.n -= b.n, a.t -= b.t, a.tt -= b.tt, a.z -= b.z, a.tz -= b.tz, a.zz -= b.zz;
  return a;
}

auto plain_error(const Moments& m) -> double {
  if (m.n < half_a_cell) return 0;
  const double lifted = m.rr - m.r * m.r / m.n, level = m.zz - m.z * m.z / m.n;
  double best = std::min({m.rr, lifted, level});
  const Plane plane = plane_of(m);
  best = std::min(best, level - plane.x * (m.xz - m.x * m.z / m.n) - plane.y * (m.yz - m.y * m.z / m.n));
  return std::max(0.0, best);
}

auto ridge_error(const LineMoments& left, const LineMoments& right, double knot, double max_slope) -> double {
  // Height at the ridge, and a fall per metre away from it on either side.
  const double n = left.n + right.n;
  const double a = knot * left.n - left.t, aa = (knot * left.n - 2 * left.t) * knot + left.tt;
  const double b = right.t - knot * right.n, bb = right.tt - (2 * right.t - knot * right.n) * knot;
  const double az = knot * left.z - left.tz, bz = right.tz - knot * right.z;
  if (aa < singular || bb < singular) return infinite;
  const double s = n - a * a / aa - b * b / bb;
  if (s < singular * n) return infinite;
  const double q = left.z + right.z - a * az / aa - b * bz / bb, top = q / s;
  const double left_rise = (az - a * top) / aa, right_rise = (bz - b * top) / bb;
  if (left_rise + right_rise > 0 || std::max(std::abs(left_rise), std::abs(right_rise)) > max_slope) return infinite;
  return std::max(0.0, left.zz + right.zz - az * az / aa - bz * bz / bb - q * top);
}

auto best_ridge_error(std::span<const LineMoments> sums, double first_knot, double step,
                      const Options::Surfaces& options) -> double {
  double best = infinite;
  for (std::size_t i = 1; i + 1 < sums.size(); ++i) {
    const LineMoments left = sums[i] - sums.front(), right = sums.back() - sums[i];
    if (left.n < half_a_cell || right.n < half_a_cell) continue;
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
  const auto mean = [](const Moments& m) { return m.n > 0 ? m.r / m.n : 0; };
  Errors out{{inside.n, inside.rr, plain_error(inside)},
             {outside.n, outside.rr, plain_error(outside)},
             {all.n, all.rr, plain_error(all)},
             mean(inside),
             mean(outside)};
  const auto improve = [](Error& error, double by) { error.best = std::min(error.best, by); };
  const double least = options.ridge_min_area / raster.cell_area();
  for (const geometry::Point2 along : {ridges.axis, geometry::left_of(ridges.axis)}) {
    const Bins bins = bins_of(raster, mask, along, options.bin);
    if (inside.n > least) improve(out.inside, ridge_over(bins.inside, bins.first, options));
    if (outside.n > least) improve(out.outside, ridge_over(bins.outside, bins.first, options));
    std::vector<LineMoments> both = bins.inside;
    for (std::size_t i = 0; i < both.size(); ++i) both[i] += bins.outside[i];
    improve(out.whole, ridge_over(both, bins.first, options));
  }
  return out;
}

auto fit_of(const Raster& raster, const std::vector<std::uint8_t>& mask, const Frame& ridges, double tolerance,
            const Options::Surfaces& options) -> Fit {
  const Moments inside = moments_of(raster, mask).inside;
  if (inside.n < 1) return {infinite, 0};
  double error = plain_error(inside);
  if (inside.n > options.ridge_min_area / raster.cell_area())
    for (const geometry::Point2 along : {ridges.axis, geometry::left_of(ridges.axis)}) {
      const Bins bins = bins_of(raster, mask, along, options.bin);
      error = std::min(error, ridge_over(bins.inside, bins.first, options));
    }
  return {std::sqrt(error / inside.n), share_on_plane(raster, mask, tolerance, options)};
}

auto fullness_of(const Raster& raster, const std::vector<std::uint8_t>& mask, std::int64_t part) -> double {
  std::vector<float> residuals;
  double mean = 0;
  for (std::size_t k = 0; k < mask.size(); ++k)
    if (mask[k] && raster.state[k] == Cell::seen) residuals.push_back(raster.residual[k]);
  if (residuals.empty()) return 0;
  for (const float r : residuals) mean += r / static_cast<double>(residuals.size());
  if (mean < 0)
    for (float& r : residuals) r = -r;
  const auto high = residuals.begin() + std::ssize(residuals) * (part - 1) / part;
  std::ranges::nth_element(residuals, high);
  return *high > 0 ? std::abs(mean) / *high : 1;
}

auto hipped_error(const Raster& raster, const std::vector<std::uint8_t>& mask, const geometry::Polygon& polygon)
    -> double {
  LineMoments m;
  for (int j = 0; j < raster.rows; ++j)
    for (int i = 0; i < raster.columns; ++i) {
      const std::size_t k = raster.at(i, j);
      if (!mask[k] || raster.state[k] != Cell::seen) continue;
      m.add(geometry::boundary_distance(polygon, raster.frame.back({raster.x(i), raster.y(j)})), raster.z[k]);
    }
  if (m.n < 1) return infinite;
  const double tt = m.tt - m.t * m.t / m.n, tz = m.tz - m.t * m.z / m.n, zz = m.zz - m.z * m.z / m.n;
  if (tt <= 0 || tz < 0) return infinite;
  return std::sqrt(std::max(0.0, zz - tz * tz / tt) / m.n);
}

}  // namespace mansard::refine::detail::carve
