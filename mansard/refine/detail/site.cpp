#include "mansard/refine/detail/site.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/blur.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;

constexpr double unseen = std::numeric_limits<double>::quiet_NaN();

/// Calls see(column, row) for every cell of the grid whose centre is inside.
template <class See>
void each_inside(const Polygon& polygon, const Heights& grid, See see) {
  std::vector<double> crossings;
  const auto cross = [&](const geometry::Ring& ring, double y) {
    for (std::size_t i = 0; i < ring.size(); ++i) add_crossing(ring[i], ring[(i + 1) % ring.size()], y, crossings);
  };
  for (std::size_t row = 0; row < grid.rows; ++row) {
    crossings.clear();
    const double y = grid.centre(0, row).y;
    cross(polygon.outer, y);
    for (const auto& hole : polygon.holes) cross(hole, y);
    each_between(grid, crossings, [&](std::size_t column) { see(column, row); });
  }
}

/// Cells aligned to whole multiples of the spacing, over the polygon's bounds.
auto grid_over(const Polygon& polygon, double spacing) -> Heights {
  const auto box = geometry::bounds(polygon.outer);
  const auto low = [spacing](double v) { return std::floor(v / spacing); };
  Heights grid;
  grid.spacing = spacing;
  grid.origin = {(low(box.least.x) + 0.5) * spacing, (low(box.least.y) + 0.5) * spacing};
  grid.columns = static_cast<std::size_t>(low(box.most.x) - low(box.least.x)) + 1;
  grid.rows = static_cast<std::size_t>(low(box.most.y) - low(box.least.y)) + 1;
  grid.z.assign(grid.columns * grid.rows, unseen);
  return grid;
}

/// Calls see(cell) for every cell of the grid whose centre is nearer to the edge than `within`.
template <class See>
void each_near(Point2 a, Point2 b, double within, const Heights& grid, See see) {
  const auto box = geometry::Box2::of(geometry::Segment2{a, b});
  const auto index = [&grid](double v, double origin, std::size_t count) {
    return static_cast<std::size_t>(
        std::clamp(std::ceil((v - origin) / grid.spacing), 0.0, static_cast<double>(count)));
  };
  const std::size_t top = index(box.most.y + within, grid.origin.y, grid.rows);
  const Point2 along = b - a;
  const double squared = dot(along, along);
  for (std::size_t row = index(box.least.y - within, grid.origin.y, grid.rows); row < top; ++row) {
    // Only where the line of this row comes near: the edge may be long and slanting.
    double least = box.least.x, most = box.most.x;
    if (along.y != 0) {
      const double y = grid.centre(0, row).y, slack = within * std::sqrt(squared) / std::abs(along.y);
      const double x = a.x + (y - a.y) / along.y * along.x;
      least = std::max(least, x - slack);
      most = std::min(most, x + slack);
    }
    const std::size_t end = index(most + within, grid.origin.x, grid.columns);
    for (std::size_t column = index(least - within, grid.origin.x, grid.columns); column < end; ++column) {
      const Point2 from = grid.centre(column, row) - a;
      const double t = squared > 0 ? std::clamp(dot(from, along) / squared, 0.0, 1.0) : 0;
      const Point2 off = from - t * along;
      if (dot(off, off) < within * within) see(row * grid.columns + column);
    }
  }
}

/// Per cell of the grid, whether its centre is nearer to the polygon's edges than that.
auto cells_near(const Polygon& polygon, double within, const Heights& grid) -> std::vector<char> {
  std::vector<char> out(grid.z.size(), 0);
  const auto mark = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      each_near(ring[i], ring[(i + 1) % ring.size()], within, grid, [&](std::size_t cell) { out[cell] = 1; });
  };
  mark(polygon.outer);
  for (const auto& hole : polygon.holes) mark(hole);
  return out;
}

auto unblurred_of(const Polygon& polygon, const Heights& grid, const Kernel& kernel) -> std::vector<double> {
  const std::size_t stride = grid.columns + 2 * blur_reach;
  std::vector<double> inside(stride * (grid.rows + 2 * blur_reach), 0), sums(inside.size(), 0);
  const auto padded = [&](std::size_t column, std::size_t row) {
    return (row + blur_reach) * stride + column + blur_reach;
  };
  each_inside(polygon, grid, [&](std::size_t column, std::size_t row) { inside[padded(column, row)] = 1; });
  blur_rows(kernel, inside, sums);
  std::vector<double> out(grid.z.size(), 0);
  each_inside(polygon, grid, [&](std::size_t column, std::size_t row) {
    out[row * grid.columns + column] = 1 / blurred(kernel, sums, padded(column, row), stride);
  });
  return out;
}

