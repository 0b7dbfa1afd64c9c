#include "mansard/refine/detail/propose_raster.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/edges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mansard::refine::detail::carve {
namespace {

using geometry::Point2;
using geometry::Polygon;

constexpr double quarter = std::numbers::pi / 2;
// Error bounds. A place below 1e4 m in a frame is turned with an error of 4e-12 m, over cells of 5 cm and more 1e-10 of
// a cell; an axis along a coordinate axis comes out of cos and sin with an error of 2⁻⁵³, and no edge of 1 km or less
// whose ends differ by the 2⁻¹⁶ m of the kernel's grid comes as near; a sum of lengths is exact to n · 2⁻⁵³.
constexpr double of_a_cell = 1e-6;
constexpr double on_axis = 1e-12;
constexpr double clearly_more = 1 + 1e-9;

template <class Map>
auto mapped(const Polygon& polygon, Map map) -> Polygon {
  Polygon out = polygon;
  for (Point2& p : out.outer) p = map(p);
  for (auto& hole : out.holes)
    for (Point2& p : hole) p = map(p);
  return out;
}

/// Calls visit(row, first, last) for the runs of cells with their centres in the polygon.
template <class Visit>
void for_each_run(const Polygon& polygon, const Raster& raster, Visit visit) {
  const geometry::Box2 box = geometry::bounds(polygon.outer);
  if (box.empty()) return;
  const auto row_of = [&](double y) { return (y - raster.least.y) / raster.spacing; };
  const int from = std::max(0, static_cast<int>(std::floor(row_of(box.least.y))));
  const int to = std::min(raster.rows - 1, static_cast<int>(std::ceil(row_of(box.most.y))));
  std::vector<double> crossings;
  for (int row = from; row <= to; ++row) {
    const double y = raster.y(row);
    crossings.clear();
    geometry::each_edge(polygon, [&](Point2 a, Point2 b) {
      if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    });
    std::ranges::sort(crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const auto column_of = [&](double x) {
        return static_cast<int>(std::ceil((x - raster.least.x) / raster.spacing));
      };
      const int first = std::max(0, column_of(crossings[i]));
      const int last = std::min(raster.columns, column_of(crossings[i + 1]));
      if (first < last) visit(row, first, last);
    }
  }
}

/// Measured height and residual at a place, from the cells around it that have both.
auto look(const Heights& measured, const Heights& model, Point2 p, double min_weight, float& z, float& residual)
    -> bool {
  const double u = (p.x - measured.origin.x) / measured.spacing, v = (p.y - measured.origin.y) / measured.spacing;
  // A place on a cell up to rounding takes that cell alone.
  const auto whole = [](double t) { return std::abs(t - std::round(t)) < of_a_cell ? std::round(t) : t; };
  const double su = whole(u), sv = whole(v);
  const double fu = std::floor(su), fv = std::floor(sv);
  double weight = 0, sum_z = 0, sum_r = 0;
  for (int dv = 0; dv < 2; ++dv)
    for (int du = 0; du < 2; ++du) {
      const double w = (du == 1 ? su - fu : 1 - su + fu) * (dv == 1 ? sv - fv : 1 - sv + fv);
      const double i = fu + du, j = fv + dv;
      if (w <= 0 || i < 0 || j < 0 || i >= static_cast<double>(measured.columns) ||
          j >= static_cast<double>(measured.rows))
        continue;
      const std::size_t k = static_cast<std::size_t>(j) * measured.columns + static_cast<std::size_t>(i);
      if (!std::isfinite(measured.z[k]) || !std::isfinite(model.z[k])) continue;
      weight += w;
      sum_z += w * measured.z[k];
      sum_r += w * (measured.z[k] - model.z[k]);
    }
  if (weight < min_weight) return false;
  z = static_cast<float>(sum_z / weight);
  residual = static_cast<float>(sum_r / weight);
  return true;
}

/// In [0, 90°).
auto angle_of(Point2 along) -> double {
  const double a = std::fmod(geometry::arc_tangent(along.y, along.x) + 2 * std::numbers::pi, quarter);
  return a >= quarter ? 0 : a;
}

/// In [−45°, 45°).
auto turn(double a, double b) -> double {
  double d = std::fmod(a - b, quarter);
  if (d < -quarter / 2) d += quarter;
  if (d >= quarter / 2) d -= quarter;
  return d;
}

}  // namespace

