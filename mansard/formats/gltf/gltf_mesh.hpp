// The models of parts as triangles that glTF can take, and the flat-roofed ones that stand for them far away.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats::detail {

/// The triangles of one face of a model.
struct FaceMesh {
  model::FaceClass kind = model::FaceClass::wall;
  geometry::Point3 normal;  ///< unit, outward, local frame
  std::uint32_t first_vertex = 0, vertices = 0, first_index = 0, indices = 0;
};

/// Vertices are shared within a face and not between faces, so every face keeps its own flat normal.
struct PartMesh {
  std::vector<geometry::Point3> vertices;  ///< local frame, metres, face by face
  std::vector<std::uint32_t> indices;      ///< three a triangle, counter-clockwise from outside, face by face
  std::vector<FaceMesh> faces;             ///< as in the model
};

/// Fails with "write-triangulate", which names the part.
[[nodiscard]] auto part_mesh(const model::LabelledSolid& model, const std::string& part) -> base::Result<PartMesh>;

/// z of the flat roof of LoD 1.2: `ms_h_roof_70p` where the part has it and it lies within the model, else half-way
/// between the lowest and the highest point of the roof. None without a roof.
[[nodiscard]] auto flat_height(const model::Part& part, const model::Frame& frame) -> std::optional<double>;

/// The ground faces of a model raised to a flat roof at `z`: LoD 1.2. Its walls are party walls where that one's are.
/// Empty without ground below z.
[[nodiscard]] auto flat_model(const model::LabelledSolid& model, double z) -> model::LabelledSolid;

}  // namespace mansard::formats::detail
