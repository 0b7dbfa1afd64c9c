// Models made by hand, as files would give them.
#pragma once

#include <string>
#include <vector>

#include "label/solids.hpp"
#include "mansard/model/surfaces.hpp"

namespace models {

using mansard::geometry::Point2;
using mansard::geometry::Point3;
using mansard::model::Model;
using mansard::model::ModelBuilding;
using mansard::model::ModelFace;
using mansard::model::ModelPart;
using mansard::model::SurfaceClass;

/// A solid's faces with their classes by their normals: upright wall, down ground, else roof.
inline auto part_of(const solids::Solid& solid, const std::string& id) -> ModelPart {
  ModelPart part{id, {}};
  for (const auto& face : solid.faces) {
    ModelFace out;
    for (const auto& loop : face.loops) {
      auto& points = out.loops.emplace_back();
      for (const auto v : loop) points.push_back(solid.vertices[v]);
    }
    out.kind = std::abs(face.normal.z) < 0.2 ? SurfaceClass::wall
               : face.normal.z < 0           ? SurfaceClass::ground
                                             : SurfaceClass::roof;
    part.faces.push_back(std::move(out));
  }
  return part;
}

/// A building of one part per solid; ids "0", "1", … and "0-0", "0-1", ….
inline auto model_of(const std::vector<std::vector<solids::Solid>>& buildings) -> Model {
  Model model;
  for (std::size_t b = 0; b < buildings.size(); ++b) {
    ModelBuilding building{std::to_string(b), {}};
    for (std::size_t p = 0; p < buildings[b].size(); ++p)
      building.parts.push_back(part_of(buildings[b][p], std::to_string(b) + "-" + std::to_string(p)));
    model.buildings.push_back(std::move(building));
  }
  return model;
}

/// The surface of such a model.
inline auto mesh_of(const std::vector<std::vector<solids::Solid>>& buildings) -> mansard::geometry::Mesh {
  return mansard::model::surface_of(model_of(buildings)).mesh;
}

/// From y = 0 to 8 m.
inline auto rectangle(double x0, double x1) -> mansard::geometry::Polygon {
  return {{{x0, 0}, {x1, 0}, {x1, 8}, {x0, 8}}, {}};
}

/// The same model with every face cut into triangles.
inline auto in_triangles(const Model& model) -> Model {
  Model out;
  const auto surface = mansard::model::surface_of(model);
  for (const auto& building : model.buildings) out.buildings.push_back({building.id, {{building.id, {}}}});
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    ModelFace face;
    auto& loop = face.loops.emplace_back();
    for (const auto v : surface.mesh.triangles[t]) loop.push_back(surface.mesh.vertices[v]);
    face.kind = surface.classes[t];
    out.buildings[surface.buildings[t]].parts[0].faces.push_back(face);
  }
  return out;
}

}  // namespace models
