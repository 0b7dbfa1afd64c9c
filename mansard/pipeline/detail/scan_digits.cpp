#include "mansard/pipeline/detail/scan_digits.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mansard::pipeline::detail {
namespace {

using geometry::Point3;

/// m; those of floats are powers of two, those of text files with few digits decimal.
constexpr std::array tried_steps{8.0, 4.0,    2.0,  1.0,     0.5,   0.25, 0.2,     0.125,
                                 0.1, 0.0625, 0.05, 0.03125, 0.025, 0.02, 0.015625};
constexpr double fine = 0.01;  // m: what laser points and compressed meshes are rounded to
constexpr std::size_t most_values = 20'000;

auto share_on(const std::vector<double>& values, double step) -> double {
  // Measured from the first value: an offset of the scan is no multiple of the step. Points are rounded to 1/4096 m.
  const double within = std::min(step / 20, 0.0005);
  std::vector<double> rest;
  for (const double value : values) {
    const double steps = (value - values.front()) / step;
    rest.push_back(std::abs(steps - std::round(steps)) * step);
  }
  return static_cast<double>(std::ranges::count_if(rest, [&](double r) { return r <= 2 * within; })) /
         static_cast<double>(values.size());
}

/// The coarsest of these steps; 0 where the values lie on none.
auto step_of(const std::vector<double>& values) -> double {
  // Steps of at least 15 mm, of which at most 2 mm count: by chance one value in seven.
  constexpr double nearly_all = 0.98;
  for (const double step : tried_steps)
    if (share_on(values, step) >= nearly_all) return step;
  return 0;
}

/// A grid by nature: one height at every place, as in a raster that was written as a mesh or a text.
auto is_grid(std::vector<Point3> places) -> bool {
  constexpr double nearly_all = 0.98;
  std::ranges::sort(places);
  const auto count = [&](auto what) {
    const auto again = std::ranges::unique(places, {}, what);
    places.erase(again.begin(), again.end());
    return static_cast<double>(places.size());
  };
  const double all = count([](const Point3& p) { return p; });  // blocks beside each other have some twice
  return count([](const Point3& p) { return std::pair(p.x, p.y); }) >= nearly_all * all;
}

}  // namespace

auto lost_digits(const model::Scene& scene, const ScanSample& sample) -> std::optional<LostDigits> {
  constexpr std::size_t fewest = 200;
  std::vector<Point3> all;
  for (const auto& block : sample.blocks) {
    const Point3 origin{static_cast<double>(block.origin[0] + scene.frame.origin[0]),
                        static_cast<double>(block.origin[1] + scene.frame.origin[1]),
                        static_cast<double>(block.origin[2] + scene.frame.origin[2])};
    const auto& places = block.mesh.points.empty() ? block.mesh.vertices : block.mesh.points;
    for (const auto& p : places) all.push_back(p + origin);
  }
  if (all.size() < fewest) return std::nullopt;
  std::vector<Point3> some;
  const std::size_t every = std::max<std::size_t>(1, all.size() / most_values);
  for (std::size_t i = 0; i < all.size(); i += every) some.push_back(all[i]);
  LostDigits out;
  const auto step_along = [&](double Point3::*axis) {
    std::vector<double> values;
    for (const auto& p : some) values.push_back(p.*axis);
    return step_of(values);
  };
  out.steps = {step_along(&Point3::x), step_along(&Point3::y), step_along(&Point3::z)};
  if (std::ranges::max(out.steps) <= fine) return std::nullopt;
  if (out.steps[0] > 0 && out.steps[0] == out.steps[1] && is_grid(all)) out.steps[0] = out.steps[1] = 0;
  // Noise is measured of the largest block: it contains what was lost, which only makes this check milder.
  const auto largest =
      std::ranges::max_element(sample.blocks, {}, [](const auto& b) { return b.mesh.vertices.size(); });
  const auto scan = accuracy::measure_noise(largest->mesh, largest->outline);
  out.noise = scan.noise;
  constexpr double exact = 0.001;  // m
  if (scan.windows == 0 || scan.noise < exact) return std::nullopt;
  // Rounding to steps s has the standard deviation s / √12. A third of the noise adds 5 % to it.
  constexpr double matters = 1.0 / 3;
  for (double& step : out.steps)
    if (step / std::sqrt(12.0) < matters * scan.noise) step = 0;
  if (std::ranges::max(out.steps) == 0) return std::nullopt;
  return out;
}

}  // namespace mansard::pipeline::detail
