#include "mansard/formats/stream.hpp"

#include <fstream>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/attribute_choice.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/drivers.hpp"

namespace mansard::formats {

auto formats() -> const std::vector<FormatName>& {
  static const std::vector<FormatName> all = [] {
    std::vector<FormatName> out;
    for (const auto& driver : drivers())
      if (driver.writes) out.push_back({*driver.writes, driver.name, driver.extensions.front(), driver.description});
    return out;
  }();
  return all;
}

auto format_of(const std::filesystem::path& path) -> std::optional<Format> {
  const std::string name = base::lower(path.filename().string());
  std::error_code status;
  if (name == "tileset.json" || name.find('.') == std::string::npos || std::filesystem::is_directory(path, status))
    return Format::tiles;
  if (name.ends_with(".city.jsonl") || name.ends_with(".jsonl")) return Format::cityjsonseq;
  for (const auto& format : formats())  // ".city.json" comes before ".json"
    if (name.ends_with(format.ending)) return format.format;
  return std::nullopt;
}

auto option_list(WriteOptions& o) -> base::OptionList {
  return std::move(
      base::OptionList("write")
          .string("lod", o.lod,
                  "Levels of detail that are written (0, 1.2, 1.3, 2.0, 2.2): of all formats as '1.2,2.2', of some as "
                  "'cityjson=0,1.2;obj=1.3'. By default 0, 1.2, 1.3 and 2.2 where a format has several, else 2.2.")
          .alias("lod")
          .string("attributes", o.attributes,
                  "Attributes of buildings that are written beside those of the source: 'all', 'none', the names of "
                  "'3dbag' or 'roofer', or a list such as 'ms_h_ground,ms_h_roof_max=top', which also renames.")
          .alias("attributes")
          .string("title", o.title, "Title of the data set, for the metadata of the files.")
          .string("date", o.date, "Date of the data set, as YYYY-MM-DD, for the metadata of the files.")
          .string("lineage", o.lineage, "What the data set was made from, for the metadata of the files.")
          .string("contact", o.contact, "Who to contact about the data set: a name, and an e-mail address in < >.")
          .choice("solids", o.solids, {{"building", Solids::building}, {"part", Solids::part}},
                  "What one solid of CityJSON, OBJ, GLB and 3D Tiles contains.")
          .choice("stl_shell", o.stl_shell,
                  {{"part", Shell::part}, {"building", Shell::building}, {"block", Shell::block}},
                  "What one closed shell of an STL contains.")
          .flag("compress", o.compress, "Compress the meshes of GLB and 3D Tiles (meshopt, quantised).")
          .number("tile_triangles", o.tile_triangles, "", {100, 1e7}, "Triangles of a leaf of a tileset, at most.")
          .choice("texture_format", o.texture_format, {{"jpeg", TextureFormat::jpeg}, {"webp", TextureFormat::webp}},
                  "Codec of the textures of GLB and 3D Tiles; OBJ, CityJSON and CityGML always have JPEG.")
          .integer("texture_quality", o.texture_quality, "", {1, 100}, "Quality of JPEG and WebP textures.")
          .alias("texture_quality")
          .integer("atlas_size", o.atlas_size, "px", {256, 16384}, "Side length of an image with textures, at most.")
          .flag(
              "unlit", o.unlit,
              "Mark the textured materials of GLB and 3D Tiles as unlit (KHR_materials_unlit): scans have their light "
              "in the picture.")
          .number("tiles_height_offset", o.tiles_height_offset, "m", {-12000, 12000},
                  "Height that is added to 3D Tiles, whose heights are above the ellipsoid: the height of the geoid "
                  "where PROJ has no grid for it (about 43 m in the Netherlands).")
          .alias("tiles-height-offset")
          .choice("obj_up", o.obj_up, {{"z", UpAxis::z}, {"y", UpAxis::y}}, "The axis of an OBJ that points up.")
          .flag("obj_local", o.obj_local,
                "Write the coordinates of an OBJ relative to the origin that its first lines name, for programs with "
                "single precision.")
          .choice("citygml", o.citygml, {{"2.0", CityGml::v2}, {"3.0", CityGml::v3}},
                  "Version of CityGML that is written."));
}

namespace {

auto open_plain(Format format, const std::filesystem::path& path, const Header& header, const WriteOptions& options,
                base::Outputs& outputs, const std::vector<Layer>& more) -> base::Result<std::unique_ptr<CityWriter>> {
  switch (format) {
    case Format::cityjson: return detail::cityjson_writer(path, header, options, outputs);
    case Format::cityjsonseq: return detail::cityjsonseq_writer(path, header, options, outputs);
    case Format::obj: return detail::obj_writer(path, header, options, outputs);
    case Format::glb: return detail::glb_writer(path, header, options, outputs);
    case Format::tiles: return detail::tiles_writer(path, header, options, outputs);
    case Format::geopackage: return detail::geopackage_writer(path, header, options, more, outputs);
    case Format::stl: return detail::stl_writer(path, header, options, outputs);
    case Format::geojson: return detail::geojson_writer(path, header, outputs);
    case Format::citygml: return detail::citygml_writer(path, header, options, outputs);
    case Format::dxf: return detail::dxf_writer(path, header, options, outputs);
    case Format::flatgeobuf: return detail::flatgeobuf_writer(path, header, outputs);
    case Format::plans: break;
  }
  return detail::plans_writer(path, header, outputs);
}

/// Passes buildings on with the attributes that were chosen.
class Choosing : public CityWriter {
 public:
  Choosing(std::unique_ptr<CityWriter> inner, AttributeChoice choice)
      : inner_(std::move(inner)), choice_(std::move(choice)), unseen_(choice_.listed()) {}
  [[nodiscard]] auto add(const model::Building& building) -> base::Result<void> override {
    std::erase_if(unseen_, [&](const std::string& name) {
      return std::ranges::find(building.attributes, name, [](const auto& own) { return own.first; }) !=
             building.attributes.end();
    });
    any_ = true;
    model::Building copy = building;
    copy.attributes = choice_.chosen(building.attributes);
    return inner_->add(copy);
  }
  [[nodiscard]] auto finish() -> base::Result<void> override { return inner_->finish(); }
  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override {
    auto all = inner_->warnings();
    for (const auto& name : unseen_)
      if (any_)
        all.push_back(base::warning("write-attribute-missing",
                                    "no building has the attribute '" + name +
                                        "'; 'mansard options --attributes' lists those that there may be",
                                    "--attributes"));
    return all;
  }

