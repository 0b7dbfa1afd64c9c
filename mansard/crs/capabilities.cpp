#include "mansard/crs/capabilities.hpp"

#include <gdal.h>
#include <gdal/cpl_string.h>
#include <gdal/ogr_srs_api.h>
#include <algorithm>
#include <array>
#include <filesystem>

#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"

namespace mansard::crs {

auto capabilities() -> Capabilities {
  namespace fs = std::filesystem;
  const GdalMessages messages;
  Capabilities out;
  out.gdal = GDALVersionInfo("RELEASE_NAME");
  int major = 0, minor = 0, patch = 0;
  OSRGetPROJVersion(&major, &minor, &patch);
  out.proj = std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
  out.network = OSRGetPROJEnableNetwork() != 0;
  out.has_register = from_words("EPSG:3857").has_value();
  std::vector<fs::path> folders;
  char** paths = OSRGetPROJSearchPaths();
  for (char** path = paths; path != nullptr && *path != nullptr; ++path) folders.emplace_back(*path);
  CSLDestroy(paths);
  folders.emplace_back("/usr/share/proj");
  folders.emplace_back("/usr/local/share/proj");
  for (const auto& folder : folders) {
    std::error_code status;
    const auto name = fs::weakly_canonical(folder, status).string();
    if (!fs::is_directory(folder, status) || std::ranges::find(out.proj_paths, name) != out.proj_paths.end()) continue;
    out.proj_paths.push_back(name);
    for (const auto& entry : fs::directory_iterator(folder, status)) {
      const auto file = entry.path().filename().string();
      // Names of PROJ's own grids of heights: nl_nsgi_nlgeo2018.tif, us_nga_egm96_15.tif, egm96_15.gtx.
      const bool raster = file.ends_with(".tif") || file.ends_with(".gtx");
      constexpr std::array words{"geo", "egm", "hbg", "quasi", "gcg", "ggf", "ell_", "raf"};
      if (raster && (file.ends_with(".gtx") || std::ranges::any_of(words, [&](const char* word) {
                       return file.find(word) != std::string::npos;
                     })))
        out.geoids.push_back(file);
    }
  }
  std::ranges::sort(out.geoids);
  return out;
}

auto has_driver(const std::string& name) -> bool {
  register_gdal();
  return GDALGetDriverByName(name.c_str()) != nullptr;
}

}  // namespace mansard::crs
