#include "mansard/refine/detail/propose_outline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/geometry/fit.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/pieces.hpp"

namespace mansard::refine::detail::carve {
namespace {

using geometry::Point2;
using geometry::Polygon;

/// Error bound, of sums of worths and of coordinates in metres. A worth is a sum of at most some 1e6 whole numbers and
/// shares, exact to 1e-10; a coordinate below 1e4 m is exact to 1e-12 m. Of boxes that are equal up to it the first is
/// taken; sides that are equal up to it touch.
constexpr double rounding = 1e-9;

/// Cell worths over a region's box, several cells to one.
struct Worths {
  int factor = 1, columns = 0, rows = 0;
  int first_column = 0, first_row = 0;
  std::vector<double> worth;
  auto at(int i, int j) -> double& {
    return worth[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)];
  }
};

struct CellBox {
  int left, bottom, right, top;  // right and top are not in it
  double sum;
};

auto worths_of(const Raster& raster, const Region& region, const Options& options) -> Worths {
  const int width = region.most_column - region.least_column + 1, height = region.most_row - region.least_row + 1;
  const int coarse = static_cast<int>(options.outlines.cells);
  Worths out;
  out.factor = (std::max(width, height) + coarse - 1) / coarse;
  out.columns = (width + out.factor - 1) / out.factor;
  out.rows = (height + out.factor - 1) / out.factor;
  out.first_column = region.least_column;
  out.first_row = region.least_row;
  out.worth.assign(static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows), 0);
  const int rim = static_cast<int>(std::lround(options.samples.melt / raster.spacing));
  for (int j = region.least_row; j <= region.most_row; ++j)
    for (int i = region.least_column; i <= region.most_column; ++i) {
      const std::size_t k = raster.at(i, j);
      double worth = 0;
      if (region.mask[k]) worth = 1;
      else if (raster.state[k] == Cell::outside) worth = -options.outlines.outside_price;
      // At the part's own edge the heights fall off whatever stands there.
      else if (raster.state[k] == Cell::seen && raster.inside(i - rim, j) && raster.inside(i + rim, j) &&
               raster.inside(i, j - rim) && raster.inside(i, j + rim))
        worth = -1;
      out.at((i - out.first_column) / out.factor, (j - out.first_row) / out.factor) += worth;
    }
  return out;
}

/// The box of the largest sum (Bentley's maximum-sum rectangle: Kadane's scan under each pair of rows).
auto best_box(Worths& worths) -> CellBox {
  CellBox best{0, 0, 0, 0, 0};
  std::vector<double> sums(static_cast<std::size_t>(worths.columns));
  for (int bottom = 0; bottom < worths.rows; ++bottom) {
    std::ranges::fill(sums, 0);
    for (int top = bottom; top < worths.rows; ++top) {
      double run = 0;
      int left = 0;
      for (int i = 0; i < worths.columns; ++i) {
        double& column = sums[static_cast<std::size_t>(i)];
        column += worths.at(i, top);
        if (run <= 0) run = 0, left = i;
        run += column;
        if (run > best.sum + rounding) best = {left, bottom, i + 1, top + 1, run};
      }
    }
  }
  return best;
}

auto rectangle_of(const Raster& raster, const Worths& w, const CellBox& box) -> Rectangle {
  const auto x = [&](int i) { return raster.x(w.first_column + i * w.factor) - raster.spacing / 2; };
  const auto y = [&](int j) { return raster.y(w.first_row + j * w.factor) - raster.spacing / 2; };
  return {{x(box.left), y(box.bottom)}, {x(box.right), y(box.top)}};
}

/// Reaching into the other where only a wall's melt parts them.
void joined(Rectangle& a, const Rectangle& b, double near) {
  const auto reaching = [near](double& least, double& most, double other_least, double other_most) {
    const double middle = (other_least + other_most) / 2;
    if (least >= other_most - rounding && least - other_most < near) least = middle;
    if (most <= other_least + rounding && other_least - most < near) most = middle;
  };
  const bool beside = a.least.y < b.most.y && b.least.y < a.most.y, over = a.least.x < b.most.x && b.least.x < a.most.x;
  if (beside && !over) reaching(a.least.x, a.most.x, b.least.x, b.most.x);
  if (over && !beside) reaching(a.least.y, a.most.y, b.least.y, b.most.y);
}

auto rectangles_of(const Raster& raster, const Region& region, const Options& options) -> std::vector<Rectangle> {
  const auto& o = options.outlines;
  Worths worths = worths_of(raster, region, options);
  const double least_sum = std::max(o.min_area_share * options.cuts.min_area / raster.cell_area(),
                                    o.min_addition * static_cast<double>(region.cells));
  std::vector<Rectangle> out;
  for (std::int64_t round = 0; round < o.max_rectangles; ++round) {
    const CellBox box = best_box(worths);
    if (box.sum < least_sum) break;
    for (int j = box.bottom; j < box.top; ++j)
      for (int i = box.left; i < box.right; ++i) worths.at(i, j) = 0;
    Rectangle rectangle = rectangle_of(raster, worths, box);
    const Point2 size = rectangle.most - rectangle.least;
    if (std::min(size.x, size.y) < o.min_width_share * options.cuts.min_width) continue;
    for (const Rectangle& before : out) joined(rectangle, before, o.near_edge);
    out.push_back(rectangle);
  }
  return out;
}

