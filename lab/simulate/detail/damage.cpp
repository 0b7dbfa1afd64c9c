#include "lab/simulate/detail/damage.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Point3;

constexpr std::size_t at_once = 1024;  // vertices that one piece of work is made of

template <class Work>
void each_vertex(std::size_t count, Work work) {
  base::parallel_for((count + at_once - 1) / at_once, [&](std::size_t some) {
    for (std::size_t v = some * at_once; v < std::min(count, (some + 1) * at_once); ++v) work(v);
  });
}

/// Towards the cameras.
auto cameras(double tilt) -> std::vector<Point3> {
  std::vector<Point3> all{{0, 0, 1}};
  constexpr int sides = 8;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.25) / sides;
    all.push_back({geometry::sine(tilt) * geometry::cosine(angle), geometry::sine(tilt) * geometry::sine(angle),
                   geometry::cosine(tilt)});
  }
  return all;
}

/// The walls that were not matched: the height below which each lacks its triangles, by face.
auto unmatched(const Surface& surface, const ScanOptions& options, std::uint64_t seed)
    -> std::map<std::uint32_t, double> {
  std::map<std::uint32_t, std::pair<double, double>> extents;
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    if (surface.classes[t] != Class::wall) continue;
    if (drawn(seed, surface.faces[t]) >= options.missing_walls) continue;
    auto& [low, high] = extents.try_emplace(surface.faces[t], 1e9, -1e9).first->second;
    for (const auto v : surface.mesh.triangles[t]) {
      low = std::min(low, surface.mesh.vertices[v].z);
      high = std::max(high, surface.mesh.vertices[v].z);
    }
  }
  std::map<std::uint32_t, double> below;
  for (const auto& [face, extent] : extents)
    below[face] = extent.first + options.missing_share * (extent.second - extent.first);
  return below;
}

/// Per vertex: its share of the area of the roof triangles around it, m².
auto roof_areas(const geometry::Mesh& mesh, const std::vector<Label>& labels) -> std::vector<double> {
  std::vector<double> areas(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < labels.size(); ++t) {
    if (labels[t].kind != Class::roof) continue;
    for (const auto v : mesh.triangles[t]) areas[v] += area_of(mesh, mesh.triangles[t]) / 3;
  }
  return areas;
}

void lose_crumbs(const geometry::Mesh& mesh, std::vector<bool>& lost) {
  constexpr std::uint32_t crumb = 40;  // triangles
  base::DisjointSets together(mesh.vertices.size());
  for (std::size_t t = 0; t < lost.size(); ++t) {
    if (lost[t]) continue;
    together.join(mesh.triangles[t][0], mesh.triangles[t][1]);
    together.join(mesh.triangles[t][0], mesh.triangles[t][2]);
  }
  std::vector<std::uint32_t> sizes(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < lost.size(); ++t)
    if (!lost[t]) ++sizes[together.of(mesh.triangles[t][0])];
  for (std::size_t t = 0; t < lost.size(); ++t)
    if (!lost[t] && sizes[together.of(mesh.triangles[t][0])] < crumb) lost[t] = true;
}

}  // namespace

auto vertex_normals(const geometry::Mesh& mesh) -> std::vector<Point3> {
  std::vector<Point3> normals(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    const Point3 n = cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (const auto v : t) normals[v] = normals[v] + n;
  }
  for (auto& n : normals) n = normalised(n);
  return normals;
}

auto visibility(const geometry::Mesh& mesh, const std::vector<Point3>& normals, double tilt, const base::Run& run)
    -> std::vector<double> {
  constexpr double grazing = 0.1;  // cosine; nothing is matched on a surface seen flatter than this
  constexpr double off = 0.3;      // m; from the surface itself
  const rays::Scene scene(mesh);
  const auto towards = cameras(tilt);
  std::vector<double> seen(mesh.vertices.size(), 0);
  each_vertex(seen.size(), [&](std::size_t v) {
    if (run.cancelled()) return;
    double sum = 0, all = 0;
    for (const Point3 to : towards) {
      const double facing = dot(normals[v], to);
      if (facing < grazing) continue;
      all += facing;
      if (!scene.cast(mesh.vertices[v] + off * normals[v], to)) sum += facing;
    }
    if (all > 0) seen[v] = sum / all;
  });
  return seen;
}

auto roughen(geometry::Mesh& mesh, const std::vector<Point3>& normals, const std::vector<double>& seen,
             const std::vector<Label>& labels, const ScanOptions& options, std::uint64_t seed) -> Roughness {
  const auto weights = roof_areas(mesh, labels);
  const bool independent = options.noise_length <= 0;
  const Noise noise(seed, independent ? 1 : options.noise_length), bulge(seed + 2, options.bulge_length);
  struct Moved {
    double noise = 0, bulge = 0;  // along the normal
  };
  std::vector<Moved> moved(mesh.vertices.size());
  each_vertex(mesh.vertices.size(), [&](std::size_t v) {
    const Point3 p = mesh.vertices[v];
    // In 2.5-D nothing moves sideways: a height is measured, not a surface.
    const Point3 along = options.height_field ? Point3{0, 0, 1} : normals[v];
    const double upright = options.height_field ? 0 : 1 - std::abs(normals[v].z);
    const double unsure = (1 + options.noise_hidden) - options.noise_hidden * seen[v];
    double by = 0;
    if (options.noise > 0 && independent) {
      auto random = random_of(seed, v);
      by = options.noise * unsure * near_normal(random);
    } else if (options.noise > 0) {
      by = options.noise * unsure * noise.at(p);
    }
    const double facing = dot(along, normals[v]);
    moved[v].noise = facing * by;
    if (options.bulge > 0 && upright > 0) {
      const double wave = options.bulge * unsure * upright * bulge.at(p);
      by += wave;
      moved[v].bulge = facing * wave;
    }
    mesh.vertices[v] = p + by * along;
  });
  double area = 0;
  Roughness sums;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const auto [by, wave] = moved[v];
    area += weights[v];
    sums.noise += weights[v] * by * by;
    sums.bulge += weights[v] * wave * wave;
    sums.both += weights[v] * (by + wave) * (by + wave);
  }
  if (area <= 0) return {};
  return {std::sqrt(sums.noise / area), std::sqrt(sums.bulge / area), std::sqrt(sums.both / area)};
}

