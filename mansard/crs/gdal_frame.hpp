// What every file that GDAL writes here needs of it.
#pragma once

#include <ogr_spatialref.h>
#include <optional>
#include <string>

#include "mansard/model/frame.hpp"

namespace mansard::crs {

/// The library's last complaint in brackets, on one line, with a blank before it; nothing where there is none.
[[nodiscard]] auto gdal_words() -> std::string;

/// The frame's CRS, x before y. GeoPackage's own "undefined Cartesian" system where there is none: GDAL knows it by its
/// name. None where the CRS is not understood.
[[nodiscard]] auto crs_of(const model::Frame& frame) -> std::optional<OGRSpatialReference>;

}  // namespace mansard::crs