/// Of places, those inside the polygon.
class Inside {
 public:
  Inside(const Polygon& polygon, const Heights& grid) : polygon_(polygon), grid_(grid), inside_(grid.z.size(), 0) {
    each_inside(polygon, grid, [&](std::size_t column, std::size_t row) { inside_[row * grid.columns + column] = 1; });
  }
  /// The cell of a place inside.
  [[nodiscard]] auto operator()(Point2 place) const -> std::optional<std::uint32_t> {
    const auto column = std::lround((place.x - grid_.origin.x) / grid_.spacing),
               row = std::lround((place.y - grid_.origin.y) / grid_.spacing);
    const auto columns = static_cast<long>(grid_.columns), rows = static_cast<long>(grid_.rows);
    if (column < 0 || row < 0 || column >= columns || row >= rows) return std::nullopt;
    const auto cell = static_cast<std::uint32_t>(row * columns + column);
    int count = 0;
    for (long r = std::max(row - 1, 0L); r <= std::min(row + 1, rows - 1); ++r)
      for (long c = std::max(column - 1, 0L); c <= std::min(column + 1, columns - 1); ++c)
        count += inside_[static_cast<std::size_t>(r * columns + c)];
    return count == 9 || geometry::contains(polygon_, place) ? std::optional(cell) : std::nullopt;
  }

 private:
  const Polygon& polygon_;
  const Heights& grid_;
  std::vector<char> inside_;
};

/// A measured point above the base.
struct Measured {
  Point2 place;
  double z = 0;
  std::uint32_t plane = planes::Found::none;
};

void add_points(Site& site, std::span<const Measured> points, const Options& options) {
  site.of_points = true;
  site.sample_area = options.samples.point_area;
  const Inside inside(site.polygon, site.measured);
  // The nearest edge is looked for where there is one: no point is farther from its cell's centre than a spacing.
  const auto beside = cells_near(site.polygon, options.margin + site.measured.spacing, site.measured);
  for (const auto& [place, z, plane] : points) {
    const auto cell = inside(place);
    if (!cell) continue;
    site.cells.push_back(*cell);
    site.places.push_back(place);
    site.z.push_back(z);
    site.plane_of.push_back(plane);
    const bool in_margin = beside[*cell] != 0 && geometry::boundary_distance(site.polygon, place) < options.margin;
    site.weight.push_back(in_margin ? options.samples.margin_weight : 1);
  }
  site.sorted = site.z;
  std::ranges::sort(site.sorted);
}

/// Of the cells of a part's margin, those that are in the building's.
using OfBuilding = std::function<bool(std::size_t cell)>;

/// Samples the surface, and weighs the samples.
void finish(Site& site, const Options& options, const OfBuilding& of_building) {
  const auto& grid = site.measured;
  site.sample_area = site.cell_area;
  const auto margin = cells_near(site.polygon, options.margin, grid);
  const auto count = static_cast<std::size_t>(std::ranges::count_if(grid.z, [](double z) { return !std::isnan(z); }));
  site.cells.reserve(count);
  site.sorted.reserve(count);
  site.weight.reserve(count);
  site.places.reserve(count);
  site.z.reserve(count);
  site.heights.assign(grid.z.size(), 0);
  site.weights.assign(grid.z.size(), 0);
  site.limits.assign(grid.z.size(), std::numeric_limits<double>::infinity());
  site.extents.assign(grid.rows, {0, 0});
  for (std::size_t row = 0, cell = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column, ++cell) {
      if (std::isnan(grid.z[cell])) continue;
      const double weight = margin[cell] != 0 ? options.samples.margin_weight : 1;
      site.cells.push_back(static_cast<std::uint32_t>(cell));
      site.sorted.push_back(grid.z[cell]);
      site.weight.push_back(weight);
      site.places.push_back(grid.centre(column, row));
      site.z.push_back(grid.z[cell]);
      site.heights[cell] = grid.z[cell];
      site.weights[cell] = weight;
      if (margin[cell] != 0 && of_building(cell)) site.limits[cell] = options.cuts.min_step;
      auto& [first, last] = site.extents[row];
      if (last == 0) first = column;
      last = column + 1;
    }
  std::ranges::sort(site.sorted);
  site.kernel = Kernel::of(options.samples.blur / grid.spacing);
  site.unblurred = unblurred_of(site.polygon, grid, site.kernel);
}

/// m: coarser over very large parts.
auto spacing_over(const Polygon& polygon, const Options& options) -> double {
  const double coarser = std::ceil(std::sqrt(geometry::area(polygon) / options.samples.max_cells) / options.grid);
  return options.grid * std::max(1.0, coarser);
}

/// Before anything is sampled.
auto unseen_over(const Polygon& polygon, double base, double spacing) -> Site {
  Site site;
  site.polygon = polygon;
  site.base = base;
  site.measured = grid_over(polygon, spacing);
  site.cell_area = spacing * spacing;
  return site;
}

