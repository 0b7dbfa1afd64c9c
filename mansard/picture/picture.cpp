#include "mansard/picture/picture.hpp"

#include <algorithm>

#include "mansard/picture/detail/error_map.hpp"
#include "mansard/picture/detail/png_bytes.hpp"
#include "mansard/picture/detail/render.hpp"

namespace mansard::picture {
namespace {

constexpr std::size_t gap = 24;  // pixels, between images

/// The corners of the frame by a camera's directions; as near to the eye as all that is drawn.
auto shown_of(const geometry::Box3& frame, const detail::Camera& camera, const geometry::Box3& drawn)
    -> geometry::Box3 {
  if (drawn.empty()) return drawn;
  geometry::Box3 box;
  for (const double x : {frame.least.x, frame.most.x})
    for (const double y : {frame.least.y, frame.most.y})
      for (const double z : {frame.least.z, frame.most.z}) box.add(detail::along(camera, {x, y, z}));
  box.most.z = std::max(box.most.z, drawn.most.z);
  return box;
}

auto views_of(detail::Scenery scenery, std::span<const Lines> lines, std::span<const View> views, const base::Run& run)
    -> base::Result<std::vector<Image>> {
  std::vector<detail::Camera> directions;
  for (const View& view : views) directions.push_back(detail::directions_of(view));
  if (auto surveyed = scenery.survey(directions); !surveyed) return surveyed.failure();
  std::vector<Image> images;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const View& view = views[v];
    images.push_back(detail::blank(view.width, view.height, detail::paper));
    auto box = scenery.box_in(v);
    for (const Lines& layer : lines)
      for (const auto& segment : layer.segments)
        for (const auto& end : segment) box.add(detail::along(directions[v], end));
    if (view.frame) box = shown_of(*view.frame, directions[v], box);
    if (!box.empty())
      if (auto drawn = detail::render(images.back(), scenery, lines, detail::camera_for(view, box), run); !drawn)
        return drawn.failure();
  }
  run.report("picture", "", 1);
  return images;
}

/// A picture onto a larger one.
void put(const Image& image, std::size_t left, std::size_t top, Image& onto) {
  for (std::size_t y = 0; y < image.height; ++y)
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * y * image.width), 3 * image.width,
                onto.pixels.begin() + static_cast<std::ptrdiff_t>(3 * ((top + y) * onto.width + left)));
}

}  // namespace

auto draw_views(std::span<const Layer> layers, std::span<const Lines> lines, std::span<const View> views,
                const base::Run& run) -> std::vector<Image> {
  return std::move(views_of(detail::Scenery(layers), lines, views, run).value());
}

auto draw_views(const Pieces& pieces, std::span<const Lines> lines, std::span<const View> views, const base::Run& run)
    -> base::Result<std::vector<Image>> {
  return views_of(detail::Scenery(pieces), lines, views, run);
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
  Image out;
  for (const Image& image : images) {
    out.width += image.width + (&image == &images.front() ? 0 : gap);
    out.height = std::max(out.height, image.height);
  }
  out.pixels.assign(3 * out.width * out.height, 255);
  std::size_t left = 0;
  for (const Image& image : images) {
    put(image, left, 0, out);
    left += image.width + gap;
  }
  return out;
}

auto below(std::span<const Image> images) -> Image {
  Image out;
  for (const Image& image : images) {
    out.height += image.height + (&image == &images.front() ? 0 : gap);
    out.width = std::max(out.width, image.width);
  }
  out.pixels.assign(3 * out.width * out.height, 255);
  std::size_t top = 0;
  for (const Image& image : images) {
    put(image, 0, top, out);
    top += image.height + gap;
  }
  return out;
}

auto png(const Image& image) -> base::Result<std::string> { return detail::png_bytes(image); }

auto codes() -> std::vector<base::Code> {
  return {{"picture-png", "A picture could not be encoded: it has no pixels, or the library refused it.",
           "Ask for a picture of another size; the models are not affected.", 1}};
}

}  // namespace mansard::picture
