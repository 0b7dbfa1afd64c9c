// Which way triangles look.
#pragma once

#include <vector>

#include "mansard/geometry/mesh.hpp"

namespace mansard::evaluate::detail {

/// Unit normals per triangle; zero without area.
[[nodiscard]] inline auto normals_of(const geometry::Mesh& mesh) -> std::vector<geometry::Point3> {
  std::vector<geometry::Point3> out;
  out.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    out.push_back(
        normalised(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]])));
  return out;
}

}  // namespace mansard::evaluate::detail
