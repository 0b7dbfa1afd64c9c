// Pictures of the faces of a building's models.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::model {

/// sRGB, three bytes a pixel, row by row from the top.
struct Pixels {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Where a point of space is in a picture, in pixels from its top left corner: across = dot(right, p) + start[0],
/// down = dot(below, p) + start[1].
struct PictureFrame {
  geometry::Point3 right, below;
  std::array<double, 2> start{0, 0};

  [[nodiscard]] auto at(geometry::Point3 p) const -> std::array<double, 2> {
    return {dot(right, p) + start[0], dot(below, p) + start[1]};
  }
};

/// The picture of a face, in its plane. A face of one colour has one pixel, and all its points are in the middle of it.
struct FaceTexture {
  PictureFrame frame;  ///< of the local frame, metres
  Pixels pixels;
};

/// The pictures of a solid, one for each of its faces, and the mean colours that simpler models of it take.
struct SolidTexture {
  std::vector<FaceTexture> faces;
  std::array<std::uint8_t, 3> roof{}, wall{};
};

/// The pictures of a building: of every solid as it is written, in the order it is written in.
struct BuildingTexture {
  std::vector<SolidTexture> solids;
  double known = 0;  ///< share of the area of roofs and outer walls whose colour the scan shows, 0 to 1
};

}  // namespace mansard::model
