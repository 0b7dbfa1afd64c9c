// Says of every triangle of a scan what it shows: wall, roof, ground or something else.
#pragma once

#include <span>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/model/surfaces.hpp"

namespace mansard::label {

struct ScanOptions {
  double reach = 1.0;          ///< m; what is farther from every wall and roof of the model is none of them
  double turned = 0.5;         ///< m; a surface that looks the other way counts as up to twice this farther
  double upright = 2.0;        ///< m; a vertical surface counts as so much farther from a roof
  double even_out = 0.5;       ///< m; the direction of a triangle is a mean over the triangles around it within this
  double ground_height = 0.5;  ///< m; what is no more than this above or below the terrain may be ground
  double cell = 3.0;           ///< m; of the grid on which the terrain is found
  double slope = 0.4;          ///< metres per metre; the terrain is nowhere steeper
};

/// Each triangle by its centre: the nearest wall or roof of the model within reach, or the terrain, whichever is nearer
/// when those that look another way are held to be farther; `other` where there is neither. The terrain is the scan's
/// own where the model has nothing: the low end of each cell, and no steeper than `slope`.
/// Guarantees: 1 a class per triangle · 2 the same at any thread count. Cost: O(n log m).
[[nodiscard]] auto label_scan(const geometry::Mesh& scan, const model::ModelSurface& model,
                              const ScanOptions& options = {}, const base::Run& run = {})
    -> std::vector<model::SurfaceClass>;

/// The trivial rule, without a model, to hold the other against: steeper than 45° is wall; else it is roof where it is
/// more than 2.5 m above the low end of the scan around (a cell of 15 m, or its neighbours), and ground where it is
/// not.
[[nodiscard]] auto label_by_normal(const geometry::Mesh& scan) -> std::vector<model::SurfaceClass>;

/// For models that know walls and roofs only: the class of the nearest wall or roof of the model, however far and
/// whichever way it looks; `other` where the model has neither.
[[nodiscard]] auto nearest_wall_or_roof(const geometry::Mesh& scan, const model::ModelSurface& model)
    -> std::vector<model::SurfaceClass>;
/// The trivial rule for these: steeper than 50° is wall, else roof.
[[nodiscard]] auto wall_or_roof_by_normal(const geometry::Mesh& scan) -> std::vector<model::SurfaceClass>;
/// Whether each triangle's centre is more than `ground_height` above the terrain, found where the model has nothing.
[[nodiscard]] auto above_ground(const geometry::Mesh& scan, const model::ModelSurface& model,
                                const ScanOptions& options = {}) -> std::vector<bool>;

/// m²: area[true class][class given], of the triangles of `scan`. `truth` is per triangle.
using ScanConfusion = std::array<std::array<double, model::surface_class_count>, model::surface_class_count>;
[[nodiscard]] auto confusion_of(const geometry::Mesh& scan, std::span<const model::SurfaceClass> truth,
                                std::span<const model::SurfaceClass> given) -> ScanConfusion;

/// For each triangle of the scan the class of the nearest triangle of another mesh, by centres: the same mesh, or one
/// of the same place. `other` further away than a metre.
[[nodiscard]] auto classes_from(const geometry::Mesh& scan, const geometry::Mesh& labelled,
                                std::span<const model::SurfaceClass> classes) -> std::vector<model::SurfaceClass>;

}  // namespace mansard::label
