#include "mansard/confidence/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "mansard/base/statistics.hpp"
#include "mansard/evaluate/walls.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/solid/append_surface.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::confidence {
namespace {

using geometry::Point2;
using geometry::Polygon;

constexpr std::array<std::string_view, measures> names{
    "area",  "height",      "unseen",      "crowns",     "bare",         "razed",   "rms",    "bias",      "above",
    "below", "patch_above", "patch_below", "stacked",    "sunk",         "top",     "rough",  "ring_high", "ring_side",
    "gap",   "seamless",    "rim_low",     "rim_side",   "free",         "walls",   "steps",  "misplaced", "relief",
    "low",   "ground_off",  "samples",     "planes",     "small_planes", "steep",   "spread", "noise",     "spacing",
    "blur",  "edge_noise",  "offset",      "height_off", "doubtful",     "fallback"};

constexpr double ring_from = 0.5, ring_to = 1.25, around = 2.0;  // m outside an outline
constexpr double rim_from = 0.25, rim_to = 1.0;                  // m inside
constexpr double lowest_wall = 2;                                // m above the ground; less may be a hedge or a car
constexpr double of_others = 0.75;                               // m; so near a neighbour its wall may be seen
constexpr std::size_t sides = 8;
/// m; a scan without blur has a step between two cells of the grid, and one that rounds more than this shows no walls.
constexpr double least_reach = 0.01, most_reach = 1;
constexpr double nothing_built = -1e6;  // m; lower than any model

struct Cell {
  Point2 at;
  bool inside = false, wall = false;
  std::optional<double> built, scanned, seen;
  [[nodiscard]] auto off() const -> std::optional<double> {
    if (!inside || wall || !built || !seen) return std::nullopt;
    return *seen - *built;
  }
};

/// m; a scan that differs by more than this is off.
auto least_off(const model::Accuracy& accuracy) -> double {
  constexpr double detail = 0.25, sure = 3;  // m, standard deviations
  return std::max(detail, sure * accuracy.noise);
}

/// The place of an outline that is nearest to a point.
auto nearest_on(std::span<const Polygon> outline, Point2 p) -> Point2 {
  Point2 best = p;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const geometry::Segment2 edge{ring[i], ring[(i + 1) % ring.size()]};
      const double t = std::clamp(geometry::parameter(edge, p), 0.0, 1.0);
      const Point2 q = edge.start + t * (edge.end - edge.start);
      const double d = dot(q - p, q - p);
      if (d < least) least = d, best = q;
    }
  };
  for (const auto& polygon : outline) {
    look(polygon.outer);
    std::ranges::for_each(polygon.holes, look);
  }
  return best;
}

/// Shares of cells by the side that they are on, and of all.
struct Sides {
  std::array<double, sides> hit{}, all{};
  void add(Point2 outward, bool is_hit) {
    const double angle = geometry::arc_tangent(outward.y, outward.x) / (2 * std::numbers::pi) + 1;
    const auto side = static_cast<std::size_t>(angle * sides) % sides;
    all[side] += 1;
    hit[side] += is_hit ? 1 : 0;
  }
  [[nodiscard]] auto share() const -> double {
    double hits = 0, cells = 0;
    for (std::size_t s = 0; s < sides; ++s) hits += hit[s], cells += all[s];
    return cells > 0 ? hits / cells : 0;
  }
  /// Of sides with a twentieth of the cells or more: of a corner or two nothing follows.
  [[nodiscard]] auto most() const -> double { return range().second; }
  /// What the side that is hit most has more than the one that is hit least; 0 of a single side.
  [[nodiscard]] auto contrast() const -> double {
    const auto [least, most] = range();
    return most - least;
  }

