#include "mansard/crs/gdal.hpp"

#include <gdal.h>
#include <array>
#include <mutex>

namespace mansard::crs {
namespace {

/// Services of maps and satellite images: they have no heights and no footprints, and a small XML file on disk, also as
/// the source of a VRT, makes GDAL fetch from any address (docs/decisions/0063).
constexpr std::array picture_services{"WMS",      "WMTS", "OGCAPI", "DAAS",   "PLMosaic",
                                      "PLScenes", "EEDA", "EEDAI",  "STACTA", "STACIT"};

}  // namespace

void register_gdal() {
  static std::once_flag registered;
  std::call_once(registered, [] {
    GDALAllRegister();
    for (const char* name : picture_services)
      if (GDALDriverH driver = GDALGetDriverByName(name); driver != nullptr) {
        GDALDeregisterDriver(driver);
        GDALDestroyDriver(driver);
      }
  });
}

}  // namespace mansard::crs
