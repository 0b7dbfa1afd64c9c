#include "mansard/formats/raster/warped_picture.hpp"

#include <cpl_string.h>
#include <gdal_utils.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "mansard/formats/image/memory_file.hpp"

namespace mansard::formats {
namespace {

auto word_list(const std::vector<std::string>& words) -> CPLStringList {
  CPLStringList list;
  for (const auto& word : words) list.AddString(word.c_str());
  return list;
}

}  // namespace

auto translated(GDALDataset& from, const std::string& to, const std::vector<std::string>& words)
    -> GDALDatasetUniquePtr {
  GDALTranslateOptions* options = GDALTranslateOptionsNew(word_list(words).List(), nullptr);
  if (options == nullptr) return nullptr;
  int failed = 0;
  GDALDatasetUniquePtr out(
      GDALDataset::FromHandle(GDALTranslate(to.c_str(), GDALDataset::ToHandle(&from), options, &failed)));
  GDALTranslateOptionsFree(options);
  return out;
}

auto warped(GDALDataset& from, const std::vector<std::string>& words) -> GDALDatasetUniquePtr {
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(word_list(words).List(), nullptr);
  if (options == nullptr) return nullptr;
  GDALDatasetH source = GDALDataset::ToHandle(&from);
  int failed = 0;
  GDALDatasetUniquePtr out(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &source, options, &failed)));
  GDALWarpAppOptionsFree(options);
  return out;
}

auto ground_picture_of(GDALDataset& dataset, int most) -> GroundPicture {
  GroundPicture out;
  double g[6];
  if (dataset.GetGeoTransform(g) != CE_None) return out;
  const int columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  const double scale = std::min(1.0, static_cast<double>(most) / std::max(columns, rows));
  const auto scaled = [&](int count) { return std::to_string(std::max(1L, std::lround(count * scale))); };
  static std::atomic<std::uint64_t> count{0};
  const MemoryFile in_memory("/vsimem/mansard_ground_" + std::to_string(count.fetch_add(1)) + ".png");
  {
    const WithoutSidecars none;
    auto png = translated(dataset, in_memory.name(),
                          {"-of", "PNG", "-r", "average", "-outsize", scaled(columns), scaled(rows)});
    const bool written = png != nullptr;
    png.reset();  // closed, it is in the file
    if (written) out.png = in_memory.bytes();
  }
  out.place.add({g[0], g[3]});
  out.place.add({g[0] + columns * g[1], g[3] + rows * g[5]});
  return out;
}

}  // namespace mansard::formats
