// How much of a scan is on the steep planes of a roof.
#pragma once

#include <span>
#include <vector>

#include "mansard/evaluate/form.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::evaluate::detail {

struct SteepPlane {
  const RoofPlane* plane = nullptr;
  std::vector<const model::ModelFace*> faces;  ///< in it
};

/// m² of the scan on each plane: a third of every triangle for each of its corners that is within 0.15 m of the plane
/// and in one of its faces, more than 0.25 m from the edge of these; only triangles within 20° of the plane's
/// direction. What blurs a step has its corners along the two edges, or is not as wide as that. Cost: O(log n) for each
/// triangle and n planes.
[[nodiscard]] auto carried(std::span<const SteepPlane> planes, const geometry::Mesh& scan)
    -> std::vector<base::Result<double>>;

}  // namespace mansard::evaluate::detail
