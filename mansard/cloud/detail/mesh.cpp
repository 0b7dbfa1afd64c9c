// Triangles between the heights of four adjacent cells, and walls where their heights are of different surfaces.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mansard/cloud/detail/grid.hpp"

namespace mansard::cloud::detail {
namespace {

using Cell = std::pair<std::int64_t, std::int64_t>;
using geometry::Point3;

/// Where a wall crosses the line between two cells: a place in plan, and the heights of both sides there.
struct Crossing {
  double x = 0, y = 0;
  double first = 0, second = 0;
};

class Mesher {
 public:
  Mesher(const Grid& grid, const Options& options) : grid_(grid), options_(options) {}

  auto run() -> geometry::Mesh {
    // Windows begin at multiples of the tile, so every square belongs to the tile of its south-west cell.
    for (std::int64_t row = halo; row < halo + tile_cells; ++row)
      for (std::int64_t column = halo; column < halo + tile_cells; ++column) square(column, row);
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] auto height(Cell c) const -> const Height* {
    if (!Grid::inside(c.first, c.second)) return nullptr;
    const auto& h = grid_.at(c.first, c.second);
    return h.points > 0 ? &h : nullptr;
  }

  /// Slope from the cell beyond `at` (seen from `to`) to `at`; 0 where that is missing or of another surface.
  [[nodiscard]] auto slope_towards(Cell at, Cell to) const -> double {
    const Cell beyond{2 * at.first - to.first, 2 * at.second - to.second};
    const auto *here = height(at), *there = height(beyond);
    if (there == nullptr) return 0;
    const double rise = here->z - there->z;
    const double run = std::hypot(here->x - there->x, here->y - there->y);
    // Steeper than this is a step itself.
    return run < grid_.side() / 8 || std::abs(rise) > options_.step_slope * run ? 0 : rise / run;
  }

  [[nodiscard]] auto is_step(Cell a, Cell b) const -> bool {
    const auto *p = height(a), *q = height(b);
    const double rise = std::abs(p->z - q->z);
    if (rise <= options_.step) return false;
    const double run = std::hypot(p->x - q->x, p->y - q->y);
    if (rise > options_.step_slope * std::max(run, grid_.side())) return true;
    // A steep roof goes on beyond the two cells, a step does not.
    return rise > 2 * run * std::max(std::abs(slope_towards(a, b)), std::abs(slope_towards(b, a)));
  }

  /// Where points lie on the wall, their mean place along the line from `a` to `b`, as a share; else a half.
  [[nodiscard]] auto place_of_wall(Cell a, Cell b, const Height& p, const Height& q) const -> double {
    const double dx = q.x - p.x, dy = q.y - p.y, squared = dx * dx + dy * dy;
    const double low = std::min(p.z, q.z), high = std::max(p.z, q.z), margin = std::max(0.3, 0.15 * (high - low));
    if (squared <= 0) return 0.5;
    double sum = 0, count = 0;
    for (const auto& cell : {a, b})
      for (const auto& point : grid_.points_of(cell.first, cell.second)) {
        const double z = static_cast<double>(point.z) / per_metre;
        if (z < low + margin || z > high - margin) continue;
        const double x = static_cast<double>(point.x) / per_metre, y = static_cast<double>(point.y) / per_metre;
        sum += ((x - p.x) * dx + (y - p.y) * dy) / squared;
        ++count;
      }
    return count < options_.wall_points ? 0.5 : std::clamp(sum / count, 0.05, 0.95);
  }

  auto crossing(Cell a, Cell b) const -> Crossing {
    if (b < a) {  // the same numbers from both sides
      const auto other = crossing(b, a);
      return {other.x, other.y, other.second, other.first};
    }
    const auto &p = *height(a), &q = *height(b);
    const double share = place_of_wall(a, b, p, q);
    const double dx = q.x - p.x, dy = q.y - p.y, run = std::hypot(dx, dy);
    Crossing out{p.x + share * dx, p.y + share * dy, p.z + slope_towards(a, b) * share * run,
                 q.z + slope_towards(b, a) * (1 - share) * run};
    // Continued slopes must not turn the step over.
    if ((out.first - out.second) * (p.z - q.z) <= 0) {
      out.first = p.z;
      out.second = q.z;
    }
    return out;
  }

  auto vertex(Point3 p) -> std::uint32_t {
    const auto [at, is_new] = numbers_.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(p);
    return at->second;
  }
  void triangle(Point3 a, Point3 b, Point3 c) {
    const auto i = vertex(a), j = vertex(b), k = vertex(c);
    if (i != j && j != k && k != i) mesh_.triangles.push_back({i, j, k});
  }
  static auto turn(Point3 a, Point3 b, Point3 c) -> double {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  /// A polygon that is star-shaped around its first corner.
  void fan(const std::vector<Point3>& ring) {
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) triangle(ring[0], ring[i], ring[i + 1]);
  }

