// The volume that a tile of 3D Tiles says it fills, and whether it reaches into a box in plan.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <variant>

#include "mansard/crs/mesh_crs.hpp"
#include "mansard/formats/mesh/transform.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::formats {

/// Longitude and latitude in degrees; `east` may be beyond 180.
struct DegreeBox {
  double west = 0, south = 0, east = 0, north = 0;
  double low = 0, high = 0;  ///< m above the ellipsoid
};
/// A middle and three half axes, in the tile's coordinates or, once placed, in the tileset's.
struct TileBox {
  geometry::Point3 middle;
  std::array<geometry::Point3, 3> half;
};
/// Nothing where the file says nothing that is understood.
using Volume = std::variant<std::monostate, DegreeBox, TileBox>;

/// Of a "boundingVolume": region, box, or sphere (as the box around it).
[[nodiscard]] auto volume_of(const nlohmann::ordered_json& object) -> Volume;
/// A region is where it is, a box goes with the tile.
[[nodiscard]] auto placed(const Volume& volume, const Transform& by) -> Volume;

/// The question that decides which tiles are read.
class TileFilter {
 public:
  /// `way` leads from the earth to the working CRS, and is none for tilesets whose coordinates stay as they are. All
  /// tiles pass where there is no box.
  TileFilter(std::optional<geometry::Box2> within, const crs::WayOfMesh* way) : within_(within), way_(way) {}
  /// False only where the volume is certain to be beside the box.
  [[nodiscard]] auto passes(const Volume& placed) const -> bool;

 private:
  std::optional<geometry::Box2> within_;
  const crs::WayOfMesh* way_;
};

}  // namespace mansard::formats
