// The story of a partition: footprints that touch, their outline, their ground, their piece of the mesh.
#include "mansard/block/block.hpp"

#include <algorithm>

#include "mansard/base/statistics.hpp"
#include "mansard/block/detail/ground.hpp"
#include "mansard/block/detail/near.hpp"
#include "mansard/block/detail/neighbours.hpp"

namespace mansard::block {
namespace {

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
    of_block = detail::percentile(std::move(all), share, options.ground_area);
    if (!of_block)
      of_block = detail::percentile(detail::surface_samples(block.mesh), options.ground_rest_percentile / 100, 0);
    if (!of_block) of_block = whole_mesh;
    return *of_block;
  };
  std::vector<double> heights;
  for (std::size_t i = 0; i < members.size(); ++i) {
    auto own = terrain ? detail::terrain_along(*terrain, block.members[i].polygons, options) : std::nullopt;
    if (!own) own = detail::percentile(around[members[i]], share, options.ground_area);
    block.members[i].ground = own ? *own : fall_back();
    heights.push_back(block.members[i].ground);
  }
  block.ground = heights.empty() ? 0 : base::mean_median(std::move(heights));
}

}  // namespace

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("block");
  list.number("touch", o.touch, "m", {0, 10}, "Footprints closer to each other than this belong to one block.")
      .source("chosen by hand; not measured");
  list.number("padding", o.padding, "m", {0, 1000}, "The mesh is kept up to this distance from the footprints.")
      .source("reference implementation chordatlas: 5 m");
  list.number("ground_ring", o.ground_ring, "m", {0, 1000},
              "Width of the ring outside the footprints in which the ground height is measured.")
      .source("chosen by hand; not measured");
  list.number("ground_percentile", o.ground_percentile, "%", {0, 100},
              "Percentile of the mesh's heights in that ring that is the ground height; low, because of trees and cars "
              "on the ground.")
      .source("chosen by hand; not measured");
  list.number("ground_area", o.ground_area, "m²", {0, 10000},
              "Minimum area of level mesh around a building for its ground height to be measured there.")
      .advanced("chosen by hand; not measured");
  list.number("ground_cosine", o.ground_cosine, "", {0, 1}, "Cosine of the maximum slope of mesh that may be ground.")
      .advanced("45°; not measured");
  list.number("ground_piece", o.ground_piece, "m", {0.05, 100},
              "Maximum length in plan of the piece of a triangle that one sample of the ground represents.")
      .advanced("chosen by hand; not measured");
  list.number("ground_rest_percentile", o.ground_rest_percentile, "%", {0, 100},
              "Percentile of all of the mesh's heights that is the ground height where no ground is visible.")
      .advanced("chosen by hand; not measured");
  list.number("terrain_step", o.terrain_step, "m", {0.05, 100},
              "Spacing along an outline at which a terrain model is sampled.")
      .advanced("chosen by hand; not measured");
  list.number("terrain_share", o.terrain_share, "", {0, 1},
              "Minimum share of an outline on which a terrain model is known for it to be used.")
      .advanced("chosen by hand; not measured");
  list.number("gap_area", o.gap_area, "m²", {0, 100},
              "Gaps between the footprints of a block with less total area than this are not closed.")
      .advanced("chosen by hand; not measured");
  return list;
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
    block.outline = detail::outline_of(all, options.touch, options.gap_area);
  });
  run.report("block", "", 0.2);
  if (run.cancelled()) return {};

  std::vector<geometry::Box2> regions;
  for (const auto& block : blocks) regions.push_back(geometry::bounds(block.outline).grown(options.padding));
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

  const auto around = detail::ground_samples(scene.mesh, shapes, options);
  const bool bare = std::ranges::any_of(blocks, [](const Block& block) { return block.mesh.triangles.empty(); });
  const double whole =
      bare
          ? detail::percentile(detail::surface_samples(scene.mesh), options.ground_rest_percentile / 100, 0).value_or(0)
          : 0;
  base::parallel_for(blocks.size(),
                     [&](std::size_t b) { set_ground(blocks[b], scene.terrain, around, groups[b], whole, options); });
  run.report("block", "", 1);
  return blocks;
}

}  // namespace mansard::block
