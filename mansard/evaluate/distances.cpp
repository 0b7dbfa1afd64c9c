#include "mansard/evaluate/distances.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/evaluate/detail/normals.hpp"

namespace mansard::evaluate {
namespace {

using geometry::Point3;
using model::SurfaceClass;

constexpr double infinity = std::numeric_limits<double>::infinity();

auto area_of(const geometry::Mesh& mesh, const geometry::Triangle& t) -> double {
  const Point3 a = mesh.vertices[t[0]];
  return length(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a)) / 2;
}

/// The distances of those samples that have one.
template <class Measure>
auto measured(const std::vector<Sample>& samples, const base::Run& run, const Measure& measure) -> std::vector<double> {
  std::vector<double> distances(samples.size(), infinity);
  base::parallel_for(samples.size(), [&](std::size_t i) {
    if (!run.cancelled()) distances[i] = measure(samples[i]);
  });
  std::erase(distances, infinity);
  return distances;
}

/// Whether no scan can show this place of the model, since another part stands against it.
auto is_hidden(const Sample& sample, const rays::Scene& scene, const model::ModelSurface& model,
               const std::vector<Point3>& normals) -> bool {
  constexpr double touching = 0.1;   // m
  constexpr double opposite = -0.9;  // cosine of 155°
  return scene
      .nearest(sample.point, touching,
               [&](std::uint32_t t) {
                 const bool other = model.parts[t] != model.parts[sample.triangle];
                 return other && dot(normals[t], normals[sample.triangle]) < opposite ? 0 : infinity;
               })
      .has_value();
}

auto is_at(Point3 p, std::span<const Site> sites) -> bool {
  return std::ranges::any_of(sites, [&](const Site& site) {
    return p.z >= site.ground + site_foot && std::ranges::any_of(site.polygons, [&](const geometry::Polygon& polygon) {
             return geometry::bounds(polygon.outer).grown(site_reach).contains(xy(p)) &&
                    (geometry::contains(polygon, xy(p)) || geometry::boundary_distance(polygon, xy(p)) <= site_reach);
           });
  });
}

}  // namespace

auto area_per_sample(const geometry::Mesh& mesh, const SampleOptions& options) -> double {
  double total = 0;
  for (const auto& t : mesh.triangles) total += area_of(mesh, t);
  return std::max(1 / options.density, total / static_cast<double>(options.most));
}

auto samples_of(const geometry::Mesh& mesh, const SampleOptions& options, std::uint64_t seed) -> std::vector<Sample> {
  const double each = area_per_sample(mesh, options);
  base::Random random(seed);
  std::vector<Sample> samples;
  double due = random.uniform();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [ia, ib, ic] = mesh.triangles[t];
    const Point3 a = mesh.vertices[ia], b = mesh.vertices[ib], c = mesh.vertices[ic];
    for (due += area_of(mesh, mesh.triangles[t]) / each; due >= 1; due -= 1) {
      // Evenly over the triangle: the half of the parallelogram beyond the diagonal is turned back.
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      samples.push_back({a + u * (b - a) + v * (c - a), t});
    }
  }
  return samples;
}

auto spread_of(std::vector<double> distances) -> Spread {
  Spread out;
  out.samples = distances.size();
  if (distances.empty()) return out;
  const auto n = static_cast<double>(distances.size());
  std::ranges::sort(distances);
  double squares = 0;
  for (const double d : distances) {
    out.mean += d / n;
    squares += d * d;
  }
  out.rms = std::sqrt(squares / n);
  out.p95 = distances[static_cast<std::size_t>(std::floor(0.95 * (n - 1) + 0.5))];
  out.most = distances.back();
  return out;
}

auto open_samples(const model::ModelSurface& model, const SampleOptions& options, std::uint64_t seed,
                  const base::Run& run) -> std::vector<Sample> {
  const auto normals = detail::normals_of(model.mesh);
  const rays::Scene scene(model.mesh);
  const auto samples = samples_of(model.mesh, options, seed);
  std::vector<char> open(samples.size(), 0);
  base::parallel_for(samples.size(), [&](std::size_t i) {
    if (!run.cancelled()) open[i] = is_hidden(samples[i], scene, model, normals) ? 0 : 1;
  });
  std::vector<Sample> out;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (open[i] != 0) out.push_back(samples[i]);
  return out;
}

auto from_model(const model::ModelSurface& model, const rays::Scene& scan, const SampleOptions& options,
                std::uint64_t seed, const base::Run& run) -> std::vector<double> {
  return measured(open_samples(model, options, seed, run), run, [&](const Sample& sample) {
    if (model.classes[sample.triangle] == SurfaceClass::ground) return infinity;
    const auto near = scan.nearest(sample.point);
    if (!near) return infinity;
    return near->distance;
  });
}

auto from_scan(const geometry::Mesh& scan, std::span<const Site> sites, const model::ModelSurface& model,
               const SampleOptions& options, std::uint64_t seed, const base::Run& run) -> std::vector<double> {
  const rays::Scene scene(model.mesh);
  return measured(samples_of(scan, options, seed), run, [&](const Sample& sample) {
    if (!is_at(sample.point, sites)) return infinity;
    const auto near = scene.nearest(sample.point, infinity, [&](std::uint32_t t) {
      return model.classes[t] == SurfaceClass::ground ? infinity : 0.0;
    });
    if (!near) return infinity;
    return near->distance;
  });
}

}  // namespace mansard::evaluate
