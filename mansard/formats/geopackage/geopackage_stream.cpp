// A city as a GeoPackage, written building by building into one transaction, and read back.
#include <map>

#include "mansard/crs/gdal.hpp"
#include "mansard/formats/detail/flat_level.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/formats/geopackage/city_tables.hpp"
#include "mansard/formats/geopackage/geopackage_tables.hpp"
#include "mansard/formats/geopackage/qgis_styles.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/formats/postgis/postgis_writer.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::formats::detail {
namespace {

using model::Value;
using Values = std::vector<Value>;
using model::FaceClass;

auto is_own(std::string_view layer) -> bool {
  bool own =
      layer.starts_with(std::string(solids_name) + "lod") || layer.starts_with(std::string(grounds_name) + "lod");
  each_city_table([&](const auto& table) { own = own || layer == table.name; });
  return own;
}

auto is_wall(FaceClass c) -> bool { return c == FaceClass::wall || c == FaceClass::party_wall; }

/// Of every edge that walls rise from, whether most of their area stands against another solid.
auto party_edges(const model::LabelledSolid& model) -> std::map<std::pair<std::uint32_t, std::uint32_t>, double> {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> party_less_open;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    const auto& face = model.solid.faces[f];
    const FaceClass c = model.classes[f];
    if (!face.provenance || !is_wall(c)) continue;
    const double area = solid::area(model.solid, face);
    party_less_open[{face.provenance->ring, face.provenance->edge}] += c == FaceClass::party_wall ? area : -area;
  }
  return party_less_open;
}

class GeoPackageWriter : public CityWriter {
 public:
  GeoPackageWriter(const Header& header, Lods lods, const solid::LevelOptions& levels, std::vector<Layer> more,
                   std::unique_ptr<base::Spool> records)
      : header_(header),
        lods_(std::move(lods)),
        levels_(levels),
        more_(std::move(more)),
        pen_(header.frame),
        records_(std::move(records)) {}

  ~GeoPackageWriter() override {
    const GeopackageManners manners;
    file_.reset();
  }