/// The cells of one grid by those of another of the same spacing.
class Cells {
 public:
  Cells(const Heights& of, const Heights& by) : of_(of) {
    const Point2 shift = (1 / by.spacing) * (by.origin - of.origin);
    dx_ = std::lround(shift.x), dy_ = std::lround(shift.y);
  }
  [[nodiscard]] auto of(std::size_t column, std::size_t row) const -> std::optional<std::size_t> {
    const auto i = static_cast<std::int64_t>(column) + dx_, j = static_cast<std::int64_t>(row) + dy_;
    if (i < 0 || j < 0 || i >= static_cast<std::int64_t>(of_.columns) || j >= static_cast<std::int64_t>(of_.rows))
      return std::nullopt;
    return static_cast<std::size_t>(j) * of_.columns + static_cast<std::size_t>(i);
  }

 private:
  const Heights& of_;
  std::int64_t dx_ = 0, dy_ = 0;
};

}  // namespace

auto Site::seen_area() const -> double {
  return cell_area *
         static_cast<double>(std::ranges::count_if(measured.z, [](double height) { return !std::isnan(height); }));
}

namespace {

/// m: of the surface above the ground, by points where there are any near.
auto height_at(Point2 place, double base, const rays::Scene& mesh, const Evidence* points) -> std::optional<double> {
  if (points == nullptr) return mesh.top_inside_walls(place, base);
  if (const auto z = points->height_at(place)) return z;
  return mesh.top(place);
}

auto measured_over(const Polygon& polygon, double base, const Evidence& evidence) -> std::vector<Measured> {
  std::vector<Measured> out;
  for (const auto& [p, plane] : evidence.in(geometry::bounds(polygon.outer))) out.push_back({xy(p), p.z - base, plane});
  return out;
}

}  // namespace

auto look(const Polygon& polygon, double base, const rays::Scene& mesh, const Options& options, const Evidence* points)
    -> Site {
  Site site = unseen_over(polygon, base, spacing_over(polygon, options));
  auto& grid = site.measured;
  // What lies beyond the outline says nothing of the roof.
  const auto rim = points == nullptr ? std::vector<char>{} : cells_near(polygon, points->reach(), grid);
  each_inside(polygon, grid, [&](std::size_t column, std::size_t row) {
    const std::size_t cell = row * grid.columns + column;
    const bool at_rim = !rim.empty() && rim[cell] != 0;
    const Point2 centre = grid.centre(cell);
    const auto z = at_rim ? points->height_at(centre, polygon) : height_at(centre, base, mesh, points);
    if (z) grid.z[cell] = *z - base;
  });
  if (points == nullptr) finish(site, options, [](std::size_t) { return true; });
  else add_points(site, measured_over(polygon, base, *points), options);
  if (points != nullptr) site.planes = points->planes();
  return site;
}

namespace {

auto points_of(const Site& site) -> std::vector<Measured> {
  std::vector<Measured> out;
  out.reserve(site.z.size());
  for (std::size_t i = 0; i < site.z.size(); ++i) out.push_back({site.places[i], site.z[i], site.plane_of[i]});
  return out;
}

/// The cells of a grid that are in the margin of the building over another site.
auto in_margin_of(const Site& site, const Cells& cells, const Heights& grid) -> OfBuilding {
  return [&site, &cells, columns = grid.columns](std::size_t cell) {
    const auto other = cells.of(cell % columns, cell / columns);
    return other && std::isfinite(site.limits[*other]);
  };
}

/// Of a surface, by the cells of its grid.
auto planes_by_cell(const Site& site) -> std::vector<std::uint32_t> {
  if (site.of_points || site.plane_of.empty()) return {};
  std::vector<std::uint32_t> out(site.measured.z.size(), planes::Found::none);
  for (std::size_t i = 0; i < site.cells.size(); ++i) out[site.cells[i]] = site.plane_of[i];
  return out;
}

/// The planes that the samples of a site are on, of a surface of which another site is known.
void add_planes(Site& to, const Cells& cells, const std::vector<std::uint32_t>& planes) {
  if (planes.empty()) return;
  to.plane_of.resize(to.cells.size(), planes::Found::none);
  const std::size_t columns = to.measured.columns;
  for (std::size_t i = 0; i < to.cells.size(); ++i)
    if (const auto other = cells.of(to.cells[i] % columns, to.cells[i] / columns);
        other && to.plane_of[i] == planes::Found::none)
      to.plane_of[i] = planes[*other];
}

}  // namespace

