#include "mansard/planes/planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>

#include "mansard/base/run.hpp"
#include "mansard/geometry/fit.hpp"

namespace mansard::planes {
namespace {

using geometry::Point2;
using geometry::Point3;

/// Neighbours of a point: three make a plane, nine are left to say how even it is.
constexpr std::size_t neighbours = 12;
/// Standard deviations: so far from a plane its points lie.
constexpr double within = 3;
/// Standard deviations: of twelve neighbours on a plane, one set in a thousand is less even (χ² of 9 degrees, 27.9).
constexpr double even = 1.76;
/// Cosine of 20°: what bends more between neighbours is a crease.
constexpr double same_way = 0.94;
/// Sine of 10°: steeper is no roof, but a wall (decision 113 has the same limit).
constexpr double upright = 0.19;
/// Nominal spacings: neighbours farther apart are of different surfaces.
constexpr double apart = 3;
/// A plane is fitted again whenever it has grown by so much.
constexpr double again = 1.3;
/// m: coordinates are rounded to millimetres in most files.
constexpr double least_noise = 0.002;

struct Points {
  std::span<const Point3> all;
  [[nodiscard]] auto kdtree_get_point_count() const -> std::size_t { return all.size(); }
  [[nodiscard]] auto kdtree_get_pt(std::size_t i, std::size_t k) const -> double {
    return k == 0 ? all[i].x : k == 1 ? all[i].y : all[i].z;
  }
  template <class Box>
  auto kdtree_get_bbox(Box& /*box*/) const -> bool {
    return false;
  }
};
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::uint32_t>;

/// Sums about a place near the points, so that they lose no digits.
struct Moments {
  double n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  void add(Point3 p) {
    n += 1, x += p.x, y += p.y, z += p.z;
    xx += p.x * p.x, xy += p.x * p.y, xz += p.x * p.z, yy += p.y * p.y, yz += p.y * p.z, zz += p.z * p.z;
  }
};

/// The plane with the least sum of squared distances along its normal.
struct Flat {
  Point3 middle, normal;  ///< the normal points up
  double variance = 0;    ///< m²; along the normal
  double width = 0;       ///< m²; the variance across the narrower side
};

/// The eigenvector of the least eigenvalue of a symmetric matrix, by Jacobi's rotations (Golub and Van Loan, Matrix
/// Computations, 8.5).
auto flat_of(const Moments& m, Point3 about) -> Flat {
  const double cx = m.x / m.n, cy = m.y / m.n, cz = m.z / m.n;
  std::array<std::array<double, 3>, 3> a{{{m.xx / m.n - cx * cx, m.xy / m.n - cx * cy, m.xz / m.n - cx * cz},
                                          {m.xy / m.n - cx * cy, m.yy / m.n - cy * cy, m.yz / m.n - cy * cz},
                                          {m.xz / m.n - cx * cz, m.yz / m.n - cy * cz, m.zz / m.n - cz * cz}}};
  std::array<std::array<double, 3>, 3> v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  constexpr int rounds = 12;  // each leaves a square of what was off the diagonal, until that is less than rounding
  constexpr double rounding = 0x1.0p-53;
  for (int round = 0; round < rounds; ++round) {
    const double off = std::abs(a[0][1]) + std::abs(a[0][2]) + std::abs(a[1][2]);
    if (off <= rounding * (a[0][0] + a[1][1] + a[2][2])) break;
    for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
      if (a[p][q] == 0) continue;
      const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (int k = 0; k < 3; ++k) {
        const double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq, a[k][q] = s * kp + c * kq;
      }
      for (int k = 0; k < 3; ++k) {
        const double pk = a[p][k], qk = a[q][k];
        a[p][k] = c * pk - s * qk, a[q][k] = s * pk + c * qk;
        const double kp = v[k][p], kq = v[k][q];
        v[k][p] = c * kp - s * kq, v[k][q] = s * kp + c * kq;
      }
    }
  }
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, {}, [&](int k) { return a[k][k]; });
  const int least = order[0];
  Point3 normal{v[0][least], v[1][least], v[2][least]};
  if (normal.z < 0) normal = -1.0 * normal;
  return {about + Point3{cx, cy, cz}, normal, std::max(0.0, a[least][least]), a[order[1]][order[1]]};
}

class Growing {
 public:
  Growing(std::span<const Point3> points, const Options& options)
      : points_(points),
        options_(options),
        noise_(std::max(options.noise, least_noise)),
        farthest_(apart * std::sqrt(options.point_area)),
        cloud_{points},
        tree_(3, cloud_) {}

  auto run() -> Found {
    out_.plane_of.assign(points_.size(), Found::none);
    if (points_.size() < neighbours) return std::move(out_);
    look_around();
    std::vector<std::uint32_t> seeds;
    for (std::uint32_t i = 0; i < points_.size(); ++i)
      if (is_even(i)) seeds.push_back(i);
    std::ranges::stable_sort(seeds, {}, [&](std::uint32_t i) { return flats_[i].variance; });
    state_.assign(points_.size(), free);
    for (const auto seed : seeds)
      if (state_[seed] == free) grow(seed);
    return std::move(out_);
  }

 private:
  enum : std::uint8_t { free, mine, taken, refused };