  auto begin(const Path& place) -> base::Result<void> {
    const GeopackageManners manners;
    const auto crs = crs::crs_of(header_.frame);
    if (!crs) return geopackage_failure("understand the CRS " + header_.frame.crs);
    crs_ = *crs;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    if (driver == nullptr) return geopackage_failure("find its GPKG driver");
    file_.reset(driver->Create(place.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!file_ || file_->StartTransaction() != OGRERR_NONE) return geopackage_failure("start the file");
    return make_tables();
  }

  auto add(const model::Building& building) -> base::Result<void> override {
    const auto keyed = gate_.admit(building);
    if (!keyed) return keyed.error();
    const GeopackageManners manners;
    model::Building named{building.id, building.attributes, building.footprint, building.ground, {}};
    gis_columns_.add(building.attributes);
    for (std::size_t p = 0; p < building.parts.size(); ++p) {
      model::Part part{keyed->parts[p], building.parts[p].plan, {}, building.parts[p].attributes};
      part_columns_.add(part.attributes);
      if (auto done = add_edges(building.id, part, building.parts[p].model); !done) return done;
      if (auto done = add_faces(building.id, part.id, building.parts[p].model); !done) return done;
      named.parts.push_back(std::move(part));
    }
    if (auto done = add_levels(building, *keyed); !done) return done;
    if (is_foreign(header_)) named.parts.clear();  // they have no plans that could be read back
    const std::string record = building_record(named);
    record_sizes_.push_back(record.size());
    records_->append(record);
    if (is_foreign(header_)) return {};
    return add_row(records_table, {record_building, building.id, record});
  }

  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override {
    auto all = warnings_;
    for (const auto* columns : {&gis_columns_, &part_columns_})
      if (auto some = columns->warning("model.gpkg")) all.push_back(std::move(*some));
    return all;
  }

  auto finish() -> base::Result<void> override {
    const GeopackageManners manners;
    if (auto done = add_footprints(); !done) return done;
    for (const Layer& layer : more_)
      if (auto done = add_layer(layer, pen_, crs_, *file_); !done) return done;
    if (auto done = add_styles(*file_); !done) return done;
    if (file_->CommitTransaction() != OGRERR_NONE) return geopackage_failure("finish the file");
    CPLErrorReset();
    file_.reset();  // writes the extents, and the spatial indexes that are still due
    if (CPLGetLastErrorType() >= CE_Failure) return geopackage_failure("close the file");
    return {};
  }

 private:
  template <class Row>
  auto make(const CityTable<Row>& given, const std::string& suffix = {}) -> base::Result<void> {
    auto table = GeopackageTable::make(*file_, given.name + suffix, given.meaning, given.geometry, crs_);
    if (!table) return table.error();
    if (auto done = table->add_fields(given.fields()); !done) return done;
    table->take_place();
    tables_.emplace(given.name + suffix, *std::move(table));
    return {};
  }
  /// `more` are the values of the columns for attributes.
  template <class Row>
  auto add_row(const CityTable<Row>& table, const Row& row, std::unique_ptr<OGRGeometry> geometry = nullptr,
               const Values& more = {}, const std::string& suffix = {}) -> base::Result<void> {
    Values values = table.values(row);
    values.insert(values.end(), more.begin(), more.end());
    return tables_.at(table.name + suffix).add_row(values, std::move(geometry));
  }

  auto make_tables() -> base::Result<void> {
    base::Result<void> made;
    each_city_table([&](const auto& table) {
      if (made) made = make(table);
    });
    if (!made) return made;
    for (const auto lod : lods_) {
      if (lod == Lod::lod0) continue;
      if (auto done = make(solids_table, suffix_of(lod)); !done) return done;
      if (auto done = make(grounds_table, suffix_of(lod)); !done) return done;
    }
    if (auto done = add_made_by(); !done) return done;
    if (is_foreign(header_)) return {};
    return add_row(records_table, {record_header, Value(), header_record(header_)});
  }

  auto add_made_by() -> base::Result<void> {
    std::vector<std::pair<std::string, std::string>> said{{"mansard", header_.made_by.version}};
    for (const auto& input : header_.made_by.inputs) said.emplace_back("input", input.path + " sha256:" + input.sha256);
    said.insert(said.end(), header_.made_by.options.begin(), header_.made_by.options.end());
    for (const auto& [name, value] : said)
      if (auto done = add_row(made_by_table, {name, value}); !done) return done;
    return {};
  }

  auto add_edges(const std::string& building, const model::Part& part, const model::LabelledSolid& model)
      -> base::Result<void> {
    for (std::size_t i = 0; i < part.plan.profiles.size(); ++i)
      if (auto done = add_row(profiles_table, {building, part.id, i, part.plan.profiles[i]}); !done) return done;
    const auto party = party_edges(model);
    std::vector<const model::PlanRing*> rings{&part.plan.outer};
    for (const auto& hole : part.plan.holes) rings.push_back(&hole);
    for (std::uint32_t r = 0; r < rings.size(); ++r)
      for (std::uint32_t e = 0; e < rings[r]->points.size(); ++e) {
        const auto a = rings[r]->points[e], b = rings[r]->points[(e + 1) % rings[r]->points.size()];
        const auto found = party.find({r, e});
        Value is_party;
        if (found != party.end()) is_party = found->second > 0;
        if (auto done = add_row(edges_table, {building, part.id, *rings[r], r, e, is_party}, pen_.line({a, b})); !done)
          return done;
      }
    return {};
  }

  auto add_faces(const std::string& building, const std::string& part, const model::LabelledSolid& model)
      -> base::Result<void> {
    for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
      const CityTable<FaceRow>* table = model.classes[f] == FaceClass::roof ? &roof_planes_table
                                        : is_wall(model.classes[f])         ? &walls_table
                                                                            : nullptr;
      if (table == nullptr) continue;
      std::unique_ptr<OGRGeometry> shape;
      if (table == &walls_table) {
        shape = pen_.foot(model.solid, model.solid.faces[f]);
      } else {
        shape = pen_.areas(model.solid, {&model.solid.faces[f], 1});
      }
      if (auto done = add_row(*table, {building, part, model, f, pen_}, std::move(shape)); !done) return done;
    }
    return {};
  }

