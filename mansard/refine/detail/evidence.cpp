#include "mansard/refine/detail/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

/// Nominal spacings: of points that lie at random, one place in 300 has none within 1.5.
constexpr double near_by = 1.5;
/// m, and rise per run: a point below another that is so near lies on a wall, or at its foot. No roof is steeper than
/// 79° (decision 113).
constexpr double wall_rise = 0.3, wall_slope = 5;

}  // namespace

Evidence::Evidence(const rays::Scene& mesh, const Options& options) {
  constexpr double all = std::numeric_limits<double>::infinity();
  const auto points = mesh.points_in({{-all, -all}, {all, all}});
  const double spacing = std::sqrt(options.samples.point_area);
  reach_ = near_by * spacing;
  auto found = planes::find(points, {options.samples.noise, options.samples.point_area, 1.0});
  const auto box = geometry::Box2::of(points);
  if (points.empty()) return;
  origin_ = box.least;
  columns_ = static_cast<std::size_t>((box.most.x - origin_.x) / reach_) + 1;
  rows_ = static_cast<std::size_t>((box.most.y - origin_.y) / reach_) + 1;
  const auto bucket_of = [&](Point3 p) {
    return static_cast<std::size_t>((p.y - origin_.y) / reach_) * columns_ +
           static_cast<std::size_t>((p.x - origin_.x) / reach_);
  };
  first_.assign(columns_ * rows_ + 1, 0);
  for (const Point3 p : points) ++first_[bucket_of(p) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  auto next = first_;
  points_.resize(points.size());
  plane_of_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = next[bucket_of(points[i])]++;
    points_[at] = points[i];
    plane_of_[at] = found.plane_of[i];
  }
  planes_ = std::move(found.planes);
  leave_out_walls(spacing);
}

template <class See>
void Evidence::each_near(Point2 place, See see) const {
  if (columns_ == 0) return;
  const auto column = std::floor((place.x - origin_.x) / reach_), row = std::floor((place.y - origin_.y) / reach_);
  const auto low = [](double at) { return static_cast<std::size_t>(std::max(0.0, at - 1)); };
  const auto high = [](double at, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(at + 2, 0.0, static_cast<double>(count)));
  };
  for (std::size_t r = low(row); r < high(row, rows_); ++r)
    for (std::size_t c = low(column); c < high(column, columns_); ++c)
      for (std::uint32_t i = first_[r * columns_ + c]; i < first_[r * columns_ + c + 1]; ++i) see(i);
}

/// Those on steep planes, and those on none with a point above them on the way of a wall.
void Evidence::leave_out_walls(double spacing) {
  std::vector<char> out(points_.size(), 0);
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (plane_of_[i] == planes::Found::wall) out[i] = 1;
    if (plane_of_[i] != planes::Found::none) continue;
    each_near(xy(points_[i]), [&](std::uint32_t k) {
      const double rise = points_[k].z - points_[i].z, run = length(xy(points_[k] - points_[i]));
      if (run < spacing && rise > wall_rise && rise > wall_slope * run) out[i] = 1;
    });
  }
  std::uint32_t to = 0;
  for (std::size_t b = 0; b + 1 < first_.size(); ++b) {
    const std::uint32_t begin = first_[b], end = first_[b + 1];
    first_[b] = to;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (out[i]) continue;
      points_[to] = points_[i];
      plane_of_[to++] = plane_of_[i];
    }
  }
  first_.back() = to;
  points_.resize(to);
  plane_of_.resize(to);
}

auto Evidence::in(const geometry::Box2& box) const -> std::vector<Sample> {
  std::vector<Sample> out;
  if (columns_ == 0) return out;
  const auto index = [](double at, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(count)));
  };
  for (std::size_t r = index((box.least.y - origin_.y) / reach_, rows_);
       r < index((box.most.y - origin_.y) / reach_ + 1, rows_); ++r)
    for (std::size_t c = index((box.least.x - origin_.x) / reach_, columns_);
         c < index((box.most.x - origin_.x) / reach_ + 1, columns_); ++c)
      for (std::uint32_t i = first_[r * columns_ + c]; i < first_[r * columns_ + c + 1]; ++i)
        if (box.contains(xy(points_[i]))) out.push_back({points_[i], plane_of_[i]});
  return out;
}

template <class Take>
auto Evidence::height_by_nearest(Point2 place, Take take) const -> std::optional<double> {
  double least = reach_ * reach_;
  std::optional<std::uint32_t> nearest;
  each_near(place, [&](std::uint32_t i) {
    const Point2 off = xy(points_[i]) - place;
    if (const double squared = dot(off, off); squared < least && take(points_[i])) least = squared, nearest = i;
  });
  if (!nearest) return std::nullopt;
  const auto plane = plane_of_[*nearest];
  return plane < planes_.size() ? planes_[plane].at(place) : points_[*nearest].z;
}

auto Evidence::height_at(Point2 place) const -> std::optional<double> {
  return height_by_nearest(place, [](Point3) { return true; });
}

auto Evidence::height_at(Point2 place, const geometry::Polygon& over) const -> std::optional<double> {
  return height_by_nearest(place, [&](Point3 p) { return geometry::contains(over, xy(p)); });
}

}  // namespace mansard::refine::detail
