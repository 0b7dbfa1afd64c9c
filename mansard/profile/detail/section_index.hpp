// Vertical cuts through a mesh, each touching only the triangles near its line.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::profile::detail {

/// A straight piece of a vertical section: `inward` along the section's direction, `height` = z, metres; `low` is not
/// above `high`.
struct SectionPoint {
  double inward = 0, height = 0;
};
struct Piece {
  SectionPoint low, high;
};

/// The vertical plane through `foot` along the unit vector `direction`, between two distances from the foot.
struct SectionPlane {
  geometry::Point2 foot;
  geometry::Point2 direction;
  double from = 0, to = 0;  ///< m
};

/// The mesh's triangles in a uniform grid over the plan. Queries may run on any thread; the mesh must outlive it.
class SectionIndex {
 public:
  explicit SectionIndex(const geometry::Mesh& mesh);
  /// The pieces of the section, clipped to the plane's window, by triangle index.
  [[nodiscard]] auto cut(const SectionPlane& plane) const -> std::vector<Piece>;

 private:
  const geometry::Mesh* mesh_;
  geometry::Box2 box_;
  double cell_ = 1;
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<std::size_t> first_;  ///< per cell, into triangles_; one more at the end
  std::vector<std::uint32_t> triangles_;
};

}  // namespace mansard::profile::detail
