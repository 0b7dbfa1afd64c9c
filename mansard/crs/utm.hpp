// The UTM zone of a place.
#pragma once

namespace mansard::crs {

/// EPSG code of the UTM zone of a place in degrees on the datum of the geographic CRS with that EPSG code (WGS 84 for
/// all but ETRS89 and NAD83, which have zones of their own); 0 beyond the zones' latitudes.
[[nodiscard]] auto utm_zone(double longitude, double latitude, int geographic) -> int;

}  // namespace mansard::crs
