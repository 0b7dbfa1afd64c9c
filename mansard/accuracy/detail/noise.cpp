#include "mansard/accuracy/detail/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "mansard/base/run.hpp"
#include "mansard/base/statistics.hpp"
#include "mansard/geometry/fit.hpp"

namespace mansard::accuracy::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr double cell = 1;            // m
constexpr double largest_radius = 4;  // m; on larger discs there are no roofs
constexpr double growth = 1.5;        // from radius to radius
constexpr std::size_t full = 12;      // samples of a disc: three make the plane, nine are left to measure by
constexpr double used = 240;          // samples of a disc; more do not change its mean square by 5 %
constexpr std::size_t least_discs = 12;
constexpr double least_share = 0.15;  // of the places
constexpr double off_centre = 0.25;   // of the radius: the disc is cut off by an edge

/// Discs over ridges, steps and clutter have more than noise; those below the quantile have noise alone where at least
/// a fifth of all is even. Where five sixths are, it is the quantile of `even_quantile` of those.
constexpr double quantile = 0.1, even_quantile = 0.12;

constexpr double pi = std::numbers::pi;

/// By quadrature over the disc: the trace of the covariance of noise exp(−d² / 2 ℓ²) without its projection on 1, x and
/// y, and (Σ λ)² / Σ λ² of its eigenvalues (docs/accuracy.md).
constexpr std::array<double, 11> radii{0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 2.8, 4, 5.6, 8};
constexpr std::array<double, 11> left{0.0005, 0.0017, 0.0067, 0.0226, 0.0728, 0.1826,
                                      0.3733, 0.5730, 0.7445, 0.8526, 0.9213};
constexpr std::array<double, 11> freedom{3.1, 3.1, 3.2, 3.5, 4.0, 5.0, 7.1, 10.9, 19.2, 35.1, 68.7};

auto between(const std::array<double, 11>& values, double at) -> double {
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(radii, at) - radii.begin());
  const double t = std::log(at / radii[next - 1]) / std::log(radii[next] / radii[next - 1]);
  return values[next - 1] * std::pow(values[next] / values[next - 1], t);
}

/// Row and column of a cell: few of them have points where a cloud has strays far away, so that there is no grid.
using Cell = std::pair<double, double>;
auto cell_of(const Point3& p) -> Cell { return {std::floor(p.y / cell), std::floor(p.x / cell)}; }

/// The quantile of χ² over its degrees of freedom (Wilson and Hilferty 1931).
auto chi_square_share(double degrees) -> double {
  constexpr double z = -1.1750;  // of the normal distribution at `even_quantile`
  const double s = 2 / (9 * degrees), root = 1 - s + z * std::sqrt(s);
  return std::max(1e-3, root * root * root);
}

}  // namespace

auto left_by_plane(double t) -> double {
  if (t >= radii.back()) return 1 - (1 - left.back()) * radii.back() * radii.back() / (t * t);  // 1 − 3 A / π r²
  if (t < radii.front()) return left.front() * std::pow(t / radii.front(), 4);                  // what bends
  return between(left, t);
}

auto degrees_of_freedom(double t) -> double {
  if (t >= radii.back()) return freedom.back() * t * t / (radii.back() * radii.back());
  return t < radii.front() ? freedom.front() : between(freedom, t);
}

Cells::Cells(std::vector<Point3> points) : points_(std::move(points)) {
  std::ranges::sort(points_);
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  std::ranges::stable_sort(points_, {}, cell_of);
}

template <class See>
void Cells::each_near(Point2 at, double radius, See see) const {
  const auto low = cell_of({at.x - radius, at.y - radius, 0}), high = cell_of({at.x + radius, at.y + radius, 0});
  for (double row = 0; row <= high.first - low.first; ++row) {
    const Cell from{low.first + row, low.second};
    const auto begin = std::ranges::lower_bound(points_, from, {}, cell_of);
    for (auto i = static_cast<std::size_t>(begin - points_.begin()); i < points_.size(); ++i) {
      if (cell_of(points_[i]) > Cell{from.first, high.second}) break;
      const Point2 off = xy(points_[i]) - at;
      if (dot(off, off) <= radius * radius) see(i, points_[i]);
    }
  }
}

