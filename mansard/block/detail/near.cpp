#include "mansard/block/detail/near.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/block/detail/neighbours.hpp"

namespace mansard::block::detail {

using geometry::Box2;
using geometry::Point2;
using geometry::Ring;
using geometry::Segment2;

/// More are found by an index, whose answer takes memory for each triangle.
constexpr std::size_t few_edges = 64;

Nearness::Nearness(const std::vector<geometry::Polygon>& area, double reach) : area_(area), reach_(reach) {
  const auto add = [this](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) edges_.push_back({ring[i], ring[(i + 1) % ring.size()]});
  };
  for (const auto& polygon : area_) {
    boxes_.push_back(geometry::bounds(polygon.outer));
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
  }
  box_ = geometry::bounds(area_).grown(reach);
  if (edges_.empty()) return;
  if (edges_.size() > few_edges) {
    std::vector<Box2> boxes;
    boxes.reserve(edges_.size());
    for (const auto& edge : edges_) boxes.push_back(Box2::of(edge));
    index_ = geometry::BoxIndex(boxes);
  }

  // Some thousand cells: few enough to be made quickly, small enough to leave few triangles to the exact test.
  const Point2 extent = box_.most - box_.least;
  size_ = std::max(0.5, std::sqrt(extent.x * extent.y / 4096));
  columns_ = static_cast<std::size_t>(extent.x / size_) + 1;
  rows_ = static_cast<std::size_t>(extent.y / size_) + 1;
  cells_.resize(columns_ * rows_);
  const double half = size_ * 0.70710678118654757;
  for (std::size_t r = 0; r < rows_; ++r)
    for (std::size_t c = 0; c < columns_; ++c) {
      const Point2 centre =
          box_.least + Point2{(static_cast<double>(c) + 0.5) * size_, (static_cast<double>(r) + 0.5) * size_};
      const double away = distance(centre);
      // A little room for the rounding of the cell a point is put into.
      const double margin = half * (1 + 1e-6);
      cells_[r * columns_ + c] = away + margin <= reach ? Cell::near : away - margin > reach ? Cell::far : Cell::mixed;
    }
}

auto Nearness::holds(Point2 p) const -> bool {
  for (std::size_t i = 0; i < area_.size(); ++i)
    if (boxes_[i].contains(p) && geometry::contains(area_[i], p)) return true;
  return false;
}

auto Nearness::distance(Point2 p) const -> double {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& edge : edges_) least = std::min(least, geometry::distance(edge, p));
  return least > 0 && holds(p) ? 0 : least;
}

auto Nearness::place(double along, double least, std::size_t count) const -> std::size_t {
  const double cell = std::floor((along - least) / size_);
  return cell <= 0 ? 0 : std::min(static_cast<std::size_t>(cell), count - 1);
}

auto Nearness::exactly(const PlanTriangle& t) const -> bool {
  const Box2 box = Box2::of(t), reach = box.grown(reach_);
  const auto is_near = [&](const Segment2& edge) {
    for (std::size_t k = 0; k < 3; ++k)
      if (detail::distance({t[k], t[(k + 1) % 3]}, edge) <= reach_) return true;
    return false;
  };
  if (edges_.size() <= few_edges) {
    for (const auto& edge : edges_)
      if (reach.overlaps(Box2::of(edge)) && is_near(edge)) return true;
  } else if (std::ranges::any_of(index_.overlapping(reach), [&](auto e) { return is_near(edges_[e]); })) {
    return true;
  }
  // No edge is near the triangle's sides: one is wholly inside the other, or they are apart.
  return holds(t[0]) || std::ranges::any_of(area_, [&](const auto& polygon) {
           const Point2 corner = polygon.outer.front();
           return box.contains(corner) && geometry::contains(std::span<const Point2>(t), corner);
         });
}

auto Nearness::operator()(Point2 p) const -> bool {
  if (edges_.empty() || !box_.contains(p)) return false;
  const Cell cell = cells_[place(p.y, box_.least.y, rows_) * columns_ + place(p.x, box_.least.x, columns_)];
  return cell == Cell::near || (cell == Cell::mixed && distance(p) <= reach_);
}

auto Nearness::operator()(const PlanTriangle& t) const -> bool {
  const Box2 box = Box2::of(t);
  if (edges_.empty() || !box_.overlaps(box)) return false;
  for (const Point2 p : t)
    if (box_.contains(p) &&
        cells_[place(p.y, box_.least.y, rows_) * columns_ + place(p.x, box_.least.x, columns_)] == Cell::near)
      return true;
  bool all_far = true;
  const std::size_t r1 = place(box.most.y, box_.least.y, rows_), c1 = place(box.most.x, box_.least.x, columns_);
  for (std::size_t r = place(box.least.y, box_.least.y, rows_); all_far && r <= r1; ++r)
    for (std::size_t c = place(box.least.x, box_.least.x, columns_); all_far && c <= c1; ++c)
      all_far = cells_[r * columns_ + c] == Cell::far;
  return !all_far && exactly(t);
}

}  // namespace mansard::block::detail
