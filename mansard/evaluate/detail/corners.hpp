// The corners of a building, with one number for all that are in one place.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/model/surfaces.hpp"

namespace mansard::evaluate::detail {

class Corners {
 public:
  static constexpr double snap = 0.005;  ///< m: the rounding of files

  explicit Corners(const model::ModelBuilding& building);

  /// The corners on the way from one to another: these two, and all within `snap` of the line between them.
  [[nodiscard]] auto along(std::uint32_t from, std::uint32_t to) const -> std::vector<std::uint32_t>;

  std::vector<geometry::Point3> points;
  std::vector<std::uint32_t> of_corner;  ///< per corner of every loop, in order: index into points

 private:
  std::vector<std::uint32_t> by_x_;
};

}  // namespace mansard::evaluate::detail
