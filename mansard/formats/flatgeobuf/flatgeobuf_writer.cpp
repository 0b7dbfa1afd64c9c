// Footprints with the attributes of their buildings as FlatGeobuf, by GDAL. Its header lists all columns, so that
// buildings are put aside until the end.
#include "mansard/crs/gdal.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/geopackage/geopackage_tables.hpp"

namespace mansard::formats::detail {
namespace {

constexpr const char *id_column = "building_id", *layer_name = "footprints";

class FlatGeobufWriter : public CityWriter {
 public:
  FlatGeobufWriter(const Header& header, std::unique_ptr<base::Spool> records, base::Sink& file)
      : header_(header), pen_(header.frame), records_(std::move(records)), file_(file) {}

  auto add(const model::Building& building) -> base::Result<void> override {
    const auto keyed = gate_.admit(building);
    if (!keyed) return keyed.error();
    columns_.add(building.attributes);
    const model::Building plain{building.id, building.attributes, building.footprint, building.ground, {}, {}};
    const std::string record = building_record(plain);
    sizes_.push_back(record.size());
    records_->append(record);
    return {};
  }

  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override {
    const auto some = columns_.warning("buildings");
    return some ? std::vector{*some} : std::vector<base::Diagnostic>();
  }

  auto finish() -> base::Result<void> override {
    const GeopackageManners manners;
    // GDAL's writer wants a name with this extension, and makes folders of others.
    const std::string name = "/vsimem/mansard-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".fgb";
    auto made = write(name);
    vsi_l_offset size = 0;
    if (const auto* bytes = VSIGetMemFileBuffer(name.c_str(), &size, FALSE); made && bytes != nullptr)
      file_.append({reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)});
    else if (made) made = failure("find what it wrote");
    VSIUnlink(name.c_str());
    return made;
  }

 private:
  static auto failure(const std::string& what) -> base::Diagnostic {
    return base::error("write-flatgeobuf", "GDAL cannot " + what + crs::gdal_words());
  }

  auto write(const std::string& name) -> base::Result<void> {
    auto crs = crs::crs_of(header_.frame);
    if (!crs) return failure("understand the CRS " + header_.frame.crs);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("FlatGeobuf");
    if (driver == nullptr) return failure("find its FlatGeobuf driver");
    GDALDatasetUniquePtr file(driver->Create(name.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!file) return failure("start the file");
    OGRLayer* layer = file->CreateLayer(layer_name, header_.frame.crs.empty() ? nullptr : &*crs, wkbMultiPolygon);
    if (layer == nullptr) return failure("make its layer");
    auto fields = columns_.fields();
    fields.insert(fields.begin(), {id_column, FieldType::string});
    auto table = GeopackageTable::over(*layer);
    if (auto done = table.add_fields(fields); !done) return done;
    std::uint64_t at = 0;
    for (const std::size_t size : sizes_) {
      const auto record = records_->read(at, size);
      if (!record) return record.error();
      at += size;
      const auto building = read_building_record(*record, layer_name);
      if (!building) return building.error();
      auto values = columns_.values(building->attributes);
      values.insert(values.begin(), building->id);
      std::unique_ptr<OGRGeometry> shape;
      if (!building->footprint.empty()) shape = pen_.polygons(building->footprint);
      if (auto done = table.add_row(values, std::move(shape)); !done) return done;
    }
    CPLErrorReset();
    file.reset();
    if (CPLGetLastErrorType() >= CE_Failure) return failure("close the file");
    return {};
  }

  const Header header_;
  const Pen pen_;
  Gate gate_;
  AttributeColumns columns_;
  std::unique_ptr<base::Spool> records_;
  std::vector<std::size_t> sizes_;
  base::Sink& file_;
};

}  // namespace

auto flatgeobuf_writer(const Path& path, const Header& header, base::Outputs& outputs) -> WriterResult {
  auto records = base::Spool::open();
  if (!records) return records.error();
  const auto file = outputs.file(path);
  if (!file) return file.error();
  crs::register_gdal();
  return WriterResult(std::make_unique<FlatGeobufWriter>(header, std::move(*records), **file));
}

}  // namespace mansard::formats::detail
