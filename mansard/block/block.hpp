// Groups footprints that touch into blocks, each with its piece of the mesh and its ground.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::block {

/// One footprint of a block.
struct Member {
  std::size_t feature = 0;  ///< index into Scene::footprints
  std::vector<geometry::Polygon> polygons;
  double ground = 0;  ///< z of the ground around it, metres
};

struct Block {
  std::string name;                        ///< "block-3": numbered by the lowest feature index in it
  std::vector<Member> members;             ///< by feature index
  std::vector<geometry::Polygon> outline;  ///< the union of the members, gaps under the touch tolerance closed
  geometry::Mesh mesh;                     ///< the triangles within the padding of the outline
  double ground = 0;                       ///< z, metres: the median of the members'
};

struct Options {
  double touch = 0.1;               ///< m; footprints closer than this belong to one block
  double padding = 5.0;             ///< m; the mesh is kept up to this distance from the footprints
  double ground_ring = 10.0;        ///< m; width of the ring outside the footprints where the ground is looked for
  double ground_percentile = 10.0;  ///< %; of the mesh's heights in that ring
  double ground_area =
      5.0;  ///< m²; less level ground around a building is more likely an awning or the eaves than the street
  double ground_cosine = 0.7071;        ///< cosine of 45°: steeper is wall, hedge or the side of a car
  double ground_piece = 2.0;            ///< m: the longest side, in plan, of what one sample stands for
  double ground_rest_percentile = 2.0;  ///< %; of all heights of the mesh, where no ground is seen
  double terrain_step = 1.0;            ///< m; between the places of an outline where the terrain is asked
  double terrain_share = 0.9;           ///< of the outline: what lies beyond the terrain's edge may be another slope
  double gap_area = 0.01;               ///< m²; gaps between touching footprints that are smaller stay open
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// The ground is the scene's terrain where that is known along a footprint's outline, else what the mesh shows around
/// it. Footprints with a defect are left out. Guarantees: 1 every usable footprint is in exactly one block · 2 blocks
/// and members are ordered by feature index, whatever the thread count · 3 every triangle of the scene within the
/// padding of a block's outline is in that block's mesh, and none entirely farther away. Cost: O((n + m) log m) for n
/// triangles, m footprints.
[[nodiscard]] auto partition(const model::Scene& scene, const Options& options, const base::Run& run = {})
    -> std::vector<Block>;

}  // namespace mansard::block
