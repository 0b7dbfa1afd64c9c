// GeoTIFF, by GDAL.
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <algorithm>
#include <atomic>
#include <limits>

#include "mansard/crs/gdal.hpp"
#include "mansard/formats/scan.hpp"

namespace mansard::formats {
namespace {

auto failed(const std::string& what) -> base::Diagnostic {
  std::string words = CPLGetLastErrorMsg();
  std::ranges::replace(words, '\n', ' ');
  return base::error("write-geotiff", "GDAL cannot " + what + (words.empty() ? "" : " (" + words + ")"));
}

/// Rows from the north, as files have them.
auto north_up(const Raster& raster) -> std::vector<float> {
  std::vector<float> out;
  out.reserve(raster.values.size());
  for (std::size_t row = raster.rows; row-- > 0;) {
    const auto line = raster.values.subspan(row * raster.columns, raster.columns);
    out.insert(out.end(), line.begin(), line.end());
  }
  return out;
}

auto bytes_of(const Raster& raster, const model::Frame& frame, const std::string& name) -> base::Result<std::string> {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) return failed("find its GTiff driver");
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "3");  // of floats
  options.SetNameValue("NUM_THREADS", "1");
  const auto columns = static_cast<int>(raster.columns), rows = static_cast<int>(raster.rows);
  GDALDatasetUniquePtr file(driver->Create(name.c_str(), columns, rows, 1, GDT_Float32, options.List()));
  if (!file) return failed("start the file");
  const double west = raster.centre.x - raster.cell / 2 + static_cast<double>(frame.origin[0]);
  const double north =
      raster.centre.y + (static_cast<double>(raster.rows) - 0.5) * raster.cell + static_cast<double>(frame.origin[1]);
  std::array<double, 6> transform{west, raster.cell, 0, north, 0, -raster.cell};
  if (file->SetGeoTransform(transform.data()) != CE_None) return failed("place the raster");
  if (!frame.crs.empty()) {
    OGRSpatialReference crs;
    if (crs.SetFromUserInput(frame.crs.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
            OGRERR_NONE ||
        file->SetSpatialRef(&crs) != CE_None)
      return failed("understand the CRS " + frame.crs);
  }
  GDALRasterBand* band = file->GetRasterBand(1);
  auto values = north_up(raster);
  if (band->SetNoDataValue(std::numeric_limits<double>::quiet_NaN()) != CE_None ||
      band->RasterIO(GF_Write, 0, 0, columns, rows, values.data(), columns, rows, GDT_Float32, 0, 0) != CE_None)
    return failed("write the values");
  file.reset();
  vsi_l_offset size = 0;
  const auto* data = reinterpret_cast<const char*>(VSIGetMemFileBuffer(name.c_str(), &size, FALSE));
  if (data == nullptr || size == 0) return failed("close the file");
  return std::string(data, static_cast<std::size_t>(size));
}

}  // namespace

auto geotiff(const Raster& raster, const model::Frame& frame) -> base::Result<std::string> {
  constexpr std::size_t most = 1U << 20U;  // cells a side
  if (raster.columns == 0 || raster.rows == 0 || raster.columns > most || raster.rows > most)
    return base::error("write-geotiff", "there are no cells, or more than a million along a side");
  crs::register_gdal();
  static std::atomic<unsigned> count{0};
  const std::string name = "/vsimem/mansard-" + std::to_string(count++) + ".tif";
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  CPLErrorReset();
  auto bytes = bytes_of(raster, frame, name);
  VSIUnlink(name.c_str());
  return bytes;
}

}  // namespace mansard::formats
