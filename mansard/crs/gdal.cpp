#include "mansard/crs/gdal.hpp"

#include <gdal_priv.h>
#include <algorithm>
#include <array>
#include <mutex>

#include "mansard/crs/gdal_reach.hpp"

namespace mansard::crs {
namespace {

/// Services of maps, images, coverages and features: a small XML file on disk, also as the source of a VRT, makes GDAL
/// fetch from any address, and some keep what they fetched in the home folder (docs/decisions/0063, 0126).
constexpr std::array services{"WMS",      "WMTS", "WCS",   "WFS",    "OGCAPI", "DAAS", "PLMosaic",
                              "PLScenes", "EEDA", "EEDAI", "STACTA", "STACIT", "GMLAS"};

/// Their libraries open files, also those that a file names, without GDAL's file system, though it is said of them.
constexpr std::array own_files{"netCDF", "HDF5", "HDF5Image", "BAG"};

/// Without them there are no databases and no rasters in memory.
constexpr std::array needed{"PostgreSQL", "MEM", "Memory"};

auto reads_by_itself(GDALDriver& driver) -> bool {
  const auto is = [&](const char* name) { return EQUAL(driver.GetDescription(), name); };
  if (std::ranges::any_of(needed, is)) return false;
  return std::ranges::any_of(services, is) || std::ranges::any_of(own_files, is) ||
         driver.GetMetadataItem(GDAL_DCAP_VIRTUALIO) == nullptr;
}

}  // namespace

void register_gdal() {
  static std::once_flag registered;
  std::call_once(registered, [] {
    GDALAllRegister();
    auto& drivers = *GetGDALDriverManager();
    for (int i = drivers.GetDriverCount() - 1; i >= 0; --i)
      if (GDALDriver* driver = drivers.GetDriver(i); reads_by_itself(*driver)) {
        drivers.DeregisterDriver(driver);
        GDALDestroyDriver(driver);
      }
    // Tables of SpatiaLite can be files that a database names.
    CPLSetConfigOption("SPATIALITE_LOAD", "NO");
    confine_gdal();
  });
}

}  // namespace mansard::crs
