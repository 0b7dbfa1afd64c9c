#include "mansard/formats/ground_tiles.hpp"

#include <cpl_http.h>
#include <cpl_string.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/image/memory_file.hpp"
#include "mansard/formats/raster/warped_picture.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
using geometry::Box2;
using geometry::Point2;

constexpr double radius = 6'378'137;                     // m, of the sphere of EPSG:3857
constexpr double half_side = std::numbers::pi * radius;  // of the square that tile 0/0/0 is
constexpr int usual_side = 256;                          // pixels of a tile
constexpr int finest = 20;                               // zoom level: pixels of 9 cm in the Netherlands
constexpr int requests_at_a_time = 4;
constexpr std::size_t tiles_at_a_time = 32;                 // between two looks at the clock
constexpr std::size_t largest_tile = std::size_t{8} << 20;  // bytes
constexpr auto patience = std::chrono::seconds(60);         // for all tiles together
constexpr const char* seconds_of_a_request = "15";

auto bad_tiles(const std::string& what, const std::string& name) -> base::Diagnostic {
  return base::error("ingest-ground-tiles", what, base::on_one_line(name));
}

auto is_address(const std::string& name) -> bool {
  const auto start = base::lower(name.substr(0, 8));
  return start.starts_with("http://") || start.starts_with("https://");
}

/// The number that a file or folder is named after.
auto number_of(const fs::path& path) -> std::optional<std::int64_t> {
  const auto number = base::to_integer(path.stem().string());
  return number && *number >= 0 ? number : std::nullopt;
}

/// What in a folder is named after the lowest number, so that the answer does not depend on the order on disk.
auto lowest_in(const fs::path& folder, bool wants_folder) -> std::optional<fs::path> {
  std::optional<std::pair<std::int64_t, fs::path>> lowest;
  std::error_code status;
  for (fs::directory_iterator at(folder, status), end; !status && at != end; at.increment(status)) {
    const auto number = number_of(at->path());
    if (!number || at->is_directory(status) != wants_folder) continue;
    if (!lowest || std::pair(*number, at->path()) < *lowest) lowest.emplace(*number, at->path());
  }
  return lowest ? std::optional(lowest->second) : std::nullopt;
}

/// The name of a tile in a folder of folders, from the first that is there.
auto pattern_in(const fs::path& folder) -> std::optional<std::string> {
  const auto zoom = lowest_in(folder, true);
  const auto column = zoom ? lowest_in(*zoom, true) : std::nullopt;
  const auto tile = column ? lowest_in(*column, false) : std::nullopt;
  if (!tile) return std::nullopt;
  std::error_code status;  // the file says that rows are counted as in TMS; gdal2tiles writes it for such rows only
  const char* row = fs::exists(folder / "tilemapresource.xml", status) ? "{-y}" : "{y}";
  return (folder / "{z}" / "{x}" / (row + tile->extension().string())).string();
}

struct TileName {
  int zoom = 0;
  std::int64_t column = 0, row = 0;  // from the west and from the north
};

auto filled(std::string pattern, const TileName& tile) -> std::string {
  const std::int64_t rows = std::int64_t{1} << tile.zoom;
  for (const auto& [word, value] : {std::pair<std::string_view, std::int64_t>{"{z}", tile.zoom},
                                    {"{x}", tile.column},
                                    {"{y}", tile.row},
                                    {"{-y}", rows - 1 - tile.row}})
    for (auto at = pattern.find(word); at != std::string::npos; at = pattern.find(word, at))
      pattern.replace(at, word.size(), std::to_string(value));
  return pattern;
}

/// The bytes of a tile; none where the source says that it has none.
using Answer = base::Result<std::optional<std::string>>;

auto answer_of(const CPLHTTPResult* result, const std::string& address) -> Answer {
  if (result == nullptr) return bad_tiles("the server of the tiles does not answer", address);
  const std::string failure = result->pszErrBuf == nullptr ? "" : result->pszErrBuf;
  for (const char* missing : {"error code : 400", "error code : 404", "error code : 410"})
    if (failure.ends_with(missing)) return std::optional<std::string>();  // 400 is sent beyond the finest zoom level
  if (result->nStatus != 0 || !failure.empty())
    return bad_tiles("the server of the tiles does not send this one (" +
                         (failure.empty() ? "status " + std::to_string(result->nStatus) : failure) +
                         "); open the address in a browser, and check the network, the proxy (GDAL_HTTP_PROXY) and the "
                         "key, if it has one",
                     address);
  if (result->nDataLen <= 0) return std::optional<std::string>();
  if (static_cast<std::size_t>(result->nDataLen) > largest_tile)
    return bad_tiles("the tile has more than 8 MB; expected a picture of 256 or 512 pixels", address);
  return std::optional(
      std::string(reinterpret_cast<const char*>(result->pabyData), static_cast<std::size_t>(result->nDataLen)));
}