auto in_frame(const Polygon& polygon, const Frame& frame) -> Polygon {
  return mapped(polygon, [&](Point2 p) { return frame.to(p); });
}

auto from_frame(const Polygon& polygon, const Frame& frame) -> Polygon {
  return mapped(polygon, [&](Point2 p) { return frame.back(p); });
}

auto raster_of(const Polygon& part, const Heights& measured, const Heights& model, const Frame& frame,
               const Options::Directions& options) -> Raster {
  Raster out;
  out.frame = frame;
  out.part = in_frame(part, frame);
  out.spacing = measured.spacing;
  const geometry::Box2 box = geometry::bounds(out.part.outer);
  const Point2 origin = frame.to(measured.origin);
  const auto on_grid = [&](double t, double o) { return o + out.spacing * std::floor((t - o) / out.spacing); };
  out.least = {on_grid(box.least.x, origin.x), on_grid(box.least.y, origin.y)};
  out.columns = static_cast<int>(std::ceil((box.most.x - out.least.x) / out.spacing)) + 1;
  out.rows = static_cast<int>(std::ceil((box.most.y - out.least.y) / out.spacing)) + 1;
  const std::size_t cells = static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows);
  out.state.assign(cells, Cell::outside);
  out.z.assign(cells, 0);
  out.residual.assign(cells, 0);
  for_each_run(out.part, out, [&](int row, int first, int last) {
    for (int column = first; column < last; ++column) {
      const std::size_t k = out.at(column, row);
      const Point2 place = frame.back({out.x(column), out.y(row)});
      const bool seen = look(measured, model, place, options.min_weight, out.z[k], out.residual[k]);
      out.state[k] = seen ? Cell::seen : Cell::unseen;
    }
  });
  return out;
}

auto turned(const Raster& raster) -> Raster {
  Raster out = raster;
  out.part = mapped(raster.part, [](Point2 p) { return Point2{p.y, p.x}; });
  out.least = {raster.least.y, raster.least.x};
  out.columns = raster.rows;
  out.rows = raster.columns;
  for (int j = 0; j < raster.rows; ++j)
    for (int i = 0; i < raster.columns; ++i) {
      const std::size_t from = raster.at(i, j), to = out.at(j, i);
      out.state[to] = raster.state[from];
      out.z[to] = raster.z[from];
      out.residual[to] = raster.residual[from];
    }
  return out;
}

auto cells_in(const Polygon& polygon, const Raster& raster) -> std::vector<std::uint8_t> {
  std::vector<std::uint8_t> out(raster.state.size(), 0);
  for_each_run(polygon, raster, [&](int row, int first, int last) {
    for (int column = first; column < last; ++column) {
      const std::size_t k = raster.at(column, row);
      out[k] = raster.state[k] != Cell::outside ? 1 : 0;
    }
  });
  return out;
}

auto direction_of(const Polygon& part, const Options::Directions& options) -> Frame {
  struct Way {
    double angle, length;
  };
  std::vector<Way> ways;
  geometry::each_edge(part, [&](Point2 a, Point2 b) {
    if (const double l = length(b - a); l > 0) ways.push_back({angle_of(b - a), l});
  });
  double best = 0, best_angle = 0;
  for (const Way& centre : ways) {
    double support = 0, shift = 0;
    for (const Way& way : ways) {
      const double d = turn(way.angle, centre.angle);
      if (std::abs(d) > options.same) continue;
      support += way.length;
      shift += way.length * d;
    }
    if (support <= best * clearly_more) continue;
    best = support;
    best_angle = centre.angle + shift / support;
  }
  if (best <= 0) return {};
  // Edges that go exactly along the axes keep them so.
  const Point2 axis{geometry::cosine(best_angle), geometry::sine(best_angle)};
  return {std::abs(axis.y) < on_axis ? Point2{1, 0} : axis};
}

}  // namespace mansard::refine::detail::carve
