#include "apps/cli/output.hpp"
#include "apps/cli/run_folder.hpp"

#include <unistd.h>
#include <algorithm>
#include <array>

#include "mansard/base/outputs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/base/unfinished.hpp"
#include "mansard/formats/results.hpp"

namespace mansard::cli {

namespace fs = std::filesystem;

namespace {

/// Made by this run, the innermost last.
auto made() -> std::vector<fs::path>& {
  static std::vector<fs::path> folders;
  return folders;
}

/// Whether it has the file extension of models, maps, tables or pictures, so that a folder is hardly meant.
auto named_as_file(const fs::path& path) -> bool {
  constexpr std::array extensions{".3ds",     ".b3dm", ".blend", ".csv", ".dae",  ".dwg", ".dxf",  ".fbx",  ".fgb",
                                  ".geojson", ".glb",  ".gltf",  ".gml", ".gpkg", ".gz",  ".html", ".ifc",  ".json",
                                  ".jsonl",   ".kml",  ".las",   ".laz", ".obj",  ".off", ".ply",  ".png",  ".shp",
                                  ".skp",     ".stl",  ".svg",   ".tif", ".tiff", ".txt", ".usd",  ".usdz", ".zip"};
  return std::ranges::find(extensions, base::lower(path.extension().string())) != extensions.end();
}

/// One name of a place, whatever it is called by; what cannot be followed (a name too long, links in a circle) keeps
/// its own. A name alone would stay relative where nothing is there yet.
auto place_of(const fs::path& path) -> fs::path {
  std::error_code status;
  const auto whole = fs::absolute(path, status);
  auto followed = fs::weakly_canonical(whole, status);
  return status ? whole.lexically_normal() : followed;
}

/// Writers put aside what they know too early: without a place for it a run would fail at its end.
auto temporary_files_possible() -> base::Result<void> {
  auto spool = base::Spool::open();
  if (!spool) return spool.failure();
  (*spool)->append("probe");
  if (auto read = (*spool)->read(0, 1); !read) return read.failure();
  return {};
}

}  // namespace

auto holds_results(const fs::path& folder) -> bool {
  std::error_code status;
  return std::ranges::any_of(fs::directory_iterator(folder, status), [](const fs::directory_entry& entry) {
    return entry.path().filename() != run_folder_name && !base::is_part(entry.path());
  });
}

auto prepare(const fs::path& folder, bool overwrite) -> base::Result<void> {
  std::error_code status;
  if (auto room = temporary_files_possible(); !room) return room;
  if (fs::exists(folder, status)) {
    if (!fs::is_directory(folder, status))
      return base::error("output-exists", "is a file, and the output is a folder; choose another path",
                         folder.string());
    base::sweep(folder);
    if (!overwrite && holds_results(folder) && !began_empty(folder))
      return base::error("output-exists", "the folder is not empty; choose another, or add --overwrite",
                         folder.string());
  } else if (named_as_file(folder)) {
    return base::error("usage", "the output is a folder, and this is the name of a file; leave the file extension out",
                       folder.string());
  } else {
    std::vector<fs::path> missing;
    for (fs::path at = fs::absolute(folder, status); !at.empty() && !fs::exists(at, status); at = at.parent_path())
      missing.push_back(at);
    made().insert(made().end(), missing.rbegin(), missing.rend());
    fs::create_directories(folder, status);
    if (status)
      return base::error("file-write",
                         "cannot create this folder: " + status.message() + "; choose a path with write permission",
                         folder.string());
  }
  // Named as what is on its way, which another process that begins here at the same time takes for no result.
  const auto probe = base::beside(folder / "probe", base::Beside::part);
  if (auto written = base::write_file(probe, ""); !written)
    return base::error("file-write", "cannot write to this folder; choose a path with write permission",
                       folder.string());
  fs::remove(probe, status);
  return {};
}

void remove_folders_left_empty() {
  std::error_code status;
  for (; !made().empty(); made().pop_back())
    if (fs::is_directory(made().back(), status)) fs::remove(made().back(), status);  // only where it is empty
}

auto spare_inputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) -> base::Result<void> {
  for (const auto& output : outputs)
    for (const auto& input : inputs) {
      std::error_code status;
      const auto from = place_of(input), to = place_of(output);
      const bool same = from == to || fs::equivalent(input, output, status);
      const auto [end, ignored] = std::mismatch(from.begin(), from.end(), to.begin(), to.end());
      if (same || (fs::is_directory(input, status) && end == from.end()))
        return base::error("output-input",
                           same ? "is an input and would be overwritten; choose another output"
                                : "is in the input folder '" + input.string() +
                                      "' and would be read as an input later; choose another output",
                           output.string());
    }
  return {};
}

