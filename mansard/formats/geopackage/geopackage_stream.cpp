// A city as a GeoPackage, written building by building into one transaction, and read back.
#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "mansard/crs/gdal.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/geopackage/geopackage_tables.hpp"
#include "mansard/formats/geopackage/qgis_styles.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::formats::detail {
namespace {

using enum FieldType;
using model::Value;
using Values = std::vector<Value>;
using model::FaceClass;

constexpr const char* records_name = "mansard_records";
/// The layers that a city makes, in their order.
constexpr std::array<std::string_view, 8> own_layers{"gis_footprints", "footprints", "edges",   "roof_planes",
                                                     "walls",          "profiles",   "made_by", records_name};

auto is_own(std::string_view layer) -> bool { return std::ranges::find(own_layers, layer) != own_layers.end(); }

auto as_whole(std::size_t number) -> Value { return static_cast<std::int64_t>(number); }

/// Degrees from the horizontal, and clockwise from north where it looks: absent below half a degree of slope, as in
/// CityJSON.
auto slope_and_azimuth(geometry::Point3 normal) -> std::pair<Value, Value> {
  constexpr double degrees = 180 / std::numbers::pi, level = 0.5;
  const double slope = std::acos(std::clamp(normal.z, -1.0, 1.0)) * degrees;
  if (slope < level) return {slope, Value()};
  const double azimuth = std::atan2(normal.x, normal.y) * degrees;
  return {slope, azimuth < 0 ? azimuth + 360 : azimuth};
}

auto profile_json(const model::Profile& profile) -> std::string {
  JsonText json;
  json.begin_array();
  for (const auto& point : profile) json.begin_array().number(point.inward).number(point.height).end_array();
  return std::move(json.end_array()).str();
}

/// Of every edge that walls rise from, whether most of their area stands against another solid.
auto party_edges(const model::LabelledSolid& model) -> std::map<std::pair<std::uint32_t, std::uint32_t>, double> {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> party_less_open;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    const auto& face = model.solid.faces[f];
    const FaceClass c = model.classes[f];
    if (!face.provenance || (c != FaceClass::wall && c != FaceClass::party_wall)) continue;
    const double area = solid::area(model.solid, face);
    party_less_open[{face.provenance->ring, face.provenance->edge}] += c == FaceClass::party_wall ? area : -area;
  }
  return party_less_open;
}

class GeoPackageWriter : public CityWriter {
 public:
  GeoPackageWriter(const Header& header, std::vector<Layer> more, std::unique_ptr<base::Spool> records)
      : header_(header), more_(std::move(more)), pen_(header.frame), records_(std::move(records)) {}

  ~GeoPackageWriter() override {
    const GeopackageManners manners;
    file_.reset();
  }

  auto begin(const Path& place) -> base::Result<void> {
    const GeopackageManners manners;
    crs_ = crs::crs_of(header_.frame);
    if (!crs_) return geopackage_failure("understand the CRS " + header_.frame.crs);
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
    const std::string record = building_record(named);
    record_sizes_.push_back(record.size());
    records_->append(record);
    return row("mansard_records", {std::string("building"), building.id, record});
  }

  auto finish() -> base::Result<void> override {
    const GeopackageManners manners;
    if (auto done = add_footprints(); !done) return done;
    for (const Layer& layer : more_)
      if (auto done = add_layer(layer, pen_, *crs_, *file_); !done) return done;
    if (auto done = add_styles(*file_); !done) return done;
    if (file_->CommitTransaction() != OGRERR_NONE) return geopackage_failure("finish the file");
    CPLErrorReset();
    file_.reset();  // writes the extents, and the spatial indexes that are still due
    if (CPLGetLastErrorType() >= CE_Failure) return geopackage_failure("close the file");
    return {};
  }

 private:
  auto make(const std::string& name, const std::string& meaning, OGRwkbGeometryType type,
            const std::vector<Field>& fields) -> base::Result<void> {
    auto table = GeopackageTable::make(*file_, name, meaning, type, *crs_);
    if (!table) return table.error();
    if (auto done = table->add_fields(fields); !done) return done;
    table->take_place();
    tables_.emplace(name, *std::move(table));
    return {};
  }
  auto row(const std::string& table, const Values& values, std::unique_ptr<OGRGeometry> geometry = nullptr)
      -> base::Result<void> {
    return tables_.at(table).add_row(values, std::move(geometry));
  }

