// Building models of any producer, as classified polygons and as triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::model {

/// What a surface is. The numbers are those of the face property `class` in PLY files.
enum class SurfaceClass : std::uint8_t { wall, roof, ground, other };
inline constexpr std::size_t surface_class_count = 4;
[[nodiscard]] auto to_string(SurfaceClass kind) -> std::string_view;

/// A plane polygon of a model.
struct ModelFace {
  std::vector<std::vector<geometry::Point3>> loops;  ///< metres, local frame; outer loop first, then holes; open
  SurfaceClass kind = SurfaceClass::other;
  bool by_normal = false;  ///< the file does not say what it is: told by its direction
};

struct ModelPart {
  std::string id;
  std::vector<ModelFace> faces;
  std::string role{};  ///< "dormer", … where the file says so (attribute ms_role)
};

struct ModelBuilding {
  std::string id;
  std::vector<ModelPart> parts;
};

struct Model {
  std::vector<ModelBuilding> buildings;  ///< in the file's order; none without a face
  Frame frame;                           ///< `crs` without a vertical part
  std::string lod;                       ///< "2.2", or several: "1.2, 2.2"; empty where the format has none
  std::vector<InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
};

/// Twice the area, as a vector along the normal of the loop.
[[nodiscard]] auto area_vector(const std::vector<geometry::Point3>& loop) -> geometry::Point3;

/// A model as triangles; what belongs to which is kept per triangle.
struct ModelSurface {
  geometry::Mesh mesh;
  std::vector<SurfaceClass> classes;
  std::vector<std::uint32_t> buildings;  ///< index into Model::buildings
  std::vector<std::uint32_t> parts;      ///< counted through all buildings
  std::vector<std::uint32_t> faces;      ///< counted through all parts
  std::size_t lost = 0;                  ///< faces that cannot be cut into triangles, left out
};
[[nodiscard]] auto surface_of(const Model& model) -> ModelSurface;
/// The triangles of those buildings that are true in `buildings`, which has one entry for each.
[[nodiscard]] auto part_of(const ModelSurface& surface, const std::vector<bool>& buildings) -> ModelSurface;

}  // namespace mansard::model
