// How much of a scan is on the steep planes of a roof.
#pragma once

#include <vector>

#include "mansard/evaluate/form.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::evaluate::detail {

/// m² of the scan on a plane: a third of every triangle for each of its corners that is within 0.15 m of the plane and
/// in one of its faces, more than 0.25 m from the edge of these; only triangles within 20° of the plane's direction.
/// What blurs a step has its corners along the two edges, or is not as wide as that.
[[nodiscard]] auto carried(const RoofPlane& plane, const std::vector<const model::ModelFace*>& faces,
                           const geometry::Mesh& scan, const std::vector<geometry::Point3>& normals)
    -> base::Result<double>;

}  // namespace mansard::evaluate::detail
