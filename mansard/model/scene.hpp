// What is known before anything is reconstructed: mesh, footprints and terrain in one local frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/model/footprint.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::model {

/// What was read and what was left out.
struct MeshCounts {
  std::uint64_t vertices = 0, triangles = 0;            ///< kept
  std::uint64_t not_finite = 0;                         ///< triangles dropped for NaN or infinite corners
  std::uint64_t out_of_range = 0;                       ///< … for indices that name no vertex
  std::uint64_t degenerate = 0;                         ///< … without area
  std::uint64_t duplicate = 0;                          ///< … that repeat another one's corners
  std::uint64_t non_manifold_edges = 0;                 ///< kept, counted
  std::uint64_t boundary_edges = 0;                     ///< kept, counted
  std::uint64_t flipped_edges = 0;                      ///< kept: neighbours that disagree about the outside
  std::uint64_t vertices_read = 0, triangles_read = 0;  ///< what the files hold; more than kept where things repeat
};

/// Heights at the centres of square cells.
struct HeightGrid {
  geometry::Point2 centre;  ///< of cell (0, 0), the south-west one; local frame, metres
  double cell = 1;          ///< m
  std::size_t columns = 0, rows = 0;
  std::vector<float> values;  ///< z, metres, as the file has them; row by row from the south; NaN for none
  double base = 0;            ///< m; to be taken off the values: z of the local frame's origin in the file's heights
  /// Between the four nearest centres; none beyond them, or where one of them has no value.
  [[nodiscard]] auto at(geometry::Point2 p) const -> std::optional<double>;
};

struct Scene {
  geometry::Mesh mesh;  ///< local frame
  std::vector<Footprint> footprints;
  /// What is known around them, of the same source, but not asked for: it belongs to blocks, and is never written.
  std::vector<Footprint> surroundings;
  /// The ground, where it was given; else blocks look for it in the mesh.
  std::shared_ptr<const HeightGrid> terrain;
  /// The scan has nothing but buildings: points of these classes alone. Nothing in it can be ground.
  bool roofs_only = false;
  Frame frame;
  std::vector<InputFile> inputs;
  MeshCounts mesh_counts;
  std::vector<base::Diagnostic> warnings;

  /// By the numbers that blocks have for their members: the footprints, then their surroundings.
  [[nodiscard]] auto feature(std::size_t number) const -> const Footprint& {
    return number < footprints.size() ? footprints[number] : surroundings[number - footprints.size()];
  }
};

}  // namespace mansard::model
