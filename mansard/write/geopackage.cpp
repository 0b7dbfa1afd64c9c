// GeoPackage, by GDAL: the one file of this room that knows it.
#include <ogrsf_frmts.h>
#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <mutex>
#include <optional>
#include <set>

#include "mansard/write/write.hpp"

namespace mansard::write {
namespace {

using geometry::Point2;

/// An error in GDAL's words.
auto failed(const std::string& what) -> base::Diagnostic {
  std::string words = CPLGetLastErrorMsg();
  std::ranges::replace(words, '\n', ' ');
  return base::error("write-geopackage", "GDAL cannot " + what + (words.empty() ? "" : " (" + words + ")"));
}

auto fits(const ingest::Value& value, FieldType type) -> bool {
  if (std::holds_alternative<std::monostate>(value)) return true;
  switch (type) {
    case FieldType::whole: return std::holds_alternative<std::int64_t>(value);
    case FieldType::real: return std::holds_alternative<double>(value) || std::holds_alternative<std::int64_t>(value);
    case FieldType::text: return std::holds_alternative<std::string>(value);
    case FieldType::flag: return std::holds_alternative<bool>(value);
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

auto check(const std::vector<Layer>& layers) -> base::Result<void> {
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

auto lower(std::string text) -> std::string {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// SQL tells names apart regardless of case, and GDAL's own columns come first.
auto column_names(const std::vector<Field>& fields) -> std::vector<std::string> {
  std::set<std::string> taken{"fid", "geom"};
  std::vector<std::string> names;
  for (const Field& field : fields) {
    std::string name = field.name;
    for (int n = 2; !taken.insert(lower(name)).second; ++n) name = field.name + "_" + std::to_string(n);
    names.push_back(std::move(name));
  }
  return names;
}

auto geometry_type(Shape shape) -> OGRwkbGeometryType {
  switch (shape) {
    case Shape::none: return wkbNone;
    case Shape::line: return wkbLineString;
    case Shape::lines: return wkbMultiLineString;
    case Shape::polygon: return wkbPolygon;
    case Shape::polygons: return wkbMultiPolygon;
  }
  return wkbNone;
}

/// Local coordinates to the file's.
class Pen {
 public:
  explicit Pen(const ingest::Frame& frame)
      : origin_{static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1])} {}

  [[nodiscard]] auto geometry_of(const Feature& feature, Shape shape) const -> std::unique_ptr<OGRGeometry> {
    if (shape == Shape::line && !feature.lines.empty()) return line(feature.lines.front());
    if (shape == Shape::polygon && !feature.polygons.empty()) return polygon(feature.polygons.front());
    if (!feature.lines.empty()) {
      auto all = std::make_unique<OGRMultiLineString>();
      for (const auto& points : feature.lines) all->addGeometryDirectly(line(points).release());
      return all;
    }
    if (!feature.polygons.empty()) {
      auto all = std::make_unique<OGRMultiPolygon>();
      for (const auto& one : feature.polygons) all->addGeometryDirectly(polygon(one).release());
      return all;
    }
    return nullptr;
  }

 private:
  void add(const std::vector<Point2>& points, OGRSimpleCurve& curve) const {
    for (const Point2 p : points) curve.addPoint(origin_.x + p.x, origin_.y + p.y);
  }
  [[nodiscard]] auto line(const std::vector<Point2>& points) const -> std::unique_ptr<OGRLineString> {
    auto out = std::make_unique<OGRLineString>();
    add(points, *out);
    return out;
  }
  [[nodiscard]] auto ring(const geometry::Ring& points) const -> std::unique_ptr<OGRLinearRing> {
    auto out = std::make_unique<OGRLinearRing>();
    add(points, *out);
    out->closeRings();
    return out;
  }
  [[nodiscard]] auto polygon(const geometry::Polygon& one) const -> std::unique_ptr<OGRPolygon> {
    auto out = std::make_unique<OGRPolygon>();
    out->addRingDirectly(ring(one.outer).release());
    for (const auto& hole : one.holes) out->addRingDirectly(ring(hole).release());
    return out;
  }

  Point2 origin_;
};

/// The frame's CRS. GeoPackage's own "undefined Cartesian" system where there is none: GDAL knows it by its name.
auto crs_of(const ingest::Frame& frame) -> std::optional<OGRSpatialReference> {
  OGRSpatialReference crs;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const OGRErr failure =
      frame.crs.empty()
          ? crs.SetLocalCS("Undefined Cartesian SRS")
          : crs.SetFromUserInput(frame.crs.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get());
  if (failure != OGRERR_NONE) return std::nullopt;
  return crs;
}

auto add_field(const std::string& name, FieldType type, OGRLayer& table) -> bool {
  static constexpr OGRFieldType types[] = {OFTInteger64, OFTReal, OFTString, OFTInteger};
  OGRFieldDefn definition(name.c_str(), types[static_cast<std::size_t>(type)]);
  if (type == FieldType::flag) definition.SetSubType(OFSTBoolean);
  return table.CreateField(&definition) == OGRERR_NONE;
}

void set(OGRFeature& row, int column, const ingest::Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) row.SetField(column, text->c_str());
  else if (const auto* whole = std::get_if<std::int64_t>(&value)) row.SetField(column, static_cast<GIntBig>(*whole));
  else if (const auto* number = std::get_if<double>(&value)) row.SetField(column, *number);
  else if (const auto* flag = std::get_if<bool>(&value)) row.SetField(column, *flag ? 1 : 0);
  else row.SetFieldNull(column);
}

auto add(const Layer& layer, const Pen& pen, const OGRSpatialReference& crs, GDALDataset& file) -> base::Result<void> {
  CPLStringList options;
  options.SetNameValue("DESCRIPTION", layer.meaning.c_str());
  // Layers without geometry take no CRS; const was added to this argument after GDAL 3.6.
  OGRSpatialReference copy(crs);
  OGRLayer* table = file.CreateLayer(layer.name.c_str(), layer.shape == Shape::none ? nullptr : &copy,
                                     geometry_type(layer.shape), options.List());
  if (table == nullptr) return failed("make the layer " + layer.name);
  const auto names = column_names(layer.fields);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!add_field(names[i], layer.fields[i].type, *table)) return failed("make the field " + names[i]);
  for (const Feature& feature : layer.features) {
    OGRFeature row(table->GetLayerDefn());
    for (std::size_t i = 0; i < feature.values.size(); ++i) set(row, static_cast<int>(i), feature.values[i]);
    if (auto geometry = pen.geometry_of(feature, layer.shape)) row.SetGeometryDirectly(geometry.release());
    if (table->CreateFeature(&row) != OGRERR_NONE) return failed("write a feature of " + layer.name);
  }
  return {};
}

/// A file in memory, gone at the end of the scope.
class MemoryFile {
 public:
  MemoryFile() {
    static std::atomic<unsigned> count{0};
    name_ = "/vsimem/mansard-" + std::to_string(count++) + ".gpkg";
  }
  MemoryFile(const MemoryFile&) = delete;
  auto operator=(const MemoryFile&) -> MemoryFile& = delete;
  ~MemoryFile() { VSIUnlink(name_.c_str()); }