  auto make_tables() -> base::Result<void> {
    const std::vector<Field> ids{{"building_id"}, {"part_id"}};
    const auto with = [&](std::vector<Field> fields) {
      fields.insert(fields.begin(), ids.begin(), ids.end());
      return fields;
    };
    struct Plan {
      const char *name, *meaning;
      OGRwkbGeometryType type;
      std::vector<Field> fields;
    };
    const std::vector<Plan> plans{
        {"gis_footprints",
         "The footprints as they were read, with their own attributes and those of the buildings",
         wkbMultiPolygon,
         {{"building_id"}, {"parts", integer}, {"ground", real}}},
        {"footprints", "The plans of the parts, with the attributes of their models", wkbPolygon,
         with({{"base", real}, {"top", real}, {"area", real}})},
        {"edges", "The edges of the plans; the part is on their left", wkbLineString,
         with({{"ring", integer}, {"edge", integer}, {"profile", integer}, {"length", real}, {"party", boolean}})},
        {"roof_planes", "The faces of the roofs", wkbMultiPolygon25D,
         with({{"face", integer}, {"class"}, {"slope", real}, {"azimuth", real}, {"area", real}})},
        {"walls", "The walls, which stand upright: in plan they are lines", wkbMultiPolygon25D,
         with({{"face", integer}, {"class"}, {"azimuth", real}, {"area", real}, {"ring", integer}, {"edge", integer}})},
        {"profiles", "The profiles that edges rise along: [inward, height] in metres from the foot of the edge",
         wkbNone, with({{"profile", integer}, {"points"}})},
        {"made_by", "How this file was made", wkbNone, {{"name"}, {"value"}}},
        {records_name,
         "What mansard reads this file back from: plan + profiles",
         wkbNone,
         {{"kind"}, {"id"}, {"json"}}},
    };
    for (const auto& plan : plans)
      if (auto made = make(plan.name, plan.meaning, plan.type, plan.fields); !made) return made;
    if (auto done = add_made_by(); !done) return done;
    return row(records_name, {std::string("header"), Value(), header_record(header_)});
  }

  auto add_made_by() -> base::Result<void> {
    std::vector<std::pair<std::string, std::string>> said{{"mansard", header_.made_by.version}};
    for (const auto& input : header_.made_by.inputs) said.emplace_back("input", input.path + " sha256:" + input.sha256);
    said.insert(said.end(), header_.made_by.options.begin(), header_.made_by.options.end());
    for (const auto& [name, value] : said)
      if (auto done = row("made_by", {name, value}); !done) return done;
    return {};
  }

  auto add_edges(const std::string& building, const model::Part& part, const model::LabelledSolid& model)
      -> base::Result<void> {
    for (std::size_t i = 0; i < part.plan.profiles.size(); ++i)
      if (auto done = row("profiles", {building, part.id, as_whole(i), profile_json(part.plan.profiles[i])}); !done)
        return done;
    const auto party = party_edges(model);
    std::vector<const model::PlanRing*> rings{&part.plan.outer};
    for (const auto& hole : part.plan.holes) rings.push_back(&hole);
    for (std::uint32_t r = 0; r < rings.size(); ++r)
      for (std::uint32_t e = 0; e < rings[r]->points.size(); ++e) {
        const auto a = rings[r]->points[e], b = rings[r]->points[(e + 1) % rings[r]->points.size()];
        const auto found = party.find({r, e});
        Value is_party;
        if (found != party.end()) is_party = found->second > 0;
        if (auto done = row("edges",
                            {building, part.id, as_whole(r), as_whole(e), as_whole(rings[r]->profile_of_edge[e]),
                             length(b - a), is_party},
                            pen_.line({a, b}));
            !done)
          return done;
      }
    return {};
  }

