// Draws pictures: models beside the scan and the footprints, and error maps.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::picture {

using Colour = std::array<std::uint8_t, 3>;

/// The paper's Figure 5: mesh blue, footprints orange, output grey with roofs and walls told apart.
inline constexpr Colour mesh_blue{122, 154, 204}, footprint_orange{240, 140, 30}, wall_grey{216, 212, 204},
    roof_red{176, 98, 80}, party_grey{150, 150, 158}, ground_grey{120, 124, 120};

/// Triangles with a colour each (one colour means all alike), or with pictures on them.
struct Layer {
  geometry::Mesh mesh;
  std::vector<Colour> colours;
  /// The colour at a point of a triangle, from any thread; none where there is no picture. Pictures have light and
  /// shadow in them, so they get half of those of the drawing.
  std::function<std::optional<Colour>(std::size_t triangle, geometry::Point3 point)> picture{};
};

/// Lines drawn on top where not hidden (lifted 5 cm off the surfaces).
struct Lines {
  std::vector<std::array<geometry::Point3, 2>> segments;
  Colour colour = footprint_orange;
  double width = 2;  ///< pixels
};

struct View {
  enum class Kind : std::uint8_t { above, angle } kind = Kind::angle;  ///< orthographic from above, or at an angle
  double azimuth = 0.6;                     ///< rad; where the camera stands, clockwise from south
  double elevation = 0.7;                   ///< rad above the horizon
  std::size_t width = 1600, height = 1200;  ///< pixels
  std::optional<geometry::Box3> frame{};    ///< m; what is shown, so that pictures compare; none: all that is drawn
};

/// An image, row by row from the top, 3 bytes a pixel.
struct Image {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Shaded by a sun and an open sky, supersampled. Same input, same bytes.
[[nodiscard]] auto draw(std::span<const Layer> layers, std::span<const Lines> lines, const View& view,
                        const base::Run& run = {}) -> Image;
/// The same scene from several sides, which costs less than one by one.
[[nodiscard]] auto draw_views(std::span<const Layer> layers, std::span<const Lines> lines, std::span<const View> views,
                              const base::Run& run = {}) -> std::vector<Image>;

/// A scene of any size, of which one piece is in memory at a time.
struct Pieces {
  std::size_t count = 0;
  /// The layers of a piece, the same each time; called about eight times for each, never twice at once.
  std::function<base::Result<std::vector<Layer>>(std::size_t piece)> load;
};
/// The same picture as that of all layers together, but for the colour where two triangles are equally near. Fails as
/// `load` does.
[[nodiscard]] auto draw_views(const Pieces& pieces, std::span<const Lines> lines, std::span<const View> views,
                              const base::Run& run = {}) -> base::Result<std::vector<Image>>;

/// A field on a grid as colours with a legend: `values` row by row from the south, NaN left grey, colours fixed from
/// −limit (blue) over 0 (white) to +limit (red), in metres.
[[nodiscard]] auto error_map(std::span<const float> values, std::size_t columns, std::size_t rows, double limit,
                             const std::string& title) -> Image;

/// Images side by side on white, or one below the other.
[[nodiscard]] auto beside(std::span<const Image> images) -> Image;
[[nodiscard]] auto below(std::span<const Image> images) -> Image;

[[nodiscard]] auto png(const Image& image) -> base::Result<std::string>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::picture