  void square(std::int64_t column, std::int64_t row) {
    std::vector<Cell> ring;
    for (const Cell& c : {Cell{column, row}, Cell{column + 1, row}, Cell{column + 1, row + 1}, Cell{column, row + 1}})
      if (height(c) != nullptr) ring.push_back(c);
    if (ring.size() < 3) return;
    std::vector<Point3> corners;
    for (const auto& c : ring) corners.push_back({height(c)->x, height(c)->y, height(c)->z});
    const std::size_t n = ring.size();
    std::vector<std::size_t> steps;  // of the edge from corner k to the next one
    for (std::size_t k = 0; k < n; ++k)
      if (is_step(ring[k], ring[(k + 1) % n])) steps.push_back(k);
    if (steps.size() < 2) return smooth(corners);

    std::vector<Crossing> walls;
    for (const auto k : steps) walls.push_back(crossing(ring[k], ring[(k + 1) % n]));
    Point3 centre;
    for (const auto& wall : walls)
      centre = centre + (1.0 / static_cast<double>(walls.size())) * Point3{wall.x, wall.y, 0};
    // A group of corners is between two walls: its polygon goes from the centre along one, over the corners, back along
    // the other.
    std::vector<double> inner;
    for (std::size_t g = 0; g < steps.size(); ++g)
      inner.push_back(0.5 * (walls[g].second + walls[(g + 1) % steps.size()].first));
    for (std::size_t g = 0; g < steps.size(); ++g) {
      const auto &from = walls[g], &to = walls[(g + 1) % steps.size()];
      std::vector<Point3> polygon{{centre.x, centre.y, inner[g]}, {from.x, from.y, from.second}};
      for (std::size_t k = (steps[g] + 1) % n;; k = (k + 1) % n) {
        polygon.push_back(corners[k]);
        if (k == steps[(g + 1) % steps.size()]) break;
      }
      polygon.push_back({to.x, to.y, to.first});
      fan(polygon);
      // The wall at `from`: the group before is on its first side.
      const double before = inner[(g + steps.size() - 1) % steps.size()];
      wall({from.x, from.y, from.first}, {from.x, from.y, from.second}, {centre.x, centre.y, before},
           {centre.x, centre.y, inner[g]});
    }
  }

  /// Between two groups, from the square's edge to its centre, where the first group is on the left. Seen from the
  /// lower group it is counter-clockwise.
  void wall(Point3 edge_first, Point3 edge_second, Point3 centre_first, Point3 centre_second) {
    triangle(edge_first, edge_second, centre_first);
    triangle(centre_first, edge_second, centre_second);
  }

  /// Cut along the diagonal that rises less, where both give triangles that face up.
  void smooth(const std::vector<Point3>& c) {
    if (c.size() == 3) return triangle(c[0], c[1], c[2]);
    const bool first = turn(c[0], c[1], c[2]) > 0 && turn(c[0], c[2], c[3]) > 0;
    const bool second = turn(c[1], c[2], c[3]) > 0 && turn(c[1], c[3], c[0]) > 0;
    const bool level = std::abs(c[0].z - c[2].z) <= std::abs(c[1].z - c[3].z);
    if (first && (level || !second)) {
      triangle(c[0], c[1], c[2]);
      triangle(c[0], c[2], c[3]);
    } else {
      triangle(c[1], c[2], c[3]);
      triangle(c[1], c[3], c[0]);
    }
  }

  const Grid& grid_;
  const Options& options_;
  geometry::Mesh mesh_;
  std::map<std::array<double, 3>, std::uint32_t> numbers_;
};

}  // namespace

auto mesh_of(const Grid& grid, const Options& options) -> geometry::Mesh {
  auto out = Mesher(grid, options).run();
  out.points = points_of(grid);
  return out;
}

auto points_of(const Grid& grid) -> std::vector<Point3> {
  std::vector<Point3> out;
  for (std::int64_t row = halo; row < halo + tile_cells; ++row)
    for (std::int64_t column = halo; column < halo + tile_cells; ++column)
      for (const auto& p : grid.points_of(column, row))
        out.push_back({static_cast<double>(p.x) / per_metre, static_cast<double>(p.y) / per_metre,
                       static_cast<double>(p.z) / per_metre});
  return out;
}

}  // namespace mansard::cloud::detail
