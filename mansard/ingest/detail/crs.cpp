#include "mansard/ingest/detail/crs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "mansard/base/text.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/crs/utm.hpp"

namespace mansard::ingest::detail {
namespace {

auto largest_side(const std::vector<formats::RawFeature>& features) -> double {
  double largest = 0;
  for (const auto& feature : features)
    if (const auto box = bounds(feature); !box.empty())
      largest = std::max({largest, box.most.x - box.least.x, box.most.y - box.least.y});
  return largest;
}

/// GeoJSON without "crs" is in degrees by its standard. It cannot be if it lies beyond them; and it is not if it lies
/// on the mesh (which is in metres) and some building of it is larger than 1, which would be a hundred kilometres.
auto looks_local(const formats::FeatureFile& file, const geometry::Box2& mesh) -> bool {
  const geometry::Box2 box = bounds(file.features);
  if (box.empty()) return false;
  if (box.least.x < -180 || box.most.x > 180 || box.least.y < -90 || box.most.y > 90) return true;
  return box.overlaps(mesh) && largest_side(file.features) >= 1;
}

auto utm_crs(const OGRSpatialReference& geographic, const geometry::Box2& box, const crs::GdalMessages& messages,
             const std::string& subject) -> base::Result<crs::Crs> {
  const geometry::Point2 centre = 0.5 * (box.least + box.most);
  const char* code = geographic.GetAuthorityCode("GEOGCS");
  const auto number = base::to_integer(code != nullptr ? code : "").value_or(4326);
  const int zone = crs::utm_zone(centre.x, centre.y, static_cast<int>(number));
  if (zone == 0)
    return base::error("ingest-crs-unknown",
                       "the footprints are in degrees where there is no UTM zone; say --crs EPSG:n", subject);
  crs::Crs crs;
  if (crs.system.importFromEPSG(zone) != OGRERR_NONE)
    return base::error("ingest-crs-unknown",
                       "EPSG:" + std::to_string(zone) + ", the UTM zone of the footprints, could not be looked up" +
                           (messages.failure().empty() ? std::string() : " (" + messages.failure() + ")") +
                           "; say --crs EPSG:n",
                       subject);
  return crs;
}

auto without_crs(const std::string& option, const std::string& subject, bool geojson) -> base::Result<Way> {
  const std::string why = geojson ? "this GeoJSON names no CRS, and its coordinates are not degrees"
                                  : "the file names no CRS of its coordinates";
  Way way;
  if (option.empty()) {
    way.warnings.push_back(base::warning(
        "ingest-crs-local",
        why + "; they are taken as metres in the frame of the mesh. Give --crs EPSG:n if they have a CRS", subject));
    return way;
  }
  const auto wanted = crs::wanted_crs(option);
  if (!wanted) return wanted.error();
  way.name = crs::name_of(wanted->system);
  way.warnings.push_back(base::warning("ingest-crs-local", why + "; they are taken to be in " + way.name, subject));
  return way;
}

/// A place in a projected CRS, as its metres are on the ground there.
struct Scale {
  double along_x = 1, along_y = 1;     ///< metres on the ground per metre of the CRS
  double longitude = 0, latitude = 0;  ///< degrees
};

/// From half a hundred metres to all four sides; nothing where the projection does not reach.
auto scale_at(const crs::Crs& projected, geometry::Point2 place) -> std::optional<Scale> {
  crs::Crs earth;
  if (earth.system.CopyGeogCSFrom(&projected.system) != OGRERR_NONE) return std::nullopt;
  earth.system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const auto way = crs::transformation(projected, earth);
  if (!way) return std::nullopt;
  constexpr double step = 50;
  std::array<double, 4> x{place.x - step, place.x + step, place.x, place.x};
  std::array<double, 4> y{place.y, place.y, place.y - step, place.y + step};
  if (way->Transform(4, x.data(), y.data()) == 0) return std::nullopt;
  const double unit = earth.system.GetAngularUnits();  // degrees, grads
  for (auto& c : x) c *= unit;
  for (auto& c : y) c *= unit;
  const double flattening = earth.system.GetInvFlattening() == 0 ? 0 : 1 / earth.system.GetInvFlattening();
  const double squared = flattening * (2 - flattening);
  const double latitude = 0.5 * (y[2] + y[3]), sine = std::sin(latitude);
  const double across = earth.system.GetSemiMajor() / std::sqrt(1 - squared * sine * sine);
  const double along = across * (1 - squared) / (1 - squared * sine * sine);
  const auto distance = [&](int a, int b) {
    const double turned = std::remainder(x[b] - x[a], 2 * std::numbers::pi);
    return std::hypot(across * std::cos(latitude) * turned, along * (y[b] - y[a]));
  };
  const double degree = std::numbers::pi / 180;
  const Scale scale{distance(0, 1) / (2 * step), distance(2, 3) / (2 * step), x[2] / degree, latitude / degree};
  if (!std::isfinite(scale.along_x) || !std::isfinite(scale.along_y)) return std::nullopt;
  return scale;
}

/// Web maps' Mercator, and zones far from where they are made for: lengths in plan are not those of heights.
void warn_of_scale(const formats::FeatureFile& file, const crs::Crs& source, const crs::Crs& working,
                   const std::string& subject, Way& way) {
  constexpr double tolerable = 0.01;  // no survey's projection is off by a tenth of that where it is used
  const auto first = std::ranges::find_if(file.features, [](const auto& feature) { return !bounds(feature).empty(); });
  if (first == file.features.end()) return;
  const geometry::Box2 box = bounds(*first);
  geometry::Point2 place = 0.5 * (box.least + box.most);
  if (!way.to.empty()) {
    const auto there = crs::transformation(source, working);
    if (!there || there->Transform(1, &place.x, &place.y) == 0) return;
  }
  const auto scale = scale_at(working, place);
  if (!scale) return;
  const bool worse = std::abs(scale->along_x - 1) > std::abs(scale->along_y - 1);
  const double metre = worse ? scale->along_x : scale->along_y;
  if (std::abs(metre - 1) <= tolerable) return;
  const int zone = crs::utm_zone(scale->longitude, scale->latitude, 4326);
  way.warnings.push_back(base::warning(
      "ingest-crs-scale",
      "a metre of " + crs::title_of(working.system) + " is " + base::to_text(metre, 2) +
          " m on the ground here, and heights are true metres: shapes come out distorted; say --crs with a system made "
          "for the place" +
          (zone == 0 ? std::string() : ", as EPSG:" + std::to_string(zone)),
      subject));
}

}  // namespace

auto choose_way(const formats::FeatureFile& file, const std::string& option, const geometry::Box2& mesh,
                const std::string& mesh_crs, const std::string& subject) -> base::Result<Way> {
  const crs::GdalMessages messages;
  if (option == "local") return Way{};
  if (!file.crs_failure.empty() && option.empty())
    return base::error("ingest-crs-unknown",
                       "the CRS that the footprints name is not known (" + file.crs_failure +
                           "); correct it, or say --crs EPSG:n, or --crs local for the mesh's frame",
                       subject);
  if (!file.crs_failure.empty() || file.crs.empty()) return without_crs(option, subject, false);
  if (file.assumed_crs && looks_local(file, mesh)) return without_crs(option, subject, true);

  const auto source = crs::from_wkt(file.crs);
  if (OGRSpatialReference all; !source && all.importFromWkt(file.crs.c_str()) == OGRERR_NONE)
    if (const auto grid = crs::grid_elsewhere(all))
      return base::error(
          "ingest-crs-unknown",
          "the CRS of the footprints refers to the grid '" + base::on_one_line(*grid) +
              "' by a path or an address, which is not opened; say --crs EPSG:n after reprojecting them, "
              "or give the grid by its name alone and install it among PROJ's",
          subject);
  if (!source || (source->system.IsGeographic() == 0 && source->system.IsProjected() == 0))
    return base::error("ingest-crs-unknown",
                       "the CRS of the footprints is neither projected nor geographic, or not known" +
                           (messages.failure().empty() ? std::string() : " (" + messages.failure() + ")") +
                           "; reproject them, or say --crs local if they are metres in the mesh's frame",
                       subject);
  std::optional<crs::Crs> target;
  if (!option.empty()) {
    auto wanted = crs::wanted_crs(option);
    if (!wanted) return wanted.error();
    target = std::move(*wanted);
  } else if (source->system.IsProjected() != 0 && crs::in_metres(source->system)) {
    Way way{crs::name_of(source->system), {}, {}, {}};
    const crs::Crs stays = crs::flat(source->system);
    warn_of_scale(file, stays, stays, subject, way);
    return way;
  } else if (!mesh_crs.empty()) {
    target = crs::from_words(mesh_crs);
  } else if (source->system.IsProjected() != 0) {
    return base::error(
        "ingest-crs-unit",
        "the CRS of the footprints (" + crs::title_of(source->system) +
            ") is not in metres; say --crs EPSG:n with a projected CRS that is, and bring the mesh there",
        subject);
  } else {
    auto zone = utm_crs(crs::flat(source->system).system, bounds(file.features), messages, subject);
    if (!zone) return zone.failure();
    target = std::move(*zone);
  }

  if (!target) return base::error("ingest-crs-unknown", "the mesh's CRS is not known; say --crs EPSG:n", subject);
  Way way;
  way.name = crs::name_of(target->system);
  const crs::Crs from = crs::flat(source->system), to = crs::flat(target->system);
  if (from.system.IsSame(&to.system) == 0) {
    way.from = crs::wkt_of(from.system);
    way.to = crs::wkt_of(to.system);
  }
  warn_of_scale(file, from, to, subject, way);
  return way;
}

auto way_without_features(const std::string& option, const std::string& mesh_crs) -> base::Result<Way> {
  const crs::GdalMessages messages;
  Way way;
  if (option.empty()) way.name = mesh_crs;
  if (option.empty() || option == "local") return way;
  const auto wanted = crs::wanted_crs(option);
  if (!wanted) return wanted.error();
  way.name = crs::name_of(wanted->system);
  return way;
}

auto go(const Way& way, std::vector<formats::RawFeature>& features, const std::string& subject) -> base::Result<void> {
  if (way.to.empty()) return {};
  const crs::GdalMessages messages;
  const auto from = crs::from_wkt(way.from), to = crs::from_wkt(way.to);
  const auto way_there = from && to ? crs::transformation(*from, *to) : crs::Transformation();
  if (!way_there)
    return base::error("ingest-crs-unknown",
                       "there is no way from the footprints' CRS to " + way.name + " (" + messages.failure() +
                           "); say --crs EPSG:n with another one",
                       subject);
  constexpr double lost = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> x, y;
  std::vector<int> done;
  for (auto& feature : features)
    for (auto& part : feature.parts)
      for (auto& ring : part) {
        x.clear();
        y.clear();
        for (const auto p : ring) {
          x.push_back(p.x);
          y.push_back(p.y);
        }
        done.assign(ring.size(), 0);
        if (!ring.empty())
          way_there->Transform(static_cast<int>(ring.size()), x.data(), y.data(), nullptr, nullptr, done.data());
        for (std::size_t i = 0; i < ring.size(); ++i)
          ring[i] = done[i] != 0 ? geometry::Point2{x[i], y[i]} : geometry::Point2{lost, lost};
      }
  return {};
}

}  // namespace mansard::ingest::detail
