#include "mansard/fracture/detail/cells.hpp"

namespace mansard::fracture::detail {
namespace {

/// More cells than this in a row or column cost more to walk than they save.
constexpr double most_cells = 256;

auto index(double offset, double side, std::size_t count) -> std::size_t {
  const double k = std::floor(offset / side);
  return k <= 0 ? 0 : std::min(count - 1, static_cast<std::size_t>(std::min(k, most_cells)));
}

}  // namespace

Cells::Cells(const Box2& box, double side) : origin_(box.least) {
  const Point2 extent = box.most - box.least;
  side_ = std::max(side, std::max(extent.x, extent.y) / (most_cells - 1));
  columns_ = static_cast<std::size_t>(extent.x / side_) + 1;
  rows_ = static_cast<std::size_t>(extent.y / side_) + 1;
  cells_.resize(columns_ * rows_);
}

auto Cells::column(double x) const -> std::size_t { return index(x - origin_.x, side_, columns_); }
auto Cells::row(double y) const -> std::size_t { return index(y - origin_.y, side_, rows_); }

void Cells::put(std::uint32_t number, const Segment2& segment, double reach) {
  walk(segment, reach, [&](std::size_t cell) { cells_[cell].push_back(number); });
}

void Cells::take_back(const Segment2& segment, double reach) {
  walk(segment, reach, [&](std::size_t cell) { cells_[cell].pop_back(); });
}

}  // namespace mansard::fracture::detail
