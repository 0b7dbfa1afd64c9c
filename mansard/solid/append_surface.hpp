// The surfaces of solids as one mesh.
#pragma once

#include "mansard/geometry/mesh.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::solid {

/// Adds the surface of a solid to a mesh. False, and nothing is added, where it cannot be cut into triangles.
inline auto append_surface(const model::Solid& solid, geometry::Mesh& mesh) -> bool {
  const auto pieces = triangulate(solid);
  if (!pieces) return false;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), solid.vertices.begin(), solid.vertices.end());
  for (const auto& t : pieces->triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return true;
}

}  // namespace mansard::solid
