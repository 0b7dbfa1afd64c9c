// Ray-traced light on coloured triangles.
#pragma once

#include "mansard/base/run.hpp"
#include "mansard/picture/detail/camera.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::picture::detail {

/// All layers as one mesh.
struct Model {
  geometry::Mesh mesh;
  std::vector<Light> albedo;  ///< a triangle
  /// The layers with pictures: their first triangle, and what gives the colours.
  std::vector<std::pair<std::size_t, const Layer*>> pictured;
  /// As Layer::picture, of all layers.
  [[nodiscard]] auto picture_at(std::size_t triangle, geometry::Point3 point) const -> std::optional<Colour>;
  std::vector<geometry::Point3> normals;  ///< a triangle, unit, either side; zero for one without area
};
[[nodiscard]] auto joined(std::span<const Layer> layers) -> Model;

inline constexpr Colour paper{250, 250, 248};

/// The model under a sun and an open sky, standing on a sheet of paper that takes its shadow. `scene` is of its mesh,
/// which is not asked; `points` are the mesh's vertices.
void render(Canvas& canvas, const Model& model, const rays::Scene& scene, std::span<const geometry::Point3> points,
            const Camera& camera, const base::Run& run);

/// The lines' visible pieces: those with nothing more than 10 cm in front of them.
void draw_lines(Canvas& canvas, const Lines& lines, const rays::Scene& scene, const Camera& camera);

}  // namespace mansard::picture::detail