  [[nodiscard]] auto name() const -> const char* { return name_.c_str(); }
  [[nodiscard]] auto bytes() const -> std::string {
    vsi_l_offset size = 0;
    const auto* data = reinterpret_cast<const char*>(VSIGetMemFileBuffer(name_.c_str(), &size, FALSE));
    return data == nullptr ? std::string() : std::string(data, static_cast<std::size_t>(size));
  }

 private:
  std::string name_;
};

}  // namespace

auto geopackage(const std::vector<Layer>& layers, const ingest::Frame& frame) -> base::Result<std::string> {
  if (const auto sound = check(layers); !sound) return sound.error();
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  CPLErrorReset();
  const CPLConfigOptionSetter date("OGR_CURRENT_DATE", "1970-01-01T00:00:00.000Z", false);  // of this thread only

  const auto crs = crs_of(frame);
  if (!crs) return failed("understand the CRS " + frame.crs);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  if (driver == nullptr) return failed("find its GPKG driver");
  const MemoryFile memory;
  GDALDatasetUniquePtr file(driver->Create(memory.name(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!file || file->StartTransaction() != OGRERR_NONE) return failed("start the file");
  const Pen pen(frame);
  for (const Layer& layer : layers)
    if (const auto added = add(layer, pen, *crs, *file); !added) return added.error();
  if (file->CommitTransaction() != OGRERR_NONE) return failed("finish the file");
  CPLErrorReset();
  file.reset();  // writes the extents, and the spatial indexes that are still due
  auto bytes = memory.bytes();
  if (CPLGetLastErrorType() >= CE_Failure || bytes.empty()) return failed("close the file");
  return bytes;
}

}  // namespace mansard::write