  void look_around() {
    near_.resize(points_.size() * neighbours);
    flats_.resize(points_.size());
    constexpr std::size_t piece = 1024;
    base::parallel_for((points_.size() + piece - 1) / piece, [&](std::size_t k) {
      std::array<double, neighbours> squares{};
      for (std::size_t i = k * piece; i < std::min(points_.size(), (k + 1) * piece); ++i) {
        const std::array<double, 3> at{points_[i].x, points_[i].y, points_[i].z};
        tree_.knnSearch(at.data(), neighbours, &near_[i * neighbours], squares.data());
        Moments moments;
        for (std::size_t j = 0; j < neighbours; ++j) moments.add(points_[near_[i * neighbours + j]] - points_[i]);
        flats_[i] = flat_of(moments, points_[i]);
      }
    });
  }

  [[nodiscard]] auto is_even(std::uint32_t i) const -> bool {
    const double rms = std::sqrt(flats_[i].variance);
    return rms <= even * noise_ && flats_[i].width > 4 * flats_[i].variance;
  }

  void grow(std::uint32_t seed) {
    Flat plane = flats_[seed];
    std::vector<std::uint32_t> region{seed}, passed;
    Moments moments;
    const Point3 about = points_[seed];
    moments.add({});
    state_[seed] = mine;
    std::size_t fitted = neighbours;
    for (std::size_t at = 0; at < region.size(); ++at)
      for (std::size_t j = 0; j < neighbours; ++j) {
        const auto next = near_[region[at] * neighbours + j];
        if (state_[next] != free && state_[next] != refused) continue;
        if (length(points_[next] - points_[region[at]]) > farthest_) continue;
        if (std::abs(dot(points_[next] - plane.middle, plane.normal)) > within * noise_) continue;
        if (is_even(next) && std::abs(dot(flats_[next].normal, plane.normal)) < same_way) continue;
        state_[next] = mine;
        region.push_back(next);
        moments.add(points_[next] - about);
        if (static_cast<double>(region.size()) < again * static_cast<double>(fitted)) continue;
        fitted = region.size();
        plane = flat_of(moments, about);
      }
    finish(region, about, plane);
  }

  /// Fits it to those that are on it, and keeps it where these are enough.
  void finish(std::vector<std::uint32_t>& region, Point3 about, Flat plane) {
    constexpr int rounds = 2;
    std::vector<std::uint32_t> on = region;
    for (int round = 0; round < rounds && on.size() >= 3; ++round) {
      Moments moments;
      for (const auto i : on) moments.add(points_[i] - about);
      plane = flat_of(moments, about);
      on.clear();
      for (const auto i : region)
        if (std::abs(dot(points_[i] - plane.middle, plane.normal)) <= within * noise_) on.push_back(i);
    }
    const double count = static_cast<double>(on.size());
    const bool enough = on.size() >= neighbours / 2 && count * options_.point_area >= options_.least_area;
    for (const auto i : region)
      state_[i] = enough ? static_cast<std::uint8_t>(free) : static_cast<std::uint8_t>(refused);
    if (!enough) return;
    const bool is_wall = plane.normal.z < upright;
    const auto number = is_wall ? Found::wall : static_cast<std::uint32_t>(out_.planes.size());
    for (const auto i : on) {
      state_[i] = taken;
      out_.plane_of[i] = number;
    }
    if (!is_wall) out_.planes.push_back(fitted(std::move(on)));
  }

  [[nodiscard]] auto fitted(std::vector<std::uint32_t> on) const -> Plane {
    Plane out;
    std::ranges::sort(on);
    const Point3 about = points_[on.front()];
    geometry::PlaneSums sums;
    for (const auto i : on) sums.add(points_[i].x - about.x, points_[i].y - about.y, points_[i].z - about.z);
    const auto centred = sums.centred();
    out.slope = centred.slopes();
    out.middle = about + (1 / sums.count) * Point3{sums.x, sums.y, sums.z};
    double squares = 0;
    for (const auto i : on) {
      const double d = points_[i].z - out.at(xy(points_[i]));
      squares += d * d;
    }
    out.rms = std::sqrt(squares / sums.count);
    const double variance = squares / std::max(1.0, sums.count - 3), det = centred.determinant();
    out.height_variance = variance / sums.count;
    out.slope_xx = variance * centred.yy / det;
    out.slope_xy = -variance * centred.xy / det;
    out.slope_yy = variance * centred.xx / det;
    out.points = std::move(on);
    return out;
  }

  std::span<const Point3> points_;
  Options options_;
  double noise_, farthest_;  // m
  Points cloud_;
  Tree tree_;
  std::vector<std::uint32_t> near_;
  std::vector<Flat> flats_;
  std::vector<std::uint8_t> state_;
  Found out_;
};

}  // namespace

auto Plane::error_at(Point2 place) const -> double {
  const Point2 off = place - xy(middle);
  return std::sqrt(height_variance + off.x * off.x * slope_xx + 2 * off.x * off.y * slope_xy +
                   off.y * off.y * slope_yy);
}

auto find(std::span<const Point3> points, const Options& options) -> Found { return Growing(points, options).run(); }

}  // namespace mansard::planes
