// Heights of the ground over an area: from a terrain model, or found in a mesh.
#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/terrain/terrain.hpp"

namespace mansard::terrain {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Point3;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

auto empty_grid(const Box2& area, double cell) -> model::HeightGrid {
  model::HeightGrid grid;
  grid.centre = area.least;
  grid.cell = cell;
  const auto count = [&](double least, double most) {
    return static_cast<std::size_t>(std::lround((most - least) / cell)) + 1;
  };
  grid.columns = count(area.least.x, area.most.x);
  grid.rows = count(area.least.y, area.most.y);
  grid.values.assign(grid.columns * grid.rows, unknown);
  return grid;
}

auto node(const model::HeightGrid& grid, std::size_t i, std::size_t j) -> Point2 {
  return {grid.centre.x + grid.cell * static_cast<double>(i), grid.centre.y + grid.cell * static_cast<double>(j)};
}

/// Fills what is not known from means of ever larger squares, and from these back to the nodes: continuous, and near to
/// what is known around a gap.
void fill(std::vector<float>& values, std::size_t columns, std::size_t rows) {
  if (std::ranges::none_of(values, [](float v) { return std::isnan(v); }) || (columns < 2 && rows < 2)) return;
  const std::size_t wide = (columns + 1) / 2, high = (rows + 1) / 2;
  std::vector<float> coarse(wide * high, unknown);
  for (std::size_t j = 0; j < high; ++j)
    for (std::size_t i = 0; i < wide; ++i) {
      double sum = 0;
      int count = 0;
      for (const std::size_t y : {2 * j, 2 * j + 1})
        for (const std::size_t x : {2 * i, 2 * i + 1})
          if (x < columns && y < rows && !std::isnan(values[y * columns + x])) sum += values[y * columns + x], ++count;
      if (count > 0) coarse[j * wide + i] = static_cast<float>(sum / count);
    }
  fill(coarse, wide, high);
  const auto at = [&](std::ptrdiff_t i, std::ptrdiff_t j) -> double {
    i = std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(wide) - 1);
    j = std::clamp<std::ptrdiff_t>(j, 0, static_cast<std::ptrdiff_t>(high) - 1);
    return coarse[static_cast<std::size_t>(j) * wide + static_cast<std::size_t>(i)];
  };
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < columns; ++x) {
      auto& value = values[y * columns + x];
      if (!std::isnan(value)) continue;
      // Between the middles of the four nearest squares: three quarters of its own in each direction.
      const auto i = static_cast<std::ptrdiff_t>(x / 2), j = static_cast<std::ptrdiff_t>(y / 2);
      const std::ptrdiff_t di = x % 2 == 0 ? -1 : 1, dj = y % 2 == 0 ? -1 : 1;
      value = static_cast<float>(0.5625 * at(i, j) + 0.1875 * (at(i + di, j) + at(i, j + dj)) +
                                 0.0625 * at(i + di, j + dj));
    }
}

auto finished(model::HeightGrid grid, const std::string& where) -> base::Result<Heights> {
  const auto known =
      static_cast<std::size_t>(std::ranges::count_if(grid.values, [](float v) { return !std::isnan(v); }));
  if (known == 0)
    return base::error("terrain-no-ground", "no height of the ground is known around the buildings " + where +
                                                "; give a terrain model that covers them with --dtm");
  Heights out{std::move(grid), {}};
  for (const float value : out.grid.values) out.known.push_back(!std::isnan(value));
  fill(out.grid.values, out.grid.columns, out.grid.rows);
  return out;
}

/// The least (or greatest) of all values within `reach` cells along rows, then along columns; what is not known counts
/// as nothing.
template <class Better>
auto spread(const std::vector<float>& values, std::size_t columns, std::size_t rows, std::size_t reach, Better better)
    -> std::vector<float> {
  std::vector<float> out(values.size(), unknown), half(values.size(), unknown);
  // M. van Herk, A fast algorithm for local minimum and maximum filters on rectangular and octagonal kernels, 1992.
  const auto line = [&](const std::vector<float>& from, std::vector<float>& to, std::size_t first, std::size_t step,
                        std::size_t count) {
    const std::size_t width = 2 * reach + 1, padded = ((count + 2 * reach + width - 1) / width) * width;
    std::vector<float> in(padded, unknown), ahead(padded), back(padded);
    for (std::size_t k = 0; k < count; ++k) in[k + reach] = from[first + k * step];
    const auto best = [&](float a, float b) { return std::isnan(a) ? b : (std::isnan(b) || better(a, b) ? a : b); };
    for (std::size_t k = 0; k < padded; ++k) ahead[k] = k % width == 0 ? in[k] : best(ahead[k - 1], in[k]);
    for (std::size_t k = padded; k-- > 0;)
      back[k] = (k + 1) % width == 0 || k + 1 == padded ? in[k] : best(back[k + 1], in[k]);
    for (std::size_t k = 0; k < count; ++k)
      to[first + k * step] = best(back[k], ahead[std::min(k + 2 * reach, padded - 1)]);
  };
  for (std::size_t j = 0; j < rows; ++j) line(values, half, j * columns, 1, columns);
  for (std::size_t i = 0; i < columns; ++i) line(half, out, i, columns, rows);
  return out;
}

}  // namespace

