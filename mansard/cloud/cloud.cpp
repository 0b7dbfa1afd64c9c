// Points are put aside by tile, each with those around it; then a tile's cells get heights, and triangles.
#include "mansard/cloud/cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "mansard/cloud/classes.hpp"
#include "mansard/cloud/detail/compare_strips.hpp"
#include "mansard/cloud/detail/grid.hpp"
#include "mansard/cloud/detail/metres.hpp"

namespace mansard::cloud {
namespace {

using detail::halo;
using detail::per_metre;
using detail::tile_cells;

/// A point on disk: coordinates from the south-west corner of the tile's window.
struct Stored {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint8_t classification = 0, flags = 0;
  std::uint16_t strip = 0;
};
static_assert(sizeof(Stored) == 16);

/// More than twice round the earth, in quanta, and no height on it.
constexpr double farthest = 1e8, highest = 1e5;

auto rounded(double metres) -> std::int64_t { return static_cast<std::int64_t>(std::floor(metres * per_metre + 0.5)); }
auto floored(std::int64_t a, std::int64_t b) -> std::int64_t { return a / b - (a % b < 0 ? 1 : 0); }

auto is_noise(const Sample& s) -> bool {
  return s.classification == 7 || s.classification == 18 ||
         !(std::abs(s.position.x) < farthest && std::abs(s.position.y) < farthest && std::abs(s.position.z) < highest);
}

auto flags_of(const Sample& s) -> std::uint8_t {
  return static_cast<std::uint8_t>((s.returns <= 1 ? detail::only_return : 0) |
                                   (s.return_number >= s.returns ? detail::last_return : 0));
}

/// The number of points, and the mean height of those of class 2, in every metre of the tile itself.
/// `by_class`: whether buildings are found by class, where points that no class decides are of interest.
auto ground_of(const std::vector<detail::Point>& points, std::int64_t cell, std::int64_t x, std::int64_t y,
               bool by_class) -> std::pair<GroundTile, std::uint64_t> {
  GroundTile out;
  const std::int64_t side = cell * tile_cells, border = cell * halo;
  out.x = floored(x, per_metre);
  out.y = floored(y, per_metre);
  out.columns = out.rows = static_cast<std::size_t>(side / per_metre);
  std::vector<std::int64_t> sum(out.columns * out.rows, 0), count(sum.size(), 0);
  std::map<std::pair<std::uint32_t, std::uint8_t>, std::pair<std::uint32_t, std::int64_t>> undecided;
  out.points.assign(sum.size(), 0);
  for (const auto& p : points) {
    const std::int64_t px = p.x - border, py = p.y - border;
    if (px < 0 || py < 0 || px >= side || py >= side) continue;
    const auto i = static_cast<std::size_t>(py / per_metre) * out.columns + static_cast<std::size_t>(px / per_metre);
    out.points[i] += 1;
    if (by_class && use_of(p.classification) == Use::undecided) {
      auto& [number, heights] = undecided[{static_cast<std::uint32_t>(i), p.classification}];
      ++number;
      heights += p.z;
    }
    if (p.classification != 2) continue;
    sum[i] += p.z;
    ++count[i];
  }
  out.heights.assign(sum.size(), std::numeric_limits<float>::quiet_NaN());
  std::uint64_t known = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (count[i] == 0) continue;
    out.heights[i] = static_cast<float>(static_cast<double>(sum[i]) / static_cast<double>(count[i]) / per_metre);
    ++known;
  }
  if (known == 0) out.heights.clear();
  for (const auto& [key, what] : undecided)
    out.undecided.push_back(
        {key.first, key.second, what.first,
         static_cast<float>(static_cast<double>(what.second) / static_cast<double>(what.first) / per_metre)});
  return {std::move(out), known};
}

}  // namespace

