#include "apps/cli/terrain.hpp"

#include <algorithm>

#include "apps/cli/output.hpp"
#include "mansard/formats/terrain.hpp"
#include "mansard/pipeline/terrain.hpp"

namespace mansard::cli {

namespace fs = std::filesystem;
using formats::Format;

void TerrainOut::add_to(CLI::App& verb) {
  verb.add_option("--terrain-out", files,
                  "Also write the terrain around the models, joined to them, to this file; repeat it for more (" +
                      formats::terrain_extensions() + "); STL is one closed surface of terrain and models")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

auto TerrainOut::targets() const -> base::Result<std::vector<Target>> {
  std::vector<Target> out;
  for (const auto& file : files) {
    fs::path path = file;
    const auto format = formats::terrain_format_of(path);
    if (!format)
      return base::error("terrain-format",
                         "unknown file extension for a terrain; expected " + formats::terrain_extensions(), file);
    if (path.filename() == "tileset.json") path = path.parent_path();
    out.push_back({*format, std::move(path)});
  }
  return out;
}

auto TerrainOut::check(const std::vector<fs::path>& results, const std::vector<fs::path>& inputs, bool overwrite) const
    -> base::Result<void> {
  const auto all = targets();
  if (!all) return all.failure();
  auto taken = results;
  for (const auto& target : *all) {
    if (auto apart = spare_results(target.path, taken); !apart) return apart;
    if (auto spared = spare_inputs({target.path}, inputs); !spared) return spared;
    if (auto usable = target_free(target, overwrite); !usable) return usable;
    taken.push_back(target.path);
  }
  return {};
}

auto TerrainOut::write(const Made& made, const model::Scene& scene, const ingest::MeshCells* cells,
                       const pipeline::Options& options, base::Outputs& outputs, const base::Run& run,
                       Progress& progress) const -> base::Result<void> {
  if (!asked()) return {};
  const auto all = targets();
  if (!all) return all.failure();
  const bool closed = std::ranges::any_of(*all, [](const Target& t) { return t.format == Format::stl; });
  const bool open = std::ranges::any_of(*all, [](const Target& t) { return t.format != Format::stl; });
  progress.show("terrain", "", 0);
  std::vector<terrain::Ground> grounds;
  std::vector<model::Building> buildings;  // only where they are part of the surface
  auto visited = made.each([&](const model::Building& building, const auto&) -> base::Result<void> {
    auto ground = terrain::ground_of(building);
    if (ground.rings.empty()) return {};
    grounds.push_back(std::move(ground));
    if (closed) buildings.push_back(building);
    return {};
  });
  if (!visited) return visited;
  const auto area = terrain::area_around(grounds, options.terrain);
  if (area.empty())
    return base::error("pipeline-nothing", "there are no models, so there is no terrain around them", "--terrain-out");
  const auto heights = pipeline::terrain_heights(scene, cells, area, options.terrain, run);
  if (!heights) return heights.failure();
  geometry::Mesh mesh, below, shell;
  const auto tell = [&](const std::vector<base::Diagnostic>& warnings) {
    for (const auto& warning : warnings) progress.say(base::to_string(warning));
  };
  if (open) {
    const auto made_terrain = terrain::make(*heights, grounds, options.terrain, run);
    if (!made_terrain) return made_terrain.failure();
    tell(made_terrain->warnings);
    mesh = terrain::mesh_of(*made_terrain);
    below = terrain::mesh_below(*made_terrain);
    progress.say("terrain: " + std::to_string(mesh.triangles.size()) + " triangles around " +
                 std::to_string(grounds.size()) + " buildings");
  }
  if (closed) {
    auto surface = terrain::closed(*heights, buildings, options.terrain, run);
    if (!surface) return surface.failure();
    tell(surface->warnings);
    shell = std::move(surface->mesh);
    progress.say("closed surface of terrain and buildings: " + std::to_string(shell.triangles.size()) + " triangles");
  }
  for (const auto& target : *all) {
    const auto written = formats::write_terrain(target.format, target.path, target.format == Format::stl ? shell : mesh,
                                                {made.frame, made.made_by}, options.write, outputs, below);
    if (!written) return written.failure();
    tell(*written);
  }
  return {};
}

}  // namespace mansard::cli
