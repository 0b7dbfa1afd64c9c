// The story of a partition: footprints that touch, their outline, their ground, their piece of the mesh.
#include "mansard/block/block.hpp"

#include <algorithm>

#include "mansard/block/detail/ground.hpp"
#include "mansard/block/detail/near.hpp"
#include "mansard/block/detail/neighbours.hpp"

namespace mansard::block {
namespace {

/// Less level ground than this around a building, in m², is more likely an awning or the eaves than the street.
constexpr double enough_ground = 5;

/// The triangles asked for, with the vertices they name in their old order.
auto part_of(const geometry::Mesh& mesh, const std::vector<std::uint32_t>& triangles) -> geometry::Mesh {
  geometry::Mesh out;
  std::vector<std::uint32_t> used;
  used.reserve(3 * triangles.size());
  for (const auto t : triangles) used.insert(used.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  out.vertices.reserve(used.size());
  for (const auto v : used) out.vertices.push_back(mesh.vertices[v]);
  out.triangles.reserve(triangles.size());
  for (const auto t : triangles) {
    auto& triangle = out.triangles.emplace_back(mesh.triangles[t]);
    for (auto& v : triangle) v = static_cast<std::uint32_t>(std::ranges::lower_bound(used, v) - used.begin());
  }
  return out;
}

auto median(std::vector<double> values) -> double {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return n == 0 ? 0 : (values[(n - 1) / 2] + values[n / 2]) / 2;
}

/// Ground of each member: by the terrain, else around itself, else around the block, else the low end of what mesh
/// there is. Never NaN.
void set_ground(Block& block, const std::optional<model::HeightGrid>& terrain,
                const std::vector<std::vector<detail::Sample>>& around, const std::vector<std::size_t>& members,
                double whole_mesh, const Options& options) {
  const double share = options.ground_percentile / 100;
  std::optional<double> of_block;
  const auto fall_back = [&]() -> double {
    if (of_block) return *of_block;
    std::vector<detail::Sample> all;
    for (const auto m : members) all.insert(all.end(), around[m].begin(), around[m].end());
    of_block = detail::percentile(std::move(all), share, enough_ground);
    if (!of_block) of_block = detail::percentile(detail::surface_samples(block.mesh), 0.02, 0);
    if (!of_block) of_block = whole_mesh;
    return *of_block;
  };
  std::vector<double> heights;
  for (std::size_t i = 0; i < members.size(); ++i) {
    auto own = terrain ? detail::terrain_along(*terrain, block.members[i].polygons) : std::nullopt;
    if (!own) own = detail::percentile(around[members[i]], share, enough_ground);
    block.members[i].ground = own ? *own : fall_back();
    heights.push_back(block.members[i].ground);
  }
  block.ground = median(std::move(heights));
}

}  // namespace

auto option_list(Options& o) -> base::OptionList {
  return std::move(
      base::OptionList("block")
          .number("touch", o.touch, "m", {0, 10}, "Footprints closer than this belong to one block.")
          .number("padding", o.padding, "m", {0, 1000}, "The mesh is kept up to this distance from the footprints.")
          .number("ground_ring", o.ground_ring, "m", {0, 1000},
                  "Width of the ring outside the footprints where the ground is looked for.")
          .number("ground_percentile", o.ground_percentile, "%", {0, 100},
                  "Percentile of the mesh heights in that ring that is taken as the ground; low, because trees and "
                  "cars are in the ring."));
}

auto partition(const model::Scene& scene, const Options& options, const base::Run& run) -> std::vector<Block> {
  run.report("block", "", 0);
  std::vector<std::size_t> features;
  std::vector<detail::Polygons> shapes;
  for (std::size_t f = 0; f < scene.footprints.size(); ++f) {
    const auto& footprint = scene.footprints[f];
    if (footprint.defect || footprint.polygons.empty()) continue;
    features.push_back(f);
    shapes.push_back(footprint.polygons);
  }
  const auto groups = detail::groups_of(shapes, options.touch);
  if (run.cancelled()) return {};

  std::vector<Block> blocks(groups.size());
  base::parallel_for(groups.size(), [&](std::size_t b) {
    Block& block = blocks[b];
    block.name = "block-" + std::to_string(features[groups[b].front()]);
    detail::Polygons all;
    for (const auto m : groups[b]) {
      block.members.push_back({features[m], shapes[m], 0});
      all.insert(all.end(), shapes[m].begin(), shapes[m].end());
    }
    block.outline = detail::outline_of(all, options.touch);
  });
  run.report("block", "", 0.2);
  if (run.cancelled()) return {};

  std::vector<geometry::Box2> regions;
  for (const auto& block : blocks) regions.push_back(detail::bounds(block.outline).grown(options.padding));
  const auto near_by = detail::candidates(scene.mesh, regions);
  base::parallel_for(blocks.size(), [&](std::size_t b) {
    const detail::Nearness near(blocks[b].outline, options.padding);
    std::vector<std::uint32_t> kept;
    for (const auto t : near_by[b])
      if (near(detail::plan_of(scene.mesh, scene.mesh.triangles[t]))) kept.push_back(t);
    blocks[b].mesh = part_of(scene.mesh, kept);
  });
  run.report("block", "", 0.6);
  if (run.cancelled()) return {};

  const auto around = detail::ground_samples(scene.mesh, shapes, options.ground_ring);
  const bool bare = std::ranges::any_of(blocks, [](const Block& block) { return block.mesh.triangles.empty(); });
  const double whole = bare ? detail::percentile(detail::surface_samples(scene.mesh), 0.02, 0).value_or(0) : 0;
  base::parallel_for(blocks.size(),
                     [&](std::size_t b) { set_ground(blocks[b], scene.terrain, around, groups[b], whole, options); });
  run.report("block", "", 1);
  return blocks;
}

}  // namespace mansard::block