void Counts::include(const Counts& o) {
  points += o.points;
  repeated += o.repeated;
  not_used += o.not_used;
  cells += o.cells;
  isolated += o.isolated;
  filled += o.filled;
  tiles_by_class += o.tiles_by_class;
  tiles_by_shape += o.tiles_by_shape;
  ground_cells += o.ground_cells;
  for (std::size_t i = 0; i < classes.size(); ++i) classes[i] += o.classes[i];
}

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("cloud");
  list.number("cell", o.cell, "m", {0, 16},
              "Side length of the cells in which point clouds become a surface; 0 to take it from the density.")
      .source("from the density by default");
  list.choice("buildings", o.buildings,
              {{"automatic", Buildings::automatic},
               {"class", Buildings::by_class},
               {"shape", Buildings::by_shape},
               {"top", Buildings::top}},
              "How buildings are found in point clouds: by class 6; by shape, which is all but vegetation; "
              "automatically, by "
              "class where a tile has points of class 6 and else by shape; or not at all, as the top of everything.")
      .source("automatic by default");
  list.string("building_classes", o.building_classes, "Classes of points that are buildings, with commas: 6,67.")
      .source("class 6 of ASPRS; France has 67 for other buildings");
  list.string("ground_classes", o.ground_classes, "Classes of points that are the ground, with commas: 2,66.")
      .source("class 2 of ASPRS");
  list.string("left_out_classes", o.left_out_classes,
              "Classes of points that are left out beside those of noise (7 and 18), with commas.")
      .source("empty by default");
  list.number("step", o.step, "m", {0.1, 10}, "Difference in height between adjacent cells that is a wall.")
      .source("half a storey; lower steps become slopes")
      .number("gap", o.gap, "m²", {0, 100}, "Holes in a surface that are no larger are filled.")
      .source("a shed whose roof reflects nothing (Delft)")
      .number("isolated", o.isolated, "m²", {0, 100}, "Patches of a surface that are smaller are removed.")
      .source("a mast, a bird, a person; not tuned");
  list.number("points_per_cell", o.points_per_cell, "", {0.1, 1000}, "Minimum density of points that a cell must hold.")
      .advanced("Delft at several densities; docs/robustness.md")
      .number("points_per_large_cell", o.points_per_large_cell, "", {0.1, 1000},
              "Minimum density of points that a cell of 1 m or more must hold.")
      .advanced("Delft and two simulated blocks with 2 points/m², November 2026")
      .number("minimum_cell", o.minimum_cell, "m", {0.0625, 16},
              "Minimum side length of a cell taken from the density.")
      .advanced("walls are half-way between cells; smaller cells cost time")
      .number("maximum_cell", o.maximum_cell, "m", {0.0625, 16},
              "Maximum side length of a cell taken from the density.")
      .advanced("in larger cells dormers and narrow houses vanish")
      .number("building_share", o.building_share, "", {0, 1},
              "Share of a tile's points that must be of class 6 for buildings to be found by class.")
      .advanced("a house of 40 m² in a tile of 128 m")
      .number("step_slope", o.step_slope, "m/m", {1, 20}, "Slope between adjacent cells that is a wall.")
      .advanced("65°, steeper than roofs")
      .number("gap_residual", o.gap_residual, "m", {0, 10},
              "Maximum root mean square distance of the rim of a hole from its plane for the hole to be filled.")
      .advanced("noise of LiDAR and roof tiles; not tuned")
      .number("wall_points", o.wall_points, "", {1, 1e6},
              "Minimum number of points on a wall for it to be where they are, not half-way between two cells.")
      .advanced("fewer are a sill or a pipe")
      .number("ground_reach", o.ground_reach, "m", {0, 100},
              "Distance to which heights of ground points are continued into areas without any.")
      .advanced("half the width of a block of houses");
  return list;
}

auto cell_for(double density, const Options& options) -> double {
  const auto power = [](double side) { return std::exp2(std::floor(std::log2(side))); };
  double side = options.cell;
  if (side == 0) {
    side = options.minimum_cell;
    // Cells of 2 m lose narrow houses and ridges, which costs more than a few cells without points.
    const auto enough = [&] { return side < 1 ? options.points_per_cell : options.points_per_large_cell; };
    while (side < options.maximum_cell && side * side * density < enough()) side *= 2;
  }
  return std::clamp(power(side), 1.0 / 16, 16.0);
}

auto Surface::open(double cell, const Options& options) -> base::Result<std::unique_ptr<Surface>> {
  std::unique_ptr<Surface> out(new Surface(rounded(cell), options));
  auto spool = base::Spool::open();
  if (!spool) return spool.failure();
  out->spool_ = std::move(*spool);
  return out;
}