auto Cells::ground_of_one(std::span<const Point2> places) const -> double {
  // The smallest disc of which half of the places have a dozen.
  for (double radius = 0.25; radius < largest_radius; radius *= growth) {
    std::vector<double> counts;
    for (const Point2 at : places) {
      double count = 0;
      each_near(at, radius, [&](std::size_t, Point3) { count += 1; });
      counts.push_back(count);
    }
    if (const double middle = counts.empty() ? 0 : base::median(std::move(counts)); middle >= full)
      return pi * radius * radius / middle;
  }
  double all = 0;
  for (const Point2 at : places) each_near(at, largest_radius, [&](std::size_t, Point3) { all += 1; });
  return pi * largest_radius * largest_radius * static_cast<double>(places.size()) / std::max(1.0, all);
}

auto Cells::disc_at(Point2 at, double radius, std::size_t every) const -> std::optional<Disc> {
  geometry::PlaneSums sums;
  double zz = 0;
  std::optional<double> level;
  each_near(at, radius, [&](std::size_t i, Point3 p) {
    if (i % every != 0) return;
    if (!level) level = p.z;
    const double z = p.z - *level;
    sums.add(p.x - at.x, p.y - at.y, z);
    zz += z * z;
  });
  if (sums.count < static_cast<double>(full)) return std::nullopt;
  const Point2 centre{sums.x / sums.count, sums.y / sums.count};
  const auto equations = sums.centred();
  const bool even =
      length(centre) <= off_centre * radius && equations.determinant() > 0.05 * equations.xx * equations.yy;
  if (!even) return std::nullopt;
  const Point2 slope = equations.slopes();
  const double rest = zz - sums.z * sums.z / sums.count - slope.x * equations.xz - slope.y * equations.yz;
  return Disc{std::max(0.0, rest / sums.count) / (1 + dot(slope, slope)), sums.count};
}

auto Cells::residuals(std::span<const Point2> places, double ground, double least) const -> std::vector<Residual> {
  std::vector<double> all;
  for (double radius = std::max(least, std::sqrt(full * ground / pi) * 1.05); radius < largest_radius; radius *= growth)
    all.push_back(radius);
  if (!all.empty() && all.back() < largest_radius / 1.15) all.push_back(largest_radius);
  std::vector<std::optional<Residual>> found(all.size());
  base::parallel_for(all.size(), [&](std::size_t k) {
    const double radius = all[k];
    const auto every = static_cast<std::size_t>(std::max(1.0, pi * radius * radius / ground / used));
    std::vector<double> squares, counts;
    for (const Point2 at : places)
      if (const auto disc = disc_at(at, radius, every)) {
        squares.push_back(disc->squared);
        counts.push_back(disc->count);
      }
    if (squares.size() < least_discs ||
        static_cast<double>(squares.size()) < least_share * static_cast<double>(places.size()))
      return;
    const std::size_t discs = squares.size();
    found[k] = Residual{radius, base::percentile(std::move(squares), quantile), base::median(std::move(counts)), discs};
  });
  std::vector<Residual> out;
  for (const auto& one : found)
    if (one) out.push_back(*one);
  return out;
}