  auto add_faces(const std::string& building, const std::string& part, const model::LabelledSolid& model)
      -> base::Result<void> {
    for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
      const auto& face = model.solid.faces[f];
      const auto [slope, azimuth] = slope_and_azimuth(face.normal);
      const double area = solid::area(model.solid, face);
      auto polygons = std::make_unique<OGRMultiPolygon>();
      polygons->addGeometryDirectly(pen_.face(model.solid, face).release());
      base::Result<void> done;
      if (model.classes[f] == FaceClass::roof) {
        constexpr double flat = 5;  // degrees, as of ms_area_roof_flat
        const std::string kind = std::get<double>(slope) <= flat ? "flat" : "sloped";
        done = row("roof_planes", {building, part, as_whole(f), kind, slope, azimuth, area}, std::move(polygons));
      } else if (model.classes[f] == FaceClass::wall || model.classes[f] == FaceClass::party_wall) {
        Values values{building, part, as_whole(f), std::string(class_name(model.classes[f])), azimuth, area, {}, {}};
        if (face.provenance) values[6] = as_whole(face.provenance->ring), values[7] = as_whole(face.provenance->edge);
        done = row("walls", values, std::move(polygons));
      }
      if (!done) return done;
    }
    return {};
  }

  /// Once all attributes are known.
  auto add_footprints() -> base::Result<void> {
    if (auto done = tables_.at("gis_footprints").add_fields(gis_columns_.fields()); !done) return done;
    if (auto done = tables_.at("footprints").add_fields(part_columns_.fields()); !done) return done;
    std::uint64_t at = 0;
    for (const std::size_t size : record_sizes_) {
      const auto record = records_->read(at, size);
      if (!record) return record.error();
      at += size;
      const auto building = read_building_record(*record, records_name);
      if (!building) return building.error();
      if (auto done = add_footprints(*building); !done) return done;
    }
    return {};
  }

  /// Polygons of one feature that touch along a line are no valid MultiPolygon; their union is.
  [[nodiscard]] auto gis_geometry(const std::vector<geometry::Polygon>& footprint) const
      -> std::unique_ptr<OGRGeometry> {
    if (footprint.empty()) return nullptr;
    auto polygons = pen_.polygons(footprint);
    if (polygons->IsValid() != 0) return polygons;
    const auto united = geometry::unite(footprint);
    return united ? pen_.polygons(*united) : std::move(polygons);
  }

  auto add_footprints(const model::Building& building) -> base::Result<void> {
    const auto joined = [](Values values, const Values& more) {
      values.insert(values.end(), more.begin(), more.end());
      return values;
    };
    const Values gis{building.id, as_whole(building.parts.size()), pen_.height(building.ground)};
    if (auto done = row("gis_footprints", joined(gis, gis_columns_.values(building.attributes)),
                        gis_geometry(building.footprint));
        !done)
      return done;
    for (const model::Part& part : building.parts) {
      const auto polygon = model::polygon_of(part.plan);
      const Values values{building.id, part.id, pen_.height(part.plan.base),
                          pen_.height(part.plan.base + part.plan.cap), geometry::area(polygon)};
      if (auto done = row("footprints", joined(values, part_columns_.values(part.attributes)), pen_.polygon(polygon));
          !done)
        return done;
    }
    return {};
  }

  const Header header_;
  const std::vector<Layer> more_;
  const Pen pen_;
  std::optional<OGRSpatialReference> crs_;
  GDALDatasetUniquePtr file_;
  std::map<std::string, GeopackageTable> tables_;
  Gate gate_;
  AttributeColumns gis_columns_, part_columns_;
  std::unique_ptr<base::Spool> records_;
  std::vector<std::size_t> record_sizes_;
};

/// Those of the same name say the same of the footprints and the making; what else has a taken name is of a
/// segmentation.
auto beside_ours(std::vector<Layer> more) -> std::vector<Layer> {
  std::erase_if(more, [](const Layer& layer) { return layer.name == "gis_footprints" || layer.name == "made_by"; });
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
    columns_ = {records_.GetLayerDefn()->GetFieldIndex("kind"), records_.GetLayerDefn()->GetFieldIndex("json")};
    if (columns_.first < 0 || columns_.second < 0) return no_plans("its table mansard_records lacks a column");
    const OGRFeatureUniquePtr row(records_.GetNextFeature());
    if (!row || row->GetFieldAsString(columns_.first) != std::string_view("header"))
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

auto geopackage_writer(const Path& path, const Header& header, const std::vector<Layer>& more, base::Outputs& outputs)
    -> WriterResult {
  auto layers = beside_ours(more);
  if (const auto sound = check_layers(layers); !sound) return sound.error();
  auto records = base::Spool::open();
  if (!records) return records.error();
  const auto place = outputs.place(path);
  if (!place) return place.error();
  crs::register_gdal();
  auto writer = std::make_unique<GeoPackageWriter>(header, std::move(layers), std::move(*records));
  if (auto begun = writer->begin(*place); !begun) return begun.error();
  return WriterResult(std::move(writer));
}

auto geopackage_reader(const Path& path) -> ReaderResult {
  std::error_code status;
  if (!std::filesystem::exists(path, status))
    return base::error("file-missing", "no such file; check the path", path.string());
  crs::register_gdal();
  const GeopackageManners manners;
  GDALDatasetUniquePtr file(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!file)
    return base::error("write-read-format",
                       "this is no GeoPackage" + crs::gdal_words() + "; give one that mansard wrote", path.string());
  OGRLayer* records = file->GetLayerByName(records_name);
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
