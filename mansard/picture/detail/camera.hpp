// An orthographic camera, framed to what is drawn.
#pragma once

#include "mansard/picture/detail/canvas.hpp"

namespace mansard::picture::detail {

struct Camera {
  geometry::Point3 right, up, towards;  ///< unit; `towards` points from the scene to the eye
  geometry::Point3 eye;                 ///< the middle of the picture, in front of everything
  double pixel = 1;                     ///< metres a pixel
  std::size_t width = 0, height = 0;

  /// Where the ray through a place of the picture starts; it runs along −towards.
  [[nodiscard]] auto start(Spot s) const -> geometry::Point3 {
    return eye + (pixel * (s.x - 0.5 * static_cast<double>(width))) * right +
           (pixel * (0.5 * static_cast<double>(height) - s.y)) * up;
  }
  [[nodiscard]] auto spot(geometry::Point3 p) const -> Spot {
    const auto d = p - eye;
    return {0.5 * static_cast<double>(width) + geometry::dot(d, right) / pixel,
            0.5 * static_cast<double>(height) - geometry::dot(d, up) / pixel};
  }
  /// Metres from the start of its ray to a point.
  [[nodiscard]] auto depth(geometry::Point3 p) const -> double { return -geometry::dot(p - eye, towards); }
};

/// The directions of a view's camera; where it stands is not set yet.
[[nodiscard]] auto directions_of(const View& view) -> Camera;
/// A place by these directions: x to the right, y up, z to the eye.
[[nodiscard]] inline auto along(const Camera& directions, geometry::Point3 p) -> geometry::Point3 {
  return {dot(p, directions.right), dot(p, directions.up), dot(p, directions.towards)};
}
/// Shows with a small margin all that lies in the box, which is by the view's directions and not empty.
[[nodiscard]] auto camera_for(const View& view, const geometry::Box3& box) -> Camera;

}  // namespace mansard::picture::detail
