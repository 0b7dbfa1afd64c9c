// A face cut into triangles over its own corners: ears, then flips of diagonals. Every decision on a side is exact.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/solid/solid.hpp"

namespace mansard::solid {

using Corners = std::array<std::uint32_t, 3>;

/// Cuts faces into triangles, keeping its storage from face to face. No triangle has its corners on a line, seen along
/// the axis nearest to the face's normal; where a diagonal could go either way, the least angle is made larger.
/// Cost: O(n log n) in practice; O(n²) for a face with many reflex corners all over it.
class Triangulator {
 public:
  explicit Triangulator(const model::Solid& solid) : solid_(solid) {}

  /// Appends the face's triangles, `area` its area_vector(). False, with nothing appended, when its boundary crosses or
  /// touches itself other than where a hole shares a vertex, or a hole lies outside.
  auto append(const model::Face& face, geometry::Point3 area, std::vector<Corners>& out) -> bool;

 private:
  struct Corner {
    geometry::Point2 at;
    std::uint32_t vertex;
    std::uint32_t prev, next;
    std::uint32_t beyond;  ///< the half-diagonal on the other side of the edge that starts here, if it is one
    bool reflex;           ///< or straight
  };
  struct Triangle {
    std::array<std::uint32_t, 3> corner;
    std::array<std::uint32_t, 3> beyond;  ///< across the edge from corner i to i + 1: 3 · triangle + edge there
  };

  void lay_out(const model::Face& face, geometry::Point3 area);
  [[nodiscard]] auto turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const -> int;
  [[nodiscard]] auto is_convex() const -> bool;
  [[nodiscard]] auto is_simple() -> bool;
  [[nodiscard]] auto holes_lie_inside() const -> bool;
  auto halve(std::vector<Corners>& out) const -> bool;
  auto bridge_holes() -> bool;
  void bridge(std::uint32_t from, std::uint32_t to);
  [[nodiscard]] auto opens_towards(std::uint32_t v, geometry::Point2 q) const -> bool;
  class Near;
  [[nodiscard]] auto sees(std::uint32_t a, std::uint32_t b, const Near& near) const -> bool;
  auto clip_ears() -> bool;
  void gather_reflex();
  [[nodiscard]] auto is_ear(std::uint32_t v) const -> bool;
  void cut(std::uint32_t v);
  [[nodiscard]] auto quality(std::uint32_t a, std::uint32_t b, std::uint32_t c) const -> double;
  void flip_diagonals();

  const model::Solid& solid_;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> first_;  ///< of each loop, and the end
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> reflex_;  ///< sorted along `long_axis_`, with those that have become convex in between
  std::vector<std::uint32_t> order_, open_;
  std::uint32_t at_ = 0;  ///< a corner still on the loop
  std::size_t dead_ = 0;  ///< in reflex_
  int long_axis_ = 0;
};

}  // namespace mansard::solid
