// Groups footprints that touch into blocks, each with its piece of the mesh and its ground.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::block {

/// What the height of the ground at a building comes from, the surest first.
enum class GroundSource : std::uint8_t {
  attribute,   ///< of the footprint
  terrain,     ///< a terrain model, or the ground points of a cloud
  scan,        ///< level mesh around the footprint
  neighbours,  ///< level mesh around the block
  option,      ///< Options::ground_height
  outline,     ///< the z of a footprint that is drawn in three dimensions
  lowest,      ///< the lowest of what the scan shows beside the building: it may be too high
  assumed,     ///< a storey below the lowest roof: nothing shows the ground
  unknown,     ///< there is no scan near it
};
/// m; how far from its outline a building's own walls, decks and scaffolds are looked for (confidence).
inline constexpr double beside_reach = 3;
/// As in attributes: "terrain".
[[nodiscard]] auto to_string(GroundSource source) -> std::string_view;

/// The terrain at the walls of a building, where it is seen.
struct AtWalls {
  double mean = 0, highest = 0;  ///< z along its open walls
  double error = 0;              ///< m; standard error of the lowest
};

/// One footprint of a block.
struct Member {
  std::size_t feature = 0;  ///< number in the scene: Scene::feature
  std::vector<geometry::Polygon> polygons;
  double ground = 0;  ///< z of its ground, metres: where it is seen the lowest at its walls
  GroundSource ground_source = GroundSource::scan;
  std::optional<AtWalls> at_walls{};  ///< where terrain or scan shows it
};

struct Block {
  std::string name;  ///< "block-" and the first id of its members: the shortest, of these the first in the alphabet
  std::vector<Member> members;               ///< by feature number
  std::vector<geometry::Polygon> outline;    ///< the union of the members, gaps under the touch tolerance closed
  geometry::Mesh mesh;                       ///< the triangles within the padding of the outline
  double ground = 0;                         ///< z, metres: the median of the members'
  bool ground_known = true;                  ///< false where nothing says a ground and no mesh is near; it is 0 then
  std::array<std::int64_t, 3> origin{};      ///< of its own frame, in that of the scene; whole metres
  std::vector<base::Diagnostic> warnings{};  ///< "block-outline", without subject
  std::vector<geometry::Polygon> beside{};   ///< other footprints within beside_reach of its box
};

/// A block in its own frame, which begins at whole metres below it, and with its members in an order of their own: all
/// that is computed from it is a function of the block alone, wherever it lies in whatever scene.
struct OwnFrame {
  Block block;                        ///< members by their coordinates; Member::feature counts from 0 in this order
  std::vector<std::size_t> features;  ///< the scene's numbers of the members
};
[[nodiscard]] auto in_own_frame(Block block) -> OwnFrame;

struct Options {
  double touch = 0.1;               ///< m; footprints closer than this belong to one block
  double padding = 5.0;             ///< m; the mesh is kept up to this distance from the footprints
  double ground_ring = 10.0;        ///< m; width of the ring outside the footprints where the ground is looked for
  double ground_percentile = 10.0;  ///< %; of the mesh's heights in that ring
  double ground_area =
      5.0;  ///< m²; less level ground around a building is more likely an awning or the eaves than the street
  double ground_cosine = 0.7071;        ///< cosine of 45°: steeper is wall, hedge or the side of a car
  double overhang = 1.0;                ///< m; so far around a footprint a level surface may be its roof
  std::optional<double> ground_height;  ///< m, in the heights of the files; where neither terrain nor scan shows any
  double storey = 3.0;                  ///< m; from the lowest roof down to a ground that nothing shows
  double ground_piece = 2.0;            ///< m: the longest side, in plan, of what one sample stands for
  double ground_rest_percentile = 2.0;  ///< %; of all heights of the mesh, where no ground is seen
  double ground_reach = 50.0;           ///< m; how far from a block, at most, the mesh says something of its ground
  double terrain_step = 1.0;            ///< m; between the places of an outline where the terrain is asked
  double terrain_share = 0.9;           ///< of the outline: what lies beyond the terrain's edge may be another slope
  /// m²; gaps between touching footprints that are smaller stay open; such gaps are rounding's
  static constexpr double gap_area = 0.01;
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// The ground is what the footprint's attribute says, else the lowest of the scene's terrain at its walls where that is
/// known along the outline, else the lowest that the mesh shows there (a percentile of what is around it where it shows
/// nothing at the walls), else one of the others of GroundSource, rounded to 2⁻¹⁰ m. Footprints with a
/// defect are left out, and so are blocks of surroundings alone. Guarantees: 1 every usable footprint is in exactly one
/// block · 2 blocks and members are ordered by feature number, whatever the thread count · 3 every triangle of the
/// scene within the padding of a block's outline is in that block's mesh, and none entirely farther away · 4 a block
/// depends on its members, on the footprints and the mesh near it and on nothing else: not on their order in the files,
/// nor on where the scene's frame begins, nor on what else is in the scene. Its coordinates are rounded to
/// model::coordinate_unit. Cost: O((n + m) log m) for n triangles, m footprints.
[[nodiscard]] auto partition(const model::Scene& scene, const Options& options, const base::Run& run = {})
    -> std::vector<Block>;

/// What will be one block, before its mesh is looked at.
struct Group {
  std::vector<std::size_t> features;  ///< of Scene::feature, ascending
  geometry::Box2 box;
  geometry::Box2 reach;  ///< what of the scene its block may depend on
};
/// Of a scene, without its mesh: those that `partition` makes blocks of, in the same order.
[[nodiscard]] auto groups(const model::Scene& scene, const Options& options) -> std::vector<Group>;

/// The same blocks, each made when it is asked for, so that not all their pieces of the mesh are in memory together.
/// The scene must outlive it.
class Partition {
 public:
  /// Without blocks where the run is cancelled.
  Partition(const model::Scene& scene, const Options& options, const base::Run& run = {});
  ~Partition();
  Partition(Partition&&) noexcept;
  auto operator=(Partition&&) noexcept -> Partition&;

  [[nodiscard]] auto size() const -> std::size_t;
  /// What is known before it is made: name, members, outline and the place of its frame in plan.
  [[nodiscard]] auto outlined(std::size_t i) const -> const Block&;
  /// How many triangles are near it, about as many as it will have.
  [[nodiscard]] auto triangles_near(std::size_t i) const -> std::size_t;
  /// From any thread.
  [[nodiscard]] auto make(std::size_t i) const -> Block;

 private:
  struct Prepared;
  std::unique_ptr<Prepared> prepared_;
};

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::block
