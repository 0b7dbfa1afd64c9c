#include "lab/simulate/detail/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/stopped.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Point2;

/// The highest of ground, buildings and objects.
auto top(const World& world, const rays::Scene& buildings, const std::vector<const Object*>& objects, Point2 p)
    -> double {
  double z = world.terrain.at(p);
  if (const auto roof = buildings.top(p)) z = std::max(z, *roof);
  for (const auto* object : objects)
    if (const auto span = object->span(p)) z = std::max(z, span->second);
  return z;
}

/// Those over a strip along x.
auto objects_between(const World& world, double south, double north) -> std::vector<const Object*> {
  std::vector<const Object*> some;
  for (const auto& object : world.objects)
    if (const auto box = object.bounds(); box.most.y >= south && box.least.y <= north) some.push_back(&object);
  return some;
}

}  // namespace

auto height_field(const World& world, double resolution, std::uint64_t seed, const base::Run& run)
    -> base::Result<geometry::Mesh> {
  const auto count = [&](double least, double most) {
    return static_cast<std::size_t>(std::ceil((most - least) / resolution)) + 1;
  };
  const std::size_t columns = count(world.area.least.x, world.area.most.x);
  const std::size_t rows = count(world.area.least.y, world.area.most.y);
  const rays::Scene buildings(world.surface.mesh);
  geometry::Mesh mesh;
  mesh.vertices.resize(columns * rows);
  base::parallel_for(rows, [&](std::size_t row) {
    if (run.cancelled()) return;
    const double y = world.area.least.y + resolution * static_cast<double>(row);
    const auto objects = objects_between(world, y - resolution, y + resolution);
    for (std::size_t column = 0; column < columns; ++column) {
      const auto c = static_cast<std::int64_t>(column), r = static_cast<std::int64_t>(row);
      constexpr double loose = 0.5;  // of the step; more could turn a triangle over
      const Point2 off{loose * (drawn(seed, c, r, 0) - 0.5), loose * (drawn(seed, c, r, 1) - 0.5)};
      const Point2 p =
          world.area.least + resolution * (Point2{static_cast<double>(column), static_cast<double>(row)} + off);
      mesh.vertices[row * columns + column] = {p.x, p.y, top(world, buildings, objects, p)};
    }
  });
  if (run.cancelled()) return base::stopped();
  for (std::size_t row = 0; row + 1 < rows; ++row)
    for (std::size_t column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<std::uint32_t>(row * columns + column), b = a + 1;
      const auto d = a + static_cast<std::uint32_t>(columns), c = d + 1;
      const auto step = [&](std::uint32_t u, std::uint32_t v) {
        return std::abs(mesh.vertices[u].z - mesh.vertices[v].z);
      };
      const bool rising = step(a, c) <= step(b, d);  // the diagonal that bridges less height
      mesh.triangles.push_back(rising ? geometry::Triangle{a, b, c} : geometry::Triangle{a, b, d});
      mesh.triangles.push_back(rising ? geometry::Triangle{a, c, d} : geometry::Triangle{b, c, d});
    }
  return mesh;
}

}  // namespace mansard::simulate::detail