  /// The solids at every level of detail that is written.
  auto add_levels(const model::Building& building, const Gate::Keyed& keyed) -> base::Result<void> {
    if (std::ranges::none_of(lods_, [](Lod lod) { return lod != Lod::lod0; })) return {};
    const Drawn all = drawn(building, keyed, Solids::building);
    std::size_t number = 0;
    const auto levels = level_surfaces(all, header_.frame, lods_, levels_);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const auto& part = all.solids[i].part;
      const auto& made = levels[i];
      for (const auto lod : lods_) {
        if (lod == Lod::lod0) continue;
        const auto model = lod == Lod::lod22 ? part.model : solid_of(made.at(lod));
        if (model.solid.faces.empty()) continue;
        const LevelRow row{building.id, number, model, pen_};
        if (auto done = add_row(solids_table, row, pen_.surface(model.solid), {}, suffix_of(lod)); !done) return done;
        // Parts of other producers may have none.
        if (auto ground = pen_.ground(model))
          if (auto done = add_row(grounds_table, row, std::move(ground), {}, suffix_of(lod)); !done) return done;
      }
      ++number;
    }
    return {};
  }

  /// Once all attributes are known.
  auto add_footprints() -> base::Result<void> {
    if (auto done = tables_.at(gis_footprints_table.name).add_fields(gis_columns_.fields()); !done) return done;
    if (auto done = tables_.at(footprints_table.name).add_fields(part_columns_.fields()); !done) return done;
    std::uint64_t at = 0;
    for (const std::size_t size : record_sizes_) {
      const auto record = records_->read(at, size);
      if (!record) return record.error();
      at += size;
      const auto building = read_building_record(*record, records_table.name);
      if (!building) return building.error();
      if (auto done = add_footprints(*building); !done) return done;
    }
    return {};
  }

  /// Polygons of one feature that touch along a line are not a valid MultiPolygon; their union is.
  [[nodiscard]] auto gis_geometry(const model::Building& building) -> std::unique_ptr<OGRGeometry> {
    if (building.footprint.empty()) return nullptr;
    auto polygons = pen_.polygons(building.footprint);
    if (polygons->IsValid() != 0) return polygons;
    const auto united = geometry::unite(building.footprint);
    if (united) return pen_.polygons(*united);
    warnings_.push_back(base::warning("write-geopackage-footprint",
                                      "its polygons touch and could not be united (" + united.error().message +
                                          "); its MultiPolygon in the layer gis_footprints is not valid",
                                      building.id));
    return polygons;
  }

  auto add_footprints(const model::Building& building) -> base::Result<void> {
    if (auto done = add_row(gis_footprints_table, {building, pen_}, gis_geometry(building),
                            gis_columns_.values(building.attributes));
        !done)
      return done;
    for (const model::Part& part : building.parts) {
      if (part.plan.outer.points.empty()) continue;
      const auto outline = model::polygon_of(part.plan);
      if (auto done = add_row(footprints_table, {building.id, part, outline, pen_}, pen_.polygon(outline),
                              part_columns_.values(part.attributes));
          !done)
        return done;
    }
    return {};
  }

  const Header header_;
  const Lods lods_;
  const solid::LevelOptions levels_;
  const std::vector<Layer> more_;
  const Pen pen_;
  OGRSpatialReference crs_;
  GDALDatasetUniquePtr file_;
  std::map<std::string, GeopackageTable> tables_;
  Gate gate_;
  AttributeColumns gis_columns_, part_columns_;
  std::unique_ptr<base::Spool> records_;
  std::vector<std::size_t> record_sizes_;
  std::vector<base::Diagnostic> warnings_;
};

/// Those of the same name say the same of the footprints and the making; what else has a taken name is of a
/// segmentation.
auto beside_ours(std::vector<Layer> more) -> std::vector<Layer> {
  std::erase_if(more, [](const Layer& layer) {
    return layer.name == gis_footprints_table.name || layer.name == made_by_table.name;
  });
  for (Layer& layer : more)
    if (is_own(layer.name)) layer.name = "segment_" + layer.name;
  return more;
}

class GeoPackageReader : public CityReader {
 public:
  GeoPackageReader(GDALDatasetUniquePtr file, OGRLayer& records, std::string name)
      : file_(std::move(file)), records_(records), name_(std::move(name)) {}

