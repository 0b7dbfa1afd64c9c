// What is known before anything is reconstructed: mesh, footprints and terrain in one local frame.
#pragma once

#include <cstddef>
#include <cstdint>
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
  std::vector<float> values;  ///< z, metres, local frame; row by row from the south; NaN for none
  /// Between the four nearest centres; none beyond them, or where one of them has no value.
  [[nodiscard]] auto at(geometry::Point2 p) const -> std::optional<double>;
};

struct Scene {
  geometry::Mesh mesh;  ///< local frame
  std::vector<Footprint> footprints;
  std::optional<HeightGrid> terrain;  ///< the ground, where it was given; else blocks look for it in the mesh
  Frame frame;
  std::vector<InputFile> inputs;
  MeshCounts mesh_counts;
  std::vector<base::Diagnostic> warnings;
};

}  // namespace mansard::model
