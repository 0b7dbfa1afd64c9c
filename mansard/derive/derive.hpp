// Draws footprints from the mesh alone, where there is no survey: what stands above the ground, outlined and
// straightened.
#pragma once

#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/derive/options.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::derive {

struct Derived {
  std::vector<model::Footprint> footprints;
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
