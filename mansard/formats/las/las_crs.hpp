// Where a LAS file says it is: WKT, or GeoTIFF keys.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mansard/crs/mesh_crs.hpp"
#include "mansard/formats/las/las_header.hpp"

namespace mansard::formats {

struct CloudCrs {
  crs::MeshCrs crs;
  double unit = 1;    ///< m, of x and y; 0 for degrees
  std::string title;  ///< "EPSG:28992 Amersfoort / RD New"
};

/// WKT 1 or 2, compound or not. None where it is not a plane or geographic CRS.
[[nodiscard]] auto crs_of_wkt(std::string_view wkt) -> std::optional<CloudCrs>;

/// By the WKT record where the header's flag says so or where there are no GeoTIFF keys, else by the keys; where one
/// cannot be used, by the other. A unit that the keys state beside the code of a CRS overrides that of the CRS. None
/// where there is no record; a record that cannot be used adds the warning "ingest-points-crs".
[[nodiscard]] auto crs_of_las(LasHeader& header, const std::string& name) -> std::optional<CloudCrs>;

}  // namespace mansard::formats
