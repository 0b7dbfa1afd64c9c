// Tables of a GeoPackage, by GDAL.
#pragma once

#include <ogrsf_frmts.h>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mansard/crs/gdal_frame.hpp"
#include "mansard/formats/layers.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::formats::detail {

/// "write-geopackage" in GDAL's words.
[[nodiscard]] auto geopackage_failure(const std::string& what) -> base::Diagnostic;

/// While it lives, in this thread, GDAL keeps quiet and takes every day for the first: files would have today's date.
class GeopackageManners {
 public:
  GeopackageManners() : quiet_(CPLQuietErrorHandler), date_("OGR_CURRENT_DATE", "1970-01-01T00:00:00.000Z", false) {
    CPLErrorReset();
  }

 private:
  CPLErrorHandlerPusher quiet_;
  CPLConfigOptionSetter date_;
};

/// Local coordinates to the file's.
class Pen {
 public:
  explicit Pen(const model::Frame& frame)
      : origin_{static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1]),
                static_cast<double>(frame.origin[2])} {}

  /// None where the feature has no lines and polygons.
  [[nodiscard]] auto geometry_of(const Feature& feature, Shape shape) const -> std::unique_ptr<OGRGeometry>;
  [[nodiscard]] auto polygon(const geometry::Polygon& one) const -> std::unique_ptr<OGRPolygon>;
  [[nodiscard]] auto polygons(const std::vector<geometry::Polygon>& all) const -> std::unique_ptr<OGRMultiPolygon>;
  [[nodiscard]] auto line(const std::vector<geometry::Point2>& points) const -> std::unique_ptr<OGRLineString>;
  /// With z.
  [[nodiscard]] auto face(const model::Solid& solid, const model::Face& face) const -> std::unique_ptr<OGRPolygon>;
  /// All faces, from outside.
  [[nodiscard]] auto surface(const model::Solid& solid) const -> std::unique_ptr<OGRPolyhedralSurface>;
  /// Some faces in plan, with z. Where these are not a valid MultiPolygon, their union, with the heights of its corners
  /// (the lowest where there are several, and at crossings). None where they have no area in plan.
  [[nodiscard]] auto areas(const model::Solid& solid, std::span<const model::Face> faces) const
      -> std::unique_ptr<OGRMultiPolygon>;
  /// The ground of a solid, counter-clockwise from above; as areas(). None where it has no ground.
  [[nodiscard]] auto ground(const model::LabelledSolid& solid) const -> std::unique_ptr<OGRMultiPolygon>;
  /// Where a vertical face stands in plan, from left to right as seen from outside.
  [[nodiscard]] auto foot(const model::Solid& solid, const model::Face& face) const -> std::unique_ptr<OGRLineString>;
  [[nodiscard]] auto height(double z) const -> double { return origin_.z + z; }

 private:
  geometry::Point3 origin_;
};

/// A layer that is being written.
class GeopackageTable {
 public:
  /// Fails with "write-geopackage".
  [[nodiscard]] static auto make(GDALDataset& file, const std::string& name, const std::string& meaning,
                                 OGRwkbGeometryType type, const OGRSpatialReference& crs)
      -> base::Result<GeopackageTable>;
  /// A layer of any format that somebody else made.
  [[nodiscard]] static auto over(OGRLayer& layer) -> GeopackageTable { return GeopackageTable(layer); }
  /// Before the first row, which may be later. SQL tells names apart regardless of case, and GDAL's own columns come
  /// first: a name that is taken gets "_2" or the next number free.
  [[nodiscard]] auto add_fields(const std::vector<Field>& fields) -> base::Result<void>;
  /// GDAL makes tables when their first row comes; this makes it now, so that it stands before those made later.
  void take_place() { layer_->GetFeatureCount(); }
  /// One value per field, of its type or absent.
  [[nodiscard]] auto add_row(std::span<const model::Value> values, std::unique_ptr<OGRGeometry> geometry = nullptr)
      -> base::Result<void>;

 private:
  explicit GeopackageTable(OGRLayer& layer) : layer_(&layer) {}
  OGRLayer* layer_;
};

/// Fails with "write-layer": names that are taken, geometry or values that do not fit.
[[nodiscard]] auto check_layers(const std::vector<Layer>& layers) -> base::Result<void>;

/// A layer as it is. Its geometry and values must be sound.
[[nodiscard]] auto add_layer(const Layer& layer, const Pen& pen, const OGRSpatialReference& crs, GDALDataset& file)
    -> base::Result<void>;

/// Such a layer of a file, in the local frame. Fails with "write-layer-left", a warning: it is more than a Layer
/// holds.
[[nodiscard]] auto read_layer(OGRLayer& table, const model::Frame& frame) -> base::Result<Layer>;

/// Columns for attributes that come object by object: those of any object, in the order of their first appearance.
/// Whole and real numbers under one name make real ones, any other mixture texts. Beyond `most` of them, those that
/// came last are together in one column, as JSON: a table has no more columns than its format allows.
class AttributeColumns {
 public:
  /// SQLite allows 2,000 (https://www.sqlite.org/limits.html, SQLITE_MAX_COLUMN), PostgreSQL 1,600
  /// (https://www.postgresql.org/docs/current/limits.html); the tables have less than 100 of their own.
  static constexpr std::size_t most = 1500;

  void add(const model::Attributes& attributes);
  [[nodiscard]] auto fields() const -> std::vector<Field>;
  /// A value per column: the last of a name, absent where there is none.
  [[nodiscard]] auto values(const model::Attributes& attributes) const -> std::vector<model::Value>;
  /// Which of them are in the column of all others; none where there is no such column.
  [[nodiscard]] auto warning(const std::string& subject) const -> std::optional<base::Diagnostic>;

 private:
  struct Column {
    std::string name;
    std::optional<FieldType> type;
  };
  std::vector<Column> columns_;
  std::map<std::string, std::size_t> number_;
};

}  // namespace mansard::formats::detail
