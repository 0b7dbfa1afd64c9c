// Footprints as GeoJSON (RFC 7946): a Feature a line, so that files of any size can be written and read back.
#include <ogr_spatialref.h>
#include <fstream>

#include "mansard/base/text.hpp"
#include "mansard/crs/gdal_frame.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;

constexpr std::string_view start_of_file = R"({"type":"FeatureCollection","mansard":)";
constexpr std::string_view start_of_features = R"(,"features":[)";
constexpr std::string_view in_metres =
    R"(,"mansard_coordinates":"metres, x east and y north, in no known reference system: not RFC 7946")";
/// The last member of a building's first feature.
constexpr std::string_view start_of_record = R"(,"mansard":)";

/// From the local frame to the coordinates of the file.
class LonLatPen {
 public:
  explicit LonLatPen(const model::Frame& frame)
      : origin_{static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1])} {}

  /// False where the frame has a CRS that cannot be brought to longitude and latitude.
  auto begin(const model::Frame& frame) -> bool {
    if (frame.crs.empty()) return true;
    const auto from = crs::crs_of(frame);
    OGRSpatialReference to;
    to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (!from || to.importFromEPSG(4326) != OGRERR_NONE) return false;
    way_.reset(OGRCreateCoordinateTransformation(&*from, &to));
    return way_ != nullptr;
  }

  /// False where a point cannot be brought along.
  auto append(JsonText& json, const Polygon& local) const -> bool {
    Polygon polygon = local;
    if (!take_along(polygon.outer)) return false;
    for (auto& hole : polygon.holes)
      if (!take_along(hole)) return false;
    polygon = geometry::oriented(std::move(polygon));
    append_ring(json.begin_array(), polygon.outer);
    for (const auto& hole : polygon.holes) append_ring(json, hole);
    json.end_array();
    return true;
  }

 private:
  auto take_along(geometry::Ring& ring) const -> bool {
    for (Point2& p : ring) {
      p = p + origin_;
      if (way_ && (way_->Transform(1, &p.x, &p.y) == FALSE || !std::isfinite(p.x) || !std::isfinite(p.y))) return false;
    }
    return true;
  }

  void append_ring(JsonText& json, const geometry::Ring& ring) const {
    constexpr int decimals = 9;  // a tenth of a millimetre
    json.begin_array();
    for (std::size_t i = 0; i <= ring.size(); ++i) {
      const Point2 p = ring[i % ring.size()];
      json.begin_array();
      if (way_) json.raw(base::to_text(p.x, decimals)).raw(base::to_text(p.y, decimals));
      else json.number(p.x).number(p.y);
      json.end_array();
    }
    json.end_array();
  }

  Point2 origin_;
  std::unique_ptr<OGRCoordinateTransformation> way_;
};

class GeoJsonWriter : public CityWriter {
 public:
  GeoJsonWriter(LonLatPen pen, const Header& header, base::Sink& file) : pen_(std::move(pen)), file_(file) {
    file_.append(start_of_file);
    file_.append(header_record(header));
    if (header.frame.crs.empty()) file_.append(in_metres);
    file_.append(start_of_features);
  }

  auto add(const model::Building& building) -> base::Result<void> override {
    const auto keyed = gate_.admit(building);
    if (!keyed) return keyed.error();
    model::Building record = building;
    for (std::size_t p = 0; p < building.parts.size(); ++p) record.parts[p].id = keyed->parts[p];
    std::string text = building_record(record);
    if (building.parts.empty()) return append(building, nullptr, text);
    for (const model::Part& part : record.parts) {
      if (auto done = append(building, &part, text); !done) return done;
      text.clear();
    }
    return {};
  }

  auto finish() -> base::Result<void> override {
    file_.append("\n]}\n");
    return {};
  }

 private:
  auto append(const model::Building& building, const model::Part* part, const std::string& record)
      -> base::Result<void> {
    const std::string& id = part != nullptr ? part->id : building.id;
    JsonText json;
    json.begin_object().key("type").text("Feature").key("id").text(id).key("geometry");
    if (!append_geometry(json, building, part))
      return base::error("write-geojson",
                         "its footprint cannot be brought to longitude and latitude; give the CRS that "
                         "its coordinates are in",
                         id);
    append_properties(json.key("properties"), building, part);
    if (!record.empty()) json.key("mansard").raw(record);
    file_.append(first_ ? "\n" : ",\n");
    file_.append(json.end_object().str());
    first_ = false;
    return {};
  }

