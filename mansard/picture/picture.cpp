#include "mansard/picture/picture.hpp"

#include <algorithm>

#include "mansard/picture/detail/error_map.hpp"
#include "mansard/picture/detail/png_bytes.hpp"
#include "mansard/picture/detail/render.hpp"

namespace mansard::picture {
namespace {

/// Everything that must be in the picture.
auto corners_of(const detail::Model& model, std::span<const Lines> lines) -> std::vector<geometry::Point3> {
  std::vector<geometry::Point3> points;
  for (const auto& triangle : model.mesh.triangles)
    for (const auto v : triangle) points.push_back(model.mesh.vertices[v]);
  for (const Lines& layer : lines)
    for (const auto& segment : layer.segments) points.insert(points.end(), segment.begin(), segment.end());
  return points;
}

}  // namespace

auto draw(std::span<const Layer> layers, std::span<const Lines> lines, const View& view, const base::Run& run)
    -> Image {
  detail::Canvas canvas(view.width, view.height, detail::to_light(detail::paper));
  const detail::Model model = detail::joined(layers);
  if (const auto points = corners_of(model, lines); !points.empty()) {
    const detail::Camera camera = detail::camera_for(view, points);
    const rays::Scene scene(model.mesh);
    if (!model.mesh.triangles.empty()) detail::render(canvas, model, scene, camera, run);
    for (const Lines& layer : lines) detail::draw_lines(canvas, layer, scene, camera);
  }
  run.report("picture", "", 1);
  return detail::to_image(canvas);
}

auto error_map(std::span<const float> values, std::size_t columns, std::size_t rows, double limit,
               const std::string& title) -> Image {
  return detail::map_image(values, columns, rows, limit, title);
}

auto beside(std::span<const Image> images) -> Image {
  constexpr std::size_t gap = 24;  // pixels
  Image out;
  for (const Image& image : images) {
    out.width += image.width + (&image == &images.front() ? 0 : gap);
    out.height = std::max(out.height, image.height);
  }
  out.pixels.assign(3 * out.width * out.height, 255);
  std::size_t left = 0;
  for (const Image& image : images) {
    for (std::size_t y = 0; y < image.height; ++y)
      std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * y * image.width), 3 * image.width,
                  out.pixels.begin() + static_cast<std::ptrdiff_t>(3 * (y * out.width + left)));
    left += image.width + gap;
  }
  return out;
}

auto png(const Image& image) -> base::Result<std::string> { return detail::png_bytes(image); }

auto codes() -> std::vector<base::Code> {
  return {{"picture-png", "A picture could not be encoded: it has no pixels, or the library refused it.",
           "Ask for a picture of another size; the models are not affected.", 1}};
}

}  // namespace mansard::picture
