#include "instances.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>

#include "mansard/ingest/ingest.hpp"
#include "mansard/slice/slice.hpp"

namespace mansard::bench {
namespace {

template <class T>
auto value_or_end(base::Result<T> result) -> T {
  if (!result) {
    std::cerr << base::to_string(result.error()) << "\n";
    std::exit(1);
  }
  return std::move(result).value();
}

auto measured(const fracture::Arrangement& arrangement, const sweep::SweepEdges& edges, const block::Block& block,
              const segment::Options& options) -> Instance {
  Instance made;
  const rays::Scene mesh(block.mesh);
  const auto start = std::chrono::steady_clock::now();
  made.segmentation = value_or_end(segment::choose(arrangement, edges, block, mesh, options));
  made.choose_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  made.sweep_edges = edges.edges.size();
  made.inside_faces =
      static_cast<std::size_t>(std::ranges::count_if(made.segmentation.faces, &segment::FaceEvidence::inside));
  return made;
}

}  // namespace

auto planted_instance(const planted::Recipe& recipe, const std::string& family, const segment::Options& options)
    -> Instance {
  const planted::Block block = planted::make(recipe);
  Instance made = measured(planted::fractured(block, options), block.edges, block.block, options);
  made.family = family;
  made.name = recipe.name + "/" + std::to_string(recipe.seed);
  return made;
}

auto real_inputs() -> std::vector<RealInput> {
  return {
      {"hall", "mvs_buildings/cgal_building.off", "mvs_buildings/cgal_footprints.geojson"},
      {"b9", "mvs_buildings/b9_mesh.off", "mvs_buildings/b9_footprints.geojson"},
      {"delft", "delft/delft_west_mesh.ply", "delft/delft_west_footprints.geojson", {84800, 447400, 0}},
      {"zhongshan-L19", "zhongshan/zhongshan_A_L19.ply", "zhongshan/zhongshan_A_footprints.geojson"},
      {"zhongshan-L18", "zhongshan/zhongshan_A_L18.ply", "zhongshan/zhongshan_A_footprints.geojson"},
      {"block-A", "sim_rotterdam/block_A_sim_mesh.ply", "sim_rotterdam/block_A_footprints.geojson"},
  };
}

void for_each_block(const RealInput& input, const std::filesystem::path& data, const segment::Options& options,
                    const std::function<void(Instance)>& use) {
  ingest::Options reading;
  reading.mesh_offset = input.mesh_offset;
  const auto scene = value_or_end(ingest::read_scene({data / input.mesh}, data / input.footprints, reading));
  for (const block::Block& block : block::partition(scene, {})) {
    const auto edges = sweep::find_edges(slice::cut(block, {}), block, {});
    geometry::Box2 region;
    for (const auto& polygon : block.outline)
      for (const geometry::Point2 p : polygon.outer) region.add(p);
    const auto arrangement = value_or_end(fracture::arrange(segment::cuts_of(edges, block, options), region, {}));
    Instance made = measured(arrangement, edges, block, options);
    made.family = input.name;
    made.name = input.name + "/" + block.name;
    use(std::move(made));
  }
}

}  // namespace mansard::bench
