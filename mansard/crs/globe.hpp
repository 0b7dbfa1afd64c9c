// Where the models of a city are on Earth.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::crs {

/// A frame of its own: an origin and three axes of length 1 at right angles, in the frame of the whole (Earth-centred,
/// metres, or the local frame of a city without a CRS).
struct Place {
  geometry::Point3 origin, east{1, 0, 0}, north{0, 1, 0}, up{0, 0, 1};

  [[nodiscard]] auto inside(geometry::Point3 p) const -> geometry::Point3;   ///< from the frame of the whole
  [[nodiscard]] auto outside(geometry::Point3 p) const -> geometry::Point3;  ///< to it
};

/// From the local frame to the Earth-centred one (EPSG:4978): to longitude, latitude and height by PROJ through GDAL,
/// then by the definition of the WGS 84 ellipsoid. Heights of a CRS that has none, or one whose geoid PROJ lacks, are
/// taken as heights above the ellipsoid.
class Globe {
 public:
  enum class Heights { not_of_the_crs, of_the_crs, without_geoid };

  /// None for a frame without CRS. Fails with "write-tiles-crs" where PROJ cannot go from there to WGS 84.
  [[nodiscard]] static auto of(const model::Frame& frame) -> base::Result<std::optional<Globe>>;

  /// Every point, in place: longitude and latitude in degrees on WGS 84, height in metres. Fails with
  /// "write-tiles-crs".
  [[nodiscard]] auto to_angles(std::vector<geometry::Point3>& points) const -> base::Result<void>;
  /// Every point, in place. Fails with "write-tiles-crs".
  [[nodiscard]] auto to_earth(std::vector<geometry::Point3>& points) const -> base::Result<void>;
  /// East, north and up there.
  [[nodiscard]] auto place(geometry::Point3 local) const -> base::Result<Place>;
  [[nodiscard]] auto heights() const -> Heights { return heights_; }
  /// "write-tiles-grid", where what PROJ has does not suffice.
  [[nodiscard]] auto warnings() const -> const std::vector<base::Diagnostic>& { return warnings_; }

 private:
  struct Projection;
  Globe() = default;

  model::Frame frame_;
  Heights heights_ = Heights::not_of_the_crs;
  std::vector<base::Diagnostic> warnings_;
  std::shared_ptr<Projection> projection_;
};

}  // namespace mansard::crs
