#include "mansard/formats/source.hpp"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>
#include <algorithm>
#include <cmath>

#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/raster/raster.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

auto open(const fs::path& path, unsigned int kind) -> GDALDatasetUniquePtr {
  crs::register_gdal();
  // The GML driver would write a .gfs file beside its input.
  const CPLStringList quiet(CSLSetNameValue(nullptr, "WRITE_GFS", "NO"));
  const CPLStringList none;
  const std::string name = inside_of(name_for_gdal(path));
  GDALDriverH driver = GDALIdentifyDriverEx(name.c_str(), kind, nullptr, nullptr);
  const bool gml = driver != nullptr && std::string_view(GDALGetDescription(driver)) == "GML";
  return GDALDatasetUniquePtr(GDALDataset::Open(name.c_str(), kind | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                                                gml ? quiet.List() : none.List(), nullptr));
}

auto name_of(const OGRSpatialReference* crs) -> std::string {
  if (crs == nullptr) return {};
  const char* authority = crs->GetAuthorityName(nullptr);
  const char* code = crs->GetAuthorityCode(nullptr);
  if (authority != nullptr && code != nullptr) return std::string(authority) + ":" + code;
  const char* name = crs->GetName();
  return name == nullptr ? std::string() : name;
}

auto layer_of(OGRLayer& layer) -> SourceLayer {
  SourceLayer out;
  out.name = layer.GetName();
  out.geometry = OGRGeometryTypeToName(layer.GetGeomType());
  out.crs = name_of(layer.GetSpatialRef());
  if (const auto count = layer.GetFeatureCount(TRUE); count >= 0) out.features = count;
  OGREnvelope box;
  if (layer.GetGeomType() != wkbNone && layer.GetExtent(&box, TRUE) == OGRERR_NONE && box.IsInit() != 0)
    out.extent = SourceExtent{box.MinX, box.MinY, box.MaxX, box.MaxY};
  const OGRFeatureDefn& fields = *layer.GetLayerDefn();
  for (int i = 0; i < fields.GetFieldCount(); ++i)
    out.fields.emplace_back(fields.GetFieldDefn(i)->GetNameRef(),
                            OGRFieldDefn::GetFieldTypeName(fields.GetFieldDefn(i)->GetType()));
  return out;
}

}  // namespace

auto vector_source(const fs::path& path) -> base::Result<VectorSource> {
  if (path.string().find(':') == std::string::npos && !is_there(path)) return why_missing(path);
  const crs::GdalMessages messages;
  const Confined confined(path);  // layers of some formats are opened when they are asked for
  const auto dataset = open(path, GDAL_OF_VECTOR);
  if (auto done = confined.check(); !done) return done.error();
  if (!dataset)
    return base::error("ingest-footprints-format",
                       "not a readable vector file (" + messages.failure() + "); check what it is", path.string());
  VectorSource out;
  out.driver = dataset->GetDriverName();
  for (auto* layer : dataset->GetLayers()) {
    auto& one = out.layers.emplace_back(layer_of(*layer));
    if (auto done = confined.check(); !done) return done.error();
    // Degrees are only GDAL's guess where a GeoJSON names no CRS; reading it makes nothing of them beyond the earth.
    const auto& box = one.extent;
    if (out.driver == "GeoJSON" && one.crs == "EPSG:4326" && box &&
        ((*box)[0] < -180 || (*box)[2] > 180 || (*box)[1] < -90 || (*box)[3] > 90))
      one.crs.clear();
  }
  return out;
}

auto raster_source(const fs::path& path) -> base::Result<RasterSource> {
  if (!is_there(path)) return why_missing(path);
  const crs::GdalMessages messages;
  const Confined confined(path);
  const auto dataset = open(path, GDAL_OF_RASTER);
  if (auto done = confined.check(); !done) return done.error();
  if (!dataset)
    return base::error("ingest-raster", "not a readable raster (" + messages.failure() + "); check what it is",
                       path.string());
  RasterSource out;
  out.driver = dataset->GetDriverName();
  out.crs = name_of(dataset->GetSpatialRef());
  out.columns = dataset->GetRasterXSize();
  out.rows = dataset->GetRasterYSize();
  out.bands = dataset->GetRasterCount();
  std::array<double, 6> t{0, 1, 0, 0, 0, 1};
  dataset->GetGeoTransform(t.data());
  out.cell = {std::hypot(t[1], t[4]), std::hypot(t[2], t[5])};
  const auto n = static_cast<double>(out.columns), m = static_cast<double>(out.rows);
  const auto [x0, x1] = std::minmax({t[0], t[0] + n * t[1], t[0] + m * t[2], t[0] + n * t[1] + m * t[2]});
  const auto [y0, y1] = std::minmax({t[3], t[3] + n * t[4], t[3] + m * t[5], t[3] + n * t[4] + m * t[5]});
  out.extent = {x0, y0, x1, y1};
  if (out.bands > 0) {
    auto* band = dataset->GetRasterBand(1);
    int given = 0;
    const double value = band->GetNoDataValue(&given);
    if (given != 0) out.nodata = value;
    out.unit = band->GetUnitType();
  }
  return out;
}

auto named_as_raster(const fs::path& path) -> bool { return is_raster(path); }

}  // namespace mansard::formats
