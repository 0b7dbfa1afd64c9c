// The coloured points of a scan, and which of them are near a place.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/formats/textured_mesh.hpp"

namespace mansard::texture {

using ScanPoint = formats::ColouredPoint;

/// Finds the nearest of many points: a balanced tree, whose answers do not depend on the order in which points came.
/// Cost: O(n log n) to make, about O(log n) for each answer.
class PointTree {
 public:
  PointTree() = default;
  explicit PointTree(std::vector<ScanPoint> points);

  /// In the order of the numbers below: points at one place are beside each other.
  [[nodiscard]] auto points() const -> const std::vector<ScanPoint>& { return points_; }
  struct Near {
    double squared = 0;  ///< m², the distance
    std::uint32_t point = 0;
    friend auto operator<=>(const Near&, const Near&) = default;
  };
  /// The `most` nearest within a distance in metres, the nearest first.
  [[nodiscard]] auto nearest(geometry::Point3 p, std::size_t most, double within) const -> std::vector<Near>;

 private:
  void divide(std::size_t first, std::size_t last, int depth);
  void search(std::size_t first, std::size_t last, int depth, geometry::Point3 p, std::size_t most,
              std::vector<Near>& found, double& bound) const;

  std::vector<ScanPoint> points_;  ///< the middle one of every range divides it, along x, y and z in turn
};

/// The colour of a surface at a place, sRGB: the mean, in linear light, of the four nearest points within a distance in
/// metres, the nearer the more. None where there is no point.
[[nodiscard]] auto colour_at(const PointTree& points, geometry::Point3 p, double within)
    -> std::optional<std::array<std::uint8_t, 3>>;

}  // namespace mansard::texture
