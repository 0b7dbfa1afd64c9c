// The ground around buildings as triangles that meet the outlines of their ground exactly.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/city.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::terrain {

struct Options {
  double tolerance = 0.1;  ///< m; of the surface from the heights, vertically
  double margin = 20;      ///< m; from the outlines of the buildings to the border of the terrain
  double cell = 1;         ///< m between the heights that the surface is made from
  double depth = 5;        ///< m; of the bottom of a closed surface below its lowest point
  // Ground in a mesh: what stands on it is recognised by its size and its steep sides.
  double object_width = 33;     ///< m; the widest object without a footprint that is taken off
  double object_slope = 0.3;    ///< tangent; ground that is steeper is taken for the side of an object
  double object_height = 0.15;  ///< m; what rises less from its surroundings is ground
  double object_step = 2.5;     ///< m; what rises more is never ground
  double beside = 1;            ///< m around footprints where walls and eaves hide the ground
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// On the grid of files: quanta of 0.1 mm from the local origin.
using Place = std::array<std::int64_t, 3>;

/// A ring of a building's ground, outer ones counter-clockwise seen from above. Edge i goes from corner i to corner
/// i + 1, at the height of edge i: heights differ where a ring is that of several buildings.
struct GroundRing {
  std::vector<std::array<std::int64_t, 2>> corners;
  std::vector<std::int64_t> heights;
};
/// The ground of one building, or of several that touch.
struct Ground {
  std::string id;
  std::vector<GroundRing> rings;
};
/// Of the solids that are written of a building.
[[nodiscard]] auto ground_of(const model::Building& building) -> Ground;

/// The area of the terrain of some grounds: their box and the margin, in whole metres. Empty without grounds.
[[nodiscard]] auto area_around(std::span<const Ground> grounds, const Options& options) -> geometry::Box2;

/// Heights of the ground over an area, every `Options::cell`, from where they are known; gaps are filled from around
/// them.
struct Heights {
  model::HeightGrid grid;     ///< in the local frame
  std::vector<bool> known{};  ///< of each value, whether it was not filled; empty: all
};
/// From a terrain model, or the ground of a point cloud. Fails with "terrain-no-ground".
[[nodiscard]] auto heights_of(const model::Scene& scene, const geometry::Box2& area, const Options& options)
    -> base::Result<Heights>;

/// Finds the ground in a mesh: the lowest level surface of each cell, without footprints and without what stands out of
/// its surroundings, by the progressive morphological filter of K. Zhang et al. (2003).
class MeshGround {
 public:
  MeshGround(const geometry::Box2& area, const Options& options);
  /// A piece of the mesh; some of its triangles may come several times.
  void add(const geometry::Mesh& mesh);
  /// Fails with "terrain-no-ground".
  [[nodiscard]] auto heights(std::span<const geometry::Polygon> footprints) const -> base::Result<Heights>;

 private:
  geometry::Box2 area_;
  Options options_;
  model::HeightGrid lowest_;
};

/// A surface over the area without the buildings.
struct Terrain {
  std::vector<Place> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< upwards; upright where grounds of two heights meet
  std::vector<std::array<Place, 3>> below;              ///< triangles of the grounds, at their heights
  geometry::Box2 area;
  std::vector<base::Diagnostic> warnings;
};

/// Guarantees: 1 in plan the triangles and the grounds cover the area once, without gap or overlap · 2 every edge of a
/// ground, where it is not also that of another ground, is an edge of the surface, with the same corners · 3 the
/// surface is within the tolerance of every height that is more than half a cell from the grounds · 4 the same input
/// gives the same triangles. Grounds that overlap others are left out, with the warning "terrain-overlap". Fails with
/// "terrain-extent", "terrain-join". Cost: O(n log n) for n heights in practice.
[[nodiscard]] auto make(const Heights& heights, std::span<const Ground> grounds, const Options& options,
                        const base::Run& run = {}) -> base::Result<Terrain>;

/// Whether guarantees 1 and 2 are kept: what is wrong, and how the edges of the grounds are met.
struct Joints {
  std::size_t joined = 0;  ///< edges of grounds that are edges of the terrain
  std::size_t split = 0;   ///< the same in several pieces, where a corner of another ground is on the edge
  std::size_t shared = 0;  ///< edges that are also those of another ground
  std::size_t open = 0;    ///< the others
  std::size_t faults = 0;  ///< edges of the terrain with a border that is neither that of the area nor of a ground
};
[[nodiscard]] auto joints(const Terrain& terrain, std::span<const Ground> grounds) -> Joints;

/// A closed surface of terrain and buildings, with a bottom, for the simulation of flows: buildings that touch are one.
/// Coordinates are those of single precision, in the local frame.
struct Closed {
  geometry::Mesh mesh;
  std::vector<base::Diagnostic> warnings;
};
/// Guarantees: 1 every edge has two triangles, in opposite directions · 2 no two triangles intersect. Buildings whose
/// union is not such a surface have flat roofs, as few as are found quickly, or are replaced by the prism over their
/// outline, with the warning "terrain-simplified".
/// Fails with "terrain-closed", and as make().
[[nodiscard]] auto closed(const Heights& heights, std::span<const model::Building> buildings, const Options& options,
                          const base::Run& run = {}) -> base::Result<Closed>;

/// The triangles in metres.
[[nodiscard]] auto mesh_of(const Terrain& terrain) -> geometry::Mesh;
/// Terrain::below, each corner once.
[[nodiscard]] auto mesh_below(const Terrain& terrain) -> geometry::Mesh;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::terrain
