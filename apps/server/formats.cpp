#include "apps/server/formats.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "mansard/base/options.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::string_view archive = ".zip";

/// What is read of a format. Written formats come from formats::formats() and have the same names.
struct ReadFormat {
  std::string_view name, description;
  Words extensions;  ///< in lower case, without the dot
  Words sidecars;    ///< extensions of files that are read along with one of the format
  Words reads;       ///< "mesh", "raster", "footprints", "models"
};

auto read_formats() -> const std::vector<ReadFormat>& {
  static const std::vector<ReadFormat> all{
      {"obj", "Wavefront OBJ", {"obj"}, {"mtl", "png", "jpg", "jpeg"}, {"mesh", "models"}},
      {"ply", "Stanford PLY, text or binary", {"ply"}, {}, {"mesh"}},
      {"off", "Object File Format, text", {"off"}, {}, {"mesh"}},
      {"glb", "Binary glTF", {"glb"}, {}, {"mesh", "models"}},
      {"gltf", "glTF", {"gltf"}, {"bin", "png", "jpg", "jpeg"}, {"mesh"}},
      {"tiles", "3D Tiles", {"3tz"}, {}, {"mesh", "models"}},
      {"geotiff", "GeoTIFF with heights", {"tif", "tiff"}, {"tfw"}, {"raster"}},
      {"vrt", "GDAL virtual raster with heights", {"vrt"}, {}, {"raster"}},
      {"aaigrid", "Arc/Info ASCII grid with heights", {"asc"}, {"prj"}, {"raster"}},
      {"hfa", "Erdas Imagine raster with heights", {"img"}, {}, {"raster"}},
      {"geojson", "GeoJSON", {"geojson", "json"}, {}, {"footprints", "models"}},
      {"geopackage", "GeoPackage", {"gpkg"}, {}, {"footprints", "models"}},
      {"shapefile", "ESRI Shapefile", {"shp", "zip"}, {"shx", "dbf", "prj", "cpg", "qmd"}, {"footprints"}},
      {"gml", "GML", {"gml"}, {}, {"footprints"}},
      {"flatgeobuf", "FlatGeobuf", {"fgb"}, {}, {"footprints"}},
      {"kml", "KML", {"kml"}, {}, {"footprints"}},
      {"osm", "OpenStreetMap", {"osm", "pbf"}, {}, {"footprints"}},
      {"cityjson", "CityJSON", {"json"}, {}, {"footprints", "models"}},
      {"cityjsonseq", "CityJSONSeq", {"jsonl"}, {}, {"footprints", "models"}},
      {"plans", "Plans and profiles", {"json"}, {}, {"models"}},
  };
  return all;
}

auto json_of(std::string_view name, std::string_view description, const ReadFormat* read,
             const formats::FormatName* written) -> Json {
  const Words none;
  return {{"name", name},
          {"description", description},
          {"extensions", read != nullptr ? read->extensions : none},
          {"sidecars", read != nullptr ? read->sidecars : none},
          {"reads", read != nullptr ? read->reads : none},
          {"files", written != nullptr ? files_of(written->format) : std::vector<std::string>()}};
}

}  // namespace

auto formats_json() -> Json {
  Json all = Json::array();
  for (const auto& written : formats::formats()) {
    const auto read = std::ranges::find(read_formats(), written.name, &ReadFormat::name);
    all.push_back(json_of(written.name, written.meaning, read == read_formats().end() ? nullptr : &*read, &written));
  }
  for (const auto& read : read_formats())
    if (std::ranges::find(formats::formats(), read.name, &formats::FormatName::name) == formats::formats().end())
      all.push_back(json_of(read.name, read.description, &read, nullptr));
  return all;
}

auto compressed_extensions_json() -> Json { return Json::array({"gz"}); }

auto has_mesh_extension(const std::filesystem::path& path) -> bool {
  auto extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension.empty()) return false;
  const auto has = [](const Words& words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
  };
  return std::ranges::any_of(read_formats(), [&](const auto& format) {
    return has(format.reads, "mesh") && has(format.extensions, std::string_view(extension).substr(1));
  });
}

auto files_of(formats::Format format) -> std::vector<std::string> {
  std::vector<std::string> names;
  for (const auto& place : formats::places_of({format, formats::name_in_folder(format)}))
    names.push_back(place.string() + std::string(format == formats::Format::tiles ? archive : ""));
  return names;
}

auto formats_named(const std::vector<std::string>& names) -> base::Result<std::vector<formats::Format>> {
  std::vector<std::string> known;
  for (const auto& format : formats::formats()) known.emplace_back(format.name);
  for (const auto& name : names)
    if (std::ranges::find(known, name) == known.end())
      return base::error(
          "option-value",
          "unknown format '" + base::on_one_line(name) + "'" + base::did_you_mean(base::nearest_word(name, known)),
          base::on_one_line(name));
  std::vector<formats::Format> out;
  for (const auto& format : formats::formats())
    if (names.empty() || std::ranges::find(names, format.name) != names.end()) out.push_back(format.format);
  return out;
}

}  // namespace mansard::server
