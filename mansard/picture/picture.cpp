#include "mansard/picture/picture.hpp"

#include <algorithm>

#include "mansard/picture/detail/error_map.hpp"
#include "mansard/picture/detail/png_bytes.hpp"
#include "mansard/picture/detail/render.hpp"

namespace mansard::picture {
namespace {

/// The vertices that a triangle has, each once.
auto used_vertices(const geometry::Mesh& mesh) -> std::vector<geometry::Point3> {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles)
    for (const auto v : triangle) used[v] = 1;
  std::vector<geometry::Point3> points;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) points.push_back(mesh.vertices[v]);
  return points;
}

}  // namespace

auto draw_views(std::span<const Layer> layers, std::span<const Lines> lines, std::span<const View> views,
                const base::Run& run) -> std::vector<Image> {
  detail::Model model = detail::joined(layers);
  auto points = used_vertices(model.mesh);
  const std::size_t of_surfaces = points.size();
  for (const Lines& layer : lines)
    for (const auto& segment : layer.segments) points.insert(points.end(), segment.begin(), segment.end());
  const rays::Scene scene(std::move(model.mesh));  // which has it now
  std::vector<Image> images;
  for (const View& view : views) {
    detail::Canvas canvas(view.width, view.height, detail::to_light(detail::paper));
    if (!points.empty()) {
      const detail::Camera camera = detail::camera_for(view, points);
      if (of_surfaces > 0) detail::render(canvas, model, scene, std::span(points).first(of_surfaces), camera, run);
      for (const Lines& layer : lines) detail::draw_lines(canvas, layer, scene, camera);
    }
    images.push_back(detail::to_image(canvas));
  }
  run.report("picture", "", 1);
  return images;
}

auto draw(std::span<const Layer> layers, std::span<const Lines> lines, const View& view, const base::Run& run)
    -> Image {
  return std::move(draw_views(layers, lines, std::span(&view, 1), run).front());
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
