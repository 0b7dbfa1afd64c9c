// The planes of a model: faces that lie in one plane and share an edge are one.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/model/surfaces.hpp"

namespace mansard::evaluate {

struct Plane {
  geometry::Point3 normal;  ///< unit; of its largest face, outward where the model's faces are
  geometry::Point3 point;   ///< a corner of that face
  double area = 0;          ///< m²
  model::SurfaceClass kind = model::SurfaceClass::other;
  std::uint32_t building = 0;
};

struct Planes {
  std::vector<Plane> planes;           ///< of one building after the other, the largest first face first
  std::vector<std::uint32_t> of_face;  ///< per face, counted through all parts
};

struct PlaneOptions {
  double angle = 0.0174533;  ///< rad; 1°
  double distance = 0.01;    ///< m
};

/// Faces of one building and class join where they share an edge (two corners, to the millimetre), their normals are
/// within `angle` of that of the plane's largest face, and all their corners within `distance` of its plane.
/// Guarantees: 1 every face is in one plane · 2 cutting a face into triangles does not change the number of planes.
/// Cost: O(n log n) for n corners.
[[nodiscard]] auto planes_of(const model::Model& model, const PlaneOptions& options = {}) -> Planes;

}  // namespace mansard::evaluate