auto fetched(const std::vector<std::string>& addresses) -> std::vector<Answer> {
  CPLStringList options;
  options.SetNameValue("CONNECTTIMEOUT", seconds_of_a_request);
  options.SetNameValue("TIMEOUT", seconds_of_a_request);
  options.SetNameValue("USERAGENT", "mansard (serve --basemap)");
  std::vector<const char*> names;
  for (const auto& address : addresses) names.push_back(address.c_str());
  const auto count = static_cast<int>(names.size());
  CPLHTTPResult** results = CPLHTTPMultiFetch(names.data(), count, requests_at_a_time, options.List());
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < addresses.size(); ++i)
    answers.push_back(answer_of(results == nullptr ? nullptr : results[i], addresses[i]));
  CPLHTTPDestroyMultiResult(results, count);
  return answers;
}

auto read_all(const std::vector<std::string>& names) -> std::vector<Answer> {
  if (is_address(names.front())) return fetched(names);
  std::vector<Answer> answers;
  for (const auto& name : names) {
    std::error_code status;
    if (!fs::exists(name, status)) {
      answers.emplace_back(std::optional<std::string>());
      continue;
    }
    auto bytes = base::read_file(name);
    answers.push_back(bytes ? Answer(std::move(*bytes)) : Answer(bytes.failure()));
  }
  return answers;
}

/// A square picture, four bytes a pixel.
struct Pixels4 {
  int side = 0;
  std::vector<std::uint8_t> rgba;
};

auto decoded(std::string& bytes, const std::string& name) -> base::Result<Pixels4> {
  static std::atomic<std::uint64_t> count{0};
  crs::GdalMessages messages;
  const WithoutSidecars without;
  const MemoryFile file("/vsimem/mansard_ground_tile_" + std::to_string(count.fetch_add(1)));
  VSILFILE* opened =
      VSIFileFromMemBuffer(file.name(), reinterpret_cast<GByte*>(bytes.data()), bytes.size(), FALSE);  // NOLINT
  if (opened != nullptr) VSIFCloseL(opened);
  const std::array<const char*, 4> drivers{"PNG", "JPEG", "WEBP", nullptr};
  const std::array<const char*, 1> siblings{nullptr};
  const GDALDatasetUniquePtr data(
      GDALDataset::Open(file.name(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data(), nullptr, siblings.data()));
  if (!data || data->GetRasterCount() == 0)
    return bad_tiles("what was sent for the tile is not a picture; expected PNG, JPEG or WebP", name);
  Pixels4 out;
  out.side = data->GetRasterXSize();
  if (out.side != data->GetRasterYSize() || out.side < 16 || out.side > 4 * usual_side)
    return bad_tiles("a tile has " + std::to_string(out.side) + " by " + std::to_string(data->GetRasterYSize()) +
                         " pixels; expected a square of at most 1,024",
                     name);
  const auto pixels = static_cast<std::size_t>(out.side) * static_cast<std::size_t>(out.side);
  out.rgba.assign(4 * pixels, 255);
  const int bands = data->GetRasterCount();
  const auto read = [&](int band, std::size_t channel) {
    return data->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, out.side, out.side, out.rgba.data() + channel, out.side,
                                               out.side, GDT_Byte, 4, 4 * static_cast<GSpacing>(out.side),
                                               nullptr) == CE_None;
  };
  bool whole = true;
  for (std::size_t c = 0; c < 3; ++c) whole = whole && read(bands >= 3 ? static_cast<int>(c) + 1 : 1, c);
  if (bands == 2 || bands == 4) whole = whole && read(bands, 3);
  if (!whole) return bad_tiles("the picture of the tile is damaged (" + messages.failure() + ")", name);
  if (const auto* table = data->GetRasterBand(1)->GetColorTable(); table != nullptr && bands < 3)
    for (std::size_t i = 0; i < pixels; ++i) {
      const GDALColorEntry* entry = table->GetColorEntry(out.rgba[4 * i]);
      if (entry == nullptr) continue;
      const std::array channels{entry->c1, entry->c2, entry->c3, entry->c4};
      for (std::size_t c = 0; c < 4; ++c) out.rgba[4 * i + c] = static_cast<std::uint8_t>(channels[c]);
    }
  return out;
}

