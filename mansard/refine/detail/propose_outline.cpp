#include "mansard/refine/detail/propose_outline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/geometry/extent.hpp"
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

/// Along the raster's axes, metres.
struct Rectangle {
  Point2 least, most;
};

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

/// The rows along a rectangle's sides, less its ends where corners melt.
auto rows_of(const Raster& raster, const Rectangle& of, const Options& options) -> std::vector<int> {
  const double melted = options.samples.melt, trim = of.most.y - of.least.y > 4 * melted ? melted : 0;
  std::vector<int> out;
  for (int row = row_of(raster, of.least.y + trim); row < row_of(raster, of.most.y - trim); ++row) out.push_back(row);
  return out;
}

/// Both sides that face along x.
void settle(const Raster& raster, Rectangle& rectangle, const Options& options) {
  const std::vector<int> rows = rows_of(raster, rectangle, options);
  if (rows.empty()) return;
  for (const int way : {-1, 1}) {
    double& at = way < 0 ? rectangle.least.x : rectangle.most.x;
    if (const auto out = pushed(raster, at, way, rows, options.outlines)) at = *out;
    else at = aligned(raster, at, raster.y(rows.front()), raster.y(rows.back()), options.outlines);
  }
}

auto exchanged(const Rectangle& r) -> Rectangle { return {{r.least.y, r.least.x}, {r.most.y, r.most.x}}; }

}  // namespace

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

auto outline_of(const Raster& raster, const Raster& across, const Region& region, const Options& options)
    -> std::optional<Polygon> {
  const auto& o = options.outlines;
  Worths worths = worths_of(raster, region, options);
  const CellBox box = best_box(worths);
  if (box.sum < o.min_area_share * options.cuts.min_area / raster.cell_area()) return std::nullopt;
  Rectangle r = rectangle_of(raster, worths, box);
  const auto narrower = [&](double width) { return std::min(r.most.x - r.least.x, r.most.y - r.least.y) < width; };
  if (narrower(o.min_width_share * options.cuts.min_width)) return std::nullopt;
  settle(raster, r, options);
  r = exchanged(r);
  settle(across, r, options);
  r = exchanged(r);
  if (narrower(options.samples.melt)) return std::nullopt;
  return Polygon{{r.least, {r.most.x, r.least.y}, r.most, {r.least.x, r.most.y}}, {}};
}

auto askew_outline_of(const Raster& raster, const Region& region, const Options& options) -> std::optional<Polygon> {
  const auto fills = [&](double area) {
    return static_cast<double>(region.cells) * raster.cell_area() > options.regions.hollow_share * area;
  };
  const int columns = region.most_column - region.least_column + 1, rows = region.most_row - region.least_row + 1;
  if (fills(columns * rows * raster.cell_area())) return std::nullopt;
  std::vector<Point2> rims;
  for (int j = region.least_row; j <= region.most_row; ++j)
    for (int i = region.least_column; i <= region.most_column; ++i) {
      if (!region.mask[raster.at(i, j)]) continue;
      const double half = raster.spacing / 2;
      for (const double x : {-half, half})
        for (const double y : {-half, half}) rims.push_back({raster.x(i) + x, raster.y(j) + y});
    }
  const auto around = geometry::extent_of(std::move(rims));
  if (!fills(around.width * around.length)) return std::nullopt;
  return Polygon{{around.corners.begin(), around.corners.end()}, {}};
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
