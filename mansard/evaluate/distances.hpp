// How far two surfaces are from each other, both ways.
#pragma once

#include <span>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/surfaces.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::evaluate {

struct SampleOptions {
  double density = 4;          ///< samples per m²
  std::size_t most = 400'000;  ///< more are thinned out evenly
};

/// A place on a surface.
struct Sample {
  geometry::Point3 point;
  std::uint32_t triangle = 0;
};

/// Places spread over the mesh by area, drawn with the seed: as many on a triangle as its area asks for, give or take
/// one. Guarantees: 1 the same mesh, options and seed give the same samples.
[[nodiscard]] auto samples_of(const geometry::Mesh& mesh, const SampleOptions& options, std::uint64_t seed)
    -> std::vector<Sample>;

/// m² that each of them represents.
[[nodiscard]] auto area_per_sample(const geometry::Mesh& mesh, const SampleOptions& options) -> double;

/// m, of some samples.
struct Spread {
  std::size_t samples = 0;
  double mean = 0, rms = 0, p95 = 0, most = 0;
};
[[nodiscard]] auto spread_of(std::vector<double> distances) -> Spread;

/// Places on the model that could be seen if all of it stood free of the scan: not where a face of another part stands
/// against it, looking the opposite way (within 25°) at most 10 cm off.
[[nodiscard]] auto open_samples(const model::ModelSurface& model, const SampleOptions& options, std::uint64_t seed,
                                const base::Run& run = {}) -> std::vector<Sample>;

/// Metres from those of them that are not on ground faces, which no scan shows, to the scan's surface.
[[nodiscard]] auto from_model(const model::ModelSurface& model, const rays::Scene& scan, const SampleOptions& options,
                              std::uint64_t seed, const base::Run& run = {}) -> std::vector<double>;

/// Where a scan shows a building rather than its surroundings.
struct Site {
  std::vector<geometry::Polygon> polygons;
  double ground = 0;  ///< z, m
};
inline constexpr double site_reach = 0.5;  ///< m around the polygons
inline constexpr double site_foot = 1.0;   ///< m above the ground

/// Metres from places on the scan to the model's surface (its ground faces left out): places within `site_reach` of a
/// site's polygons in plan and `site_foot` above its ground. Trees and cars there count too.
[[nodiscard]] auto from_scan(const geometry::Mesh& scan, std::span<const Site> sites, const model::ModelSurface& model,
                             const SampleOptions& options, std::uint64_t seed, const base::Run& run = {})
    -> std::vector<double>;

}  // namespace mansard::evaluate
