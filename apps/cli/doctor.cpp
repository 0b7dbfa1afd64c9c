// `mansard doctor [MESH… FOOTPRINTS]`: what this machine lacks, and how inputs fit together.
#include <sys/statvfs.h>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/shell_word.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/outputs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/capabilities.hpp"
#include "mansard/pipeline/placing.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Request : Common {
  std::vector<std::string> inputs;
  bool json = false;
};

enum class Found { fine, note, problem };

struct Finding {
  Found found = Found::fine;
  std::string subject, what;
  std::string remedy{};  ///< a command or a setting; empty for none
};

auto word_of(Found found) -> const char* {
  return found == Found::fine ? "ok" : found == Found::note ? "note" : "problem";
}

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

/// Which inputs these are, whatever their order: those with the extension of a mesh first.
struct Sorted {
  pipeline::InputPaths paths;
  bool wrong_order = false;
};

auto is_footprints(const std::string& path) -> bool {
  return formats::has_extension(path, &formats::Reads::footprints) &&
         !formats::has_extension(path, &formats::Reads::mesh);
}

auto sorted(const std::vector<std::string>& inputs) -> Sorted {
  Sorted out;
  auto words = inputs;
  const auto at = std::ranges::find_if(words, is_footprints);
  const auto last = std::prev(words.end());
  if (at != words.end() && at != last && !is_footprints(*last)) {
    out.wrong_order = true;
    std::rotate(at, std::next(at), words.end());
  }
  out.paths.footprints = words.back();
  out.paths.meshes.assign(words.begin(), std::prev(words.end()));
  return out;
}

auto command_of(const pipeline::InputPaths& paths, const std::string& options) -> std::string {
  std::string command = "mansard reconstruct";
  for (const auto& mesh : paths.meshes) command += " " + quoted(mesh.string());
  return command + " " + quoted(paths.footprints.string()) + (options.empty() ? "" : " " + options) + " -o models";
}

auto inputs_of(const Request& request, const pipeline::Options& options, const base::Run& run)
    -> base::Result<std::vector<Finding>> {
  std::vector<Finding> all;
  if (request.inputs.size() == 1) {
    const bool footprints = is_footprints(request.inputs.front());
    all.push_back(
        {Found::note, "inputs", footprints ? "these are footprints; there is no mesh" : "there are no footprints",
         footprints ? "mansard extrude " + quoted(request.inputs.front()) + " -o models"
                    : "mansard reconstruct " + quoted(request.inputs.front()) + " --derive-footprints -o models"});
    return all;
  }
  const auto [paths, wrong_order] = sorted(request.inputs);
  if (wrong_order)
    all.push_back(
        {Found::problem, "order", "the footprints come before a mesh; meshes come first, the footprints last", ""});
  const auto placing = pipeline::find_placing(paths, options, run);
  if (!placing) {
    if (placing.error().code == "cancelled") return placing.failure();
    for (const auto& why : placing.errors()) all.push_back({Found::problem, "inputs", base::to_string(why), ""});
    return all;
  }
  if (!*placing) {
    all.push_back({Found::problem, "place",
                   "mesh and footprints do not match, and neither a CRS nor an offset of the mesh was found that makes "
                   "them: they seem to be of different places, or nothing in the mesh rises above its ground",
                   "compare the extents: mansard info"});
    return all;
  }
  const auto more = pipeline::options_in_words(**placing, options);
  all.push_back({more.empty() && !wrong_order ? Found::fine : Found::problem, "place",
                 (more.empty() ? "mesh and footprints match: " : "mesh and footprints match with " + more + ": ") +
                     pipeline::reason_in_words(**placing),
                 command_of(paths, more)});
  return all;
}

auto doctor(const Request& request, const base::Cancel& cancel) -> int {
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  auto all = machine();
  for (auto& finding : libraries()) all.push_back(std::move(finding));
  if (!request.inputs.empty()) {
    Progress progress(request.quiet);
    auto of_inputs = inputs_of(request, options, start(request, options.seed, cancel, progress));
    if (!of_inputs) return give_up(of_inputs.errors());
    for (auto& finding : *of_inputs) all.push_back(std::move(finding));
  }
  Json json = Json::array();
  std::string text = "mansard " MANSARD_VERSION "\n";
  for (const auto& [found, subject, what, remedy] : all) {
    json.push_back({{"found", word_of(found)}, {"subject", subject}, {"what", what}, {"remedy", remedy}});
    const std::string word = word_of(found);
    text += word + std::string(9 - word.size(), ' ') + subject + ": " + what + "\n";
    if (!remedy.empty()) text += "         -> " + remedy + "\n";
  }
  std::fputs(request.json ? (json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n").c_str() : text.c_str(),
             stdout);
  const bool problems = std::ranges::any_of(all, [](const Finding& f) { return f.found == Found::problem; });
  return problems ? some_fell_back : all_done;
}

}  // namespace

auto doctor_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "doctor");
  auto request = std::make_shared<Request>();
  verb->add_option("INPUTS", request->inputs,
                   "Meshes: " + readable_formats().meshes + ". Then the footprints: " + readable_formats().footprints)
      ->type_name("MESH... FOOTPRINTS");
  verb->add_flag("--json", request->json, "Print JSON");
  add_jobs(*verb, request->jobs);
  verb->add_flag("-q,--quiet", request->quiet, "Print no progress");
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] { return doctor(*request, cancel); }};
}

}  // namespace mansard::cli
