#include "mansard/base/text.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/outside/process.hpp"

namespace mansard::formats {

auto read_by_assimp(std::string_view bytes, const std::string& name, const std::string& extension)
    -> base::Result<AssimpMesh> {
  // The library has single precision: its steps are wider than 2 mm beyond 16,384 m from the origin.
  constexpr double exact_to = 16384;
  const auto scene = read_outside(extension, bytes, name);
  if (!scene) return scene.failure();
  AssimpMesh out;
  out.up = scene->y_up != 0 ? UpAxis::y : UpAxis::z;
  out.mesh.short_faces = scene->short_faces;
  for (const auto& mesh : scene->meshes) {
    const auto first = static_cast<std::int64_t>(out.mesh.vertices.size());
    for (const auto& [x, y, z] : mesh.vertices) out.mesh.vertices.push_back({x, y, z});
    for (const auto& triangle : mesh.triangles) {
      auto& corners = out.mesh.triangles.emplace_back();
      for (std::size_t c = 0; c < 3; ++c)
        corners[c] = triangle[c] < mesh.vertices.size() ? to_index(first + triangle[c]) : no_vertex;
    }
  }
  if (scene->farthest > exact_to)
    out.warnings.push_back(base::warning("ingest-mesh-precision",
                                         "its coordinates reach " + base::to_text(scene->farthest, 0) +
                                             " m, where single precision has steps of more than 2 mm; export it with "
                                             "an origin near the mesh, and give that as --mesh-offset",
                                         name));
  return out;
}

}  // namespace mansard::formats