auto Surface::cell() const -> double { return static_cast<double>(cell_) / per_metre; }
auto Surface::side() const -> double { return cell() * tile_cells; }

void Surface::put_aside(const Tile& tile, const std::string& bytes) {
  chunks_[tile].push_back({spool_->size(), bytes.size()});
  spool_->append(bytes);
}

void Surface::flush(const Tile& tile, std::string& buffer) {
  if (buffer.empty()) return;
  put_aside(tile, buffer);
  buffered_ -= buffer.size();
  std::string().swap(buffer);  // frees its memory, as `= {}` does not: there may be thousands of tiles
}

void Surface::add(std::span<const Sample> samples, const std::optional<geometry::Box2>& within) {
  const std::int64_t side = cell_ * tile_cells, border = cell_ * halo;
  Tile least{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::min()},
      most{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max()};
  if (within) {
    least = {floored(rounded(within->least.x), side), floored(rounded(within->least.y), side)};
    most = {floored(rounded(within->most.x), side), floored(rounded(within->most.y), side)};
  }
  std::map<Tile, std::string> parts;
  Tile last{0, 0};
  std::string* at = nullptr;
  for (const auto& s : samples) {
    if (is_noise(s)) continue;
    const std::int64_t x = rounded(s.position.x), y = rounded(s.position.y);
    for (auto i = std::max(floored(x - border, side), least.first);
         i <= std::min(floored(x + border, side), most.first); ++i)
      for (auto j = std::max(floored(y - border, side), least.second);
           j <= std::min(floored(y + border, side), most.second); ++j) {
        const Tile tile{i, j};
        if (at == nullptr || tile != last) at = &parts[tile];
        last = tile;
        const Stored stored{static_cast<std::int32_t>(x - i * side + border),
                            static_cast<std::int32_t>(y - j * side + border),
                            static_cast<std::int32_t>(rounded(s.position.z)),
                            s.classification,
                            flags_of(s),
                            s.strip};
        at->append(reinterpret_cast<const char*>(&stored), sizeof stored);
      }
  }
  constexpr std::size_t piece = 1U << 16, most_buffered = std::size_t{1} << 26;
  const std::scoped_lock lock(mutex_);
  for (auto& [tile, part] : parts) {
    if (part.size() >= piece / 4) {  // of points that are beside each other: nothing to collect
      put_aside(tile, part);
      continue;
    }
    auto& buffer = buffers_[tile];
    buffer += part;
    buffered_ += part.size();
    if (buffer.size() >= piece) flush(tile, buffer);
  }
  if (buffered_ > most_buffered)
    for (auto& [tile, buffer] : buffers_) flush(tile, buffer);
}

auto Surface::tiles() -> std::vector<Tile> {
  const std::scoped_lock lock(mutex_);
  for (auto& [tile, buffer] : buffers_) flush(tile, buffer);
  buffers_.clear();
  // A square at the border of two tiles belongs to the one in the south-west, which may have no point of its own.
  std::vector<Tile> all;
  for (const auto& [tile, chunks] : chunks_) all.push_back(tile);
  return all;
}

