#include "mansard/formats/postgis/postgis_writer.hpp"

#include <ogrsf_frmts.h>

#include "mansard/crs/gdal.hpp"
#include "mansard/formats/detail/flat_level.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/geopackage/geopackage_tables.hpp"

namespace mansard::formats::detail {
namespace {

constexpr const char *buildings_name = "mansard_buildings", *solids_name = "mansard_solids";
constexpr const char *id_column = "building_id", *lod_column = "lod", *number_column = "number";

auto failure(const std::string& what) -> base::Diagnostic {
  return base::error("write-postgis", "the database: GDAL cannot " + what + crs::gdal_words());
}

auto in_quotes(const std::string& text) -> std::string {
  std::string out = "'";
  for (const char c : text) {
    out += c;
    if (c == '\'') out += c;
  }
  return out + "'";
}

void set(OGRFeature& row, int column, const model::Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) row.SetField(column, text->c_str());
  else if (const auto* whole = std::get_if<std::int64_t>(&value)) row.SetField(column, static_cast<GIntBig>(*whole));
  else if (const auto* number = std::get_if<double>(&value)) row.SetField(column, *number);
  else if (const auto* flag = std::get_if<bool>(&value)) row.SetField(column, *flag ? 1 : 0);
  else row.SetFieldNull(column);
}

/// While it lives, in this thread, GDAL keeps quiet, and rows are inserted one by one: it would copy them into new
/// tables, where they cannot be looked for before the end.
class Manners {
 public:
  Manners() : quiet_(CPLQuietErrorHandler), copy_("PG_USE_COPY", "NO", false) { CPLErrorReset(); }

 private:
  CPLErrorHandlerPusher quiet_;
  CPLConfigOptionSetter copy_;
};

class PostgisWriter : public CityWriter {
 public:
  PostgisWriter(const Header& header, Lods lods, const solid::LevelOptions& levels,
                std::unique_ptr<base::Spool> records)
      : header_(header), lods_(std::move(lods)), levels_(levels), pen_(header.frame), records_(std::move(records)) {}

  ~PostgisWriter() override {
    const Manners manners;
    if (database_ && open_) database_->RollbackTransaction();
    database_.reset();
  }