auto heights_of(const model::Scene& scene, const Box2& area, const Options& options) -> base::Result<Heights> {
  auto grid = empty_grid(area, options.cell);
  if (scene.terrain)
    for (std::size_t j = 0; j < grid.rows; ++j)
      for (std::size_t i = 0; i < grid.columns; ++i)
        if (const auto z = scene.terrain->at(node(grid, i, j)))
          grid.values[j * grid.columns + i] = static_cast<float>(*z);
  return finished(std::move(grid), "in the terrain model");
}

MeshGround::MeshGround(const Box2& area, const Options& options)
    : area_(area), options_(options), lowest_(empty_grid(area, options.cell)) {}

void MeshGround::add(const geometry::Mesh& mesh) {
  const double cell = lowest_.cell;
  for (const auto& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const Point3 normal = cross(b - a, c - a);
    // Walls are steeper than what may be ground; which way a triangle looks is not to be relied on.
    constexpr double level = 0.5;  // cosine of 60°
    if (normal.z * normal.z < level * level * dot(normal, normal) || normal.z == 0) continue;
    const Box2 box = Box2::of(std::array{a, b, c});
    if (!box.overlaps(area_)) continue;
    const auto first = [&](double p, double from) {
      return static_cast<std::size_t>(std::max(0.0, std::ceil((p - from) / cell)));
    };
    for (std::size_t j = first(box.least.y, lowest_.centre.y); j < lowest_.rows; ++j) {
      const double y = lowest_.centre.y + cell * static_cast<double>(j);
      if (y > box.most.y) break;
      for (std::size_t i = first(box.least.x, lowest_.centre.x); i < lowest_.columns; ++i) {
        const double x = lowest_.centre.x + cell * static_cast<double>(i);
        if (x > box.most.x) break;
        const Point2 p{x, y};
        const double u = cross(xy(c) - xy(b), p - xy(b)), v = cross(xy(a) - xy(c), p - xy(c)),
                     w = cross(xy(b) - xy(a), p - xy(a));
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0) continue;
        const auto z = static_cast<float>((u * a.z + v * b.z + w * c.z) / (u + v + w));
        auto& value = lowest_.values[j * lowest_.columns + i];
        if (std::isnan(value) || z < value) value = z;
      }
    }
  }
}

auto MeshGround::heights(std::span<const geometry::Polygon> footprints) const -> base::Result<Heights> {
  auto grid = lowest_;
  const std::size_t columns = grid.columns, rows = grid.rows;
  for (const auto& polygon : footprints) {
    const auto box = geometry::bounds(polygon.outer).grown(options_.beside);
    const auto first = [&](double p, double from) {
      return static_cast<std::size_t>(std::max(0.0, std::ceil((p - from) / grid.cell)));
    };
    for (std::size_t j = first(box.least.y, grid.centre.y); j < rows && node(grid, 0, j).y <= box.most.y; ++j)
      for (std::size_t i = first(box.least.x, grid.centre.x); i < columns && node(grid, i, j).x <= box.most.x; ++i)
        if (const auto p = node(grid, i, j);
            geometry::contains(polygon, p) || geometry::boundary_distance(polygon, p) < options_.beside)
          grid.values[j * columns + i] = unknown;
  }
  const auto less = [](float a, float b) { return a < b; };
  const auto greater = [](float a, float b) { return a > b; };
  // Points below the ground, as under glass and water, are taken off by a closing first.
  {
    const auto filled = spread(spread(grid.values, columns, rows, 1, greater), columns, rows, 1, less);
    for (std::size_t k = 0; k < filled.size(); ++k)
      if (!std::isnan(grid.values[k]) && filled[k] - grid.values[k] > options_.object_step) grid.values[k] = unknown;
  }
  // Openings with windows that double; what is higher than the opened surface by more than the slope of the ground
  // allows is an object.
  double before = 1;
  for (std::size_t reach = 1;; reach *= 2) {
    const double window = static_cast<double>(2 * reach + 1);
    const auto opened = spread(spread(grid.values, columns, rows, reach, less), columns, rows, reach, greater);
    const double allowed =
        std::min(options_.object_slope * (window - before) * grid.cell + options_.object_height, options_.object_step);
    for (std::size_t k = 0; k < opened.size(); ++k)
      if (!std::isnan(grid.values[k]) && grid.values[k] - opened[k] > allowed) grid.values[k] = unknown;
    before = window;
    if (window * grid.cell >= options_.object_width) break;
  }
  return finished(std::move(grid), "in the mesh");
}

}  // namespace mansard::terrain
