// The points of a tile in cells of 1 m, each of them once.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mansard/cloud/detail/grid.hpp"

namespace mansard::cloud::detail {

/// Two points are one measurement where place, class and return are the same: a tile that was given twice, deliveries
/// that overlap. The one with the lowest source stays. What is left is in an order that does not depend on
/// the one in which points came. Cost: n log n in the points of a cell.
class Metres {
 public:
  /// Of a tile's window, whose cells have this side.
  Metres(std::vector<Point> points, std::int64_t cell);

  /// Number of cells of the tile itself, along each axis.
  [[nodiscard]] auto side() const -> std::int64_t { return side_; }
  /// Those in a cell of the tile itself, from its south-west corner.
  [[nodiscard]] auto points_of(std::int64_t column, std::int64_t row) const -> std::span<const Point> {
    const auto i = static_cast<std::size_t>((row + around_) * columns_ + column + around_);
    return std::span(points_).subspan(starts_[i], starts_[i + 1] - starts_[i]);
  }
  /// Of the whole window.
  [[nodiscard]] auto points() const -> const std::vector<Point>& { return points_; }
  /// How many were left out of the tile itself.
  [[nodiscard]] auto repeated() const -> std::uint64_t { return repeated_; }
  [[nodiscard]] auto take() && -> std::vector<Point> { return std::move(points_); }

  /// Whether the point is in the tile, and not around it.
  [[nodiscard]] auto is_own(const Point& p) const -> bool;

 private:
  [[nodiscard]] auto cell_of(const Point& p) const -> std::size_t;
  void remove_repeated();

  std::int64_t border_, around_, side_, columns_;
  std::vector<Point> points_;
  std::vector<std::uint32_t> starts_;
  std::uint64_t repeated_ = 0;
};

}  // namespace mansard::cloud::detail