/// The box in Web Mercator, by points along its sides: they are not straight there. Empty where there is no way.
auto in_mercator(const Box2& box, const crs::Crs& from, const crs::Crs& mercator) -> Box2 {
  Box2 out;
  const auto there = crs::transformation(from, mercator);
  if (!there) return out;
  constexpr int steps = 8;
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const Point2 p = box.least + share * (box.most - box.least);
    for (Point2 q :
         {Point2{p.x, box.least.y}, Point2{p.x, box.most.y}, Point2{box.least.x, p.y}, Point2{box.most.x, p.y}}) {
      if (!there->Transform(1, &q.x, &q.y) || !std::isfinite(q.x) || !std::isfinite(q.y)) return {};
      out.add(q);
    }
  }
  return out;
}

auto side_of_tile(int zoom) -> double { return 2 * half_side / static_cast<double>(std::int64_t{1} << zoom); }

auto tile_at(Point2 p, int zoom) -> TileName {
  const std::int64_t last = (std::int64_t{1} << zoom) - 1;
  const auto index = [&](double from) {
    return std::clamp(static_cast<std::int64_t>(std::floor(from / side_of_tile(zoom))), std::int64_t{0}, last);
  };
  return {zoom, index(p.x + half_side), index(half_side - p.y)};
}

/// The finest zoom level at which a length has at most that many pixels.
auto zoom_for(double metres, int side, int most) -> int {
  int zoom = finest;
  while (zoom > 0 && metres / side_of_tile(zoom) * side > most) --zoom;
  return zoom;
}

struct Level {
  int zoom = 0, side = usual_side;
};

/// The zoom level: from the one wanted downwards, the first that has a tile in the middle.
auto level_for(const std::string& pattern, const Box2& box, int most) -> base::Result<Level> {
  const double extent = std::max(box.most.x - box.least.x, box.most.y - box.least.y);
  const Point2 middle = 0.5 * (box.least + box.most);
  Level level{zoom_for(extent, usual_side, most), usual_side};
  for (; level.zoom >= 0; --level.zoom) {
    const auto name = filled(pattern, tile_at(middle, level.zoom));
    auto answer = read_all({name}).front();
    if (!answer) return answer.failure();
    auto& bytes = *answer;
    if (!bytes) continue;
    const auto tile = decoded(*bytes, name);
    if (!tile) return tile.failure();
    level.side = tile->side;
    const int enough = zoom_for(extent, tile->side, most);
    if (level.zoom <= enough) return level;
    level.zoom = enough + 1;  // tiles of 512 pixels: the level above is as fine
  }
  return bad_tiles("there are no tiles at the place of the models, at any zoom level from " +
                       std::to_string(zoom_for(extent, usual_side, most)) + " down; check the address or the folder",
                   filled(pattern, tile_at(middle, zoom_for(extent, usual_side, most))));
}

