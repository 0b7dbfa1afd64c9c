#include "lab/simulate/detail/labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::simulate::detail {
namespace {

using geometry::Point3;

auto label_of(Point3 p, Point3 normal, const World& world, const std::vector<const Object*>& objects,
              const Nearest& nearest, double radius) -> Label {
  // In 2.5-D, triangles hang from crowns and roofs to the street: in between there is nothing of the ground.
  constexpr double hanging = 0.5;  // m; a melted edge, or a bump, lifts the ground by less
  const double off = std::abs(p.z - world.terrain.at(xy(p)));
  double best = off * std::max(normal.z, 0.2) + Nearest::turned * (1 - normal.z);
  Label label{Class::ground, Scan::none};
  if (off > hanging) best = std::numeric_limits<double>::infinity(), label.kind = Class::other;
  for (const Object* object : objects)
    if (const double cost = object->distance(p); cost < best) best = cost, label = {Class::other, Scan::none};
  // First nearby, then as far as asked: most surfaces lie where they should.
  constexpr double near = 0.3;
  auto found = nearest.find(p, normal, std::min(near, radius));
  if (!found) found = nearest.find(p, normal, radius);
  if (found && found->cost < best) label = {world.surface.classes[found->triangle], found->triangle};
  return label;
}

/// Those that may be the nearest to one of the triangles from `from` to `to`.
auto objects_by(const geometry::Mesh& mesh, std::size_t from, std::size_t to, const World& world, double radius)
    -> std::vector<const Object*> {
  geometry::Box2 box;
  for (std::size_t t = from; t < to; ++t) box.add(xy(centre_of(mesh, mesh.triangles[t])));
  std::vector<const Object*> near;
  for (const Object& object : world.objects)
    if (object.bounds().grown(radius).overlaps(box)) near.push_back(&object);
  return near;
}

}  // namespace

auto normal_of(const geometry::Mesh& mesh, const geometry::Triangle& t) -> Point3 {
  return normalised(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]));
}
auto centre_of(const geometry::Mesh& mesh, const geometry::Triangle& t) -> Point3 {
  return (1.0 / 3) * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
}
auto area_of(const geometry::Mesh& mesh, const geometry::Triangle& t) -> double {
  return length(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]])) / 2;
}

auto labels_of(const geometry::Mesh& mesh, const World& world, const Nearest& nearest, double radius,
               const base::Run& run) -> std::vector<Label> {
  constexpr std::size_t at_once = 1024;
  std::vector<Label> labels(mesh.triangles.size());
  base::parallel_for((labels.size() + at_once - 1) / at_once, [&](std::size_t some) {
    if (run.cancelled()) return;
    const std::size_t from = some * at_once, to = std::min(labels.size(), from + at_once);
    const auto objects = objects_by(mesh, from, to, world, radius);
    for (std::size_t t = from; t < to; ++t)
      labels[t] = label_of(centre_of(mesh, mesh.triangles[t]), normal_of(mesh, mesh.triangles[t]), world, objects,
                           nearest, radius);
  });
  return labels;
}

}  // namespace mansard::simulate::detail
