// What coloured points show of a face.
#pragma once

#include <optional>
#include <vector>

#include "mansard/texture/detail/project.hpp"
#include "mansard/texture/points.hpp"

namespace mansard::texture::detail {

/// A point with what its neighbours say of the surface that it is on. Relative to the building's origin.
struct Splat {
  Point3 at;
  Light colour{};
  double radius = 0;     ///< m, up to which it colours that surface
  bool surface = false;  ///< its neighbours are one; else they are few, or scattered in all directions (leaves)
  std::array<double, 6> spread{};  ///< xx, xy, xz, yy, yz, zz of its neighbours around their mean, of trace 1
};

/// Of the points of a scan around a building, but those of the ground. Points within a cube of one texel are one.
[[nodiscard]] auto splats_of(const std::vector<ScanPoint>& points, const std::array<double, 3>& origin,
                             const Options& options) -> std::vector<Splat>;

/// Per texel of the grid, from the bottom: the mean colour of the points around it that are on a surface parallel to
/// the face, where they outweigh those that are not; else none, and none of a face that looks down.
[[nodiscard]] auto splatted(const FaceGrid& grid, const std::vector<const Splat*>& splats, const Options& options)
    -> std::vector<std::optional<Light>>;

}  // namespace mansard::texture::detail
