// Finds by how much a mesh has to be moved so that what is high in it is over the footprints.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::align {

struct Options {
  double above_ground = 2.5;  ///< m; what is so much higher than the ground around it is high
  double around = 20;         ///< m; half width of the square in which that is looked for: wider than half a roof
  double cell = 1;            ///< m; of the grid of the last comparison
  /// Comparisons of cells in the first round, whose cells are as large as that demands. 2·10⁸ take about 0.2 s.
  double comparisons = 2e8;
  /// m; where whole multiples of 100, 50 or 10 m are within this of the best move, one of them is meant: frames are
  /// moved by round numbers.
  double round_within = 1.5;
};

struct Match {
  double x = 0, y = 0;  ///< m, to be added to the mesh
  bool round = false;   ///< the nearest round number was taken
  /// Correlation (phi, −1 … 1) of the cells that are high with those that have a footprint, over the cells near
  /// footprints that the mesh shows; and of the best other place, farther than a quarter of the footprints' extent.
  double correlation = 0, next = 0;
  double inside = 0;  ///< share of high cells among those of footprints that the mesh shows
  /// Share of the footprints' cells that the mesh shows, or of its high cells that are in footprints: the larger one.
  double met = 0;
};

/// How well mesh and footprints match when the mesh is moved by (x, y). None where they do not meet.
[[nodiscard]] auto match_at(const geometry::Mesh& mesh, std::span<const geometry::Polygon> footprints, double x,
                            double y, const Options& options = {}) -> std::optional<Match>;

/// The best move of all by which the boxes of mesh and footprints still meet in half of the smaller one. None where the
/// mesh has nothing high, there are no footprints, or the run is cancelled.
/// Guarantees: 1 the same at any thread count · 2 a mesh that was moved by whole metres gets the opposite move to
/// within a cell. Cost: O(n + comparisons).
/// Reference: correlation of binary variables, K. Pearson's phi coefficient; a search from coarse to fine cells.
[[nodiscard]] auto best_match(const geometry::Mesh& mesh, std::span<const geometry::Polygon> footprints,
                              const Options& options = {}, const base::Run& run = {}) -> std::optional<Match>;

}  // namespace mansard::align
