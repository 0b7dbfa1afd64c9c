// Where a mesh says it is, and its way to the working CRS. Heights are never converted from one datum to another.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::crs {

/// What a mesh says about its coordinates.
struct MeshCrs {
  enum class Kind {
    plane,       ///< x and y in `wkt`, projected or geographic; z up, in its unit
    tangent,     ///< metres east, north and up on the plane that touches the ellipsoid of WGS 84 at a place
    geocentric,  ///< metres from the middle of the earth, WGS 84 (EPSG:4978)
  };
  Kind kind = Kind::plane;
  std::string wkt;
  double longitude = 0, latitude = 0;  ///< degrees, of `tangent`
  geometry::Point3 origin;             ///< to be added first
  std::optional<double> height_unit;   ///< m, of `plane`; none: the unit of x and y, or metres beside degrees
};

/// A number and blanks around it.
[[nodiscard]] auto number_of(std::string_view words) -> std::optional<double>;

/// Reads "EPSG:n", "EPSG:n+m", WKT, or "ENU:latitude,longitude"; nothing where it is none of these, or geographic.
[[nodiscard]] auto mesh_crs(const std::string& words) -> std::optional<MeshCrs>;

/// The projected CRS in metres to work in where nothing else says one: the mesh's own, else the UTM zone at
/// `somewhere`, a point of the mesh. Empty where there is none.
[[nodiscard]] auto working_crs_of(const MeshCrs& mesh, geometry::Point3 somewhere) -> std::string;

/// Whether a point is within 1 km and `below` (m) under and 10 km above the ellipsoid of WGS 84.
[[nodiscard]] auto near_ellipsoid(geometry::Point3 p, double below = 0) -> bool;

class WayPool;

/// Brings coordinates from a mesh's CRS to the working one. Any thread may call one, at the same time as others.
class WayOfMesh {
 public:
  /// `working` names a projected CRS. Fails with "ingest-crs-unknown".
  [[nodiscard]] static auto between(const MeshCrs& mesh, const std::string& working, const std::string& subject)
      -> base::Result<WayOfMesh>;
  /// x and y by PROJ. z becomes the height above the ellipsoid for `tangent` and `geocentric`, else stays, in metres.
  /// NaN where a point cannot be taken along. Cost: about 1 µs a point.
  void take(std::span<geometry::Point3> points) const;
  /// A box in the working CRS that holds an upright box of degrees, west to east; nothing where that cannot be told.
  [[nodiscard]] auto box_of_degrees(double west, double south, double east, double north) const
      -> std::optional<geometry::Box2>;
  /// A box in the mesh's plane that holds one in the working CRS, before `origin` is added; nothing where unknown.
  [[nodiscard]] auto back(const geometry::Box2& box) const -> std::optional<geometry::Box2>;

 private:
  MeshCrs mesh_;
  std::string from_, to_;           ///< WKT, flat; both empty where x and y stay as they are
  std::shared_ptr<WayPool> plane_;  ///< from `from_` to `to_`; none where x and y stay
  std::shared_ptr<WayPool> earth_;  ///< from geocentric coordinates to degrees and height; none where not needed
  geometry::Point3 touch_;          ///< where the tangent plane touches the ellipsoid, geocentric
  double unit_ = 1;                 ///< m
};

}  // namespace mansard::crs