auto losses(const geometry::Mesh& mesh, const std::vector<Label>& labels, const std::vector<double>& seen,
            const World& world, const ScanOptions& options, std::uint64_t seed) -> std::vector<bool> {
  std::vector<bool> lost(labels.size(), false);
  constexpr double ragged = 1.0;  // m; root mean square of the border of what is lost
  const Noise border(seed, 4.0), patches(seed + 2, 5.0);
  const auto below = unmatched(world.surface, options, seed + 4);
  double walls = 0;
  for (std::size_t t = 0; t < labels.size(); ++t) {
    if (labels[t].kind != Class::wall) continue;
    walls += area_of(mesh, mesh.triangles[t]);
    const auto at = below.find(world.surface.faces[labels[t].triangle]);
    const Point3 p = centre_of(mesh, mesh.triangles[t]);
    if (at != below.end() && (options.missing_share >= 1 || p.z < at->second + ragged * border.at(p))) lost[t] = true;
  }

  // The least seen and the lowest first, in patches, until the walls' share is gone; ground as little seen goes with
  // it.
  struct Candidate {
    double score;
    std::size_t triangle;
    bool wall;
  };
  std::vector<Candidate> candidates;
  for (std::size_t t = 0; t < labels.size(); ++t) {
    if (lost[t] || (labels[t].kind != Class::wall && labels[t].kind != Class::ground)) continue;
    const Point3 p = centre_of(mesh, mesh.triangles[t]);
    double sees = 0;
    for (const auto v : mesh.triangles[t]) sees += seen[v] / 3;
    // Low walls are hidden by what stands before them. Ground faces the cameras, and is lost only where hidden as well.
    constexpr double high = 10, height_counts = 0.5, ground_counts = 0.45, patchy = 0.3, ground_hidden = 0.6;
    const bool wall = labels[t].kind == Class::wall;
    if (!wall && sees > ground_hidden) continue;
    const double above = std::clamp((p.z - world.terrain.at(xy(p))) / high, 0.0, 1.0);
    candidates.push_back({sees + (wall ? height_counts * above : ground_counts) + patchy * patches.at(p), t, wall});
  }
  std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
    return std::tie(a.score, a.triangle) < std::tie(b.score, b.triangle);
  });
  double gone = 0;
  for (const Candidate& candidate : candidates) {
    if (gone >= options.holes * walls) break;
    lost[candidate.triangle] = true;
    if (candidate.wall) gone += area_of(mesh, mesh.triangles[candidate.triangle]);
  }
  return lost;
}

auto torn(const geometry::Mesh& mesh, const std::vector<Label>& labels, std::vector<bool> lost, const Surface& surface,
          const ScanOptions& options, std::uint64_t seed) -> Scan {
  lose_crumbs(mesh, lost);
  Scan scan;
  struct Copy {
    std::uint32_t vertex;
    std::int64_t column, row;
    auto operator<=>(const Copy&) const = default;
  };
  std::map<Copy, std::uint32_t> at_seams;
  // A vertex's first tile is kept beside it, which spares the map all but the vertices at seams.
  struct First {
    std::int64_t column = 0, row = 0;
    std::uint32_t number = Scan::none;
  };
  std::vector<First> first(mesh.vertices.size());
  const auto copy = [&](std::uint32_t v, std::int64_t column, std::int64_t row) -> std::uint32_t {
    const auto fresh = static_cast<std::uint32_t>(scan.mesh.vertices.size());
    auto& known = first[v];
    if (known.number == Scan::none) known = {column, row, fresh};
    else if (known.column == column && known.row == row) return known.number;
    else if (const auto [at, inserted] = at_seams.emplace(Copy{v, column, row}, fresh); !inserted) return at->second;
    const auto step = [&](std::int64_t axis) { return options.seam * (2 * drawn(seed, column, row, axis) - 1); };
    scan.mesh.vertices.push_back(mesh.vertices[v] + Point3{step(0), step(1), step(2)});
    return fresh;
  };
  for (std::size_t t = 0; t < labels.size(); ++t) {
    if (lost[t]) continue;
    const Point3 p = centre_of(mesh, mesh.triangles[t]);
    const auto tile_of = [&](double x) {
      return options.seam > 0 ? static_cast<std::int64_t>(std::floor(x / options.tile)) : 0;
    };
    const auto column = tile_of(p.x), row = tile_of(p.y);
    geometry::Triangle corners{};
    std::ranges::transform(mesh.triangles[t], corners.begin(), [&](std::uint32_t v) { return copy(v, column, row); });
    scan.mesh.triangles.push_back(corners);
    scan.classes.push_back(labels[t].kind);
    scan.buildings.push_back(labels[t].triangle == Scan::none ? Scan::none : surface.buildings[labels[t].triangle]);
  }
  return scan;
}

}  // namespace mansard::simulate::detail
