#include "mansard/label/detail/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mansard/base/statistics.hpp"

namespace mansard::label::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

Terrain::Terrain(const geometry::Mesh& mesh, const std::function<bool(std::size_t)>& use, double size, double steepest)
    : size_(size) {
  const auto box = geometry::Box2::of(mesh.vertices);
  if (box.empty()) return;
  origin_ = box.least;
  columns_ = static_cast<std::int64_t>((box.most.x - box.least.x) / size) + 1;
  rows_ = static_cast<std::int64_t>((box.most.y - box.least.y) / size) + 1;
  std::vector<std::vector<double>> of_cell(static_cast<std::size_t>(columns_ * rows_));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!use(t)) continue;
    const Point3 p = centre_of(mesh, mesh.triangles[t]);
    const auto column = static_cast<std::int64_t>((p.x - origin_.x) / size);
    const auto row = static_cast<std::int64_t>((p.y - origin_.y) / size);
    of_cell[static_cast<std::size_t>(row * columns_ + column)].push_back(p.z);
  }
  for (auto& heights : of_cell) {
    if (heights.empty()) {
      cells_.push_back({infinity, infinity});
      continue;
    }
    const double low = base::percentile(std::move(heights), 0.1, base::Rank::below);
    cells_.push_back({low, low});
  }
  level(steepest);
}

/// Four sweeps over the grid, from every corner, carry each height to all others, as distances are carried.
void Terrain::level(double steepest) {
  const double straight = steepest * size_, across = straight * std::numbers::sqrt2;
  for (const std::int64_t dr : {1, -1})
    for (const std::int64_t dc : {1, -1})
      for (std::int64_t r = dr > 0 ? 0 : rows_ - 1; r >= 0 && r < rows_; r += dr)
        for (std::int64_t c = dc > 0 ? 0 : columns_ - 1; c >= 0 && c < columns_; c += dc) {
          Cell& own = cells_[static_cast<std::size_t>(r * columns_ + c)];
          const auto from = [&](std::int64_t column, std::int64_t row, double up) {
            const Cell other = cell(column, row);
            if (other.reach + up < own.reach) own = {other.reach + up, other.height};
          };
          from(c - dc, r, straight);
          from(c, r - dr, straight);
          from(c - dc, r - dr, across);
          from(c + dc, r - dr, across);
        }
}

auto Terrain::cell(std::int64_t column, std::int64_t row) const -> Cell {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return {infinity, infinity};
  return cells_[static_cast<std::size_t>(row * columns_ + column)];
}

auto Terrain::at(Point2 p) const -> double {
  if (columns_ == 0) return infinity;
  const auto along = [&](double x, double least, std::int64_t count) {
    return std::clamp((x - least) / size_ - 0.5, 0.0, static_cast<double>(count - 1));
  };
  const double x = along(p.x, origin_.x, columns_), y = along(p.y, origin_.y, rows_);
  const auto c = std::min(static_cast<std::int64_t>(x), std::max<std::int64_t>(columns_ - 2, 0));
  const auto r = std::min(static_cast<std::int64_t>(y), std::max<std::int64_t>(rows_ - 2, 0));
  const auto c1 = std::min(c + 1, columns_ - 1), r1 = std::min(r + 1, rows_ - 1);
  const double u = x - static_cast<double>(c), v = y - static_cast<double>(r);
  const auto height = [&](std::int64_t column, std::int64_t row) { return cell(column, row).height; };
  return (1 - v) * ((1 - u) * height(c, r) + u * height(c1, r)) + v * ((1 - u) * height(c, r1) + u * height(c1, r1));
}

}  // namespace mansard::label::detail
