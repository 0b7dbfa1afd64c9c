// The grid of texels in the plane of a face.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/geometry/points.hpp"
#include "mansard/model/solid.hpp"
#include "mansard/model/texture.hpp"

namespace mansard::texture::detail {

using geometry::Point2;
using geometry::Point3;

/// A face of a building, relative to the building's own origin: a whole number of metres, so that the digits are the
/// same in every frame.
struct FaceGrid {
  Point3 right, up, normal;                ///< unit; right × up = normal, which is outward
  Point3 start;                            ///< the lower left corner of the grid
  double texel = 0.1;                      ///< m
  std::uint32_t columns = 0, rows = 0;     ///< 0 of a face without area
  std::vector<std::vector<Point2>> loops;  ///< in texels from `start`, right and up
  model::FaceClass kind = model::FaceClass::wall;
};

/// The corners of solids, relative to an origin at whole metres, rounded to 0.1 mm.
struct Placed {
  std::array<double, 3> origin{};
  std::vector<std::vector<Point3>> vertices;  ///< by solid
};
[[nodiscard]] auto placed(const std::vector<model::LabelledSolid>& solids) -> Placed;

/// `size` m a texel, or more where the face is longer than `side` texels.
[[nodiscard]] auto grid_of(const model::Face& face, model::FaceClass kind, const std::vector<Point3>& vertices,
                           double size, std::uint32_t side) -> FaceGrid;

/// Where points of the local frame are in the picture of a grid.
[[nodiscard]] auto frame_of(const FaceGrid& grid, const std::array<double, 3>& origin) -> model::PictureFrame;

/// Where a line v = const is inside the loops (even-odd rule): pairs of u, rising.
[[nodiscard]] auto spans_at(const std::vector<std::vector<Point2>>& loops, double v) -> std::vector<double>;

}  // namespace mansard::texture::detail
