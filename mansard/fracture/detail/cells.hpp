// Square cells over a rectangle, to find what lies near. What is found comes without order: the caller sorts.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/fracture/detail/points.hpp"

namespace mansard::fracture::detail {

class Cells {
 public:
  /// Cells of about `side` metres, fewer and larger when the box is huge.
  Cells(const Box2& box, double side);

  /// Puts the number into every cell nearer to the segment than `reach` metres.
  void put(std::uint32_t number, const Segment2& segment, double reach);
  /// Takes back the number put in last, with the same segment and reach.
  void take_back(const Segment2& segment, double reach);

  /// Calls look(number) for all in the cells nearer to the segment than `reach`; the same number may come repeatedly.
  template <class Look>
  void near(const Segment2& segment, double reach, Look look) const {
    walk(segment, reach, [&](std::size_t cell) {
      for (const std::uint32_t number : cells_[cell]) look(number);
    });
  }

 private:
  template <class Visit>
  void walk(const Segment2& segment, double reach, Visit visit) const;
  [[nodiscard]] auto column(double x) const -> std::size_t;
  [[nodiscard]] auto row(double y) const -> std::size_t;

  Point2 origin_;
  double side_ = 1;
  std::size_t columns_ = 1, rows_ = 1;
  std::vector<std::vector<std::uint32_t>> cells_;
};

template <class Visit>
void Cells::walk(const Segment2& segment, double reach, Visit visit) const {
  const bool rightwards = segment.start.x <= segment.end.x;
  const Point2 a = rightwards ? segment.start : segment.end, b = rightwards ? segment.end : segment.start;
  const double slope = a.x < b.x ? (b.y - a.y) / (b.x - a.x) : 0;
  const double low = std::min(a.y, b.y), high = std::max(a.y, b.y);
  const std::size_t first = column(a.x - reach), last = column(b.x + reach);
  for (std::size_t i = first; i <= last; ++i) {
    // The part of the segment over this column grown by the reach; what is outside the box belongs to its rim.
    const double left = origin_.x + side_ * static_cast<double>(i) - reach, right = left + side_ + 2 * reach;
    double y0 = a.y, y1 = b.y;
    if (a.x < b.x) {
      if (i > 0 && left > a.x) y0 = a.y + slope * (std::min(left, b.x) - a.x);
      if (i + 1 < columns_ && right < b.x) y1 = a.y + slope * (std::max(right, a.x) - a.x);
    }
    const double bottom = std::clamp(std::min(y0, y1), low, high), top = std::clamp(std::max(y0, y1), low, high);
    const std::size_t above = row(top + reach);
    for (std::size_t j = row(bottom - reach); j <= above; ++j) visit(j * columns_ + i);
  }
}

}  // namespace mansard::fracture::detail
