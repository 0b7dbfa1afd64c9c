// Any layers as a GeoPackage in memory.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include "mansard/crs/gdal.hpp"
#include "mansard/formats/geopackage/geopackage_tables.hpp"
#include "mansard/formats/geopackage/qgis_styles.hpp"
#include "mansard/formats/image/memory_file.hpp"

namespace mansard::formats {
namespace {

using geometry::Point2;

auto fits(const model::Value& value, FieldType type) -> bool {
  if (std::holds_alternative<std::monostate>(value)) return true;
  switch (type) {
    case FieldType::integer: return std::holds_alternative<std::int64_t>(value);
    case FieldType::real: return std::holds_alternative<double>(value) || std::holds_alternative<std::int64_t>(value);
    case FieldType::string: return std::holds_alternative<std::string>(value);
    case FieldType::boolean: return std::holds_alternative<bool>(value);
  }
  return false;
}

auto is_finite(const std::vector<Point2>& points) -> bool {
  return std::ranges::all_of(points, [](Point2 p) { return std::isfinite(p.x) && std::isfinite(p.y); });
}

auto is_sound(const Feature& feature, Shape shape) -> bool {
  const std::size_t most_lines = shape == Shape::line ? 1 : shape == Shape::lines ? feature.lines.size() : 0;
  const std::size_t most_polygons = shape == Shape::polygon    ? 1
                                    : shape == Shape::polygons ? feature.polygons.size()
                                                               : 0;
  return feature.lines.size() <= most_lines && feature.polygons.size() <= most_polygons &&
         std::ranges::all_of(feature.lines, [](const auto& line) { return line.size() >= 2 && is_finite(line); }) &&
         std::ranges::all_of(feature.polygons, [](const geometry::Polygon& p) {
           return p.outer.size() >= 3 && is_finite(p.outer) && std::ranges::all_of(p.holes, is_finite);
         });
}

}  // namespace

auto detail::check_layers(const std::vector<Layer>& layers) -> base::Result<void> {
  std::set<std::string> names;
  for (const Layer& layer : layers) {
    const auto broken = [&](const std::string& what) { return base::error("write-layer", what, layer.name); };
    if (layer.name.empty() || !names.insert(layer.name).second) return broken("its name is empty or taken");
    for (std::size_t i = 0; i < layer.features.size(); ++i) {
      const Feature& feature = layer.features[i];
      const std::string which = "feature " + std::to_string(i) + " ";
      if (!is_sound(feature, layer.shape)) return broken(which + "has a geometry that is broken or of another shape");
      if (!std::ranges::equal(feature.values, layer.fields, fits, {}, &Field::type))
        return broken(which + "has values that do not fit the fields");
    }
  }
  return {};
}

namespace {

/// A name that no other GeoPackage in memory has.
auto name_in_memory() -> std::string {
  static std::atomic<unsigned> count{0};
  return "/vsimem/mansard-" + std::to_string(count++) + ".gpkg";
}

}  // namespace

auto geopackage(const std::vector<Layer>& layers, const model::Frame& frame) -> base::Result<std::string> {
  if (const auto sound = detail::check_layers(layers); !sound) return sound.error();
  crs::register_gdal();
  const detail::GeopackageManners manners;
  const auto crs = crs::crs_of(frame);
  if (!crs) return detail::geopackage_failure("understand the CRS " + frame.crs);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  if (driver == nullptr) return detail::geopackage_failure("find its GPKG driver");
  const MemoryFile memory(name_in_memory());
  GDALDatasetUniquePtr file(driver->Create(memory.name(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!file || file->StartTransaction() != OGRERR_NONE) return detail::geopackage_failure("start the file");
  const detail::Pen pen(frame);
  for (const Layer& layer : layers)
    if (const auto added = detail::add_layer(layer, pen, *crs, *file); !added) return added.error();
  if (const auto styled = detail::add_styles(*file); !styled) return styled.error();
  if (file->CommitTransaction() != OGRERR_NONE) return detail::geopackage_failure("finish the file");
  CPLErrorReset();
  file.reset();  // writes the extents, and the spatial indexes that are still due
  auto bytes = memory.bytes();
  if (CPLGetLastErrorType() >= CE_Failure || bytes.empty()) return detail::geopackage_failure("close the file");
  return bytes;
}

}  // namespace mansard::formats
