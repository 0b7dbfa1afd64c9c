#include "mansard/crs/mesh_crs.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <vector>

#include "mansard/base/text.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/crs/utm.hpp"

namespace mansard::crs {
namespace {

using geometry::Box2;
using geometry::Point3;

constexpr int wgs84 = 4326, wgs84_geocentric = 4978, wgs84_with_height = 4979;

auto registered(int number) -> Crs {
  Crs crs;
  crs.system.importFromEPSG(number);
  return crs;
}

/// Takes points along in pieces, so that the lists of x, y and z stay small.
void take_along(OGRCoordinateTransformation& way, std::span<Point3> points, bool with_heights) {
  constexpr std::size_t piece = 4096;
  constexpr double lost = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> x, y, z;
  std::vector<int> done;
  for (std::size_t first = 0; first < points.size(); first += piece) {
    const auto now = points.subspan(first, std::min(piece, points.size() - first));
    x.clear();
    y.clear();
    z.clear();
    for (const Point3 p : now) {
      x.push_back(p.x);
      y.push_back(p.y);
      z.push_back(p.z);
    }
    done.assign(now.size(), 0);
    way.Transform(static_cast<int>(now.size()), x.data(), y.data(), with_heights ? z.data() : nullptr, nullptr,
                  done.data());
    for (std::size_t i = 0; i < now.size(); ++i)
      now[i] = done[i] != 0 ? Point3{x[i], y[i], z[i]} : Point3{lost, lost, lost};
  }
}

/// On the ellipsoid, as seen from the middle of the earth.
auto geocentric(double longitude, double latitude) -> Point3 {
  std::array<Point3, 1> place{{{longitude, latitude, 0}}};
  const auto way = transformation(registered(wgs84_with_height), registered(wgs84_geocentric));
  if (way) take_along(*way, place, true);
  return place[0];
}

/// East, north and up of a place to what is seen from the middle of the earth.
void from_tangent(std::span<Point3> points, double longitude, double latitude, Point3 touch) {
  const double l = longitude * std::numbers::pi / 180, b = latitude * std::numbers::pi / 180;
  const Point3 east{-std::sin(l), std::cos(l), 0};
  const Point3 north{-std::sin(b) * std::cos(l), -std::sin(b) * std::sin(l), std::cos(b)};
  const Point3 up{std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b)};
  for (auto& p : points) p = touch + p.x * east + p.y * north + p.z * up;
}

/// "ENU:latitude,longitude", as ContextCapture names its local systems.
auto tangent_of(const std::string& words) -> std::optional<MeshCrs> {
  const auto comma = words.find(',');
  if (comma == words.npos) return std::nullopt;
  const auto latitude = number_of(std::string_view(words).substr(4, comma - 4));
  const auto longitude = number_of(std::string_view(words).substr(comma + 1));
  if (!latitude || !longitude || std::abs(*latitude) > 90 || std::abs(*longitude) > 360) return std::nullopt;
  MeshCrs crs;
  crs.kind = MeshCrs::Kind::tangent;
  crs.longitude = *longitude;
  crs.latitude = *latitude;
  return crs;
}

auto bounds_by(OGRCoordinateTransformation& way, const Box2& box) -> std::optional<Box2> {
  Box2 out;
  if (way.TransformBounds(box.least.x, box.least.y, box.most.x, box.most.y, &out.least.x, &out.least.y, &out.most.x,
                          &out.most.y, 21) == 0)
    return std::nullopt;
  const bool finite = std::isfinite(out.least.x) && std::isfinite(out.least.y) && std::isfinite(out.most.x) &&
                      std::isfinite(out.most.y) && out.least.x <= out.most.x && out.least.y <= out.most.y;
  return finite ? std::optional(out) : std::nullopt;
}

}  // namespace

/// Transformations that wait to be used: making one takes longer than a tile of points, and two threads cannot share
/// one.
class WayPool {
 public:
  WayPool(Crs from, Crs to) : from_(std::move(from)), to_(std::move(to)) {}

  /// Lends one out; false where there is none.
  template <class Use>
  auto with(Use use) -> bool {
    Transformation way = borrow();
    if (!way) return false;
    use(*way);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(way));
    return true;
  }

 private:
  auto borrow() -> Transformation {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return transformation(from_, to_);
    auto way = std::move(idle_.back());
    idle_.pop_back();
    return way;
  }
  const Crs from_, to_;
  std::mutex mutex_;
  std::vector<Transformation> idle_;
};

auto number_of(std::string_view words) -> std::optional<double> {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!words.empty() && blank(words.front())) words.remove_prefix(1);
  while (!words.empty() && blank(words.back())) words.remove_suffix(1);
  return base::to_number(words);
}

auto mesh_crs(const std::string& words) -> std::optional<MeshCrs> {
  if (words.starts_with("ENU:")) return tangent_of(words);
  const GdalMessages messages;
  auto given = from_words(words);
  if (!given) return std::nullopt;
  MeshCrs crs;
  if (given->system.IsGeocentric() != 0) {
    crs.kind = MeshCrs::Kind::geocentric;
    return crs;
  }
  if (given->system.IsProjected() == 0) return std::nullopt;
  crs.wkt = wkt_of(flat(given->system).system);
  return crs;
}

