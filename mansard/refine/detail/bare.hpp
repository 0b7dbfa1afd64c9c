// Roof faces that a scan cannot have shown: too narrow, or steep with next to nothing on them.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/refine/detail/site.hpp"
#include "mansard/refine/detail/strips.hpp"
#include "mansard/refine/detail/view.hpp"

namespace mansard::refine::detail {

/// The faces seen from above that nothing speaks for. A scan melts what is within a cell or two of a corner, and the
/// heights are smoothed by as much before they are compared: of a face narrower than three cells no cell shows that
/// face alone, and the step between its neighbours would look the same. A steep one stands for a wall, unless samples
/// lie on it. Those that continue a wider face are none. A strip along a curve
/// is one face. Cost: O(cells + faces²).
[[nodiscard]] auto bare_faces(const FaceStrips& strips, const model::Solid& solid, const View& view, const Site& site,
                              const Options& options) -> std::vector<std::uint32_t>;

}  // namespace mansard::refine::detail
