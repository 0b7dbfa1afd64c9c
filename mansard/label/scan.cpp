#include "mansard/label/scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/label/detail/terrain.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::label {
namespace {

using geometry::Point3;
using model::SurfaceClass;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Sine of the slope from vertical up to which a surface looks like a wall: the wall_angle of models, 0.2 rad, and the
/// noise of a scan.
constexpr double upright_rise = 0.25;

auto normals_of(const geometry::Mesh& mesh) -> std::vector<Point3> {
  std::vector<Point3> normals;
  for (const auto& t : mesh.triangles) normals.push_back(normalised(detail::area_vector(mesh, t)));
  return normals;
}

/// The triangles at every vertex.
struct Around {
  std::vector<std::uint32_t> first, triangles;
  explicit Around(const geometry::Mesh& mesh)
      : first(mesh.vertices.size() + 1, 0), triangles(3 * mesh.triangles.size()) {
    for (const auto& t : mesh.triangles)
      for (const auto v : t) ++first[v + 1];
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    auto next = first;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const auto v : mesh.triangles[t]) triangles[next[v]++] = t;
  }
};

/// What every triangle faces, without the noise of a scan: the mean, by area, over those that touch it, within `reach`.
/// What faces another way does not count, by the cosine: edges stay where they are.
auto directions_of(const geometry::Mesh& mesh, const std::vector<Point3>& normals, double reach)
    -> std::vector<Point3> {
  std::vector<Point3> out(normals.size());
  if (!(reach > 0)) return normals;
  const Around around(mesh);
  base::parallel_for(out.size(), [&](std::size_t t) {
    const Point3 middle = detail::centre_of(mesh, mesh.triangles[t]);
    std::vector<std::uint32_t> near;
    for (const auto v : mesh.triangles[t])
      near.insert(near.end(), around.triangles.begin() + around.first[v],
                  around.triangles.begin() + around.first[v + 1]);
    std::ranges::sort(near);
    near.erase(std::ranges::unique(near).begin(), near.end());
    Point3 sum = detail::area_vector(mesh, mesh.triangles[t]);
    for (const auto other : near) {
      if (other == t || length(detail::centre_of(mesh, mesh.triangles[other]) - middle) > reach) continue;
      sum = sum + std::max(0.0, dot(normals[t], normals[other])) * detail::area_vector(mesh, mesh.triangles[other]);
    }
    out[t] = normalised(sum);
  });
  return out;
}

/// What a place costs as ground: its distance from the terrain, across it, and what it looks another way.
auto ground_cost(Point3 p, Point3 normal, const detail::Terrain& terrain, const ScanOptions& options) -> double {
  constexpr double steep = 0.2;  // the foot of a wall is not ground for being low
  const double off = std::abs(p.z - terrain.at(xy(p)));
  if (!(off <= options.ground_height)) return infinity;
  return off * std::max(normal.z, steep) + options.turned * (1 - normal.z);
}

/// The terrain of a scan, found where there is no model.
auto terrain_beside(const rays::Scene& model, const geometry::Mesh& scan, const ScanOptions& options)
    -> detail::Terrain {
  const auto open = [&](std::size_t t) { return !model.top(xy(detail::centre_of(scan, scan.triangles[t]))); };
  return {scan, open, options.cell, options.slope};
}

}  // namespace

auto label_scan(const geometry::Mesh& scan, const model::ModelSurface& model, const ScanOptions& options,
                const base::Run& run) -> std::vector<SurfaceClass> {
  run.report("label", {}, 0);
  const rays::Scene scene(model.mesh);
  const auto model_normals = normals_of(model.mesh);
  const auto normals = directions_of(scan, normals_of(scan), options.even_out);
  const detail::Terrain terrain = terrain_beside(scene, scan, options);
  std::vector<SurfaceClass> classes(scan.triangles.size(), SurfaceClass::other);
  base::parallel_for(classes.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    const Point3 p = detail::centre_of(scan, scan.triangles[i]);
    const auto extra = [&](std::uint32_t t) {
      if (model.classes[t] == SurfaceClass::ground) return infinity;
      const double turned = options.turned * (1 - dot(normals[i], model_normals[t]));
      if (model.classes[t] != SurfaceClass::roof) return turned;
      return turned + options.upright * std::max(0.0, 1 - std::abs(normals[i].z) / upright_rise);
    };
    const double as_ground = ground_cost(p, normals[i], terrain, options);
    if (as_ground < infinity) classes[i] = SurfaceClass::ground;
    const auto near = scene.nearest(p, options.reach, extra);
    if (near && near->distance + extra(near->triangle) <= as_ground) classes[i] = model.classes[near->triangle];
  });
  run.report("label", {}, 1);
  return classes;
}