 private:
  [[nodiscard]] auto range() const -> std::pair<double, double> {
    constexpr double few = 0.05;
    double cells = 0;
    for (const double n : all) cells += n;
    std::optional<std::pair<double, double>> out;
    for (std::size_t s = 0; s < sides; ++s) {
      if (all[s] < few * cells || all[s] <= 0) continue;
      const double here = hit[s] / all[s];
      out = out ? std::pair(std::min(out->first, here), std::max(out->second, here)) : std::pair(here, here);
    }
    return out.value_or(std::pair(0.0, 0.0));
  }
};

/// The building and what is around it on a grid.
struct Grid {
  double step = 0;
  std::size_t columns = 0, rows = 0;
  std::vector<Cell> cells;

  explicit Grid(const Site& site) {
    constexpr double finest = 0.25, most_cells = 3000;
    double area = 0;
    for (const auto& polygon : site.footprint) area += geometry::area(polygon);
    step = std::max(finest, std::sqrt(area / most_cells));
    const auto box = geometry::bounds(site.footprint).grown(around);
    columns = static_cast<std::size_t>(std::ceil((box.most.x - box.least.x) / step));
    rows = static_cast<std::size_t>(std::ceil((box.most.y - box.least.y) / step));
    cells.resize(columns * rows);
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = 0; i < columns; ++i) {
        auto& cell = cells[j * columns + i];
        cell.at = box.least + step * Point2{static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5};
        cell.inside = geometry::contains(site.footprint, cell.at);
      }
  }
  /// see(cell, neighbour) for the neighbours at so many cells in each of eight directions, where there are any.
  template <class See>
  void around_cell(std::size_t at, std::size_t by, See see) const {
    const auto i = at % columns, j = at / columns;
    for (const int dj : {-1, 0, 1})
      for (const int di : {-1, 0, 1}) {
        if (di == 0 && dj == 0) continue;
        const auto x = static_cast<std::ptrdiff_t>(i) + di * static_cast<std::ptrdiff_t>(by),
                   y = static_cast<std::ptrdiff_t>(j) + dj * static_cast<std::ptrdiff_t>(by);
        if (x < 0 || y < 0 || x >= static_cast<std::ptrdiff_t>(columns) || y >= static_cast<std::ptrdiff_t>(rows))
          continue;
        see(static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x));
      }
  }
};

/// Marks what is so near a wall of the model that the scan may show its other side.
void mark_walls(Grid& grid, double reach) {
  evaluate::HeightCells built{grid.columns, grid.rows, grid.step, {}};
  for (const auto& cell : grid.cells)
    built.heights.push_back(!cell.inside ? evaluate::HeightCells::outside : cell.built.value_or(nothing_built));
  const auto kept = evaluate::away_from_walls(built, std::clamp(reach, least_reach, most_reach));
  for (std::size_t c = 0; c < grid.cells.size(); ++c) grid.cells[c].wall = grid.cells[c].inside && !kept[c];
}

/// The largest number of connected marked cells.
auto largest(const Grid& grid, const std::vector<bool>& marked) -> std::size_t {
  std::vector<bool> done(marked.size());
  std::vector<std::size_t> open;
  std::size_t most = 0;
  for (std::size_t c = 0; c < marked.size(); ++c) {
    if (!marked[c] || done[c]) continue;
    std::size_t count = 0;
    done[c] = true;
    open.assign(1, c);
    while (!open.empty()) {
      const auto at = open.back();
      open.pop_back();
      ++count;
      grid.around_cell(at, 1, [&](std::size_t n) {
        if (!marked[n] || done[n]) return;
        done[n] = true;
        open.push_back(n);
      });
    }
    most = std::max(most, count);
  }
  return most;
}

auto model_of(const Site& site) -> geometry::Mesh {
  geometry::Mesh out;
  for (const auto* one : site.solids) solid::append_surface(one->solid, out);
  return out;
}

