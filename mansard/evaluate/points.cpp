#include "mansard/evaluate/points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::evaluate {
namespace {

auto middle(std::vector<double>& values) -> double {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

auto point_scores(const geometry::Mesh& model, std::span<const geometry::Point3> points) -> PointScores {
  PointScores out;
  out.points = points.size();
  const rays::Scene scene(model);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  constexpr std::size_t piece = 4096;
  std::vector<double> distances(points.size(), none);
  base::parallel_for((points.size() + piece - 1) / piece, [&](std::size_t b) {
    for (std::size_t i = b * piece; i < std::min(points.size(), (b + 1) * piece); ++i)
      if (const auto z = scene.top(geometry::xy(points[i]))) distances[i] = points[i].z - *z;
  });
  std::erase_if(distances, [](double d) { return std::isnan(d); });
  out.without_model = points.size() - distances.size();
  if (distances.empty()) return out;
  const auto n = static_cast<double>(distances.size());
  double squares = 0;
  for (const double d : distances) squares += d * d;
  out.rmse = std::sqrt(squares / n);
  const auto share = [&](double limit) {
    return static_cast<double>(std::ranges::count_if(distances, [&](double d) { return std::abs(d) <= limit; })) / n;
  };
  out.within_10cm = share(0.1);
  out.within_25cm = share(0.25);
  out.within_50cm = share(0.5);
  out.median = middle(distances);
  for (double& d : distances) d = std::abs(d);
  out.median_absolute = middle(distances);
  return out;
}

}  // namespace mansard::evaluate