  auto append_geometry(JsonText& json, const model::Building& building, const model::Part* part) const -> bool {
    if (part != nullptr) {
      json.begin_object().key("type").text("Polygon").key("coordinates");
      if (!pen_.append(json, model::polygon_of(part->plan))) return false;
      json.end_object();
      return true;
    }
    if (building.footprint.empty()) {
      json.null();
      return true;
    }
    json.begin_object().key("type").text("MultiPolygon").key("coordinates").begin_array();
    for (const auto& polygon : building.footprint)
      if (!pen_.append(json, polygon)) return false;
    json.end_array().end_object();
    return true;
  }

  /// The building's attributes, then the part's, of which those with a name that both have are kept.
  static void append_properties(JsonText& json, const model::Building& building, const model::Part* part) {
    model::Attributes all = building.attributes;
    if (part != nullptr) all.insert(all.end(), part->attributes.begin(), part->attributes.end());
    std::erase_if(all, [](const auto& a) { return a.first == "building_id" || a.first == "part_id"; });
    json.begin_object().key("building_id").text(building.id).key("part_id");
    if (part != nullptr) json.text(part->id);
    else json.null();
    append_attributes(json, all);
    json.end_object();
  }

  LonLatPen pen_;
  base::Sink& file_;
  Gate gate_;
  bool first_ = true;
};

auto no_plans(const std::string& what, const std::string& name) -> base::Diagnostic {
  return base::error("write-read-plans",
                     what +
                         "; give the file as mansard wrote it, or its footprints to "
                         "'mansard extrude' or 'mansard reconstruct'",
                     name);
}

class GeoJsonReader : public CityReader {
 public:
  GeoJsonReader(std::ifstream file, std::string name, Header header)
      : file_(std::move(file)), name_(std::move(name)), header_(std::move(header)) {}

  [[nodiscard]] auto header() const -> const Header& override { return header_; }
  [[nodiscard]] auto has_models() const -> bool override { return false; }
  auto next() -> base::Result<std::optional<model::Building>> override {
    for (std::string line; std::getline(file_, line);) {
      if (line == "]}") return std::optional<model::Building>();
      if (line.ends_with(',')) line.pop_back();
      const auto record = record_in(line);
      if (!record)
        return base::error(
            "write-read-plans",
            "a line of it is not a Feature as mansard writes them; give the file as mansard wrote it, or "
            "take out its member 'mansard', and 'mansard extrude' reads the footprints that are left",
            name_);
      if (record->empty()) continue;  // a further part
      auto building = read_building_record(*record, name_);
      if (!building) return building.error();
      return std::optional(*std::move(building));
    }
    return base::error("write-read-plans", "it is cut short; copy it again, as mansard wrote it", name_);
  }

 private:
  /// What follows the member "properties", or nothing. Texts are skipped, so that none can look like the member.
  static auto record_in(std::string_view line) -> std::optional<std::string_view> {
    if (!line.starts_with(R"({"type":"Feature",)") || !line.ends_with('}')) return std::nullopt;
    int depth = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (c == '{' || c == '[') ++depth;
      if (c == '}' || c == ']') --depth;
      if (c == '"')
        for (++i; i < line.size() && line[i] != '"';) i += line[i] == '\\' ? 2 : 1;
      if (depth == 1 && line.substr(i).starts_with(start_of_record))
        return line.substr(i + start_of_record.size(), line.size() - 1 - i - start_of_record.size());
    }
    return std::string_view();
  }

  std::ifstream file_;
  std::string name_;
  Header header_;
};

}  // namespace

auto geojson_writer(const Path& path, const Header& header, base::Outputs& outputs) -> WriterResult {
  LonLatPen pen(header.frame);
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  CPLErrorReset();
  if (!pen.begin(header.frame))
    return base::error(
        "write-geojson",
        "GDAL cannot go from the CRS " + header.frame.crs + " to longitude and latitude" + crs::gdal_words(),
        path.string());
  const auto file = outputs.file(path);
  if (!file) return file.error();
  return WriterResult(std::make_unique<GeoJsonWriter>(std::move(pen), header, **file));
}

auto geojson_reader(const Path& path) -> ReaderResult {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!file || !std::getline(file, line))
    return base::error("file-read", "this file cannot be read, or is empty", path.string());
  const std::size_t end = std::min(line.rfind(in_metres), line.rfind(start_of_features));
  if (!line.starts_with(start_of_file) || end == std::string::npos)
    return no_plans("this GeoJSON carries no plans: mansard did not write it, or another program has since",
                    path.string());
  auto header = read_header_record(std::string_view(line).substr(start_of_file.size(), end - start_of_file.size()),
                                   path.string());
  if (!header) return header.error();
  return ReaderResult(std::make_unique<GeoJsonReader>(std::move(file), path.string(), *std::move(header)));
}

}  // namespace mansard::formats::detail