auto label_by_normal(const geometry::Mesh& scan) -> std::vector<SurfaceClass> {
  constexpr double steep = 0.70710678;        // cosine of 45°
  constexpr double storey = 2.5, reach = 15;  // m
  // No slope to speak of: what is lowest within reach.
  const detail::Terrain lowest(
      scan, [](std::size_t) { return true; }, reach, 0.01);
  std::vector<SurfaceClass> classes;
  classes.reserve(scan.triangles.size());
  for (const auto& t : scan.triangles) {
    const Point3 p = detail::centre_of(scan, t);
    if (std::abs(normalised(detail::area_vector(scan, t)).z) < steep) classes.push_back(SurfaceClass::wall);
    else classes.push_back(p.z > lowest.at(xy(p)) + storey ? SurfaceClass::roof : SurfaceClass::ground);
  }
  return classes;
}

auto nearest_wall_or_roof(const geometry::Mesh& scan, const model::ModelSurface& model) -> std::vector<SurfaceClass> {
  const rays::Scene scene(model.mesh);
  const auto extra = [&](std::uint32_t t) {
    const bool known = model.classes[t] == SurfaceClass::wall || model.classes[t] == SurfaceClass::roof;
    return known ? 0 : infinity;
  };
  std::vector<SurfaceClass> classes(scan.triangles.size(), SurfaceClass::other);
  base::parallel_for(classes.size(), [&](std::size_t i) {
    if (const auto near = scene.nearest(detail::centre_of(scan, scan.triangles[i]), infinity, extra))
      classes[i] = model.classes[near->triangle];
  });
  return classes;
}

auto above_ground(const geometry::Mesh& scan, const model::ModelSurface& model, const ScanOptions& options)
    -> std::vector<bool> {
  const detail::Terrain terrain = terrain_beside(rays::Scene(model.mesh), scan, options);
  std::vector<bool> above;
  above.reserve(scan.triangles.size());
  for (const auto& t : scan.triangles) {
    const Point3 p = detail::centre_of(scan, t);
    above.push_back(p.z > terrain.at(xy(p)) + options.ground_height);
  }
  return above;
}

auto wall_or_roof_by_normal(const geometry::Mesh& scan) -> std::vector<SurfaceClass> {
  constexpr double steep = 0.64278761;  // cosine of 50°
  std::vector<SurfaceClass> classes;
  classes.reserve(scan.triangles.size());
  for (const auto& t : scan.triangles)
    classes.push_back(std::abs(normalised(detail::area_vector(scan, t)).z) < steep ? SurfaceClass::wall
                                                                                   : SurfaceClass::roof);
  return classes;
}

auto confusion_of(const geometry::Mesh& scan, std::span<const SurfaceClass> truth, std::span<const SurfaceClass> given)
    -> ScanConfusion {
  ScanConfusion area{};
  for (std::size_t t = 0; t < scan.triangles.size(); ++t)
    area[static_cast<std::size_t>(truth[t])][static_cast<std::size_t>(given[t])] +=
        length(detail::area_vector(scan, scan.triangles[t])) / 2;
  return area;
}

auto classes_from(const geometry::Mesh& scan, const geometry::Mesh& labelled, std::span<const SurfaceClass> classes)
    -> std::vector<SurfaceClass> {
  constexpr double same_place = 1.0;  // m
  const rays::Scene scene(labelled);
  std::vector<SurfaceClass> out(scan.triangles.size(), SurfaceClass::other);
  base::parallel_for(out.size(), [&](std::size_t i) {
    if (const auto near = scene.nearest(detail::centre_of(scan, scan.triangles[i]), same_place))
      out[i] = classes[near->triangle];
  });
  return out;
}

}  // namespace mansard::label