auto working_crs_of(const MeshCrs& mesh, Point3 somewhere) -> std::string {
  const GdalMessages messages;
  std::array<Point3, 1> place{mesh.origin + somewhere};
  if (mesh.kind == MeshCrs::Kind::tangent)
    from_tangent(place, mesh.longitude, mesh.latitude, geocentric(mesh.longitude, mesh.latitude));
  if (mesh.kind != MeshCrs::Kind::plane) {
    if (const auto way = transformation(registered(wgs84_geocentric), registered(wgs84_with_height)))
      take_along(*way, place, true);
  } else {
    const auto own = from_wkt(mesh.wkt);
    if (!own) return {};
    if (own->system.IsProjected() != 0 && in_metres(own->system)) return name_of(own->system);
    if (const auto way = transformation(*own, registered(wgs84))) take_along(*way, place, false);
  }
  const int zone = utm_zone(place[0].x, place[0].y, wgs84);
  return zone == 0 ? std::string() : "EPSG:" + std::to_string(zone);
}

auto near_ellipsoid(Point3 p, double below) -> bool {
  constexpr double major = 6378137, minor = 6356752.314245;
  const double r = length(p);
  if (!(r > 0)) return false;
  // Along the ray from the middle; at these heights no more than a few metres from the height along the normal.
  const double equatorial = std::hypot(p.x, p.y) / r, polar = p.z / r;
  const double surface = 1 / std::hypot(equatorial / major, polar / minor);
  return r > surface - 1'000 - below && r < surface + 10'000;
}

auto WayOfMesh::between(const MeshCrs& mesh, const std::string& working, const std::string& subject)
    -> base::Result<WayOfMesh> {
  const GdalMessages messages;
  const auto unknown = [&](const std::string& what) {
    return base::error("ingest-crs-unknown", what + "; say --crs EPSG:n with a projected CRS in metres", subject);
  };
  if (working.empty()) return unknown("the mesh is placed on the earth, and the CRS to work in is not known");
  const auto to = from_words(working);
  const auto from = mesh.kind == MeshCrs::Kind::plane ? from_wkt(mesh.wkt) : registered(wgs84);
  if (!to || !from) return unknown("there is no way from the mesh's CRS to " + working);
  WayOfMesh way;
  way.mesh_ = mesh;
  if (mesh.kind == MeshCrs::Kind::plane && from->system.IsProjected() != 0) way.unit_ = from->system.GetLinearUnits();
  if (mesh.kind == MeshCrs::Kind::plane && mesh.height_unit) way.unit_ = *mesh.height_unit;
  if (mesh.kind == MeshCrs::Kind::tangent) way.touch_ = geocentric(mesh.longitude, mesh.latitude);
  if (mesh.kind != MeshCrs::Kind::plane)
    way.earth_ = std::make_shared<WayPool>(registered(wgs84_geocentric), registered(wgs84_with_height));
  const Crs source = flat(from->system), target = flat(to->system);
  if (source.system.IsSame(&target.system) != 0) return way;
  way.plane_ = std::make_shared<WayPool>(source, target);
  if (!way.plane_->with([](auto&) {}))
    return unknown("there is no way from the mesh's CRS to " + working + " (" + messages.failure() + ")");
  way.from_ = wkt_of(source.system);
  way.to_ = wkt_of(target.system);
  return way;
}

void WayOfMesh::take(std::span<Point3> points) const {
  const GdalMessages messages;
  for (auto& p : points) p = p + mesh_.origin;
  if (mesh_.kind == MeshCrs::Kind::tangent) from_tangent(points, mesh_.longitude, mesh_.latitude, touch_);
  if (earth_) earth_->with([&](auto& way) { take_along(way, points, true); });
  // What stays as it is must keep its last bit.
  if (unit_ != 1)
    for (auto& p : points) p.z *= unit_;
  // x and y only: the footprints come the same way, and heights stay above the ellipsoid they are given on.
  if (plane_) plane_->with([&](auto& way) { take_along(way, points, false); });
}

auto WayOfMesh::box_of_degrees(double west, double south, double east, double north) const -> std::optional<Box2> {
  constexpr double largest = 2;  // degrees; what is larger than a province is no reason to leave a tile out
  constexpr std::size_t side = 9;
  if (!plane_ || mesh_.kind == MeshCrs::Kind::plane || !(east - west < largest && north - south < largest))
    return std::nullopt;
  const GdalMessages messages;
  std::array<Point3, side * side> points{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t column = i % side, row = i / side;
    const double u = static_cast<double>(column) / (side - 1), v = static_cast<double>(row) / (side - 1);
    points[i] = {west + u * (east - west), south + v * (north - south), 0};
  }
  plane_->with([&](auto& way) { take_along(way, points, false); });
  Box2 box;
  for (const Point3 p : points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return std::nullopt;
    box.add(xy(p));
  }
  // Sides bulge between the points, by far less than this.
  const double reach = length(box.most - box.least) / 2;
  return box.grown(1 + reach * reach / 6'356'752);
}

auto WayOfMesh::back(const Box2& box) const -> std::optional<Box2> {
  if (mesh_.kind != MeshCrs::Kind::plane) return std::nullopt;
  const GdalMessages messages;
  auto out = std::optional(box);
  if (!to_.empty()) {
    const auto from = from_wkt(from_), to = from_wkt(to_);
    const auto way = from && to ? transformation(*to, *from) : Transformation();
    out = way ? bounds_by(*way, box) : std::nullopt;
  }
  if (out) out = Box2{out->least - xy(mesh_.origin), out->most - xy(mesh_.origin)};
  return out;
}

}  // namespace mansard::crs
