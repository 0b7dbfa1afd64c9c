// The steps of a scan: what stands there, its surface, what each piece of it shows, and what becomes of it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/simulate/detail/damage.hpp"
#include "lab/simulate/detail/exact.hpp"
#include "lab/simulate/detail/height_field.hpp"
#include "lab/simulate/detail/raising.hpp"
#include "lab/simulate/detail/surface_net.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/base/text.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::simulate {
namespace {

/// A seed of its own for every purpose.
enum Purpose : std::uint64_t { ground, things, places, roughness, damage, tiles };

auto seed_for(std::uint64_t seed, Purpose purpose) -> std::uint64_t { return base::Random(seed, purpose).next(); }

/// What a grid may have: columns that can be numbered and kept, and cells along an axis.
constexpr double most_columns = 1 << 27, most_along = 1 << 20, most_levels = 1 << 19;

/// Columns of the grid and its levels, held against what can be numbered and kept. Fails with "simulate-size".
auto check_size(const Surface& surface, const geometry::Box2& area, const ScanOptions& options) -> base::Result<void> {
  constexpr double ground_square = 2;  // m; all that a scan has a grid of that has the faces themselves
  const bool faces = keeps_faces(options);
  const double resolution = faces ? ground_square : options.resolution;
  double high = 0;
  for (const auto v : surface.mesh.vertices) high = std::max(high, std::abs(v.z));
  const auto size = area.most - area.least;
  const auto extent = (1 / resolution) * size;
  const double columns = extent.x * extent.y;
  if (columns < most_columns && std::max(extent.x, extent.y) < most_along && high / resolution < most_levels) return {};
  const double coarser =
      std::max({std::sqrt(size.x * size.y / most_columns), std::max(size.x, size.y) / most_along, high / most_levels});
  constexpr double tenth = 10;  // the advice is rounded up to 0.1 m
  return base::error(
      "simulate-size",
      "the scan would have too many cells: " + base::to_text(size.x, 0) + " × " + base::to_text(size.y, 0) + " m are " +
          base::to_text(columns / 1e6, 0) + " million columns at " + base::to_text(resolution) + " m, and " +
          base::to_text(most_columns / 1e6, 0) + " million are the most; keep a part of it with --bbox" +
          (faces ? ""
                 : ", or take a resolution of " + base::to_text(std::floor(coarser * tenth + 1) / tenth, 1) + " m"),
      "simulate.resolution");
}

auto class_of(model::FaceClass kind) -> Class {
  switch (kind) {
    case model::FaceClass::wall:
    case model::FaceClass::party_wall: return Class::wall;
    case model::FaceClass::roof:
    case model::FaceClass::soffit: return Class::roof;
    case model::FaceClass::ground: return Class::ground;
  }
  return Class::other;
}

/// Of noises that are added, the variances and the integrals of their autocovariance add up.
auto accuracy_of(const detail::Roughness& rough, const ScanOptions& options) -> Accuracy {
  Accuracy out{rough.both, 0, options.resolution, options.height_field ? 0 : options.melt};
  const double noise = rough.noise * rough.noise, bulge = rough.bulge * rough.bulge;
  if (noise + bulge > 0)
    out.correlated_area = (noise * correlated_area(options.noise_length, options.resolution) +
                           bulge * correlated_area(options.bulge_length, options.resolution)) /
                          (noise + bulge);
  return out;
}

/// Along the sides of the bases, but for those that have another base beside them.
auto ground_at_walls(const Surface& surface, const detail::Terrain& terrain, const ScanOptions& options)
    -> std::vector<std::optional<Scan::AtWalls>> {
  constexpr double step = 1, beside = 0.15;  // m; farther than the cracks between outlines that were rounded
  const auto grounded = detail::on_ground(surface);
  geometry::Mesh floor{surface.mesh.vertices, {}, {}};
  for (std::size_t t = 0; t < grounded.size(); ++t)
    if (grounded[t]) floor.triangles.push_back(surface.mesh.triangles[t]);
  const rays::Scene floors(floor);
  std::vector<std::optional<Scan::AtWalls>> out;
  std::vector<double> lengths;
  for (std::size_t t = 0; t < grounded.size(); ++t) {
    if (!grounded[t]) continue;
    const auto& corners = surface.mesh.triangles[t];
    const auto building = surface.buildings[t];
    if (building >= out.size()) out.resize(building + 1), lengths.resize(building + 1);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = [&](std::size_t k) { return surface.mesh.vertices[corners[(i + k) % 3]]; };
      const geometry::Point3 a = at(0), side = at(1) - a;
      const double length = geometry::length(xy(side));
      if (!(length > 0)) continue;
      auto outward = (1 / length) * left_of(xy(side));
      if (dot(outward, xy(at(2) - a)) > 0) outward = -1.0 * outward;
      const double pieces = std::ceil(length / step);
      for (double k = 0; k < pieces; ++k) {
        const auto p = a + ((k + 0.5) / pieces) * side;
        if (floors.top(xy(p) + beside * outward)) continue;
        const double z = keeps_faces(options) ? p.z : terrain.at(xy(p)), weight = length / pieces;
        auto& found = out[building];
        if (!found) found = {z, 0, z};
        *found = {std::min(found->lowest, z), found->mean + weight * z, std::max(found->highest, z)};
        lengths[building] += weight;
      }
    }
  }
  for (std::size_t b = 0; b < out.size(); ++b)
    if (out[b]) out[b]->mean /= lengths[b];
  return out;
}

}  // namespace

