// The roofs of a solid as a height field that can be changed, and the solid below the field.
#pragma once

#include <optional>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::solid::detail {

/// A plane that is not vertical.
struct RoofPlane {
  geometry::Point3 at, normal;
  [[nodiscard]] auto height(geometry::Point2 p) const -> double {
    return at.z - (normal.x * (p.x - at.x) + normal.y * (p.y - at.y)) / normal.z;
  }
};

/// A face of a roof. Loops of fillings that lie in its plane come after its own.
struct RoofFace {
  std::uint32_t face = 0;  ///< of the solid: its kind, provenance and normal
  std::vector<std::vector<geometry::Point3>> loops;
  std::uint32_t piece = 0;
  double area = 0;  ///< m², in plan
  RoofPlane plane;
};

/// Where two faces are adjacent in plan.
struct Contact {
  std::uint32_t face = 0, other = 0;  ///< of RoofField::faces
  double length = 0;                  ///< m
  geometry::Point2 middle;
  double rise = 0;  ///< m; of the other face above the plane of the first, 1 m beyond an edge that they share
};

/// Guarantee: `pieces` are the sets of faces that are connected without a wall between them.
struct RoofField {
  std::vector<RoofFace> faces;
  std::uint32_t pieces = 0;
  std::vector<double> outline;  ///< m; of each piece, where another piece, a wall or the outside begins

  [[nodiscard]] auto area_of(std::uint32_t piece) const -> double;
  /// With a wall between them, also of one piece. Every pair twice: from either side. O(n log n).
  [[nodiscard]] auto contacts() const -> std::vector<Contact>;
  /// With an edge that they share, every pair twice. Not the edge of a face with itself. O(n log n).
  [[nodiscard]] auto seams() const -> std::vector<Contact>;
  /// Counts pieces and measures their outlines anew.
  void connect();
};

/// None where the solid is no height field over one level of ground: overhanging eaves, several levels.
[[nodiscard]] auto roof_field(const model::LabelledSolid& solid) -> std::optional<RoofField>;

/// The solid between the ground of `solid` and a field. None where it is not one valid solid over the same corners
/// with at most as many faces.
[[nodiscard]] auto solid_below(const RoofField& field, const model::LabelledSolid& solid)
    -> std::optional<model::LabelledSolid>;

/// z below which that share of the area of some faces lies: of flat triangles, exactly.
[[nodiscard]] auto height_at(const std::vector<const RoofFace*>& faces, double share) -> double;

}  // namespace mansard::solid::detail
