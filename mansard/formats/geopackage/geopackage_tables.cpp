#include "mansard/formats/geopackage/geopackage_tables.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>

#include "mansard/base/text.hpp"
#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/json/json_text.hpp"
#include "mansard/geometry/change.hpp"

namespace mansard::formats::detail {
namespace {

constexpr const char* other_attributes = "other_attributes";

auto attributes_json(const model::Attributes& attributes) -> std::string {
  JsonText json;
  append_attributes(json.begin_object(), attributes);
  json.end_object();
  return json.take();
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

auto add_field(const std::string& name, FieldType type, OGRLayer& table) -> bool {
  static constexpr OGRFieldType types[] = {OFTInteger64, OFTReal, OFTString, OFTInteger};
  OGRFieldDefn definition(name.c_str(), types[static_cast<std::size_t>(type)]);
  if (type == FieldType::boolean) definition.SetSubType(OFSTBoolean);
  return table.CreateField(&definition) == OGRERR_NONE;
}

void set(OGRFeature& row, int column, const model::Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) row.SetField(column, text->c_str());
  else if (const auto* whole = std::get_if<std::int64_t>(&value)) row.SetField(column, static_cast<GIntBig>(*whole));
  else if (const auto* number = std::get_if<double>(&value)) row.SetField(column, *number);
  else if (const auto* flag = std::get_if<bool>(&value)) row.SetField(column, *flag ? 1 : 0);
  else row.SetFieldNull(column);
}

void add_points(const std::vector<geometry::Point2>& points, geometry::Point3 origin, OGRSimpleCurve& curve) {
  for (const auto& p : points) curve.addPoint(origin.x + p.x, origin.y + p.y);
}

auto ring_of(const geometry::Ring& points, geometry::Point3 origin) -> std::unique_ptr<OGRLinearRing> {
  auto out = std::make_unique<OGRLinearRing>();
  add_points(points, origin, *out);
  out->closeRings();
  return out;
}

auto type_for(const model::Value& value, std::optional<FieldType> before) -> FieldType {
  const auto own = std::holds_alternative<bool>(value)           ? FieldType::boolean
                   : std::holds_alternative<std::int64_t>(value) ? FieldType::integer
                   : std::holds_alternative<double>(value)       ? FieldType::real
                                                                 : FieldType::string;
  if (!before || *before == own) return own;
  const auto is_number = [](FieldType type) { return type == FieldType::integer || type == FieldType::real; };
  return is_number(own) && is_number(*before) ? FieldType::real : FieldType::string;
}

auto as_text(const model::Value& value) -> model::Value {
  if (const auto* flag = std::get_if<bool>(&value)) return std::string(*flag ? "true" : "false");
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* number = std::get_if<double>(&value)) return base::to_text(*number);
  return value;
}

}  // namespace

auto geopackage_failure(const std::string& what) -> base::Diagnostic {
  const std::string words = crs::gdal_words();
  // SQLite: "database or disk is full", "disk I/O error"
  const bool disk = words.find("disk") != words.npos;
  return base::error("write-geopackage",
                     "GDAL cannot " + what + words + (disk ? "; choose a place that can be written and has room" : ""));
}

auto Pen::line(const std::vector<geometry::Point2>& points) const -> std::unique_ptr<OGRLineString> {
  auto out = std::make_unique<OGRLineString>();
  add_points(points, origin_, *out);
  return out;
}

auto Pen::polygon(const geometry::Polygon& one) const -> std::unique_ptr<OGRPolygon> {
  auto out = std::make_unique<OGRPolygon>();
  out->addRingDirectly(ring_of(one.outer, origin_).release());
  for (const auto& hole : one.holes) out->addRingDirectly(ring_of(hole, origin_).release());
  return out;
}

auto Pen::polygons(const std::vector<geometry::Polygon>& all) const -> std::unique_ptr<OGRMultiPolygon> {
  auto out = std::make_unique<OGRMultiPolygon>();
  for (const auto& one : all) out->addGeometryDirectly(polygon(one).release());
  return out;
}