/// The tiles of a level that meet the box, as one picture in memory.
auto mosaic(const std::string& pattern, const Box2& box, const Level& level, const crs::Crs& mercator)
    -> base::Result<GDALDatasetUniquePtr> {
  const auto first = tile_at({box.least.x, box.most.y}, level.zoom),
             last = tile_at({box.most.x, box.least.y}, level.zoom);
  const auto columns = static_cast<int>(last.column - first.column + 1),
             rows = static_cast<int>(last.row - first.row + 1);
  GDALDatasetUniquePtr out(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
      "", columns * level.side, rows * level.side, 4, GDT_Byte, nullptr));
  if (!out) return bad_tiles("there is not enough memory for the tiles", pattern);
  const double pixel = side_of_tile(level.zoom) / level.side;
  double g[6]{static_cast<double>(first.column) * side_of_tile(level.zoom) - half_side, pixel, 0,
              half_side - static_cast<double>(first.row) * side_of_tile(level.zoom),    0,     -pixel};
  out->SetGeoTransform(g);
  out->SetSpatialRef(&mercator.system);
  out->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
  const auto began = std::chrono::steady_clock::now();
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  for (std::size_t at = 0; at < count; at += tiles_at_a_time) {
    if (std::chrono::steady_clock::now() - began > patience)
      return bad_tiles("the server of the tiles is too slow: " + std::to_string(at) + " of " + std::to_string(count) +
                           " tiles in a minute; try again later",
                       pattern);
    std::vector<std::string> names;
    for (std::size_t i = at; i < std::min(count, at + tiles_at_a_time); ++i)
      names.push_back(filled(pattern, {level.zoom, first.column + static_cast<std::int64_t>(i) % columns,
                                       first.row + static_cast<std::int64_t>(i) / columns}));
    auto answers = read_all(names);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!answers[k]) return answers[k].failure();
      auto& bytes = *answers[k];
      if (!bytes) continue;  // transparent
      auto tile = decoded(*bytes, names[k]);
      if (!tile) return tile.failure();
      if (tile->side != level.side)
        return bad_tiles("tiles have different sizes: " + std::to_string(tile->side) + " and " +
                             std::to_string(level.side) + " pixels",
                         names[k]);
      const auto column = static_cast<int>(at + k) % columns, row = static_cast<int>(at + k) / columns;
      if (out->RasterIO(GF_Write, column * level.side, row * level.side, level.side, level.side, tile->rgba.data(),
                        level.side, level.side, GDT_Byte, 4, nullptr, 4, 4 * static_cast<GSpacing>(level.side), 1,
                        nullptr) != CE_None)
        return bad_tiles("the tile cannot be put beside the others", names[k]);
    }
  }
  return out;
}

}  // namespace

auto is_ground_tiles(const std::string& name) -> bool {
  std::error_code status;
  return is_address(name) || name.find("{z}") != std::string::npos ||
         (fs::is_directory(name, status) && lowest_in(name, true).has_value());
}

auto ground_tiles_pattern(const std::string& name) -> base::Result<std::string> {
  std::error_code status;
  if (!is_address(name) && fs::is_directory(name, status)) {
    const auto pattern = pattern_in(fs::absolute(name));
    if (pattern) return *pattern;
    return bad_tiles(
        "there are no tiles in the folder; expected files like 17/67311/43299.png: zoom level, column, row", name);
  }
  const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
  if (!has("{z}") || !has("{x}") || has("{y}") == has("{-y}"))
    return bad_tiles(
        "this does not say how tiles are named; expected {z}, {x}, and {y} or {-y}, as in "
        "https://example.org/{z}/{x}/{y}.png",
        name);
  auto rest = filled(name, {});
  if (const auto open = rest.find('{'); open != std::string::npos)
    return bad_tiles("'" + rest.substr(open, rest.find('}', open) - open + 1) +
                         "' is not known in a pattern of tiles; expected {z}, {x}, {y} and {-y} only. Write one of the "
                         "servers in place of {s}",
                     name);
  return is_address(name) ? name : fs::absolute(name).string();
}

auto read_ground_tiles(const std::string& pattern, const std::string& crs, const Box2& around, int most)
    -> base::Result<GroundPicture> {
  crs::register_gdal();
  const crs::GdalMessages messages;
  const auto wanted = crs.empty() ? std::nullopt : crs::from_words(crs);
  const auto mercator = crs::from_words("EPSG:3857");
  if (!wanted || !mercator)
    return bad_tiles("tiles cannot be placed: the models have no CRS; give it when the inputs are read (ingest.crs)",
                     pattern);
  const auto own = crs::flat(wanted->system);
  const auto box = in_mercator(around, own, *mercator);
  if (box.empty())
    return bad_tiles("the place of the models cannot be transformed to Web Mercator (EPSG:3857)", pattern);
  const auto level = level_for(pattern, box, most);
  if (!level) return level.failure();
  const auto all = mosaic(pattern, box, *level, *mercator);
  if (!all) return all.failure();
  const auto number = [](double value) { return base::to_text(value); };
  const auto moved =
      warped(**all, {"-of", "VRT", "-dstalpha", "-r", "bilinear", "-t_srs", crs::wkt_of(own.system), "-te",
                     number(around.least.x), number(around.least.y), number(around.most.x), number(around.most.y)});
  auto out = moved ? ground_picture_of(*moved, most) : GroundPicture{};
  if (out.png.empty())
    return bad_tiles("the tiles cannot be transformed to " + crs +
                         (messages.failure().empty() ? "" : " (" + messages.failure() + ")"),
                     pattern);
  return out;
}

}  // namespace mansard::formats