/// m³: what the error of a square metre grows by, for every metre that the walls within the footprint are displaced.
auto steps_of(const Grid& grid) -> double {
  double sum = 0;
  const auto look = [&](const Cell& a, const Cell& b) {
    if (!a.inside || !b.inside || !a.built || !b.built) return;
    const double jump = std::abs(*a.built - *b.built);
    if (jump > evaluate::step_of_walls(grid.step)) sum += jump * jump * grid.step;
  };
  for (std::size_t j = 0; j < grid.rows; ++j)
    for (std::size_t i = 0; i < grid.columns; ++i) {
      const auto& cell = grid.cells[j * grid.columns + i];
      if (i + 1 < grid.columns) look(cell, grid.cells[j * grid.columns + i + 1]);
      if (j + 1 < grid.rows) look(cell, grid.cells[(j + 1) * grid.columns + i]);
    }
  return sum;
}

/// m²: what the error grows by where the scan shows the other side of a wall of the model, per area of the footprint.
/// Rounded edges are as high as half of a wall where it stands.
auto misplaced_of(const Grid& grid) -> double {
  double sum = 0, inside = 0;
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    const auto& cell = grid.cells[c];
    if (!cell.inside) continue;
    inside += 1;
    if (!cell.built || !cell.seen) continue;
    double low = *cell.built, high = *cell.built;
    bool at_outline = false;
    for (const std::size_t by : {1, 2})
      grid.around_cell(c, by, [&](std::size_t n) {
        const auto& near = grid.cells[n];
        if (!near.inside) at_outline = at_outline || by == 1;
        if (!near.inside || !near.built) return;
        low = std::min(low, *near.built);
        high = std::max(high, *near.built);
      });
    if (at_outline || high - low < evaluate::step_of_walls(grid.step)) continue;
    const double other = *cell.built - low > high - *cell.built ? low : high;
    const double off = std::abs(*cell.seen - *cell.built);
    if (off > std::abs(*cell.seen - other)) sum += off * off;
  }
  return inside > 0 ? sum / inside : 0;
}

void measure_form(const Site& site, Evidence& out) {
  using enum Measure;
  constexpr double least_plane = 1, small = 4, steepest = 0.5;  // m², m², cosine of 60°
  double all = 0, in_small = 0, in_steep = 0;
  for (const auto* one : site.solids)
    for (std::size_t f = 0; f < one->classes.size(); ++f) {
      if (one->classes[f] != model::FaceClass::roof) continue;
      const auto& face = one->solid.faces[f];
      const double area = solid::area(one->solid, face);
      all += area;
      if (area >= least_plane) out[planes] += 1;
      if (area < small) in_small += area;
      if (face.normal.z < steepest) in_steep += area;
    }
  if (all <= 0) return;
  out[small_planes] = in_small / all;
  out[steep] = in_steep / all;
}