auto Pen::face(const model::Solid& solid, const model::Face& face) const -> std::unique_ptr<OGRPolygon> {
  auto out = std::make_unique<OGRPolygon>();
  for (const auto& loop : face.loops) {
    auto ring = std::make_unique<OGRLinearRing>();
    for (const auto corner : loop) {
      const auto p = origin_ + solid.vertices[corner];
      ring->addPoint(p.x, p.y, p.z);
    }
    ring->closeRings();
    out->addRingDirectly(ring.release());
  }
  return out;
}

auto Pen::surface(const model::Solid& solid) const -> std::unique_ptr<OGRPolyhedralSurface> {
  auto out = std::make_unique<OGRPolyhedralSurface>();
  for (const auto& one : solid.faces) out->addGeometryDirectly(face(solid, one).release());
  return out;
}

auto Pen::areas(const model::Solid& solid, std::span<const model::Face> faces) const
    -> std::unique_ptr<OGRMultiPolygon> {
  if (faces.empty()) return nullptr;
  auto out = std::make_unique<OGRMultiPolygon>();
  for (const auto& one : faces) out->addGeometryDirectly(face(solid, one).release());
  if (out->IsValid() != 0) return out;
  // Of other producers: rings that cross themselves, ground of triangles that touch along their edges.
  std::vector<geometry::Polygon> pieces;
  std::map<geometry::Point2, double> heights;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& one : faces) {
    for (const auto& loop : one.loops)
      for (const auto corner : loop) {
        const auto p = solid.vertices[corner];
        const auto entry = heights.try_emplace(geometry::xy(p), p.z).first;
        entry->second = std::min(entry->second, p.z);
        lowest = std::min(lowest, p.z);
      }
    auto sound =
        geometry::make_valid(geometry::polygon_of(one.loops, [&](auto v) { return geometry::xy(solid.vertices[v]); }));
    if (sound) std::ranges::move(*sound, std::back_inserter(pieces));
  }
  const auto united = geometry::unite(pieces);
  if (!united || united->empty()) return nullptr;
  model::Solid flat;
  out = std::make_unique<OGRMultiPolygon>();
  for (const auto& polygon : *united) {
    model::Face made;
    const auto add = [&](const geometry::Ring& ring) {
      auto& loop = made.loops.emplace_back();
      for (const auto p : ring) {
        const auto known = heights.find(p);
        loop.push_back(static_cast<std::uint32_t>(flat.vertices.size()));
        flat.vertices.push_back({p.x, p.y, known != heights.end() ? known->second : lowest});
      }
    };
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
    out->addGeometryDirectly(face(flat, made).release());
  }
  return out;
}

auto Pen::ground(const model::LabelledSolid& solid) const -> std::unique_ptr<OGRMultiPolygon> {
  std::vector<model::Face> faces;
  for (std::size_t f = 0; f < solid.classes.size(); ++f) {
    if (solid.classes[f] != model::FaceClass::ground) continue;
    auto& upward = faces.emplace_back(solid.solid.faces[f]);
    for (auto& loop : upward.loops) std::ranges::reverse(loop);
  }
  return areas(solid.solid, faces);
}

auto Pen::foot(const model::Solid& solid, const model::Face& face) const -> std::unique_ptr<OGRLineString> {
  const geometry::Point2 along{-face.normal.y, face.normal.x};
  const auto& corners = face.loops.front();
  const auto [first, last] =
      std::ranges::minmax(corners, {}, [&](std::uint32_t v) { return dot(along, geometry::xy(solid.vertices[v])); });
  return line({geometry::xy(solid.vertices[first]), geometry::xy(solid.vertices[last])});
}

auto Pen::geometry_of(const Feature& feature, Shape shape) const -> std::unique_ptr<OGRGeometry> {
  if (shape == Shape::line && !feature.lines.empty()) return line(feature.lines.front());
  if (shape == Shape::polygon && !feature.polygons.empty()) return polygon(feature.polygons.front());
  if (!feature.lines.empty()) {
    auto all = std::make_unique<OGRMultiLineString>();
    for (const auto& points : feature.lines) all->addGeometryDirectly(line(points).release());
    return all;
  }
  if (feature.polygons.empty()) return nullptr;
  return polygons(feature.polygons);
}

