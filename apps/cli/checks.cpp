#include "apps/cli/checks.hpp"

#include <sys/statvfs.h>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "mansard/base/outputs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/capabilities.hpp"

namespace mansard::cli {
namespace {

auto gigabytes(double bytes) -> std::string { return base::to_text(bytes / 1e9, 1) + " GB"; }

/// Megabytes available to new processes, as the kernel estimates it.
auto memory_available() -> double {
  std::ifstream file("/proc/meminfo");
  for (std::string name, unit; file >> name;) {
    double kilobytes = 0;
    if (!(file >> kilobytes)) break;
    std::getline(file, unit);
    if (name == "MemAvailable:") return kilobytes / 1e3;
  }
  return 0;
}

/// What is lost without a driver of GDAL, and where it comes from.
struct Driver {
  const char *name, *use;
};
constexpr std::array drivers{Driver{"GPKG", "GeoPackages are neither read nor written"},
                             Driver{"GeoJSON", "GeoJSON is not read"},
                             Driver{"ESRI Shapefile", "shapefiles are not read"},
                             Driver{"FlatGeobuf", "FlatGeobuf is not read"},
                             Driver{"GML", "GML is not read"},
                             Driver{"OSM", "OpenStreetMap files (.osm, .pbf) are not read"},
                             Driver{"PostgreSQL", "databases (PG:...) are not read"},
                             Driver{"GTiff", "rasters of heights are neither read nor written"}};

}  // namespace

auto word_of(Found found) -> const char* {
  return found == Found::fine ? "ok" : found == Found::note ? "note" : "problem";
}

auto line_of(const Finding& finding) -> std::string {
  const std::string word = word_of(finding.found);
  return word + std::string(9 - word.size(), ' ') + finding.subject + ": " + finding.what + "\n" +
         (finding.remedy.empty() ? "" : "         -> " + finding.remedy + "\n");
}

auto machine() -> std::vector<Finding> {
  std::vector<Finding> all;
  all.push_back(
      {Found::fine, "processor", std::to_string(std::max(1U, std::thread::hardware_concurrency())) + " cores"});
  // A block of 2 million triangles takes about 1 GB: docs/city.md.
  const double free = memory_available();
  all.push_back({free > 0 && free < 1000 ? Found::note : Found::fine, "memory", gigabytes(free * 1e6) + " available",
                 free > 0 && free < 1000 ? "process a smaller area (--bbox), or close other programs" : ""});
  const auto* given = std::getenv("TMPDIR");
  const std::string temporary = given != nullptr ? given : "/tmp";
  auto spool = base::Spool::open();
  struct statvfs disk {};
  const bool known = ::statvfs(temporary.c_str(), &disk) == 0;
  const double space = known ? static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize) : 0;
  if (!spool)
    all.push_back({Found::problem, "temporary files", base::to_string(spool.error()),
                   "set TMPDIR to a folder with write permission"});
  else
    all.push_back({known && space < 1e9 ? Found::note : Found::fine, "temporary files",
                   temporary + ", " + gigabytes(space) + " free",
                   known && space < 1e9 ? "set TMPDIR to a folder with more space" : ""});
  return all;
}

auto libraries() -> std::vector<Finding> {
  std::vector<Finding> all;
  const auto can = crs::capabilities();
  std::string missing;
  for (const auto& driver : drivers)
    if (!crs::has_driver(driver.name))
      missing += std::string(missing.empty() ? "" : "; ") + driver.name + ": " + driver.use;
  all.push_back({missing.empty() ? Found::fine : Found::problem, "GDAL",
                 can.gdal + (missing.empty() ? ", with all drivers that are used" : ", without " + missing),
                 missing.empty() ? "" : "install Debian's libgdal32, or a GDAL that was built with these drivers"});
  const bool registered = can.has_register;
  all.push_back({registered ? Found::fine : Found::problem, "PROJ",
                 can.proj + (registered ? ", with the EPSG register" : ", without its database: no CRS is known"),
                 registered ? "" : "install Debian's proj-data, or set PROJ_DATA to the folder with proj.db"});
  std::string grids;
  for (std::size_t i = 0; i < std::min<std::size_t>(can.geoids.size(), 4); ++i)
    grids += (i > 0 ? ", " : "") + can.geoids[i];
  if (can.geoids.size() > 4) grids += " and " + std::to_string(can.geoids.size() - 4) + " more";
  all.push_back({can.geoids.empty() ? Found::note : Found::fine, "geoids",
                 can.geoids.empty() ? "PROJ has no grid of a geoid: heights in 3D Tiles are those of the models, not "
                                      "heights above the ellipsoid, and are up to 100 m too high or too low on a globe"
                                    : grids,
                 can.geoids.empty() ? "copy the grid of your country from https://cdn.proj.org to the folder " +
                                          (can.proj_paths.empty() ? "/usr/share/proj" : can.proj_paths.front())
                                    : ""});
  return all;
}

}  // namespace mansard::cli