auto Surface::make(const Tile& tile) const -> base::Result<TileSurface> {
  std::vector<Chunk> chunks;
  {
    const std::scoped_lock lock(mutex_);
    const auto at = chunks_.find(tile);
    if (at != chunks_.end()) chunks = at->second;
  }
  std::vector<detail::Point> points;
  for (const auto& chunk : chunks) {
    base::Result<std::string> bytes = [&] {
      const std::scoped_lock lock(mutex_);
      return spool_->read(chunk.offset, chunk.bytes);
    }();
    if (!bytes) return bytes.failure();
    for (std::size_t i = 0; i + sizeof(Stored) <= bytes->size(); i += sizeof(Stored)) {
      Stored s;
      std::memcpy(&s, bytes->data() + i, sizeof s);
      points.push_back({s.x, s.y, s.z, s.classification, s.flags, s.strip});
    }
  }
  TileSurface out;
  detail::Metres metres(std::move(points), cell_);
  out.counts.repeated = metres.repeated();
  std::uint64_t buildings = 0;
  for (const auto& p : metres.points()) {
    buildings += p.classification == 6 ? 1 : 0;
    if (!metres.is_own(p)) continue;
    ++out.counts.points;
    ++out.counts.classes[p.classification];
  }
  const std::int64_t side = cell_ * tile_cells, border = cell_ * halo;
  const std::int64_t x = tile.first * side, y = tile.second * side;
  out.strips = detail::compare_strips(metres);
  auto mode = options_.buildings;
  if (mode == Buildings::automatic)
    mode = buildings > 0 && static_cast<double>(buildings) >=
                                options_.building_share * static_cast<double>(metres.points().size())
               ? Buildings::by_class
               : Buildings::by_shape;
  std::tie(out.ground, out.counts.ground_cells) = ground_of(metres.points(), cell_, x, y, mode == Buildings::by_class);
  ++(mode == Buildings::by_class ? out.counts.tiles_by_class : out.counts.tiles_by_shape);
  detail::Grid grid(std::move(metres).take(), cell_, mode);
  detail::clean(grid, options_, out.counts);
  out.mesh = detail::mesh_of(grid, options_);
  const double west = static_cast<double>(x - border) / per_metre, south = static_cast<double>(y - border) / per_metre;
  // Windows of adjacent tiles begin at different places: rounded, what both have is at one place again.
  for (auto* places : {&out.mesh.vertices, &out.mesh.points})
    for (auto& v : *places)
      v = {static_cast<double>(rounded(v.x)) / per_metre + west, static_cast<double>(rounded(v.y)) / per_metre + south,
           static_cast<double>(rounded(v.z)) / per_metre};
  return out;
}

auto join(const std::vector<GroundTile>& tiles, double reach) -> std::optional<Ground> {
  Ground out;
  std::int64_t east = std::numeric_limits<std::int64_t>::min(), north = east;
  out.x = out.y = std::numeric_limits<std::int64_t>::max();
  for (const auto& tile : tiles) {
    if (tile.heights.empty()) continue;
    out.x = std::min(out.x, tile.x);
    out.y = std::min(out.y, tile.y);
    east = std::max(east, tile.x + static_cast<std::int64_t>(tile.columns));
    north = std::max(north, tile.y + static_cast<std::int64_t>(tile.rows));
  }
  if (east <= out.x) return std::nullopt;
  const auto steps = static_cast<std::int64_t>(reach);
  out.x -= steps;
  out.y -= steps;
  out.columns = static_cast<std::size_t>(east + steps - out.x);
  out.rows = static_cast<std::size_t>(north + steps - out.y);
  out.heights.assign(out.columns * out.rows, std::numeric_limits<float>::quiet_NaN());
  for (const auto& tile : tiles)
    for (std::size_t row = 0; row < tile.rows && !tile.heights.empty(); ++row)
      std::copy_n(tile.heights.begin() + static_cast<std::ptrdiff_t>(row * tile.columns), tile.columns,
                  out.heights.begin() +
                      static_cast<std::ptrdiff_t>((static_cast<std::size_t>(tile.y - out.y) + row) * out.columns +
                                                  static_cast<std::size_t>(tile.x - out.x)));
  // Row by row, from the heights before the step: what is filled in one of them does not count for the next row.
  std::vector<float> before(out.columns), here(out.columns);
  for (std::int64_t step = 0; step < steps; ++step) {
    bool any = false;
    for (std::size_t row = 0; row < out.rows; ++row) {
      float* const heights = out.heights.data() + row * out.columns;
      here.assign(heights, heights + out.columns);
      const float* const after = row + 1 < out.rows ? heights + out.columns : nullptr;
      for (std::size_t column = 0; column < out.columns; ++column) {
        if (!std::isnan(here[column])) continue;
        double sum = 0;
        int count = 0;
        for (const float* line : {row == 0 ? nullptr : std::as_const(before).data(), std::as_const(here).data(), after})
          for (std::size_t c = column == 0 ? 0 : column - 1; line != nullptr && c <= column + 1 && c < out.columns; ++c)
            if (!std::isnan(line[c])) {
              sum += static_cast<double>(line[c]);
              ++count;
            }
        if (count == 0) continue;
        heights[column] = static_cast<float>(sum / count);
        any = true;
      }
      before.swap(here);
    }
    if (!any) break;
  }
  return out;
}

}  // namespace mansard::cloud
