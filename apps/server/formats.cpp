#include "apps/server/formats.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "mansard/base/options.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

constexpr std::string_view archive = ".zip";

/// What the page accepts for uploads beyond the extensions of a driver: extensions that several formats share, and
/// those of files that are read along with one of the format.
struct Uploads {
  std::string_view driver;
  std::vector<std::string_view> extensions, sidecars;
};

auto uploads_of(std::string_view driver) -> const Uploads& {
  static const std::array<Uploads, 7> all{{{"obj", {}, {".mtl", ".png", ".jpg", ".jpeg"}},
                                           {"gltf", {}, {".bin", ".png", ".jpg", ".jpeg"}},
                                           {"geotiff", {}, {".tfw"}},
                                           {"asc", {}, {".prj"}},
                                           {"geojson", {".json"}, {}},
                                           {"shapefile", {".zip"}, {".shx", ".dbf", ".prj", ".cpg", ".qmd"}},
                                           {"", {}, {}}}};
  const auto at = std::ranges::find(all, driver, &Uploads::driver);
  return at != all.end() ? *at : all.back();
}

auto reads_json(const formats::Reads& reads) -> Json {
  Json kinds = Json::array();
  if (reads.mesh) kinds.push_back("mesh");
  if (reads.raster) kinds.push_back("raster");
  if (reads.footprints) kinds.push_back("footprints");
  if (reads.results) kinds.push_back("models");
  return kinds;
}

auto json_of(const formats::Driver& driver) -> Json {
  auto extensions = driver.extensions;
  const auto& uploads = uploads_of(driver.name);
  extensions.insert(extensions.end(), uploads.extensions.begin(), uploads.extensions.end());
  return {{"name", driver.name},
          {"title", driver.title},
          {"description", driver.description},
          {"extensions", extensions},
          {"sidecars", uploads.sidecars},
          {"reads", reads_json(driver.reads)},
          {"files", driver.writes ? files_of(*driver.writes) : std::vector<std::string>()}};
}

}  // namespace

auto formats_json() -> Json {
  Json all = Json::array();
  for (const auto& driver : formats::drivers()) all.push_back(json_of(driver));
  return all;
}

auto compressed_extensions_json() -> Json { return Json::array({".gz"}); }

auto files_of(formats::Format format) -> std::vector<std::string> {
  std::vector<std::string> names;
  for (const auto& place : formats::places_of({format, formats::name_in_folder(format)}))
    names.push_back(place.string() + std::string(format == formats::Format::tiles ? archive : ""));
  return names;
}

auto written_formats() -> std::vector<formats::Format> {
  std::vector<formats::Format> all;
  for (const auto& driver : formats::drivers())
    if (driver.writes) all.push_back(*driver.writes);
  return all;
}

auto formats_named(const std::vector<std::string>& names) -> base::Result<std::vector<formats::Format>> {
  if (names.empty()) return written_formats();
  std::vector<std::string> known;
  std::vector<formats::Format> out;
  for (const auto& driver : formats::drivers()) {
    if (!driver.writes) continue;
    known.emplace_back(driver.name);
    if (std::ranges::find(names, driver.name) != names.end()) out.push_back(*driver.writes);
  }
  for (const auto& name : names)
    if (std::ranges::find(known, name) == known.end())
      return base::error(
          "option-value",
          "unknown format '" + base::on_one_line(name) + "'" + base::did_you_mean(base::nearest_word(name, known)),
          base::on_one_line(name));
  return out;
}

}  // namespace mansard::server
