#include "mansard/crs/globe.hpp"

#include <cpl_error.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <numbers>

namespace mansard::crs {
namespace {

using geometry::Point3;

constexpr double radius = 6378137, flattening = 1 / 298.257223563;  // WGS 84, metres
constexpr double eccentricity2 = flattening * (2 - flattening);

struct Angles {
  double sin_lon, cos_lon, sin_lat, cos_lat;
  explicit Angles(Point3 degrees)
      : sin_lon(std::sin(degrees.x * std::numbers::pi / 180)),
        cos_lon(std::cos(degrees.x * std::numbers::pi / 180)),
        sin_lat(std::sin(degrees.y * std::numbers::pi / 180)),
        cos_lat(std::cos(degrees.y * std::numbers::pi / 180)) {}
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

  /// To longitude and latitude of WGS 84, with heights above its ellipsoid if they are asked for. False for no way.
  auto find(OGRSpatialReference from, bool heights, bool guess) -> bool {
    OGRSpatialReference to;
    if (to.importFromEPSG(heights ? 4979 : 4326) != OGRERR_NONE) return false;
    if (!heights) {
      if (from.IsCompound() != 0) from.StripVertical();
      from.DemoteTo2D(nullptr);
    }
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    // PROJ's guess, where it lacks a geoid or a grid, leaves out what it lacks and the shift of the datum with it.
    OGRCoordinateTransformationOptions options;
    options.SetBallparkAllowed(guess);
    transformation.reset(OGRCreateCoordinateTransformation(&from, &to, options));
    return transformation != nullptr;
  }
};

auto Globe::of(const model::Frame& frame) -> base::Result<std::optional<Globe>> {
  if (frame.crs.empty()) return std::optional<Globe>();
  const Quiet quiet;
  OGRSpatialReference from;
  if (from.SetFromUserInput(frame.crs.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
      OGRERR_NONE)
    return no_way(frame.crs);
  Globe globe;
  globe.frame_ = frame;
  globe.projection_ = std::make_shared<Projection>();
  Projection& way = *globe.projection_;
  const auto warn = [&](const std::string& what) {
    globe.warnings_.push_back(base::warning(
        "write-tiles-grid", what + "; install PROJ's grids for the region, or let it fetch them (PROJ_NETWORK=ON)",
        frame.crs.substr(0, 100)));
  };
  if (from.IsCompound() != 0 || from.GetAxesCount() == 3) {
    globe.heights_ = Heights::of_the_crs;
    if (way.find(from, true, false)) return std::optional<Globe>(std::move(globe));
    globe.heights_ = Heights::without_geoid;
    warn(
        "PROJ has no geoid here for the heights of this coordinate system, so they are taken as heights above the "
        "ellipsoid: the tileset may stand some ten metres too low or too high on a globe");
  }
  if (way.find(from, false, false)) return std::optional<Globe>(std::move(globe));
  if (!way.find(from, false, true)) return no_way(frame.crs);
  warn("PROJ has no grid here for the datum of this coordinate system: the tileset may stand a hundred metres away");
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

}  // namespace mansard::crs
