#include "apps/cli/find_inputs.hpp"

#include <algorithm>
#include <system_error>

#include "apps/cli/formats.hpp"
#include "apps/cli/shell_word.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/formats/source.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;
using formats::has_extension;
using formats::Reads;
using Paths = std::vector<fs::path>;

constexpr int deepest = 4;
/// A folder with more tiles than this is named as a folder: a command with hundreds of files is of no use to anybody.
constexpr std::size_t most_tiles = 3;

struct FoundFiles {
  Paths meshes, points, rasters, footprints;
  [[nodiscard]] auto surfaces() const -> std::size_t { return meshes.size() + points.size() + rasters.size(); }
  void take(FoundFiles other) {
    for (auto member : {&FoundFiles::meshes, &FoundFiles::points, &FoundFiles::rasters, &FoundFiles::footprints})
      for (auto& path : other.*member) (this->*member).push_back(std::move(path));
  }
};

/// False: no format has that name.
auto add(const fs::path& path, FoundFiles& found) -> bool {
  if (pipeline::is_footprints_name(path)) found.footprints.push_back(path);
  else if (path.filename() == "ept.json" || has_extension(path, &Reads::points)) found.points.push_back(path);
  else if (path.filename() == "tileset.json" || has_extension(path, &Reads::mesh)) found.meshes.push_back(path);
  else if (has_extension(path, &Reads::raster)) found.rasters.push_back(path);
  else return false;
  return true;
}

auto in_folder_order(const fs::path& folder) -> base::Result<std::vector<fs::directory_entry>> {
  std::vector<fs::directory_entry> entries;
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
    if (!at->path().filename().string().starts_with('.')) entries.push_back(*at);
  if (failure) return base::error("file-read", "cannot list the folder: " + failure.message(), folder.string());
  std::ranges::sort(entries, {}, [](const auto& entry) { return entry.path().filename().string(); });
  return entries;
}

auto search(const fs::path& folder, int depth) -> base::Result<FoundFiles> {
  FoundFiles found;
  std::error_code status;
  if (fs::exists(folder / "tileset.json", status) || fs::exists(folder / "ept.json", status)) {
    (fs::exists(folder / "ept.json", status) ? found.points : found.meshes).push_back(folder);
    return found;
  }
  if (formats::extension_of(folder) == ".gdb") {
    found.footprints.push_back(folder);
    return found;
  }
  const auto entries = in_folder_order(folder);
  if (!entries) return entries.failure();
  bool levels = false;  // a tile of OSGB has its levels of detail beside it: only the reader of the folder tells them
  for (const auto& entry : *entries) {
    const auto& path = entry.path();
    if (entry.is_directory(status)) {
      const bool own = fs::exists(path / "project.json", status) || fs::exists(path / "run.json", status);
      if (own || depth >= deepest) continue;
      auto below = search(path, depth + 1);
      if (!below) return below.failure();
      found.take(std::move(*below));
    } else if (entry.is_regular_file(status)) {
      levels |= add(path, found) && formats::extension_of(path) == ".osgb";
    }
  }
  for (auto member : {&FoundFiles::meshes, &FoundFiles::points}) {
    auto& paths = found.*member;
    if (paths.size() == found.surfaces() && (paths.size() > most_tiles || levels)) paths = {folder};
  }
  return found;
}

auto names_of(const Paths& paths) -> std::string {
  std::string all;
  for (const auto& path : paths) all += (all.empty() ? "" : ", ") + formats::name_to_show(path);
  return all;
}

/// Of a single layer or of several: whether there are polygons in it, as far as the file says.
auto may_have_polygons(const fs::path& path) -> bool {
  const auto source = formats::vector_source(path);
  if (!source) return false;
  return std::ranges::any_of(source->layers, [](const formats::SourceLayer& layer) {
    return layer.geometry.find("Polygon") != std::string::npos || layer.geometry.find("Surface") != std::string::npos ||
           layer.geometry.find("Collection") != std::string::npos || layer.geometry.starts_with("Unknown");
  });
}

