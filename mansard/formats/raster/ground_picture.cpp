#include "mansard/formats/ground_picture.hpp"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/image/memory_file.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

auto bad_picture(const std::string& what, const fs::path& path) -> base::Diagnostic {
  return base::error("ingest-raster", what, path.string());
}

auto arguments(const std::vector<std::string>& words) -> CPLStringList {
  CPLStringList list;
  for (const auto& word : words) list.AddString(word.c_str());
  return list;
}

/// As gdal_translate and gdalwarp do it; null where they fail.
auto translate(GDALDataset& from, const std::string& to, const std::vector<std::string>& words)
    -> GDALDatasetUniquePtr {
  GDALTranslateOptions* options = GDALTranslateOptionsNew(arguments(words).List(), nullptr);
  if (options == nullptr) return nullptr;
  int failed = 0;
  GDALDatasetUniquePtr out(
      GDALDataset::FromHandle(GDALTranslate(to.c_str(), GDALDataset::ToHandle(&from), options, &failed)));
  GDALTranslateOptionsFree(options);
  return out;
}

auto warp(GDALDataset& from, const std::vector<std::string>& words) -> GDALDatasetUniquePtr {
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(arguments(words).List(), nullptr);
  if (options == nullptr) return nullptr;
  GDALDatasetH source = GDALDataset::ToHandle(&from);
  int failed = 0;
  GDALDatasetUniquePtr out(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &source, options, &failed)));
  GDALWarpAppOptionsFree(options);
  return out;
}

/// What makes 8-bit grey or RGB of its bands; empty where they are.
auto to_colours(GDALDataset& dataset) -> std::vector<std::string> {
  std::vector<std::string> words;
  GDALRasterBand* first = dataset.GetRasterBand(1);
  if (first->GetColorTable() != nullptr && dataset.GetRasterCount() == 1) words = {"-expand", "rgba"};
  else if (first->GetRasterDataType() != GDT_Byte) words = {"-ot", "Byte", "-scale"};
  const int bands = dataset.GetRasterCount();
  const bool alpha = bands == 4 && dataset.GetRasterBand(4)->GetColorInterpretation() == GCI_AlphaBand;
  if (bands > 3 && !alpha) words.insert(words.end(), {"-b", "1", "-b", "2", "-b", "3"});
  if (bands == 2 && dataset.GetRasterBand(2)->GetColorInterpretation() != GCI_AlphaBand)
    words.insert(words.end(), {"-b", "1"});
  return words;
}

}  // namespace

auto read_ground_picture(const fs::path& path, const std::string& crs, int most) -> base::Result<GroundPicture> {
  crs::register_gdal();
  if (!is_there(path)) return why_missing(path);
  const crs::GdalMessages messages;
  const Offline offline(path);
  GDALDatasetUniquePtr file(GDALDataset::Open(name_for_gdal(path).c_str(),
                                              GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                                              nullptr, nullptr));
  if (!file || file->GetRasterCount() == 0)
    return bad_picture(
        "not a picture that GDAL reads" + (messages.failure().empty() ? "" : " (" + messages.failure() + ")"), path);
  if (!is_virtual(path)) {
    const CPLStringList files(file->GetFileList());
    for (int i = 0; i < files.Count(); ++i)
      if (auto reach = check_reach(path, files[i]); !reach) return reach.error();
  }
  double g[6];
  if (file->GetGeoTransform(g) != CE_None)
    return bad_picture("it does not say where it is; give a GeoTIFF, or a world file beside it", path);
  const auto wanted = crs.empty() ? std::nullopt : crs::from_words(crs);
  const auto* own = file->GetSpatialRef();
  const bool placed = own != nullptr && !own->IsLocal() && wanted;
  if (!placed && (g[2] != 0 || g[4] != 0 || g[1] <= 0 || g[5] >= 0))
    return bad_picture("it is turned, and has no CRS; make it north up, as gdalwarp does", path);

  GDALDatasetUniquePtr coloured, moved;
  auto* now = file.get();
  if (auto words = to_colours(*now); !words.empty()) {
    words.insert(words.end(), {"-of", "VRT"});
    coloured = translate(*now, "", words);
    now = coloured.get();
  }
  if (now != nullptr && placed) {
    const auto flat = crs::wkt_of(crs::flat(wanted->system).system);
    moved = warp(*now, {"-of", "VRT", "-dstalpha", "-r", "bilinear", "-t_srs", flat});
    now = moved.get();
  }
  if (now == nullptr || now->GetGeoTransform(g) != CE_None)
    return bad_picture("it cannot be transformed to " + (crs.empty() ? "colours" : crs) +
                           (messages.failure().empty() ? "" : " (" + messages.failure() + ")"),
                       path);

  const int columns = now->GetRasterXSize(), rows = now->GetRasterYSize();
  const double scale = std::min(1.0, static_cast<double>(most) / std::max(columns, rows));
  const auto scaled = [&](int count) { return std::to_string(std::max(1L, std::lround(count * scale))); };
  static std::atomic<std::uint64_t> count{0};
  const MemoryFile in_memory("/vsimem/mansard_ground_" + std::to_string(count.fetch_add(1)) + ".png");
  GroundPicture out;
  {
    const WithoutSidecars none;
    auto png =
        translate(*now, in_memory.name(), {"-of", "PNG", "-r", "average", "-outsize", scaled(columns), scaled(rows)});
    const bool written = png != nullptr;
    png.reset();  // closed, it is in the file
    if (written) out.png = in_memory.bytes();
  }
  if (out.png.empty())
    return bad_picture("it cannot be read" + (messages.failure().empty() ? "" : " (" + messages.failure() + ")"), path);
  out.place.add({g[0], g[3]});
  out.place.add({g[0] + columns * g[1], g[3] + rows * g[5]});
  return out;
}

}  // namespace mansard::formats