/// What the scan shows of the roof.
void measure_roof(const Site& site, const Grid& grid, Evidence& out) {
  using enum Measure;
  constexpr double least_rough = 0.25, sure_rough = 4, low_roof = 1.5;
  const double tolerance = least_off(site.accuracy);
  const double rough_by = std::max(least_rough, sure_rough * site.accuracy.noise);
  std::vector<double> differences, heights, built;
  std::vector<bool> high(grid.cells.size()), deep(grid.cells.size());
  double inside = 0, missing = 0, hidden = 0, without = 0, gone = 0, beside = 0, squares = 0, compared = 0, lower = 0;
  double roughness = 0, rough_cells = 0;
  std::array<double, 8> ring{};
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    const auto& cell = grid.cells[c];
    if (!cell.inside) continue;
    inside += 1;
    if (!cell.seen) missing += 1;
    if (!cell.seen && cell.scanned) hidden += 1;
    const bool at_ground = cell.seen && *cell.seen < site.ground + low_roof;
    if (!cell.built) (at_ground ? gone : without) += 1;
    if (cell.wall) beside += 1;
    if (cell.built) built.push_back(*cell.built - site.ground);
    if (cell.seen) heights.push_back(*cell.seen);
    if (cell.built && at_ground) lower += 1;
    const auto difference = cell.off();
    if (!difference) continue;
    differences.push_back(*difference);
    squares += *difference * *difference;
    compared += 1;
    if (*difference > tolerance) high[c] = true, out[stacked] += *difference;
    if (*difference < -tolerance) deep[c] = true, out[sunk] -= *difference;
    std::size_t count = 0;
    grid.around_cell(c, 2, [&](std::size_t n) {
      const auto& near = grid.cells[n];
      if (near.seen && near.built) ring[count++] = *near.seen - *near.built;
    });
    if (count < ring.size()) continue;
    rough_cells += 1;
    std::ranges::sort(ring);
    if (std::abs(*difference - 0.5 * (ring[3] + ring[4])) > rough_by) roughness += 1;
  }
  if (inside <= 0) return;
  out[misplaced] = misplaced_of(grid);
  out[steps] = steps_of(grid) / (inside * grid.step * grid.step);
  const double cell_area = grid.step * grid.step;
  out[area] = inside * cell_area;
  out[unseen] = missing / inside;
  out[crowns] = hidden / inside;
  out[bare] = without / inside;
  out[razed] = gone / inside;
  out[walls] = beside / inside;
  if (!built.empty()) {
    std::ranges::sort(built);
    out[height] = base::median_of_sorted(built);
    out[spread] = base::percentile_of_sorted(built, 0.95) - base::percentile_of_sorted(built, 0.05);
  }
  if (!heights.empty()) {
    double mean = 0, square = 0;
    for (const double z : heights) mean += z / static_cast<double>(heights.size());
    for (const double z : heights) square += (z - mean) * (z - mean) / static_cast<double>(heights.size());
    out[relief] = std::sqrt(square);
    out[low] = lower / static_cast<double>(heights.size());
  }
  if (compared > 0) {
    std::ranges::sort(differences);
    const auto share = [&](const std::vector<bool>& of) {
      return static_cast<double>(std::ranges::count(of, true)) / compared;
    };
    out[rms] = std::sqrt(squares / compared);
    out[bias] = base::median_of_sorted(differences);
    out[top] = base::percentile_of_sorted(differences, 0.99);
    out[above] = share(high);
    out[below] = share(deep);
    out[stacked] /= compared;
    out[sunk] /= compared;
    out[patch_above] = static_cast<double>(largest(grid, high)) * cell_area;
    out[patch_below] = static_cast<double>(largest(grid, deep)) * cell_area;
  }
  if (rough_cells > 0) out[rough] = roughness / rough_cells;
}

/// z at which the scan would go on outside, `distance` m from a place of the outline in the direction `out`; none where
/// it bends inside, or there is none.
auto going_on(const rays::Scene& scene, Point2 on, Point2 out, double distance) -> std::optional<double> {
  constexpr double first = 0.3, second = 0.6, third = 0.9, straight = 0.1;  // m inside, and m
  const auto a = scene.top(on - first * out), b = scene.top(on - second * out), c = scene.top(on - third * out);
  if (!a || !b || !c || std::abs(*a - 2 * *b + *c) > straight) return std::nullopt;
  return *a + (*a - *c) / (third - first) * (distance + first);
}