auto keeps_faces(const ScanOptions& options) -> bool {
  const auto unwanted = {options.melt,          options.noise,  options.bulge,      options.holes,
                         options.missing_walls, options.seam,   options.trees,      options.cars,
                         options.chimneys,      options.crowns, options.roof_trees, options.faults};
  return options.exact && !options.height_field && std::ranges::all_of(unwanted, [](double x) { return x <= 0; });
}

auto correlated_area(double noise_length, double spacing) -> double {
  if (noise_length <= 0) return spacing * spacing;
  constexpr double fine = 32;  // steps a wavelength, from which the sum is the integral to six digits
  const double step = std::max(spacing, noise_length / fine);
  const auto reach = static_cast<int>(std::ceil(std::numbers::sqrt3 * noise_length / step));  // no correlation beyond
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) sum += detail::correlation(noise_length, {i * step, j * step, 0});
  return sum * step * step;
}

auto surface_of(const model::City& city) -> base::Result<Surface> {
  Surface out;
  std::uint32_t faces = 0;
  for (std::uint32_t b = 0; b < city.buildings.size(); ++b)
    for (const auto& part : city.buildings[b].parts) {
      const auto& solid = part.model.solid;
      auto triangulated = solid::triangulate(solid);
      if (!triangulated) {
        auto why = triangulated.error();
        why.subject = part.id;
        return why;
      }
      const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
      out.mesh.vertices.insert(out.mesh.vertices.end(), solid.vertices.begin(), solid.vertices.end());
      for (std::size_t t = 0; t < triangulated->triangles.size(); ++t) {
        const auto& corners = triangulated->triangles[t];
        const std::uint32_t face = triangulated->face_of[t];
        out.mesh.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
        out.classes.push_back(class_of(part.model.classes[face]));
        out.buildings.push_back(b);
        out.faces.push_back(faces + face);
      }
      faces += static_cast<std::uint32_t>(solid.faces.size());
    }
  return out;
}

auto scan(const Surface& surface, const ScanOptions& options, std::uint64_t seed, const base::Run& run)
    -> base::Result<Scan> {
  if (surface.mesh.triangles.empty())
    return base::error("simulate-nothing", "there is no building to be scanned; give a model with solids");
  const auto area = geometry::Box2::of(surface.mesh.vertices).grown(options.margin);

  if (auto fits = check_size(surface, area, options); !fits) return fits.error();

  run.report("simulate", "surroundings", 0);
  const detail::Terrain terrain(surface, area, options, seed_for(seed, ground));
  if (keeps_faces(options)) {
    auto exact = detail::exact_scan(surface, terrain, area, run);
    if (exact) exact->at_walls = ground_at_walls(surface, terrain, options);
    return exact;
  }
  const detail::Nearest nearest(surface);
  auto around = detail::surroundings_of(surface, nearest, terrain, area, options, seed_for(seed, things));
  const detail::World world{surface, terrain, around.objects, area};

  run.report("simulate", "surface", 0.1);
  auto mesh = options.height_field ? detail::height_field(world, options.resolution, seed_for(seed, places), run)
                                   : detail::surface_net(world, options.resolution, options.melt, run);
  if (!mesh) return mesh.error();

  run.report("simulate", "labels", 0.4);
  const double radius = std::max(1.0, 2 * (options.melt + options.resolution));
  const auto labels = detail::labels_of(*mesh, world, nearest, radius, run);
  if (run.cancelled()) return base::stopped();

  run.report("simulate", "damage", 0.7);
  const auto normals = detail::vertex_normals(*mesh);
  // A laser from above sees all that a height field has.
  const auto seen = options.height_field ? std::vector<double>(mesh->vertices.size(), 1)
                                         : detail::visibility(*mesh, normals, options.camera_tilt, run);
  if (run.cancelled()) return base::stopped();
  auto lost = detail::losses(*mesh, labels, seen, world, options, seed_for(seed, damage));
  const auto rough = detail::roughen(*mesh, normals, seen, labels, options, seed_for(seed, roughness));
  auto out = detail::torn(*mesh, labels, std::move(lost), surface, options, seed_for(seed, tiles));
  out.crowns = std::move(around.crowns);
  out.planted = accuracy_of(rough, options);
  out.at_walls = ground_at_walls(surface, terrain, options);
  run.report("simulate", {}, 1);
  return out;
}

}  // namespace mansard::simulate
