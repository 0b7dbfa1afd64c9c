// The layers of a GeoPackage read back, as they are given to a writer.
#include "mansard/formats/geopackage/geopackage_tables.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Point2;

auto shape_of(OGRwkbGeometryType type) -> std::optional<Shape> {
  switch (type) {  // flat ones alone: a Layer has no heights
    case wkbNone: return Shape::none;
    case wkbLineString: return Shape::line;
    case wkbMultiLineString: return Shape::lines;
    case wkbPolygon: return Shape::polygon;
    case wkbMultiPolygon: return Shape::polygons;
    default: return std::nullopt;
  }
}

auto type_of(const OGRFieldDefn& field) -> std::optional<FieldType> {
  switch (field.GetType()) {
    case OFTInteger: return field.GetSubType() == OFSTBoolean ? FieldType::boolean : FieldType::integer;
    case OFTInteger64: return FieldType::integer;
    case OFTReal: return FieldType::real;
    case OFTString: return FieldType::string;
    default: return std::nullopt;
  }
}

auto value_of(const OGRFeature& row, int column, FieldType type) -> model::Value {
  if (row.IsFieldSetAndNotNull(column) == 0) return {};
  switch (type) {
    case FieldType::boolean: return row.GetFieldAsInteger(column) != 0;
    case FieldType::integer: return static_cast<std::int64_t>(row.GetFieldAsInteger64(column));
    case FieldType::real: return row.GetFieldAsDouble(column);
    case FieldType::string: break;
  }
  return std::string(row.GetFieldAsString(column));
}

/// Geometry in the local frame. Taking a whole-metre origin off and adding it again gives the same doubles.
class Reader {
 public:
  explicit Reader(const model::Frame& frame)
      : x_(static_cast<double>(frame.origin[0])), y_(static_cast<double>(frame.origin[1])) {}

  /// False for what a Feature cannot hold.
  auto read(const OGRGeometry& geometry, Feature& feature) const -> bool {
    if (geometry.IsEmpty() != 0) return true;
    switch (geometry.getGeometryType()) {
      case wkbLineString: feature.lines.push_back(points(*geometry.toLineString())); return true;
      case wkbPolygon: feature.polygons.push_back(polygon(*geometry.toPolygon())); return true;
      case wkbMultiLineString:
        for (const auto* line : geometry.toMultiLineString()) feature.lines.push_back(points(*line));
        return true;
      case wkbMultiPolygon:
        for (const auto* one : geometry.toMultiPolygon()) feature.polygons.push_back(polygon(*one));
        return true;
      default: return false;
    }
  }

 private:
  [[nodiscard]] auto points(const OGRSimpleCurve& curve) const -> std::vector<Point2> {
    std::vector<Point2> out;
    for (int i = 0; i < curve.getNumPoints(); ++i) out.push_back({curve.getX(i) - x_, curve.getY(i) - y_});
    return out;
  }
  [[nodiscard]] auto ring(const OGRLinearRing& closed) const -> geometry::Ring {
    auto out = points(closed);
    if (out.size() > 1 && out.front() == out.back()) out.pop_back();
    return out;
  }
  [[nodiscard]] auto polygon(const OGRPolygon& one) const -> geometry::Polygon {
    geometry::Polygon out;
    if (const auto* outer = one.getExteriorRing()) out.outer = ring(*outer);
    for (int i = 0; i < one.getNumInteriorRings(); ++i) out.holes.push_back(ring(*one.getInteriorRing(i)));
    return out;
  }

  double x_, y_;
};

}  // namespace

auto read_layer(OGRLayer& table, const model::Frame& frame) -> base::Result<Layer> {
  const auto left = [&](const std::string& why) {
    return base::warning("write-layer-left", "this layer stays behind: " + why, table.GetName());
  };
  const auto shape = shape_of(table.GetGeomType());
  if (!shape) return left("its geometry is none of lines and polygons without heights");
  if (*shape != Shape::none) {
    const auto ours = crs::crs_of(frame);
    const auto* theirs = table.GetSpatialRef();
    const bool same = ours && theirs != nullptr && theirs->IsSame(&*ours) != 0;
    if (!same) return left("it is in another coordinate system than the buildings");
  }
  Layer layer{table.GetName(), {}, *shape, {}, {}};
  if (const char* meaning = table.GetMetadataItem("DESCRIPTION")) layer.meaning = meaning;
  const OGRFeatureDefn& definition = *table.GetLayerDefn();
  for (int i = 0; i < definition.GetFieldCount(); ++i) {
    const OGRFieldDefn& field = *definition.GetFieldDefn(i);
    const auto type = type_of(field);
    if (!type) return left("its field " + std::string(field.GetNameRef()) + " is no text, number or flag");
    layer.fields.push_back({field.GetNameRef(), *type});
  }
  const Reader reader(frame);
  table.ResetReading();
  while (const OGRFeatureUniquePtr row{table.GetNextFeature()}) {
    Feature& feature = layer.features.emplace_back();
    for (int i = 0; i < definition.GetFieldCount(); ++i)
      feature.values.push_back(value_of(*row, i, layer.fields[static_cast<std::size_t>(i)].type));
    if (const auto* geometry = row->GetGeometryRef(); geometry != nullptr && !reader.read(*geometry, feature))
      return left("it has a geometry that is none of lines and polygons without heights");
  }
  // What another program drew need not be what a layer of ours may be.
  if (const auto sound = check_layers({layer}); !sound) return left(sound.error().message);
  return layer;
}

}  // namespace mansard::formats::detail
