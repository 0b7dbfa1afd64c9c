#include "mansard/derive/detail/outline.hpp"

#include <cpl_error.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>
#include <memory>

#include "mansard/crs/gdal.hpp"

namespace mansard::derive::detail {
namespace {

struct Close {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Close>;

/// Nothing that the library says reaches the terminal.
class Quiet {
 public:
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  Quiet(const Quiet&) = delete;
  auto operator=(const Quiet&) -> Quiet& = delete;
  ~Quiet() { CPLPopErrorHandler(); }
};

auto failed() -> base::Diagnostic {
  return base::error("derive-outline",
                     std::string("the outlines cannot be drawn (") + CPLGetLastErrorMsg() + "); raise derive.cell");
}

auto created(const char* driver_name, const Place& place, int bands) -> Dataset {
  auto* driver = GetGDALDriverManager()->GetDriverByName(driver_name);
  if (driver == nullptr) return nullptr;
  const bool raster = bands > 0;
  return Dataset(driver->Create("", raster ? static_cast<int>(place.columns) : 0,
                                raster ? static_cast<int>(place.rows) : 0, bands, raster ? GDT_Int32 : GDT_Unknown,
                                nullptr));
}

auto ring_of(const OGRLinearRing& ring, const Place& place) -> geometry::Ring {
  geometry::Ring out;
  for (int i = 0; i + 1 < ring.getNumPoints(); ++i)
    out.push_back({place.corner.x + ring.getX(i) * place.cell, place.corner.y + ring.getY(i) * place.cell});
  return out;
}

auto polygon_of(const OGRPolygon& polygon, const Place& place) -> geometry::Polygon {
  geometry::Polygon out{ring_of(*polygon.getExteriorRing(), place), {}};
  for (int i = 0; i < polygon.getNumInteriorRings(); ++i)
    out.holes.push_back(ring_of(*polygon.getInteriorRing(i), place));
  return geometry::oriented(std::move(out));
}

}  // namespace

auto polygons_of(const Place& place, const std::vector<std::int32_t>& of, std::size_t count)
    -> base::Result<std::vector<std::vector<geometry::Polygon>>> {
  const Quiet quiet;
  crs::register_gdal();
  const auto raster = created("MEM", place, 1), vector = created("Memory", place, 0);
  if (!raster || !vector) return failed();
  auto* band = raster->GetRasterBand(1);
  auto* layer = vector->CreateLayer("outlines", nullptr, wkbPolygon, nullptr);
  OGRFieldDefn field("building", OFTInteger);
  if (layer == nullptr || layer->CreateField(&field) != OGRERR_NONE) return failed();
  // Row 0 is the southern one here: without a georeference, y of the outlines grows with the rows.
  std::vector<std::int32_t> numbers = of;
  if (band->RasterIO(GF_Write, 0, 0, static_cast<int>(place.columns), static_cast<int>(place.rows), numbers.data(),
                     static_cast<int>(place.columns), static_cast<int>(place.rows), GDT_Int32, 0, 0) != CE_None ||
      GDALPolygonize(band, band, layer, 0, nullptr, nullptr, nullptr) != CE_None)
    return failed();
  std::vector<std::vector<geometry::Polygon>> out(count);
  for (const auto& feature : *layer) {
    const auto number = feature->GetFieldAsInteger(0);
    const auto* shape = feature->GetGeometryRef();
    if (number <= 0 || shape == nullptr || wkbFlatten(shape->getGeometryType()) != wkbPolygon) continue;
    out[static_cast<std::size_t>(number)].push_back(polygon_of(*shape->toPolygon(), place));
  }
  return out;
}

}  // namespace mansard::derive::detail