/// One of several vector files.
auto chosen_footprints(const Paths& candidates, std::vector<std::string>& notes) -> base::Result<fs::path> {
  if (candidates.size() == 1) return candidates.front();
  Paths left;
  for (const auto& path : candidates)
    if (may_have_polygons(path)) left.push_back(path);
  if (left.empty())
    return base::error("new-inputs", "none of these vector files has polygons; add the file with the footprints",
                       names_of(candidates));
  Paths called;
  for (const auto& path : left)
    if (base::lower(path.filename().string()).starts_with("footprints")) called.push_back(path);
  if (called.size() == 1) left = called;
  if (left.size() > 1)
    return base::error("new-inputs",
                       "several vector files were found; name the mesh and the one file with the footprints of "
                       "buildings instead of the folder",
                       names_of(left));
  Paths others;
  for (const auto& path : candidates)
    if (path != left.front()) others.push_back(path);
  notes.push_back("the footprints are taken from " + left.front().string() + "; left out: " + names_of(others));
  return left.front();
}

/// Of what folders hold: one kind of surface.
void prefer_one_kind(FoundFiles& found, std::vector<std::string>& notes) {
  const bool meshes = !found.meshes.empty(), points = !found.points.empty();
  const auto leave = [&](Paths& paths, const char* what, const char* instead) {
    if (paths.empty()) return;
    notes.push_back(std::string("left out: ") + names_of(paths) + ", because there is " + instead + "; to use " + what +
                    " instead, name the file and not the folder");
    paths.clear();
  };
  if (meshes) leave(found.points, "the point cloud", "a mesh");
  if (meshes || points) leave(found.rasters, "the raster", meshes ? "a mesh" : "a point cloud");
}

auto unknown_kind(const std::string& name) -> base::Diagnostic {
  return base::error("new-inputs",
                     "neither a mesh nor footprints by its file extension; meshes: " + readable_formats().meshes +
                         "; footprints: " + readable_formats().footprints,
                     formats::name_to_show(name));
}

}  // namespace

auto find_inputs(const std::vector<std::string>& given) -> base::Result<FoundInputs> {
  FoundInputs out;
  FoundFiles named, found;
  std::error_code status;
  for (const auto& name : given) {
    if (auto there = formats::check_input(name); !there) return there.failure();
    if (formats::is_disk_name(name) && fs::is_directory(name, status)) {
      auto inside = search(name, 0);
      if (!inside) return inside.failure();
      found.take(std::move(*inside));
    } else if (!add(name, named)) {
      // An archive, or a file of another of GDAL's formats.
      if (!may_have_polygons(name)) return unknown_kind(name);
      named.footprints.emplace_back(name);
    }
  }
  // A folder gives what is not named. Beside a mesh and footprints it can only be there for its meshes.
  if (!named.footprints.empty()) found.footprints.clear();
  else if (named.surfaces() > 0) found = FoundFiles{{}, {}, {}, std::move(found.footprints)};
  prefer_one_kind(found, out.notes);
  found.take(std::move(named));
  if (found.footprints.size() > 1) {
    auto one = chosen_footprints(found.footprints, out.notes);
    if (!one) return one.failure();
    found.footprints = {std::move(*one)};
  }
  for (auto member : {&FoundFiles::meshes, &FoundFiles::points, &FoundFiles::rasters})
    for (auto& path : found.*member) out.paths.meshes.push_back(std::move(path));
  if (!found.footprints.empty()) out.paths.footprints = found.footprints.front();
  out.paths.derive_footprints = found.footprints.empty();
  if (!out.paths.meshes.empty()) return out;
  if (out.paths.derive_footprints)
    return base::error("new-inputs",
                       "no mesh, point cloud or footprints found; meshes: " + readable_formats().meshes +
                           "; footprints: " + readable_formats().footprints,
                       names_of({given.begin(), given.end()}));
  return base::error("new-inputs",
                     "these are footprints alone, and a project needs a mesh or a point cloud; for models without one, "
                     "run: mansard extrude " +
                         quoted(formats::name_to_show(out.paths.footprints)) + " -o models",
                     formats::name_to_show(out.paths.footprints));
}

}  // namespace mansard::cli
