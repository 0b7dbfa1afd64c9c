#include "mansard/formats/ground_picture.hpp"

#include <cpl_string.h>
#include <gdal_priv.h>

#include <memory>
#include <vector>

#include "mansard/base/files.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/raster/warped_picture.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

auto bad_picture(const std::string& what, const fs::path& path) -> base::Diagnostic {
  return base::error("ingest-raster", what, path.string());
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
  if (auto checked = base::check_no_pipe(path); !checked) return checked.failure();
  const crs::GdalMessages messages;
  const Confined confined(path);
  GDALDatasetUniquePtr file(GDALDataset::Open(name_for_gdal(path).c_str(),
                                              GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                                              nullptr, nullptr));
  if (auto done = confined.check(); !done) return done.error();
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
    coloured = translated(*now, "", words);
    now = coloured.get();
  }
  if (now != nullptr && placed) {
    const auto flat = crs::wkt_of(crs::flat(wanted->system).system);
    moved = warped(*now, {"-of", "VRT", "-dstalpha", "-r", "bilinear", "-t_srs", flat});
    now = moved.get();
  }
  if (now == nullptr || now->GetGeoTransform(g) != CE_None)
    return bad_picture("it cannot be transformed to " + (crs.empty() ? "colours" : crs) +
                           (messages.failure().empty() ? "" : " (" + messages.failure() + ")"),
                       path);

  auto out = ground_picture_of(*now, most);
  if (auto done = confined.check(); !done) return done.error();
  if (out.png.empty())
    return bad_picture("it cannot be read" + (messages.failure().empty() ? "" : " (" + messages.failure() + ")"), path);
  return out;
}

}  // namespace mansard::formats
