// The terrain around buildings, from a mesh that has everything else in it too.
#pragma once

#include <optional>
#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::block::detail {

/// A height that stands for an area of m².
struct Sample {
  geometry::Point2 at;
  double z = 0, weight = 0;
};

/// The height below which that share (0 … 1) of the samples' area lies; nothing for less than `least` m² of them.
[[nodiscard]] auto percentile(std::vector<Sample> samples, double share, double least) -> std::optional<double>;

/// What may be ground within the ring of each of the first `count` shapes (polygons of one footprint): small pieces of
/// triangles that are not steep, outside all shapes; those that are no farther than Options::overhang from one only
/// where there are enough of others, which shows that they are no eaves. One list per shape, in the order of
/// the mesh.
[[nodiscard]] auto ground_samples(const geometry::Mesh& mesh, const std::vector<std::vector<geometry::Polygon>>& shapes,
                                  std::size_t count, const Options& options) -> std::vector<std::vector<Sample>>;

/// One sample per triangle of the whole mesh, at its lowest corner and by its area in space: walls count too.
[[nodiscard]] auto surface_samples(const geometry::Mesh& mesh) -> std::vector<Sample>;

/// Those of triangles that are no roof: farther than Options::overhang from all shapes, or steep and as near to the
/// boundary of `outline`.
[[nodiscard]] auto beside_samples(const geometry::Mesh& mesh, const std::vector<std::vector<geometry::Polygon>>& shapes,
                                  const std::vector<geometry::Polygon>& outline, const Options& options)
    -> std::vector<Sample>;

}  // namespace mansard::block::detail
