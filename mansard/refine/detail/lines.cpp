#include "mansard/refine/detail/lines.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/geometry/fit.hpp"

namespace mansard::refine::detail {
namespace {

auto weight_of(const Look& look, const RoofLine& line, double robust) -> double {
  const double d = std::abs(look.height - line.at_edge - line.slope * look.inward);
  return look.weight * (d <= robust ? 1 : robust / d);
}

}  // namespace

auto line_through(std::span<const Look> looks, RoofLine start, const Options::Lines& options)
    -> std::optional<RoofLine> {
  if (std::ssize(looks) < options.min_samples) return std::nullopt;
  RoofLine line = start;
  for (std::int64_t round = 0; round < options.rounds; ++round) {
    geometry::LineSums all, centred;
    for (const Look& look : looks) all.add(look.inward, look.height, weight_of(look, line, options.robust));
    if (!(all.weight > 0)) return std::nullopt;
    const double x = all.x / all.weight, z = all.z / all.weight;
    for (const Look& look : looks) centred.add(look.inward - x, look.height - z, weight_of(look, line, options.robust));
    const double slope = centred.xx > 0 ? centred.xz / centred.xx : 0;
    if (!((1 + slope * slope) * centred.xx >= options.min_spread * options.min_spread * all.weight))
      return std::nullopt;
    line.slope = slope;
    line.at_edge = z - line.slope * x;
  }
  return line;
}

auto raised_line(std::span<const Look> looks, RoofLine start, const Options::Lines& options) -> RoofLine {
  RoofLine line = start;
  for (std::int64_t round = 0; round < options.rounds; ++round) {
    double w = 0, z = 0;
    for (const Look& look : looks) {
      const double weight = weight_of(look, line, options.robust);
      w += weight;
      z += weight * (look.height - line.slope * look.inward);
    }
    if (!(w > 0)) return start;
    line.at_edge = z / w;
  }
  return line;
}

}  // namespace mansard::refine::detail