auto row_of(const Raster& raster, double y) -> int {
  return std::clamp(static_cast<int>(std::ceil((y - raster.least.y) / raster.spacing)), 0, raster.rows);
}

/// In-part metres beyond `at`, going `way` (±1) along the row, as far as tells whether they are more than `near`;
/// negative where none of the row's cells within twice that of the side is in the part.
auto run_beyond(const Raster& raster, double at, int way, int row, double near) -> double {
  const double place = (at - raster.least.x) / raster.spacing;
  int column = static_cast<int>(way > 0 ? std::ceil(place) : std::floor(place));
  const int inward = static_cast<int>(std::lround(2 * near / raster.spacing));
  bool any = false;
  for (int i = 0; i <= inward && !any; ++i) any = raster.inside(column - way * i, row);
  if (!any) return -1;
  double run = 0;
  for (; raster.inside(column, row) && run <= near; column += way) run += raster.spacing;
  return run;
}

/// A side where only the part's melted rim lies beyond goes out over it.
auto pushed(const Raster& raster, double at, int way, const std::vector<int>& rows, const Options::Outlines& options)
    -> std::optional<double> {
  double farthest = 0;
  std::size_t near = 0, all = 0;
  for (const int row : rows) {
    const double run = run_beyond(raster, at, way, row, options.near_edge);
    if (run < 0) continue;
    ++all;
    if (run > options.near_edge) continue;
    ++near;
    farthest = std::max(farthest, run);
  }
  if (all == 0 || static_cast<double>(near) < options.push_share * static_cast<double>(all)) return std::nullopt;
  // A run of cells is short of the edge by less than one, and the side starts within one: two reach past it.
  return at + way * (farthest + 2 * raster.spacing);
}

/// Rows of a side whose outer face is free of the other rectangles, less its ends where corners melt.
auto free_rows(const Raster& raster, double at, int way, std::size_t self, const std::vector<Rectangle>& all,
               const Options& options) -> std::vector<int> {
  const double melted = options.samples.melt;
  const Rectangle& own = all[self];
  const double trim = own.most.y - own.least.y > 4 * melted ? melted : 0;
  std::vector<int> out;
  for (int row = row_of(raster, own.least.y + trim); row < row_of(raster, own.most.y - trim); ++row) {
    const double x = at + way * melted, y = raster.y(row);
    const bool covered = std::ranges::any_of(all, [&](const Rectangle& o) {
      return &o != &own && x > o.least.x && x < o.most.x && y > o.least.y && y < o.most.y;
    });
    if (!covered) out.push_back(row);
  }
  return out;
}

/// Both sides of each rectangle that face along x.
void settle(const Raster& raster, std::vector<Rectangle>& all, bool finally, const Options& options) {
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const int way : {-1, 1}) {
      double& at = way < 0 ? all[i].least.x : all[i].most.x;
      const std::vector<int> rows = free_rows(raster, at, way, i, all, options);
      if (rows.empty()) continue;
      if (!finally) at = step_near(raster, at, rows, options);
      else if (const auto out = pushed(raster, at, way, rows, options.outlines)) at = *out;
      else at = aligned(raster, at, raster.y(rows.front()), raster.y(rows.back()), options.outlines);
    }
}

auto exchanged(std::vector<Rectangle> all) -> std::vector<Rectangle> {
  for (Rectangle& r : all) r = {{r.least.y, r.least.x}, {r.most.y, r.most.x}};
  return all;
}

/// Sides that nearly go on in one line do.
void lined_up(std::vector<Rectangle>& all, double near) {
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      for (const auto& side : {&Rectangle::least, &Rectangle::most})
        for (const auto& axis : {&Point2::x, &Point2::y})
          if (std::abs(all[i].*side.*axis - all[j].*side.*axis) < near) all[j].*side.*axis = all[i].*side.*axis;
}

auto polygon_of(const std::vector<Rectangle>& all, double melted) -> std::optional<Polygon> {
  std::vector<Polygon> parts;
  for (const Rectangle& r : all) {
    if (r.most.x - r.least.x < melted || r.most.y - r.least.y < melted) continue;
    parts.push_back({{r.least, {r.most.x, r.least.y}, r.most, {r.least.x, r.most.y}}, {}});
  }
  if (parts.size() == 1) return parts.front();
  auto united = geometry::unite(parts);
  if (!united || united->size() != 1) return std::nullopt;
  return std::move(united->front());
}

/// Mean residual of some rows at one column.
struct Place {
  double x = 0, level = 0;  // m
};