auto GeopackageTable::make(GDALDataset& file, const std::string& name, const std::string& meaning,
                           OGRwkbGeometryType type, const OGRSpatialReference& crs) -> base::Result<GeopackageTable> {
  CPLStringList options;
  options.SetNameValue("DESCRIPTION", meaning.c_str());
  // Layers without geometry take no CRS; const was added to this argument after GDAL 3.6.
  OGRSpatialReference copy(crs);
  OGRLayer* layer = file.CreateLayer(name.c_str(), type == wkbNone ? nullptr : &copy, type, options.List());
  if (layer == nullptr) return geopackage_failure("make the layer " + name);
  return GeopackageTable(*layer);
}

auto GeopackageTable::add_fields(const std::vector<Field>& fields) -> base::Result<void> {
  std::set<std::string> taken{"fid", "geom"};
  for (int i = 0; i < layer_->GetLayerDefn()->GetFieldCount(); ++i)
    taken.insert(base::lower(layer_->GetLayerDefn()->GetFieldDefn(i)->GetNameRef()));
  for (const Field& field : fields) {
    std::string name = field.name;
    for (int n = 2; !taken.insert(base::lower(name)).second; ++n) name = field.name + "_" + std::to_string(n);
    if (!add_field(name, field.type, *layer_)) return geopackage_failure("make the field " + name);
  }
  return {};
}

auto GeopackageTable::add_row(std::span<const model::Value> values, std::unique_ptr<OGRGeometry> geometry)
    -> base::Result<void> {
  OGRFeature row(layer_->GetLayerDefn());
  for (std::size_t i = 0; i < values.size(); ++i) set(row, static_cast<int>(i), values[i]);
  if (geometry) row.SetGeometryDirectly(geometry.release());
  if (layer_->CreateFeature(&row) != OGRERR_NONE)
    return geopackage_failure("write a feature of " + std::string(layer_->GetName()));
  return {};
}

auto add_layer(const Layer& layer, const Pen& pen, const OGRSpatialReference& crs, GDALDataset& file)
    -> base::Result<void> {
  auto table = GeopackageTable::make(file, layer.name, layer.meaning, geometry_type(layer.shape), crs);
  if (!table) return table.error();
  if (auto made = table->add_fields(layer.fields); !made) return made;
  table->take_place();  // without rows it would come after those with some
  for (const Feature& feature : layer.features)
    if (auto added = table->add_row(feature.values, pen.geometry_of(feature, layer.shape)); !added) return added;
  return {};
}

void AttributeColumns::add(const model::Attributes& attributes) {
  for (const auto& [name, value] : attributes) {
    const auto [at, is_new] = number_.try_emplace(name, columns_.size());
    if (is_new) columns_.push_back({name, {}});
    auto& type = columns_[at->second].type;
    if (!std::holds_alternative<std::monostate>(value)) type = type_for(value, type);
  }
}

auto AttributeColumns::fields() const -> std::vector<Field> {
  std::vector<Field> fields;
  for (const auto& [name, type] : columns_) {
    if (fields.size() == most) break;
    fields.push_back({name, type.value_or(FieldType::string)});
  }
  if (columns_.size() > most) fields.push_back({other_attributes, FieldType::string});
  return fields;
}

auto AttributeColumns::values(const model::Attributes& attributes) const -> std::vector<model::Value> {
  std::vector<model::Value> values(std::min(columns_.size(), most + 1));
  model::Attributes others;
  for (const auto& [name, value] : attributes) {
    const auto at = number_.find(name);
    if (at == number_.end()) continue;
    if (at->second >= most) {
      others.emplace_back(name, value);
      continue;
    }
    values[at->second] = columns_[at->second].type == FieldType::string ? as_text(value) : value;
  }
  if (!others.empty()) values[most] = attributes_json(others);
  return values;
}

auto AttributeColumns::warning(const std::string& subject) const -> std::optional<base::Diagnostic> {
  if (columns_.size() <= most) return std::nullopt;
  return base::warning("write-columns",
                       "there are " + std::to_string(columns_.size()) + " attributes, and a table has at most " +
                           std::to_string(most) + " columns for them; the others, from '" + columns_[most].name +
                           "' on, are together in the column '" + other_attributes +
                           "' as JSON. For a column each, give footprints with fewer attributes",
                       subject);
}

}  // namespace mansard::formats::detail
