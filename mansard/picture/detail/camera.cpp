#include "mansard/picture/detail/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::picture::detail {

using geometry::Point3;

auto directions_of(const View& view) -> Camera {
  Camera camera;
  camera.width = view.width;
  camera.height = view.height;
  if (view.kind == View::Kind::above) {
    camera.right = {1, 0, 0};
    camera.up = {0, 1, 0};
    camera.towards = {0, 0, 1};
  } else {
    // Clockwise from south as seen on a map: a camera in the south looks north, one in the west looks east.
    const double s = std::sin(view.azimuth), c = std::cos(view.azimuth);
    const double flat = std::cos(view.elevation), high = std::sin(view.elevation);
    camera.right = {c, -s, 0};
    camera.towards = {-s * flat, -c * flat, high};
    camera.up = geometry::cross(camera.towards, camera.right);
  }
  return camera;
}

auto camera_for(const View& view, const geometry::Box3& box) -> Camera {
  constexpr double margin = 0.04;  // of the picture, on each side
  Camera camera = directions_of(view);
  const Point3 middle = 0.5 * (box.least + box.most), size = box.most - box.least;
  const double room = 1 - 2 * margin;
  camera.pixel = std::max(
      {size.x / (room * static_cast<double>(view.width)), size.y / (room * static_cast<double>(view.height)), 1e-6});
  camera.eye = middle.x * camera.right + middle.y * camera.up + (box.most.z + 1) * camera.towards;
  return camera;
}

}  // namespace mansard::picture::detail
