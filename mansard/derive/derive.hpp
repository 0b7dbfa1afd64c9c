// Draws footprints from the mesh alone, where there is no survey: what stands above the ground, outlined and
// straightened.
#pragma once

#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::derive {

struct Options {
  double cell = 0.5;        ///< m; of the grid of heights
  double above_ground = 2;  ///< m; what stands less high is no building
  double least_area = 25;   ///< m²; of a building, and of a courtyard
  double widest = 100;      ///< m; a square so wide holds some ground
  double smooth = 0.25;     ///< 0 … 1; the least share of a roof that lies in planes
  double step = 8;          ///< m; what stands so much above what it touches is a building of its own; 0: never
  double tolerance = 1;     ///< m; what is nearer to a wall's line is that wall
  double shortest = 1.5;    ///< m; of the sides that are drawn
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

struct Derived {
  std::vector<ingest::Footprint> footprints;
  std::vector<base::Diagnostic> warnings;  ///< "derive-outline-kept"
};

/// Footprints of what stands on the ground of the scene's mesh, in its frame: on its terrain, where it has one. Their
/// ids are "derived-1" and on, from north-west to south-east; each has `derived` set and the attributes ms_derived,
/// ms_derived_height (m) and ms_derived_planes (0 … 1). Guarantees: 1 every footprint is one polygon, simple and
/// oriented, of at least `least_area` · 2 no two overlap, apart from those that a warning names · 3 the same mesh and
/// options give the same footprints at any thread count. Cost: O(n log n + c log c) for n triangles and c cells. Gives
/// up with "derive-nothing", "derive-size", "derive-outline", "cancelled".
[[nodiscard]] auto footprints(const model::Scene& scene, const Options& options, const base::Run& run = {})
    -> base::Result<Derived>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::derive