  auto begin(const std::string& connection) -> base::Result<void> {
    const Manners manners;
    const auto crs = crs::crs_of(header_.frame);
    if (!crs) return failure("understand the CRS " + header_.frame.crs);
    crs_ = *crs;
    if (GetGDALDriverManager()->GetDriverByName("PostgreSQL") == nullptr) return failure("find its PostgreSQL driver");
    database_.reset(GDALDataset::Open(connection.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
    if (!database_) return failure("open it");
    if (database_->StartTransaction() != OGRERR_NONE) return failure("begin a transaction");
    open_ = true;
    auto buildings = table(buildings_name, wkbMultiPolygon, {{id_column, FieldType::string}});
    if (!buildings) return buildings.failure();
    buildings_ = *buildings;
    auto solids =
        table(solids_name, wkbPolyhedralSurfaceZ,
              {{id_column, FieldType::string}, {lod_column, FieldType::string}, {number_column, FieldType::integer}});
    if (!solids) return solids.failure();
    solids_ = *solids;
    return {};
  }

  auto add(const model::Building& building) -> base::Result<void> override {
    const auto keyed = gate_.admit(building);
    if (!keyed) return keyed.error();
    const Manners manners;
    columns_.add(building.attributes);
    const std::string record =
        building_record({building.id, building.attributes, building.footprint, building.ground, {}, {}, {}});
    sizes_.push_back(record.size());
    records_->append(record);
    if (auto done =
            run(std::string("DELETE FROM \"") + solids_name + "\" WHERE " + id_column + " = " + in_quotes(building.id));
        !done)
      return done;
    return add_solids(building, *keyed);
  }

  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override {
    const auto some = columns_.warning("buildings");
    return some ? std::vector{*some} : std::vector<base::Diagnostic>();
  }

  auto finish() -> base::Result<void> override {
    const Manners manners;
    const auto fields = columns_.fields();
    std::vector<int> places;
    for (const auto& field : fields) {
      auto place = column(*buildings_, field);
      if (!place) return place.failure();
      places.push_back(*place);
    }
    std::uint64_t at = 0;
    for (const std::size_t size : sizes_) {
      const auto record = records_->read(at, size);
      if (!record) return record.error();
      at += size;
      const auto building = read_building_record(*record, buildings_name);
      if (!building) return building.error();
      if (auto done = put(*building, places); !done) return done;
    }
    open_ = false;
    if (database_->CommitTransaction() != OGRERR_NONE) return failure("commit the transaction");
    CPLErrorReset();
    database_.reset();
    if (CPLGetLastErrorType() >= CE_Failure) return failure("close the connection");
    return {};
  }

 private:
  auto run(const std::string& sql) -> base::Result<void> {
    CPLErrorReset();
    if (OGRLayer* result = database_->ExecuteSQL(sql.c_str(), nullptr, nullptr)) database_->ReleaseResultSet(result);
    if (CPLGetLastErrorType() >= CE_Failure) return failure("run a statement");
    return {};
  }

  /// The column of a field, added where it is missing. A column of another type is kept where it can hold the values.
  static auto column(OGRLayer& layer, const Field& field) -> base::Result<int> {
    static constexpr OGRFieldType types[] = {OFTInteger64, OFTReal, OFTString, OFTInteger};
    const auto wanted = types[static_cast<std::size_t>(field.type)];
    auto* definition = layer.GetLayerDefn();
    if (const int at = definition->GetFieldIndex(field.name.c_str()); at >= 0) {
      const auto type = definition->GetFieldDefn(at)->GetType();
      const bool whole = type == OFTInteger || type == OFTInteger64;
      const bool holds = type == wanted || type == OFTString || (type == OFTReal && wanted != OFTString) ||
                         (whole && (wanted == OFTInteger || wanted == OFTInteger64));
      if (holds) return at;
      return base::error("write-postgis",
                         "the column '" + field.name + "' of " + layer.GetName() + " has the type " +
                             OGRFieldDefn::GetFieldTypeName(type) + ", which cannot hold its values (" +
                             OGRFieldDefn::GetFieldTypeName(wanted) +
                             "); rename the attribute with --attributes, or change the column",
                         field.name);
    }
    OGRFieldDefn added(field.name.c_str(), wanted);
    if (field.type == FieldType::boolean) added.SetSubType(OFSTBoolean);
    if (layer.CreateField(&added) != OGRERR_NONE) return failure("add the column " + field.name);
    return definition->GetFieldIndex(field.name.c_str());
  }

  auto table(const char* name, OGRwkbGeometryType type, const std::vector<Field>& fields) -> base::Result<OGRLayer*> {
    OGRLayer* layer = database_->GetLayerByName(name);
    CPLErrorReset();
    const bool is_new = layer == nullptr;
    if (is_new) {
      CPLStringList options;
      options.SetNameValue("LAUNDER", "NO");
      options.SetNameValue("GEOMETRY_NAME", "geom");
      options.SetNameValue("FID", "fid");
      layer = database_->CreateLayer(name, header_.frame.crs.empty() ? nullptr : &crs_, type, options.List());
      if (layer == nullptr)
        return failure(std::string("make the table ") + name + "; PostGIS must be enabled (CREATE EXTENSION postgis)");
    } else {
      const auto* own = layer->GetSpatialRef();
      const bool same =
          own == nullptr ? header_.frame.crs.empty() : !header_.frame.crs.empty() && own->IsSame(&crs_) != 0;
      if (!same)
        return base::error("write-postgis", std::string("the table ") + name +
                                                " has another coordinate system than the models; use another schema "
                                                "(active_schema=NAME in the address), or remove the table");
      if (layer->GetLayerDefn()->GetFieldIndex(id_column) < 0)
        return base::error("write-postgis", std::string("the table ") + name + " has no column " + id_column +
                                                ", so it was not made by mansard; rename it, or use another schema "
                                                "(active_schema=NAME in the address)");
    }
    for (const auto& field : fields)
      if (auto made = column(*layer, field); !made) return made.failure();
    if (is_new) {
      const std::string unique = std::string_view(name) == buildings_name ? "UNIQUE " : "";
      if (auto done = run("CREATE " + unique + "INDEX \"" + name + "_id\" ON \"" + name + "\" (" + id_column + ")");
          !done)
        return done.failure();
    }
    return layer;
  }

  auto add_solids(const model::Building& building, const Gate::Keyed& keyed) -> base::Result<void> {
    if (std::ranges::none_of(lods_, [](Lod lod) { return lod != Lod::lod0; })) return {};
    const Drawn all = drawn(building, keyed, Solids::building);
    std::int64_t number = 0;
    const auto levels = level_surfaces(all, header_.frame, lods_, levels_);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const auto& part = all.solids[i].part;
      const auto& made = levels[i];
      for (const auto lod : lods_) {
        if (lod == Lod::lod0) continue;
        const auto model = lod == Lod::lod22 ? part.model : solid_of(made.at(lod));
        if (model.solid.faces.empty()) continue;
        OGRFeature row(solids_->GetLayerDefn());
        row.SetField(id_column, building.id.c_str());
        row.SetField(lod_column, std::string(name_of(lod)).c_str());
        row.SetField(number_column, static_cast<GIntBig>(number));
        row.SetGeometryDirectly(pen_.surface(model.solid).release());
        if (solids_->CreateFeature(&row) != OGRERR_NONE) return failure("add a solid of " + building.id);
      }
      ++number;
    }
    return {};
  }

  /// Updates the row of a building, or adds one.
  auto put(const model::Building& building, const std::vector<int>& places) -> base::Result<void> {
    buildings_->SetAttributeFilter((std::string(id_column) + " = " + in_quotes(building.id)).c_str());
    buildings_->ResetReading();
    OGRFeatureUniquePtr row(buildings_->GetNextFeature());
    const bool known = row != nullptr;
    if (!known) row.reset(OGRFeature::CreateFeature(buildings_->GetLayerDefn()));
    buildings_->SetAttributeFilter(nullptr);
    row->SetField(id_column, building.id.c_str());
    const auto values = columns_.values(building.attributes);
    for (std::size_t i = 0; i < values.size(); ++i) set(*row, places[i], values[i]);
    if (building.footprint.empty()) row->SetGeometry(nullptr);
    else row->SetGeometryDirectly(pen_.polygons(building.footprint).release());
    const auto done = known ? buildings_->SetFeature(row.get()) : buildings_->CreateFeature(row.get());
    return done == OGRERR_NONE ? base::Result<void>() : failure("write the row of " + building.id);
  }

  const Header header_;
  const Lods lods_;
  const solid::LevelOptions levels_;
  const Pen pen_;
  OGRSpatialReference crs_;
  GDALDatasetUniquePtr database_;
  bool open_ = false;  ///< the transaction
  OGRLayer *buildings_ = nullptr, *solids_ = nullptr;
  Gate gate_;
  AttributeColumns columns_;
  std::unique_ptr<base::Spool> records_;  ///< the columns of all buildings come before their rows
  std::vector<std::size_t> sizes_;
};

}  // namespace

auto postgis_writer(const std::string& connection, const Header& header, const WriteOptions& options) -> WriterResult {
  auto lods = lods_of(options.lod, Format::geopackage);
  if (!lods) return lods.error();
  auto records = base::Spool::open();
  if (!records) return records.error();
  crs::register_gdal();
  auto writer = std::make_unique<PostgisWriter>(header, *std::move(lods), options.levels, std::move(*records));
  if (auto begun = writer->begin(connection); !begun) return begun.error();
  return WriterResult(std::move(writer));
}

}  // namespace mansard::formats::detail