auto spare_results(const fs::path& result, const std::vector<fs::path>& others) -> base::Result<void> {
  const auto same = [place = place_of(result)](const fs::path& other) { return place_of(other) == place; };
  if (std::ranges::none_of(others, same)) return {};
  return base::error("usage", "two outputs have this path; choose different paths", result.string());
}

auto leftovers(const fs::path& folder, const std::string& always, const std::function<bool(const std::string&)>& own)
    -> std::vector<fs::path> {
  std::vector<fs::path> left;
  std::error_code status;
  const auto ordinary = [&](const fs::path& path) {
    return fs::symlink_status(path, status).type() == fs::file_type::regular;
  };
  if (!ordinary(folder / always)) return left;
  const auto tiles = [&](const fs::path& path) {
    return path.extension() == ".3dtiles" && ordinary(path / "tileset.json");
  };
  const auto textures = [&](const fs::path& path) {
    return path.filename().string().ends_with("_textures") && formats::holds_textures_only(path);
  };
  for (const auto& entry : fs::directory_iterator(folder, status))
    if (own(entry.path().filename().string()) &&
        (ordinary(entry.path()) || tiles(entry.path()) || textures(entry.path())))
      left.push_back(entry.path());
  return left;
}

void remove_stale(const std::vector<fs::path>& left, const std::vector<fs::path>& written) {
  for (const auto& path : left) {
    std::error_code status;
    if (std::ranges::find(written, path) == written.end()) fs::remove_all(path, status);
  }
}

void remove_stale(const std::vector<fs::path>& left, const std::vector<base::FileToWrite>& written) {
  std::vector<fs::path> paths;
  for (const auto& file : written) paths.push_back(file.path);
  remove_stale(left, paths);
}

auto can_be_made_in(const fs::path& folder, const fs::path& path) -> base::Result<void> {
  std::error_code status;
  if (!fs::is_directory(folder, status))
    return base::error("file-write",
                       "the folder '" + folder.string() + "' does not exist; create it, or choose another path",
                       path.string());
  if (::access(folder.c_str(), W_OK) != 0)
    return base::error("file-write", "cannot write to its folder; choose a path with write permission", path.string());
  return temporary_files_possible();
}

auto file_free(const fs::path& path, bool overwrite) -> base::Result<void> {
  std::error_code status;
  if (fs::is_directory(path, status))
    return base::error("output-exists", "is a folder, and the output is a file; choose another path", path.string());
  if (fs::exists(path, status) && !fs::is_regular_file(path, status))
    return base::error("output-exists", "is not a regular file; choose another path", path.string());
  if (fs::exists(path, status) && !overwrite)
    return base::error("output-exists", "the file already exists; choose another, or add --overwrite", path.string());
  const auto folder = path.parent_path();
  return can_be_made_in(folder.empty() ? "." : folder, path);
}

auto in_folder(const fs::path& folder, const std::vector<std::pair<std::string, std::string>>& named)
    -> std::vector<base::FileToWrite> {
  std::vector<base::FileToWrite> files;
  for (const auto& [name, bytes] : named) files.push_back({folder / name, bytes});
  return files;
}

}  // namespace mansard::cli
