#include "scan.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "layout.hpp"

namespace mansard::planted {
namespace {

using geometry::Point2;

/// Numbers at the knots of a square lattice.
struct Lattice {
  Point2 least;
  double pitch = 1;
  std::size_t nx = 0, ny = 0;
  std::vector<double> z;

  Lattice(const geometry::Box2& box, double step)
      : least{step * std::floor(box.least.x / step), step * std::floor(box.least.y / step)},
        pitch(step),
        nx(static_cast<std::size_t>(std::ceil((box.most.x - least.x) / step)) + 1),
        ny(static_cast<std::size_t>(std::ceil((box.most.y - least.y) / step)) + 1),
        z(nx * ny, 0.0) {}

  [[nodiscard]] auto at(std::size_t i, std::size_t j) const -> Point2 {
    return least + pitch * Point2{static_cast<double>(i), static_cast<double>(j)};
  }
  [[nodiscard]] auto value(std::size_t i, std::size_t j) const -> double {
    return z[std::min(j, ny - 1) * nx + std::min(i, nx - 1)];
  }
  /// Bilinear between the knots.
  [[nodiscard]] auto between(Point2 p) const -> double {
    const double x = std::max(0.0, (p.x - least.x) / pitch), y = std::max(0.0, (p.y - least.y) / pitch);
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
    const double u = x - static_cast<double>(i), v = y - static_cast<double>(j);
    return (1 - v) * ((1 - u) * value(i, j) + u * value(i + 1, j)) +
           v * ((1 - u) * value(i, j + 1) + u * value(i + 1, j + 1));
  }
  /// Raises the knots in the polygon to at least `height`.
  void raise(const geometry::Polygon& polygon, const std::function<double(Point2)>& height) {
    const auto box = geometry::bounds(polygon.outer);
    const auto first = [&](double from, double to) {
      return static_cast<std::size_t>(std::max(0.0, std::ceil((from - to) / pitch)));
    };
    for (std::size_t j = first(box.least.y, least.y); j < ny && at(0, j).y <= box.most.y; ++j)
      for (std::size_t i = first(box.least.x, least.x); i < nx && at(i, j).x <= box.most.x; ++i)
        if (geometry::contains(polygon, at(i, j))) z[j * nx + i] = std::max(z[j * nx + i], height(at(i, j)));
  }
};

/// Mean of the knots within `radius` of one.
auto smeared(const Lattice& fine, std::size_t i, std::size_t j, double radius) -> double {
  const auto reach = static_cast<std::ptrdiff_t>(radius / fine.pitch);
  double sum = 0;
  int count = 0;
  for (std::ptrdiff_t dj = -reach; dj <= reach; ++dj)
    for (std::ptrdiff_t di = -reach; di <= reach; ++di) {
      const auto x = static_cast<std::ptrdiff_t>(i) + di, y = static_cast<std::ptrdiff_t>(j) + dj;
      const double across = static_cast<double>(di * di + dj * dj) * fine.pitch * fine.pitch;
      if (x < 0 || y < 0 || across > radius * radius) continue;
      sum += fine.value(static_cast<std::size_t>(x), static_cast<std::size_t>(y));
      ++count;
    }
  return sum / count;
}

auto mesh_of(const Lattice& heights) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (std::size_t j = 0; j < heights.ny; ++j)
    for (std::size_t i = 0; i < heights.nx; ++i) {
      const Point2 p = heights.at(i, j);
      mesh.vertices.push_back({p.x, p.y, heights.value(i, j)});
    }
  const auto id = [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(j * heights.nx + i); };
  for (std::size_t j = 0; j + 1 < heights.ny; ++j)
    for (std::size_t i = 0; i + 1 < heights.nx; ++i) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return mesh;
}

}  // namespace

auto scan(const std::vector<House>& houses, const std::vector<Box>& boxes, const Recipe& recipe) -> geometry::Mesh {
  geometry::Box2 region;
  for (const House& h : houses)
    for (const Point2 p : h.polygon.outer) region.add(p);
  region = region.grown(5);

  Lattice fine(region, recipe.pitch / 2), heights(region, recipe.pitch), bumps(region, recipe.correlation);
  for (const House& h : houses) fine.raise(h.polygon, [&](Point2 p) { return top(h, p); });
  for (const Box& b : boxes) fine.raise(b.polygon, [&](Point2) { return b.top; });

  base::Random random(recipe.seed, 5);
  for (double& z : bumps.z) z = recipe.height_sigma * normal(random);
  for (std::size_t j = 0; j < heights.ny; ++j)
    for (std::size_t i = 0; i < heights.nx; ++i) {
      const Point2 p = heights.at(i, j);
      const Point2 in_fine = (2 / recipe.pitch) * (p - fine.least);
      const double surface = smeared(fine, static_cast<std::size_t>(std::lround(std::max(0.0, in_fine.x))),
                                     static_cast<std::size_t>(std::lround(std::max(0.0, in_fine.y))), recipe.melt / 2);
      heights.z[j * heights.nx + i] = surface + bumps.between(p);
    }
  return mesh_of(heights);
}

}  // namespace mansard::planted
