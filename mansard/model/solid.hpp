// A closed polyhedral surface, and what its faces are.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::model {

enum class FaceKind : std::uint8_t {
  side,       ///< swept by a part of an edge's profile: wall or roof by its slope
  connector,  ///< vertical, between collinear neighbours with different profiles
  terrace,    ///< horizontal part of a profile
  cap,        ///< flat top where the extrusion was ended
  base,       ///< the ground floor
  soffit,     ///< the level underside of overhanging eaves
};

/// The plan's edge and the part of its profile that a face comes from.
struct Provenance {
  std::uint32_t ring = 0;  ///< 0 the outer ring, 1 … the holes
  std::uint32_t edge = 0;
  std::uint32_t part = 0;  ///< profile part: between points part and part + 1
  friend auto operator<=>(const Provenance&, const Provenance&) = default;
};

/// A planar polygon with holes.
struct Face {
  std::vector<std::vector<std::uint32_t>> loops;  ///< indices; outer loop first, counter-clockwise seen from outside
  FaceKind kind = FaceKind::side;
  std::optional<Provenance> provenance;  ///< for side and terrace
  geometry::Point3 normal;               ///< unit, outward
};

/// A closed polyhedral surface.
struct Solid {
  std::vector<geometry::Point3> vertices;  ///< metres, local frame
  std::vector<Face> faces;
};

/// What a face of a building is.
enum class FaceClass : std::uint8_t { wall, party_wall, roof, ground, soffit };

struct LabelledSolid {
  Solid solid;
  std::vector<FaceClass> classes;  ///< per face
};

}  // namespace mansard::model
