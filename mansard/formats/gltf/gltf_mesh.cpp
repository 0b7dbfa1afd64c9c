#include "mansard/formats/gltf/gltf_mesh.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "mansard/formats/detail/triangles.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Point3;
using model::FaceClass;

/// Party walls of a model by the lower edges that they stand on, as the wall runs along them.
auto party_edges(const model::LabelledSolid& model) -> std::map<std::pair<std::uint32_t, std::uint32_t>, bool> {
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> edges;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f)
    for (const auto& loop : model.solid.faces[f].loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (model.classes[f] == FaceClass::party_wall) edges[{loop[i], loop[(i + 1) % loop.size()]}] = true;
  return edges;
}

void append_face(model::LabelledSolid& model, model::Face face, FaceClass kind) {
  model.solid.faces.push_back(std::move(face));
  model.classes.push_back(kind);
}

}  // namespace

auto part_mesh(const model::LabelledSolid& model, const std::string& part) -> base::Result<PartMesh> {
  const auto& solid = model.solid;
  const auto triangulated = triangles_of(solid, part);
  if (!triangulated) return triangulated.error();
  PartMesh mesh;
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    mesh.faces.push_back({model.classes[f], geometry::normalised(solid.faces[f].normal), 0, 0, 0, 0});
  constexpr std::uint32_t none = ~0U;
  std::vector<std::uint32_t> index_of(solid.vertices.size(), none);  // within the face at hand
  std::uint32_t at = none;
  for (std::size_t t = 0; t < triangulated->triangles.size(); ++t) {
    FaceMesh& face = mesh.faces[triangulated->face_of[t]];
    if (triangulated->face_of[t] != at) {
      at = triangulated->face_of[t];
      face.first_vertex = static_cast<std::uint32_t>(mesh.vertices.size());
      face.first_index = static_cast<std::uint32_t>(mesh.indices.size());
      for (const auto& loop : solid.faces[at].loops)
        for (const auto v : loop) index_of[v] = none;
    }
    for (const auto corner : triangulated->triangles[t]) {
      if (index_of[corner] == none) {
        index_of[corner] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(solid.vertices[corner]);
        ++face.vertices;
      }
      mesh.indices.push_back(index_of[corner]);
      ++face.indices;
    }
  }
  return mesh;
}

auto flat_height(const model::Part& part, const model::Frame& frame) -> std::optional<double> {
  double lowest = std::numeric_limits<double>::infinity(), least = lowest, most = -lowest;
  const auto& [solid, classes] = part.model;
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    for (const auto& loop : solid.faces[f].loops)
      for (const auto v : loop) {
        const double z = solid.vertices[v].z;
        lowest = std::min(lowest, z);
        if (classes[f] != FaceClass::roof) continue;
        least = std::min(least, z);
        most = std::max(most, z);
      }
  if (least > most) return std::nullopt;
  double height = (least + most) / 2;
  for (const auto& [name, value] : part.attributes)
    if (const auto* z = std::get_if<double>(&value); z != nullptr && name == "ms_h_roof_70p")
      if (const double local = *z - static_cast<double>(frame.origin[2]); local > lowest && local <= most)
        height = local;
  return height;
}

auto flat_model(const model::LabelledSolid& model, double z) -> model::LabelledSolid {
  model::LabelledSolid flat;
  const auto party = party_edges(model);
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    if (model.classes[f] != FaceClass::ground) continue;
    model::Face ground = model.solid.faces[f], roof;
    ground.normal = {0, 0, -1};
    ground.provenance.reset();
    roof.kind = model::FaceKind::cap;
    roof.normal = {0, 0, 1};
    for (auto& loop : ground.loops) {
      const auto first = static_cast<std::uint32_t>(flat.solid.vertices.size());
      const auto n = static_cast<std::uint32_t>(loop.size());
      for (const auto v : loop) {
        if (model.solid.vertices[v].z >= z) return {};
        flat.solid.vertices.push_back(model.solid.vertices[v]);
      }
      for (const auto v : loop)
        flat.solid.vertices.push_back({model.solid.vertices[v].x, model.solid.vertices[v].y, z});
      auto& above = roof.loops.emplace_back();
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        above.push_back(first + n + (n - 1 - i));
        const Point3 along = flat.solid.vertices[first + i] - flat.solid.vertices[first + j];  // as the wall runs
        model::Face wall;
        wall.kind = model::FaceKind::side;
        wall.loops = {{first + j, first + i, first + n + i, first + n + j}};
        wall.normal = geometry::normalised(Point3{along.y, -along.x, 0});
        append_face(flat, std::move(wall),
                    party.contains({loop[j], loop[i]}) ? FaceClass::party_wall : FaceClass::wall);
      }
      for (std::uint32_t i = 0; i < n; ++i) loop[i] = first + i;
    }
    append_face(flat, std::move(ground), FaceClass::ground);
    append_face(flat, std::move(roof), FaceClass::roof);
  }
  return flat;
}

}  // namespace mansard::formats::detail
