#include "mansard/write/detail/tiles_frame.hpp"

#include <cpl_error.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <numbers>

namespace mansard::write::detail {
namespace {

using geometry::Point3;

constexpr double radius = 6378137, flattening = 1 / 298.257223563;  // WGS 84, metres
constexpr double eccentricity2 = flattening * (2 - flattening);

struct Angles {
  double sin_lon, cos_lon, sin_lat, cos_lat;
  explicit Angles(Point3 degrees)
      : sin_lon(std::sin(degrees.x * std::numbers::pi / 180)), cos_lon(std::cos(degrees.x * std::numbers::pi / 180)),
        sin_lat(std::sin(degrees.y * std::numbers::pi / 180)), cos_lat(std::cos(degrees.y * std::numbers::pi / 180)) {}
};

/// The definition of the ellipsoid, as in EPSG guidance note 7-2, section 4.1.1.
auto earth_centred(Point3 degrees) -> Point3 {
  const Angles a(degrees);
  const double normal = radius / std::sqrt(1 - eccentricity2 * a.sin_lat * a.sin_lat), h = degrees.z;
  return {(normal + h) * a.cos_lat * a.cos_lon, (normal + h) * a.cos_lat * a.sin_lon,
          (normal * (1 - eccentricity2) + h) * a.sin_lat};
}

auto no_way(const std::string& crs) -> base::Diagnostic {
  return base::error(
      "write-tiles-crs",
      "there is no way from this coordinate system to WGS 84; write in a projected system of EPSG, or as GLB",
      crs.substr(0, 100));
}

/// The library's own words would go to standard error.
class Quiet {
 public:
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  auto operator=(const Quiet&) -> Quiet& = delete;
};

}  // namespace

auto Place::inside(Point3 p) const -> Point3 {
  const Point3 d = p - origin;
  return {dot(d, east), dot(d, north), dot(d, up)};
}

auto Place::outside(Point3 p) const -> Point3 { return origin + p.x * east + p.y * north + p.z * up; }

struct Globe::Projection {
  struct Destroy {
    void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
  };
  std::unique_ptr<OGRCoordinateTransformation, Destroy> transformation;
};

auto Globe::of(const ingest::Frame& frame) -> base::Result<std::optional<Globe>> {
  if (frame.crs.empty()) return std::optional<Globe>();
  const Quiet quiet;
  OGRSpatialReference from, to;
  if (from.SetFromUserInput(frame.crs.c_str()) != OGRERR_NONE) return no_way(frame.crs);
  Globe globe;
  globe.frame_ = frame;
  globe.has_heights_ = from.IsCompound() != 0 || from.GetAxesCount() == 3;
  if (to.importFromEPSG(globe.has_heights_ ? 4979 : 4326) != OGRERR_NONE) return no_way(frame.crs);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  globe.projection_ = std::make_shared<Projection>();
  globe.projection_->transformation.reset(OGRCreateCoordinateTransformation(&from, &to));
  if (!globe.projection_->transformation) return no_way(frame.crs);
  return std::optional<Globe>(std::move(globe));
}

auto Globe::to_angles(std::vector<Point3>& points) const -> base::Result<void> {
  if (points.empty()) return {};
  std::vector<double> x, y, z;
  for (const Point3& p : points) {
    x.push_back(p.x + static_cast<double>(frame_.origin[0]));
    y.push_back(p.y + static_cast<double>(frame_.origin[1]));
    z.push_back(p.z + static_cast<double>(frame_.origin[2]));
  }
  const Quiet quiet;
  std::vector<int> success(points.size());
  if (projection_->transformation->Transform(static_cast<int>(points.size()), x.data(), y.data(), z.data(), nullptr,
                                             success.data()) == 0)
    return no_way(frame_.crs);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (success[i] == 0 || !std::isfinite(x[i]) || !std::isfinite(y[i]) || !std::isfinite(z[i]))
      return no_way(frame_.crs);
    points[i] = {x[i], y[i], z[i]};
  }
  return {};
}

auto Globe::to_earth(std::vector<Point3>& points) const -> base::Result<void> {
  if (auto done = to_angles(points); !done) return done;
  for (Point3& p : points) p = earth_centred(p);
  return {};
}

auto Globe::place(Point3 local) const -> base::Result<Place> {
  std::vector<Point3> point{local};
  if (auto done = to_angles(point); !done) return done.error();
  const Angles a(point[0]);
  return Place{earth_centred(point[0]),
               {-a.sin_lon, a.cos_lon, 0},
               {-a.sin_lat * a.cos_lon, -a.sin_lat * a.sin_lon, a.cos_lat},
               {a.cos_lat * a.cos_lon, a.cos_lat * a.sin_lon, a.sin_lat}};
}

}  // namespace mansard::write::detail