 private:
  std::unique_ptr<CityWriter> inner_;
  AttributeChoice choice_;
  std::vector<std::string> unseen_;  ///< names of a list that no building has had
  bool any_ = false;                 ///< whether there was a building
};

}  // namespace

auto open_writer(Format format, const std::filesystem::path& path, const Header& header, const WriteOptions& options,
                 base::Outputs& outputs, const std::vector<Layer>& more) -> base::Result<std::unique_ptr<CityWriter>> {
  auto choice = AttributeChoice::of(options.attributes);
  if (!choice) return choice.failure();
  if (auto known = check_lods(options.lod); !known) return known.failure();
  auto writer = open_plain(format, path, header, options, outputs, more);
  if (!writer || choice->is_all()) return writer;
  return std::unique_ptr<CityWriter>(std::make_unique<Choosing>(*std::move(writer), *std::move(choice)));
}

auto write_city(const model::City& city, CityWriter& writer) -> base::Result<void> {
  // Parts may carry the id of a building that comes later; only the whole city shows it.
  const auto keys = detail::keys_of(city);
  if (!keys) return keys.error();
  for (std::size_t b = 0; b < city.buildings.size(); ++b) {
    const model::Building& building = city.buildings[b];
    bool same = true;
    for (std::size_t p = 0; p < building.parts.size(); ++p) same = same && building.parts[p].id == keys->parts[b][p];
    if (same) {
      if (auto added = writer.add(building); !added) return added;
      continue;
    }
    model::Building renamed = building;
    for (std::size_t p = 0; p < building.parts.size(); ++p) renamed.parts[p].id = keys->parts[b][p];
    if (auto added = writer.add(renamed); !added) return added;
  }
  return writer.finish();
}

namespace {

/// What a file is by its first bytes; none where they do not tell.
auto format_in(const std::filesystem::path& path) -> std::optional<Format> {
  std::error_code status;
  if (std::filesystem::is_directory(path, status) || path.filename() == "tileset.json") return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::string start(4096, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  if (start.starts_with("glTF")) return Format::glb;
  if (start.starts_with("SQLite format 3")) return Format::geopackage;
  const auto first = start.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || start[first] != '{') return std::nullopt;
  // The name of its own type comes before what it may speak of. Whether CityJSON is a sequence its reader sees.
  const std::initializer_list<std::pair<std::string_view, Format>> types{{"\"CityJSON\"", Format::cityjson},
                                                                         {"\"mansard-plan\"", Format::plans},
                                                                         {"\"FeatureCollection\"", Format::geojson}};
  std::optional<Format> found;
  auto least = std::string::npos;
  for (const auto& [type, format] : types)
    if (const auto at = start.find(type); at < least) {
      least = at;
      found = format;
    }
  return found;
}

}  // namespace

auto read_city(const std::filesystem::path& path) -> base::Result<std::unique_ptr<CityReader>> {
  if (auto checked = base::check_no_pipe(path); !checked) return checked.failure();
  // By what is in it before its name.
  auto format = format_in(path);
  if (!format) format = format_of(path);
  if (!format)
    return base::error(
        "write-read-format",
        "no format of building models has this file extension; these are read: " + extensions_in_words(&Reads::results),
        path.string());
  switch (*format) {
    case Format::cityjson:
    case Format::cityjsonseq: return detail::cityjson_reader(path);
    case Format::obj: return detail::obj_reader(path);
    case Format::glb: return detail::glb_reader(path);
    case Format::tiles: return detail::tiles_reader(path);
    case Format::geopackage: return detail::geopackage_reader(path);
    case Format::geojson: return detail::geojson_reader(path);
    case Format::plans: return detail::plans_reader(path);
    default: break;
  }
  return base::error("write-read-format",
                     "STL, CityGML, DXF and FlatGeobuf have no plans; give another format of the same models",
                     path.string());
}

auto read_whole(CityReader& reader, std::vector<base::Diagnostic>* refused) -> base::Result<model::City> {
  model::City city{reader.header().frame, reader.header().made_by, {}};
  for (;;) {
    auto next = reader.next();
    if (!next) return next.failure();
    if (!*next) break;
    city.buildings.push_back(std::move(**next));
  }
  auto without = reader.refused();
  if (refused == nullptr && !without.empty()) return base::Failure{std::move(without)};
  if (refused != nullptr) *refused = std::move(without);
  return city;
}

}  // namespace mansard::formats
