// The one place where GDAL's drivers are made known.
#pragma once

namespace mansard::crs {

/// Makes GDAL's drivers known, once in the life of the program; to be called before anything is asked of GDAL, from any
/// thread. Two threads in `GDALAllRegister` at once damage the heap (GDAL 3.6.2), also when it has been called before:
/// nothing else calls it, which tools/check_includes.cmake sees to.
void register_gdal();

}  // namespace mansard::crs