/// What the scan shows along the outline, where no neighbour is.
void measure_outline(const Site& site, const Grid& grid, Evidence& out) {
  using enum Measure;
  const double half = site.ground + 0.5 * out[height];
  // Of a block of hundreds of houses a few are near.
  struct Other {
    const Polygon* polygon;
    geometry::Box2 reach;
  };
  std::vector<Other> others;
  const auto looked_at = geometry::bounds(site.footprint).grown(around);
  for (const auto& other : site.others)
    if (const auto reach = geometry::bounds(other.outer).grown(around); reach.overlaps(looked_at))
      others.push_back({&other, reach});
  const auto in_others = [&](Point2 p) {
    return std::ranges::any_of(
        others, [&](const Other& other) { return other.reach.contains(p) && geometry::contains(*other.polygon, p); });
  };
  /// At most `around`.
  const auto nearer_to_others = [&](Point2 p, double distance) {
    return std::ranges::any_of(others, [&](const Other& other) {
      return other.reach.contains(p) && geometry::boundary_distance(*other.polygon, p) < distance;
    });
  };
  const auto near_others = [&](Point2 p) { return in_others(p) || nearer_to_others(p, of_others); };
  const double tolerance = least_off(site.accuracy);
  Sides outside, within, seams;
  double free_cells = 0, rim_cells = 0;
  std::vector<double> grounds;
  for (const auto& cell : grid.cells) {
    const Point2 on = nearest_on(site.footprint, cell.at), way = on - cell.at;
    const double distance = length(way);
    if (cell.inside) {
      if (distance < rim_from || distance > rim_to) continue;
      rim_cells += 1;
      if (near_others(on + (ring_from / distance) * way)) continue;
      free_cells += 1;
      if (cell.seen && cell.built) within.add(way, *cell.seen < site.ground + 0.5 * (*cell.built - site.ground));
    } else if (distance >= rim_from && distance <= around) {
      if (!cell.seen) continue;
      const bool on_none = !in_others(cell.at), in_ring = distance >= ring_from && distance <= ring_to;
      const bool high = on_none && *cell.seen > std::max(half, site.ground + lowest_wall);
      if (high) out[gap] += grid.step * grid.step;
      if (in_ring && on_none && !nearer_to_others(cell.at, distance)) {
        const Point2 outward = (-1 / distance) * way;
        const auto roof = high ? going_on(site.seen, on, outward, distance) : std::nullopt;
        seams.add(outward, roof && std::abs(*cell.seen - *roof) <= tolerance);
      }
      if (!on_none || distance < ring_from || nearer_to_others(cell.at, of_others)) continue;
      if (in_ring) outside.add(-1 * way, *cell.seen > half);
      if (*cell.seen < half) grounds.push_back(*cell.seen);
    }
  }
  out[ring_high] = outside.share();
  out[ring_side] = outside.most();
  out[seamless] = seams.contrast();
  out[rim_low] = within.share();
  out[rim_side] = within.most();
  if (out[area] > 0) out[gap] /= out[area];
  if (rim_cells > 0) out[free] = free_cells / rim_cells;
  if (!grounds.empty()) out[ground_off] = site.ground - base::median(std::move(grounds));
}

}  // namespace

auto name_of(Measure measure) -> std::string_view { return names[static_cast<std::size_t>(measure)]; }

auto evidence_of(const Site& site) -> Evidence {
  using enum Measure;
  Evidence out;
  const auto& scan = site.accuracy;
  out[noise] = scan.noise;
  out[spacing] = scan.spacing;
  out[blur] = scan.blur;
  out[edge_noise] = scan.edge_noise;
  out[offset] = length(scan.offset);
  if (site.footprint.empty()) return out;
  Grid grid(site);
  const rays::Scene model(model_of(site));
  for (auto& cell : grid.cells) {
    if (cell.inside) cell.built = model.top(cell.at);
    cell.scanned = site.scan.top(cell.at);
    cell.seen = &site.scan == &site.seen ? cell.scanned : site.seen.top(cell.at);
  }
  mark_walls(grid, scan.edge() + scan.spacing / 2);
  measure_form(site, out);
  measure_roof(site, grid, out);
  measure_outline(site, grid, out);
  if (site.scan.has_points()) {
    for (const auto& p : site.scan.points_in(geometry::bounds(site.footprint)))
      if (geometry::contains(site.footprint, xy(p))) out[samples] += 1;
  } else {
    out[samples] = (1 - out[unseen]) * out[area] / std::max(scan.correlated_area, scan.spacing * scan.spacing);
  }
  return out;
}

}  // namespace mansard::confidence
