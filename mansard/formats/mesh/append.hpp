// Several raw meshes as one.
#pragma once

#include <utility>

#include "mansard/formats/mesh/raw_mesh.hpp"

namespace mansard::formats {

/// Classes are kept where there is one mesh only. The number of vertices must stay below `no_vertex`.
inline void append(RawMesh& all, RawMesh more) {
  if (all.vertices.empty() && all.triangles.empty() && all.points.empty() &&
      all.vertices.capacity() < more.vertices.size()) {
    more.short_faces += all.short_faces;
    all = std::move(more);
    return;
  }
  all.classes.clear();
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  const auto own = static_cast<std::uint32_t>(more.vertices.size());
  all.vertices.insert(all.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& triangle : more.triangles) {
    auto& moved = all.triangles.emplace_back(triangle);
    // An index beyond its own mesh must not come to name a vertex of the next one.
    for (auto& corner : moved) corner = corner < own ? first + corner : no_vertex;
  }
  all.short_faces += more.short_faces;
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
}

}  // namespace mansard::formats
