// An affine map of space.
#pragma once

#include <array>

#include "mansard/geometry/points.hpp"

namespace mansard::formats {

/// Three rows of a 3 × 4 matrix.
struct Transform {
  std::array<std::array<double, 4>, 3> row{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  [[nodiscard]] static auto shift(geometry::Point3 by) -> Transform {
    Transform t;
    t.row[0][3] = by.x;
    t.row[1][3] = by.y;
    t.row[2][3] = by.z;
    return t;
  }
  /// (x, y, z) with y up becomes (x, −z, y).
  [[nodiscard]] static auto from_y_up() -> Transform { return {{{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}}}}; }
  /// From 16 numbers by columns, as glTF and 3D Tiles store them.
  template <class Numbers>
  [[nodiscard]] static auto by_columns(const Numbers& numbers) -> Transform {
    Transform t;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) t.row[i][j] = numbers[4 * j + i];
    return t;
  }

  [[nodiscard]] auto operator()(geometry::Point3 p) const -> geometry::Point3 {
    const auto along = [&p](const std::array<double, 4>& r) { return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]; };
    return {along(row[0]), along(row[1]), along(row[2])};
  }
  /// First `inner`, then this.
  [[nodiscard]] auto after(const Transform& inner) const -> Transform {
    Transform out;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        out.row[i][j] = j == 3 ? row[i][3] : 0;
        for (std::size_t k = 0; k < 3; ++k) out.row[i][j] += row[i][k] * inner.row[k][j];
      }
    return out;
  }
  [[nodiscard]] auto column(std::size_t j) const -> geometry::Point3 { return {row[0][j], row[1][j], row[2][j]}; }
  [[nodiscard]] auto mirrors() const -> bool { return dot(cross(column(0), column(1)), column(2)) < 0; }
};

}  // namespace mansard::formats
