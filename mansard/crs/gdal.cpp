#include "mansard/crs/gdal.hpp"

#include <gdal.h>
#include <mutex>

namespace mansard::crs {

void register_gdal() {
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
}

}  // namespace mansard::crs