  auto begin() -> base::Result<void> {
    const GeopackageManners manners;
    columns_ = {records_.GetLayerDefn()->GetFieldIndex(record_kind),
                records_.GetLayerDefn()->GetFieldIndex(record_json)};
    if (columns_.first < 0 || columns_.second < 0) return no_plans("its table mansard_records lacks a column");
    const OGRFeatureUniquePtr row(records_.GetNextFeature());
    if (!row || row->GetFieldAsString(columns_.first) != std::string_view(record_header))
      return no_plans("its table mansard_records does not begin with a header");
    auto header = read_header_record(row->GetFieldAsString(columns_.second), name_);
    if (!header) return header.error();
    header_ = *std::move(header);
    return {};
  }

  [[nodiscard]] auto header() const -> const Header& override { return header_; }
  [[nodiscard]] auto has_models() const -> bool override { return false; }
  auto next() -> base::Result<std::optional<model::Building>> override {
    const GeopackageManners manners;
    const OGRFeatureUniquePtr row(records_.GetNextFeature());
    if (!row) {
      if (CPLGetLastErrorType() >= CE_Failure) return no_plans("it cannot be read on" + crs::gdal_words());
      return std::optional<model::Building>();
    }
    auto building = read_building_record(row->GetFieldAsString(columns_.second), name_);
    if (!building) return building.error();
    return std::optional(*std::move(building));
  }
  auto beside() -> base::Result<Beside> override {
    const GeopackageManners manners;
    Beside out;
    for (auto* layer : file_->GetLayers()) {
      const std::string_view name = layer->GetName();
      if (is_own(name) || name == styles_name) continue;
      CPLErrorReset();
      auto read = read_layer(*layer, header_.frame);
      if (CPLGetLastErrorType() >= CE_Failure)
        return no_plans("its layer " + std::string(name) + " cannot be read" + crs::gdal_words());
      if (read) out.layers.push_back(*std::move(read));
      else out.warnings.push_back(read.error());
    }
    return out;
  }

  [[nodiscard]] auto no_plans(const std::string& what) const -> base::Diagnostic {
    return base::error("write-read-plans",
                       what +
                           "; give the file as mansard wrote it, or its footprints to "
                           "'mansard extrude' or 'mansard reconstruct'",
                       name_);
  }

 private:
  GDALDatasetUniquePtr file_;
  OGRLayer& records_;
  std::string name_;
  std::pair<int, int> columns_;
  Header header_;
};

}  // namespace

auto geopackage_writer(const Path& path, const Header& header, const WriteOptions& options,
                       const std::vector<Layer>& more, base::Outputs& outputs) -> WriterResult {
  if (is_database_name(path)) return postgis_writer(path.string(), header, options);
  auto lods = lods_of(options.lod, Format::geopackage);
  if (!lods) return lods.error();
  auto layers = beside_ours(more);
  if (const auto sound = check_layers(layers); !sound) return sound.error();
  auto records = base::Spool::open();
  if (!records) return records.error();
  const auto place = outputs.place(path);
  if (!place) return place.error();
  crs::register_gdal();
  auto writer = std::make_unique<GeoPackageWriter>(header, *std::move(lods), options.levels, std::move(layers),
                                                   std::move(*records));
  if (auto begun = writer->begin(*place); !begun) return begun.error();
  return WriterResult(std::move(writer));
}

auto geopackage_reader(const Path& path) -> ReaderResult {
  std::error_code status;
  if (!std::filesystem::exists(path, status))
    return base::error("file-missing", "no such file; check the path", path.string());
  crs::register_gdal();
  const GeopackageManners manners;
  const Confined confined(path);
  GDALDatasetUniquePtr file(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!file)
    return base::error("write-read-format",
                       "this is no GeoPackage" + crs::gdal_words() + "; give one that mansard wrote", path.string());
  OGRLayer* records = file->GetLayerByName(records_table.name);
  if (records == nullptr)
    return base::error("write-read-plans",
                       "this GeoPackage has no plans in it; give one that mansard wrote, or its "
                       "footprints to 'mansard extrude' or 'mansard reconstruct'",
                       path.string());
  auto reader = std::make_unique<GeoPackageReader>(std::move(file), *records, path.string());
  if (auto begun = reader->begin(); !begun) return begun.error();
  return ReaderResult(std::move(reader));
}

}  // namespace mansard::formats::detail
