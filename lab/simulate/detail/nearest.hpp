// The nearest triangle of the truth.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lab/simulate/simulate.hpp"

namespace mansard::simulate::detail {

/// Walls and roofs of the surface in cells of a plan grid.
class Nearest {
 public:
  explicit Nearest(const Surface& surface);

  struct Found {
    std::uint32_t triangle = 0;
    double cost = 0;  ///< metres: the distance, and up to 2 × `turned` for one that looks the other way
  };
  /// The triangle of least cost among those within `radius` metres; of equal ones that of the lowest number. `normal`
  /// is the direction that the surface at p looks to, of unit length; the zero vector where it does not matter.
  [[nodiscard]] auto find(geometry::Point3 p, geometry::Point3 normal, double radius) const -> std::optional<Found>;
  [[nodiscard]] auto normal(std::uint32_t triangle) const -> geometry::Point3 { return normals_[triangle]; }

  static constexpr double turned = 0.2;  ///< m; of two surfaces as near, the one that looks the same way is meant

 private:
  [[nodiscard]] auto column(double x) const -> std::int64_t;
  [[nodiscard]] auto row(double y) const -> std::int64_t;

  const Surface* surface_;
  geometry::Point2 origin_;
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> first_, entries_;  // cell c has entries_[first_[c]] … entries_[first_[c + 1] − 1]
  std::vector<geometry::Point3> normals_;
};

}  // namespace mansard::simulate::detail
