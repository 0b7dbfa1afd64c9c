#include "mansard/formats/las/las_crs.hpp"

#include <cpl_vsi.h>
#include <gdal.h>
#include <ogr_spatialref.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"

namespace mansard::formats {
namespace {

constexpr std::uint16_t wkt_record = 2112, directory_record = 34735, doubles_record = 34736, text_record = 34737;
constexpr std::string_view projection = "LASF_Projection";

/// Metres; none for units that clouds are not in.
auto length_unit(int code) -> std::optional<double> {
  switch (code) {
    case 9001: return 1.0;
    case 9002: return 0.3048;
    case 9003: return 1200.0 / 3937;
    default: return std::nullopt;
  }
}

/// The keys that have their value in the directory.
auto short_keys(std::string_view directory) -> std::map<int, int> {
  std::map<int, int> keys;
  constexpr std::size_t entry = 8;
  for (std::size_t at = entry; at + entry <= directory.size(); at += entry)
    if (number_at<std::uint16_t>(directory, at + 2) == 0)
      keys[number_at<std::uint16_t>(directory, at)] = number_at<std::uint16_t>(directory, at + 6);
  return keys;
}

void put(std::string& to, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 0xff);
}

/// A TIFF of one pixel with the keys, since GDAL reads them from TIFF alone.
auto tiff_with(const LasRecord& directory, const LasRecord* doubles, const LasRecord* text) -> std::string {
  struct Tag {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string value;
  };
  enum : std::uint16_t { ascii = 2, short_type = 3, long_type = 4, double_type = 12 };
  const auto number = [](std::uint16_t tag, std::uint32_t value) {
    std::string bytes;
    put(bytes, value, 4);
    return Tag{tag, long_type, 1, bytes};
  };
  const auto reals = [](std::uint16_t tag, std::vector<double> values) {
    std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
    return Tag{tag, double_type, static_cast<std::uint32_t>(values.size()), bytes};
  };
  constexpr std::uint32_t pixel_at = 8, directory_at = 10;
  std::vector<Tag> tags{number(256, 1),
                        number(257, 1),
                        number(258, 8),
                        number(259, 1),
                        number(262, 1),
                        number(273, pixel_at),
                        number(277, 1),
                        number(278, 1),
                        number(279, 1),
                        reals(33550, {1, 1, 1}),
                        reals(33922, {0, 0, 0, 0, 0, 0})};
  const auto whole = [](const std::string& content, std::size_t item) {
    return content.substr(0, content.size() / item * item);
  };
  const auto shorts = whole(directory.content, 2);
  tags.push_back({directory_record, short_type, static_cast<std::uint32_t>(shorts.size() / 2), shorts});
  if (doubles != nullptr && doubles->content.size() >= 8) {
    const auto values = whole(doubles->content, 8);
    tags.push_back({doubles_record, double_type, static_cast<std::uint32_t>(values.size() / 8), values});
  }
  if (text != nullptr && !text->content.empty())
    tags.push_back({text_record, ascii, static_cast<std::uint32_t>(text->content.size()), text->content});

  std::string out = "II";
  put(out, 42, 2);
  put(out, directory_at, 4);
  put(out, 0, 2);  // the pixel
  put(out, tags.size(), 2);
  std::size_t behind = directory_at + 2 + 12 * tags.size() + 4;
  std::string values;
  for (const auto& tag : tags) {
    put(out, tag.tag, 2);
    put(out, tag.type, 2);
    put(out, tag.count, 4);
    if (tag.value.size() <= 4) {
      out += tag.value + std::string(4 - tag.value.size(), '\0');
      continue;
    }
    put(out, behind + values.size(), 4);
    values += tag.value;
    if (values.size() % 2 != 0) values += '\0';
  }
  put(out, 0, 4);
  return out + values;
}

auto system_of_keys(const LasRecord& directory, const LasRecord* doubles, const LasRecord* text)
    -> std::optional<crs::Crs> {
  crs::register_gdal();
  static std::atomic<std::uint64_t> number = 0;
  const std::string path = "/vsimem/mansard/las-keys-" + std::to_string(number++) + ".tif";
  auto bytes = tiff_with(directory, doubles, text);
  VSIFCloseL(VSIFileFromMemBuffer(path.c_str(), reinterpret_cast<GByte*>(bytes.data()), bytes.size(), FALSE));
  const char* drivers[] = {"GTiff", nullptr};
  std::optional<crs::Crs> out;
  if (GDALDatasetH data = GDALOpenEx(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr);
      data != nullptr) {
    if (const auto* system = OGRSpatialReference::FromHandle(GDALGetSpatialRef(data)); system != nullptr) {
      out.emplace();
      out->system = *system;
      out->system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    GDALClose(data);
  }
  VSIUnlink(path.c_str());
  return out;
}

/// Of a plane or geographic system, with what is known of its heights.
auto cloud_crs(const crs::Crs& given, std::optional<double> height_unit) -> std::optional<CloudCrs> {
  const auto flat = crs::flat(given.system);
  const bool projected = flat.system.IsProjected() != 0;
  if (!projected && flat.system.IsGeographic() == 0) return std::nullopt;
  CloudCrs out;
  out.crs.wkt = crs::wkt_of(flat.system);
  if (!height_unit && given.system.IsVertical() != 0) height_unit = given.system.GetTargetLinearUnits("VERT_CS");
  if (!height_unit) height_unit = projected ? flat.system.GetLinearUnits() : 1.0;
  out.crs.height_unit = *height_unit;
  out.unit = projected ? flat.system.GetLinearUnits() : 0;
  out.title = crs::title_of(given.system);
  if (projected && !crs::in_metres(flat.system)) {
    const char* unit = nullptr;
    flat.system.GetLinearUnits(&unit);
    if (unit != nullptr) out.title += std::string(" in ") + unit;
  }
  return out;
}

auto crs_of_keys(const LasHeader& header) -> std::optional<CloudCrs> {
  const auto* directory = header.find(projection, directory_record);
  const auto keys = short_keys(directory->content);
  const auto key = [&](int name) { return keys.contains(name) ? keys.at(name) : 0; };
  auto system =
      system_of_keys(*directory, header.find(projection, doubles_record), header.find(projection, text_record));
  // Programs write the code of a system in metres beside coordinates in feet, and say so in the key of the unit.
  if (const auto unit = length_unit(key(3076));
      system && unit && system->system.IsProjected() != 0 && std::abs(system->system.GetLinearUnits() - *unit) > 1e-9) {
    auto flat = crs::flat(system->system);
    flat.system.SetLinearUnitsAndUpdateParameters(key(3076) == 9001   ? "metre"
                                                  : key(3076) == 9002 ? "foot"
                                                                      : "US survey foot",
                                                  *unit);
    system = std::move(flat);
  }
  if (!system) return std::nullopt;
  std::optional<double> height = length_unit(key(4099));
  if (const int vertical = key(4096); !height && vertical > 1024 && vertical < 32767) {
    OGRSpatialReference heights;
    if (heights.importFromEPSG(vertical) == OGRERR_NONE && heights.IsVertical() != 0)
      height = heights.GetTargetLinearUnits("VERT_CS");
  }
  return cloud_crs(*system, height);
}

}  // namespace

auto crs_of_wkt(std::string_view wkt) -> std::optional<CloudCrs> {
  const crs::GdalMessages messages;
  const auto system = crs::from_wkt(std::string(wkt.substr(0, wkt.find('\0'))));
  return system ? cloud_crs(*system, std::nullopt) : std::nullopt;
}

auto crs_of_las(LasHeader& header, const std::string& name) -> std::optional<CloudCrs> {
  const crs::GdalMessages messages;
  const auto* wkt = header.find(projection, wkt_record);
  if (wkt != nullptr && wkt->content.find_first_not_of(std::string_view("\0 \r\n\t", 5)) == std::string::npos)
    wkt = nullptr;
  const auto* directory = header.find(projection, directory_record);
  const bool has_keys = directory != nullptr && !short_keys(directory->content).empty();
  std::optional<CloudCrs> out;
  if (wkt != nullptr && (header.wkt || !has_keys)) out = crs_of_wkt(wkt->content);
  if (!out && has_keys) out = crs_of_keys(header);
  if (!out && wkt != nullptr && !header.wkt) out = crs_of_wkt(wkt->content);
  if (!out && (wkt != nullptr || has_keys))
    header.warnings.push_back(base::warning(
        "ingest-points-crs",
        "the file has a record of its CRS that is not valid; its coordinates are taken to be in the working CRS",
        name));
  return out;
}

}  // namespace mansard::formats