void put_on_planes(std::span<Site> sites, const Options& options) {
  std::map<double, std::vector<Site*>> by_spacing;
  for (Site& site : sites)
    if (!site.of_points) by_spacing[site.measured.spacing].push_back(&site);
  for (const auto& [spacing, alike] : by_spacing) {
    std::vector<Point3> cells;
    for (const Site* site : alike)
      for (std::size_t i = 0; i < site->cells.size(); ++i)
        cells.push_back({site->places[i].x, site->places[i].y, site->z[i] + site->base});
    const auto found = planes::find(cells, {.noise = options.samples.noise, .point_area = spacing * spacing});
    auto next = found.plane_of.begin();
    for (Site* site : alike) {
      const auto first = next;
      next += static_cast<std::ptrdiff_t>(site->cells.size());
      site->plane_of.assign(first, next);
    }
  }
}

auto crop(const Site& site, const Polygon& piece, const Options& options) -> Site {
  Site out = unseen_over(piece, site.base, site.measured.spacing);
  auto& grid = out.measured;
  const Cells cells(site.measured, grid);
  each_inside(piece, grid, [&](std::size_t column, std::size_t row) {
    if (const auto other = cells.of(column, row)) grid.z[row * grid.columns + column] = site.measured.z[*other];
  });
  out.planes = site.planes;
  if (site.of_points) add_points(out, points_of(site), options);
  else finish(out, options, in_margin_of(site, cells, grid));
  add_planes(out, cells, planes_by_cell(site));
  return out;
}

auto merged(const Site& a, const Site& b, const Polygon& both, const rays::Scene& mesh, const Options& options,
            const Evidence* points) -> Site {
  Site out = unseen_over(both, a.base, spacing_over(both, options));
  auto& grid = out.measured;
  if (a.measured.spacing != grid.spacing || b.measured.spacing != grid.spacing) {
    Site again = look(both, a.base, mesh, options, points);
    put_on_planes({&again, 1}, options);
    return again;
  }
  const Cells in_a(a.measured, grid), in_b(b.measured, grid);
  each_inside(both, grid, [&](std::size_t column, std::size_t row) {
    double& z = grid.z[row * grid.columns + column];
    if (const auto cell = in_a.of(column, row)) z = a.measured.z[*cell];
    if (const auto cell = in_b.of(column, row); cell && std::isnan(z)) z = b.measured.z[*cell] + (b.base - a.base);
    if (!std::isnan(z)) return;
    if (const auto top = height_at(grid.centre(column, row), a.base, mesh, points)) z = *top - a.base;
  });
  const auto of_a = in_margin_of(a, in_a, grid), of_b = in_margin_of(b, in_b, grid);
  if (points == nullptr) finish(out, options, [&](std::size_t cell) { return of_a(cell) || of_b(cell); });
  else add_points(out, measured_over(both, a.base, *points), options);
  add_planes(out, in_a, planes_by_cell(a));
  add_planes(out, in_b, planes_by_cell(b));
  out.planes = a.planes;
  return out;
}

auto without(const Site& site, const std::function<bool(Point2)>& taken, const Options& options) -> Site {
  Site out = unseen_over(site.polygon, site.base, site.measured.spacing);
  out.measured.z = site.measured.z;
  for (std::size_t cell = 0; cell < out.measured.z.size(); ++cell)
    if (double& z = out.measured.z[cell]; !std::isnan(z) && taken(out.measured.centre(cell))) z = unseen;
  if (!site.of_points) {
    finish(out, options, [&](std::size_t cell) { return std::isfinite(site.limits[cell]); });
    add_planes(out, Cells(site.measured, out.measured), planes_by_cell(site));
    return out;
  }
  out.planes = site.planes;
  auto points = points_of(site);
  std::erase_if(points, [&](const Measured& point) { return taken(point.place); });
  add_points(out, points, options);
  return out;
}

auto without_cells(const Site& site, const Options& options) -> Site {
  Site out = unseen_over(site.polygon, site.base, site.measured.spacing);
  finish(out, options, [](std::size_t) { return false; });
  out.of_points = site.of_points;
  return out;
}

void add_ceilings(Site& site, const rays::Scene& above) {
  const auto& grid = site.measured;
  each_inside(site.polygon, grid, [&](std::size_t column, std::size_t row) {
    const std::size_t cell = row * grid.columns + column;
    if (!std::isnan(grid.z[cell])) return;
    if (const auto z = above.top(grid.centre(cell)))
      site.ceilings.emplace_back(static_cast<std::uint32_t>(cell), *z - site.base);
  });
}

auto too_high_over(const Site& part, const Heights& grid, const std::vector<double>& roof) -> std::size_t {
  const Cells cells(grid, part.measured);
  const std::size_t columns = part.measured.columns;
  return static_cast<std::size_t>(std::ranges::count_if(part.ceilings, [&](const auto& hidden) {
    const auto cell = cells.of(hidden.first % columns, hidden.first / columns);
    return cell && roof[*cell] > hidden.second;
  }));
}

auto commonest(const std::vector<double>& sorted, const Options& options) -> double {
  return base::commonest(sorted, options.samples.level_band);
}

}  // namespace mansard::refine::detail
