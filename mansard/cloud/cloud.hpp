// From a point cloud to what the later stages take: a surface with walls, and heights of the ground.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/outputs.hpp"
#include "mansard/base/result.hpp"
#include "mansard/cloud/strips.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::cloud {

/// One measured point, in metres.
struct Sample {
  geometry::Point3 position;
  std::uint8_t classification = 0;  ///< of ASPRS: 2 ground, 3–5 vegetation, 6 building, 7 and 18 noise, 9 water
  std::uint8_t return_number = 1, returns = 1;
  std::uint16_t strip = 0;  ///< the flight line; 0: not known
};

enum class Buildings : std::uint8_t {
  automatic,  ///< by class where a tile has class 6, else by shape
  by_class,   ///< class 6, and what can be ground
  by_shape,   ///< all but vegetation, by class and returns
  top,        ///< none are told from anything else: the highest points of all classes
};

struct Options {
  double cell = 0;                               ///< m; side of a cell; 0: from the density
  double points_per_cell = 1.1;                  ///< of the density that a cell must hold at least
  double points_per_large_cell = 2;              ///< the same of cells of 1 m and more
  double minimum_cell = 0.25, maximum_cell = 2;  ///< m
  Buildings buildings = Buildings::automatic;
  std::string building_classes = "6", ground_classes = "2", left_out_classes;  ///< with commas; classes.hpp reads them
  double building_share = 0.002;  ///< of a tile's points that must be of class 6 for `automatic`
  double step = 1.0;              ///< m; a difference in height between adjacent cells that is a wall
  double step_slope = 2.2;        ///< m/m; the same, as a slope: 65.6°
  double isolated = 3.0;          ///< m²; patches that are smaller are removed
  double gap = 30.0;              ///< m²; holes that are no larger are filled, where their rim is of one height
  double gap_residual = 0.25;     ///< m; RMS of that rim around its plane
  double wall_points = 3;         ///< of points that a wall must have to be where they are, not half-way between cells
  double ground_reach = 12;       ///< m; so far heights of the ground are continued into areas without any
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// The side of a cell for a density (points/m²): a power of two, so that cells have their borders at whole metres.
[[nodiscard]] auto cell_for(double density, const Options& options) -> double;

/// What was decided and counted, for the report.
struct Counts {
  std::uint64_t points = 0;    ///< in the tiles
  std::uint64_t repeated = 0;  ///< beside these: the same point again
  std::uint64_t not_used = 0;  ///< of these: noise, or not finite
  std::uint64_t cells = 0;     ///< with a height
  std::uint64_t isolated = 0;  ///< cells that were emptied, or took their next lower height
  std::uint64_t filled = 0;    ///< empty cells that were filled
  std::uint64_t tiles_by_class = 0, tiles_by_shape = 0;
  std::uint64_t ground_cells = 0;  ///< of 1 m with points of class 2
  std::array<std::uint64_t, 256> classes{};

  void include(const Counts& other);
};

using Tile = std::pair<std::int64_t, std::int64_t>;

/// Heights of the ground, and numbers of points, in cells of 1 m whose borders are at whole metres.
struct GroundTile {
  std::int64_t x = 0, y = 0;  ///< of the south-west corner, m
  std::size_t columns = 0, rows = 0;
  std::vector<float> heights;  ///< m; row by row from the south; NaN for none
  std::vector<float> points;   ///< of all classes but noise, likewise; 0 for none
  /// Points of a class that says nothing of what they are (Use::undecided), where buildings are found by class: so many
  /// in a cell, by its number in `points`, and their mean height.
  struct Undecided {
    std::uint32_t cell = 0;
    std::uint8_t classification = 0;
    std::uint32_t points = 0;
    float height = 0;  ///< m
  };
  std::vector<Undecided> undecided{};  ///< by cell and class
};

struct TileSurface {
  geometry::Mesh mesh;
  GroundTile ground;
  Counts counts;
  StripOverlaps strips;
};

/// Takes points in any order and from any thread, puts them aside in tiles on disk, and then makes the surface of every
/// tile. Guarantees: 1 the surface of a tile depends on the points within it and `halo` cells around it, and not on
/// their order, nor on what else was added · 2 the surfaces of all tiles together are one: what belongs to two of them
/// has the same vertices in both · 3 every vertex is finite · 4 where there is no point within a cell, nor a small gap
/// of one height, there is no surface · 5 a point that was added twice, at the same place with the same class and
/// return, counts once. Cost: linear in points and cells; 20 bytes a point on disk.
class Surface {
 public:
  /// `cell` in metres, as from cell_for. Fails with "file-write".
  [[nodiscard]] static auto open(double cell, const Options& options) -> base::Result<std::unique_ptr<Surface>>;

  /// With `within`, points beside it (grown to the borders of tiles, and by their halo) are not kept.
  void add(std::span<const Sample> samples, const std::optional<geometry::Box2>& within);

  /// After the last `add`: the tiles that have points, in order.
  [[nodiscard]] auto tiles() -> std::vector<Tile>;
  /// From any thread. Fails with "file-write".
  [[nodiscard]] auto make(const Tile& tile) const -> base::Result<TileSurface>;

  [[nodiscard]] auto cell() const -> double;
  /// Side of a tile, m.
  [[nodiscard]] auto side() const -> double;

 private:
  Surface(std::int64_t cell, const Options& options) : cell_(cell), options_(options) {}
  void put_aside(const Tile& tile, const std::string& bytes);
  void flush(const Tile& tile, std::string& buffer);

  std::int64_t cell_;  ///< in units of quantum
  Options options_;
  mutable std::mutex mutex_;
  std::unique_ptr<base::Spool> spool_;
  struct Chunk {
    std::uint64_t offset = 0;
    std::size_t bytes = 0;
  };
  std::map<Tile, std::vector<Chunk>> chunks_;
  std::map<Tile, std::string> buffers_;
  std::size_t buffered_ = 0;
};

/// All ground tiles as one grid, with heights continued `reach` metres into areas without any: every cell without a
/// height takes the mean of its neighbours that have one, as often as that. None where no tile has a height.
struct Ground {
  std::int64_t x = 0, y = 0;  ///< of the south-west corner, m
  std::size_t columns = 0, rows = 0;
  std::vector<float> heights;
};
[[nodiscard]] auto join(const std::vector<GroundTile>& tiles, double reach) -> std::optional<Ground>;

}  // namespace mansard::cloud
