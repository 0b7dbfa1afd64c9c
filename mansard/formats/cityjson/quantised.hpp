// Surfaces on the integer grid of CityJSON.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::formats::detail {

using model::quanta_per_metre;

using Vertex = std::array<std::int64_t, 3>;  ///< quanta from the local origin
using Loops = std::vector<std::vector<Vertex>>;
using Extent =
    std::optional<std::array<Vertex, 2>>;  ///< the least and the greatest of each coordinate; none of nothing
void widen(Extent& extent, const Vertex& v);

struct Surface {
  Loops loops;  ///< outer first, counter-clockwise from outside, at least three distinct vertices each
  model::FaceClass kind = model::FaceClass::wall;
  geometry::Point3 normal;
  std::size_t face = 0;  ///< of the model
};

/// Rounds, and takes out what rounding made degenerate: repeated vertices, spikes, loops without area. Where two
/// vertices fall together every face around the edge between them loses it, so a closed surface stays closed.
[[nodiscard]] auto quantised(const model::LabelledSolid& model) -> std::vector<Surface>;
/// A polygon at a height, without vertices that are 1 mm from the one before them; empty when nothing is left of it.
[[nodiscard]] auto quantised(const geometry::Polygon& polygon, double z) -> Loops;
/// Whether the loops of a level surface neither meet nor come within 1 mm of each other or of themselves.
[[nodiscard]] auto is_sound(const Loops& loops) -> bool;

/// LoD 1.2: the ground surfaces of a solid raised to a flat roof at `z` (metres). It stands on the very vertices of the
/// finer model, and its walls are party walls where that one's are. Empty without ground surfaces below z.
[[nodiscard]] auto flat_prism(const std::vector<Surface>& solid, double z) -> std::vector<Surface>;

/// A coordinate in the frame of the file, in metres, exactly.
[[nodiscard]] auto quanta_in_file_frame(std::int64_t quanta, std::int64_t origin) -> std::string;

}  // namespace mansard::formats::detail
