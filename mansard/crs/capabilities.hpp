// What the libraries of this machine can do: for `mansard doctor`.
#pragma once

#include <string>
#include <vector>

namespace mansard::crs {

struct Capabilities {
  std::string gdal, proj;               ///< versions
  bool has_register = false;            ///< whether PROJ has its database, with the EPSG register
  std::vector<std::string> proj_paths;  ///< folders with PROJ's data that exist
  std::vector<std::string> geoids;      ///< files of geoid grids in them, sorted
  bool network = false;                 ///< whether PROJ downloads grids
};
[[nodiscard]] auto capabilities() -> Capabilities;
/// Whether GDAL has a driver: "GPKG", "PostgreSQL".
[[nodiscard]] auto has_driver(const std::string& name) -> bool;

}  // namespace mansard::crs