auto noise_from(std::span<const Residual> residuals, double ground) -> std::optional<Noise> {
  if (residuals.empty()) return std::nullopt;
  constexpr double nothing = 1e-10;  // m²: 10 µm, what coordinates are rounded to
  if (residuals.front().squared <= nothing) return Noise{0, ground, residuals.front().discs};
  // Noise grows ever less from disc to disc, whatever its correlation; where residuals begin to grow faster, discs have
  // begun to hold more than one roof.
  constexpr double steepest = 4.3, bends = 0.15;  // of logarithms; a bent surface grows with the fourth power
  std::size_t count = 1;
  for (double last = steepest; count < residuals.size(); ++count) {
    const auto &a = residuals[count - 1], &b = residuals[count];
    const double slope = std::log(b.squared / a.squared) / std::log(b.radius / a.radius);
    if (slope > std::min(steepest, last + bends)) break;
    last = std::max(0.0, slope);
  }
  const auto kept = residuals.first(count);
  // ln V − ln model by correlation length; what is above the model may be structure, and counts less.
  constexpr double above = 0.6;
  constexpr double as_good = 0.15;  // of (ln V)²: independent noise is accepted where that of its V is unexplained
  const double white = std::sqrt(ground / (2 * pi));
  Noise best;
  double least = std::numeric_limits<double>::infinity();
  // What is not seen is not claimed: noise that is correlated farther than the discs reach would be extrapolated from
  // how it begins to grow; and where discs have begun to hold more than one roof, that is in the last of them, too.
  constexpr double seen = 1.4, seen_of_one_roof = 2.8;  // correlation lengths
  const double longest = kept.back().radius / (count < residuals.size() ? seen_of_one_roof : seen);
  for (double length = white; length < std::max(longest, 1.5 * white); length *= 1.05) {
    std::vector<double> off;
    for (const auto& one : kept) {
      const double t = one.radius / length;
      const double freedom = std::min(degrees_of_freedom(t), one.samples - 3);
      off.push_back(std::log(one.squared / (left_by_plane(t) * chi_square_share(freedom))));
    }
    for (double level : off) {
      const auto weight_of = [&](std::size_t k) {
        const double share = kept[k].radius / kept.back().radius;  // what counts is what is wrong over whole roofs
        return share * (off[k] > level ? above : 1);
      };
      for (int round = 0; round < 4; ++round) {
        double sum = 0, weight = 0;
        for (std::size_t k = 0; k < off.size(); ++k) sum += weight_of(k) * off[k], weight += weight_of(k);
        level = sum / weight;
      }
      double error = 0;
      for (std::size_t k = 0; k < off.size(); ++k) error += weight_of(k) * (off[k] - level) * (off[k] - level);
      if (length == white && error < as_good) error = 0;
      if (error >= least) continue;
      least = error;
      best = {std::exp(level / 2), std::max(ground, 2 * pi * length * length), kept.front().discs};
    }
  }
  return best;
}

auto noise_of_vertices(const geometry::Mesh& mesh, const std::function<bool(Point2)>& seen, double ground)
    -> std::optional<Noise> {
  // Creases have more than noise. At least a tenth is noise alone: of the triangles of a polygon with n corners n − 3
  // pairs are even, and half of n lie over its border. The quantile of the normal distribution at 0.55 is that of its
  // absolute value at 0.1.
  constexpr double even = 0.1, normal_quantile = 0.1257;
  constexpr std::size_t least_pairs = 12;
  struct Side {  // of a triangle, by place: whether vertices are shared is a matter of the file
    Point3 from, to, apex, normal;
  };
  std::vector<Side> sides;
  for (const auto& t : mesh.triangles) {
    const std::array corners{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    const Point3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double size = length(across);
    if (!(std::abs(across.z) > faces_up * size)) continue;
    const Point3 normal = (1 / size) * across;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [from, to] = std::minmax(corners[k], corners[(k + 1) % 3]);
      sides.push_back({from, to, corners[(k + 2) % 3], across.z > 0 ? normal : -1 * normal});
    }
  }
  const auto key = [](const Side& side) { return std::tie(side.from, side.to, side.apex); };
  std::ranges::sort(sides, [&](const Side& a, const Side& b) { return key(a) < key(b); });
  std::vector<double> errors;
  const auto same = [&](std::size_t i, std::size_t j) {
    return j < sides.size() && sides[i].from == sides[j].from && sides[i].to == sides[j].to;
  };
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    for (next = i + 1; same(i, next);) ++next;
    if (next - i != 2 || !seen(0.5 * (xy(sides[i].from) + xy(sides[i].to)))) continue;
    // What four points are off a plane: the sum of their heights, weighed so that every plane gives nothing.
    const std::array p{sides[i].from, sides[i].to, sides[i].apex, sides[i + 1].apex};
    double sum = 0, squares = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Point2 a = xy(p[(k + 1) % 4]), b = xy(p[(k + 2) % 4]), c = xy(p[(k + 3) % 4]);
      const double weight = (k % 2 == 0 ? 1 : -1) * cross(b - a, c - a);
      sum += weight * (p[k].z - p[0].z);
      squares += weight * weight;
    }
    if (squares > 0)
      errors.push_back(std::abs(sum) / std::sqrt(squares) * (sides[i].normal.z + sides[i + 1].normal.z) / 2);
  }
  if (errors.size() < least_pairs) return std::nullopt;
  const std::size_t pairs = errors.size();
  return Noise{base::percentile(std::move(errors), even) / normal_quantile, ground, pairs};
}

}  // namespace mansard::accuracy::detail