/// Columns around a place in which enough of the rows were seen.
auto profile_near(const Raster& raster, double at, const std::vector<int>& rows, const Options& all)
    -> std::vector<Place> {
  const auto& options = all.outlines;
  const int centre = static_cast<int>(std::lround((at - raster.least.x) / raster.spacing));
  const int span = static_cast<int>(std::ceil((reach_beside(all) + options.max_move) / raster.spacing));
  std::vector<Place> out;
  for (int i = std::max(0, centre - span); i < std::min(raster.columns, centre + span + 1); ++i) {
    double sum = 0, count = 0;
    for (const int row : rows) {
      const std::size_t k = raster.at(i, row);
      if (raster.state[k] != Cell::seen) continue;
      sum += raster.residual[k];
      count += 1;
    }
    if (count > 0 && count >= options.row_share * static_cast<double>(rows.size()))
      out.push_back({raster.x(i), sum / count});
  }
  return out;
}

/// The level at which a roof on one side of a wall meets it, by the line through what is clear of the wall's melt.
auto level_beside(const std::vector<Place>& profile, double wall, int way, const Options& options)
    -> std::optional<double> {
  geometry::LineSums sums;
  for (const Place& place : profile) {
    const double d = way * (place.x - wall);
    if (d < options.samples.melt || d > reach_beside(options)) continue;
    sums.add(d, place.level);
  }
  if (sums.weight < 2) return std::nullopt;
  const double slope = sums.weight > 2 ? sums.joint() / sums.spread() : 0;
  return std::abs(slope) > options.surfaces.max_slope ? sums.z / sums.weight : sums.line(slope).at_zero;
}

}  // namespace

auto step_near(const Raster& raster, double at, const std::vector<int>& rows, const Options& options) -> double {
  const auto& o = options.outlines;
  const std::vector<Place> profile = profile_near(raster, at, rows, options);
  const double start = at;
  for (std::int64_t round = 0; round < o.step_rounds; ++round) {
    const auto low = level_beside(profile, at, -1, options), high = level_beside(profile, at, 1, options);
    if (!low || !high || std::abs(*high - *low) < o.min_contrast) return at;
    const double middle = (*low + *high) / 2, way = *high > *low ? 1 : -1;
    std::optional<double> best;
    for (std::size_t c = 0; c + 1 < profile.size(); ++c) {
      const Place &here = profile[c], &next = profile[c + 1];
      const double a = way * (here.level - middle), b = way * (next.level - middle);
      if (a > 0 || b <= 0 || next.x - here.x > 1.5 * raster.spacing) continue;  // a column between them is missing
      const double crossing = here.x + (next.x - here.x) * a / (a - b);
      if (std::abs(crossing - start) > o.max_move) continue;
      if (!best || std::abs(crossing - at) < std::abs(*best - at)) best = crossing;
    }
    if (!best) return at;
    at = *best;
  }
  return at;
}

auto aligned(const Raster& raster, double at, double from, double to, const Options::Outlines& o) -> double {
  double best = at, best_distance = o.near_edge;
  const auto look_at = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      if (std::abs(b.x - a.x) > o.max_slant * std::abs(b.y - a.y)) continue;
      const double overlap = std::min(std::max(a.y, b.y), to) - std::max(std::min(a.y, b.y), from);
      if (overlap < -o.max_gap) continue;
      const double place = (a.x + b.x) / 2, distance = std::abs(place - at);
      if (distance > (overlap >= o.min_overlap ? o.near_edge : o.near_line) || distance >= best_distance) continue;
      best = place;
      best_distance = distance;
    }
  };
  look_at(raster.part.outer);
  for (const auto& hole : raster.part.holes) look_at(hole);
  return best;
}

auto outlines_of(const Raster& raster, const Raster& across, const Region& region, const Options& options)
    -> std::vector<Polygon> {
  const std::vector<Rectangle> all = rectangles_of(raster, region, options);
  std::vector<Polygon> out;
  for (std::size_t count = 1; count <= all.size(); ++count) {
    std::vector<Rectangle> some(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::int64_t round = 0; round <= options.outlines.settle_rounds; ++round) {
      const bool finally = round == options.outlines.settle_rounds;
      settle(raster, some, finally, options);
      some = exchanged(std::move(some));
      settle(across, some, finally, options);
      some = exchanged(std::move(some));
      if (!finally) lined_up(some, options.outlines.near_edge);
    }
    if (auto polygon = polygon_of(some, options.samples.melt)) out.push_back(std::move(*polygon));
  }
  return out;
}

auto pieces_in_part(const Polygon& part, const Polygon& polygon, const Options::Pieces& options)
    -> std::vector<Polygon> {
  const auto [whole, taken] = fitted(part, polygon, options);
  auto pieces = geometry::intersect(whole, taken);
  if (!pieces) return {};
  auto out = tidied(std::move(*pieces), options);
  rank(
      out, [](const Polygon& piece) { return -geometry::area(piece); }, same_area);
  return out;
}

auto pieces_in_part(const Polygon& part, const Polygon& in_frame, const Frame& frame, const Options::Pieces& options)
    -> std::vector<Polygon> {
  return pieces_in_part(part, from_frame(in_frame, frame), options);
}

}  // namespace mansard::refine::detail::carve
