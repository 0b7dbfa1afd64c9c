#include "mansard/refine/detail/lines.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::refine::detail {
namespace {

constexpr double robust = 0.25;  // m; three times the noise of a fair scan
constexpr int rounds = 8;        // reweighing converges well before

auto weight_of(const Look& look, const RoofLine& line) -> double {
  const double d = std::abs(look.height - line.at_edge - line.slope * look.inward);
  return look.weight * (d <= robust ? 1 : robust / d);
}

}  // namespace

auto line_through(std::span<const Look> looks, RoofLine start) -> std::optional<RoofLine> {
  constexpr std::size_t fewest = 12;
  constexpr double narrowest = 0.25;  // m; standard deviation of the distances, along the slope
  if (looks.size() < fewest) return std::nullopt;
  RoofLine line = start;
  for (int round = 0; round < rounds; ++round) {
    double w = 0, x = 0, z = 0, xx = 0, xz = 0;
    for (const Look& look : looks) {
      const double weight = weight_of(look, line);
      w += weight;
      x += weight * look.inward;
      z += weight * look.height;
    }
    if (!(w > 0)) return std::nullopt;
    x /= w;
    z /= w;
    for (const Look& look : looks) {
      const double weight = weight_of(look, line);
      xx += weight * (look.inward - x) * (look.inward - x);
      xz += weight * (look.inward - x) * (look.height - z);
    }
    const double slope = xx > 0 ? xz / xx : 0;
    if (!((1 + slope * slope) * xx >= narrowest * narrowest * w)) return std::nullopt;
    line.slope = slope;
    line.at_edge = z - line.slope * x;
  }
  return line;
}

auto raised_line(std::span<const Look> looks, RoofLine start) -> RoofLine {
  RoofLine line = start;
  for (int round = 0; round < rounds; ++round) {
    double w = 0, z = 0;
    for (const Look& look : looks) {
      const double weight = weight_of(look, line);
      w += weight;
      z += weight * (look.height - line.slope * look.inward);
    }
    if (!(w > 0)) return start;
    line.at_edge = z / w;
  }
  return line;
}

}  // namespace mansard::refine::detail
