#include "mansard/refine/detail/lines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/order.hpp"

namespace mansard::refine::detail {
namespace {

/// m, and rise per run: a line that moves less than a micrometre between rounds stays.
constexpr double settled = 1e-6;

/// 1 within `robust`, without a branch: which samples are beyond is as good as random.
auto weight_of(const Look& look, const RoofLine& line, double robust) -> double {
  const double d = std::abs(look.height - line.at_edge - line.slope * look.inward);
  return look.weight * (robust / std::max(d, robust));
}

}  // namespace

auto line_through(std::span<const Look> looks, RoofLine start, const Options::Lines& options)
    -> std::optional<RoofLine> {
  if (std::ssize(looks) < options.min_samples) return std::nullopt;
  // Sums about the middle of the looks: within some tens of metres of all, so that no digits are lost.
  double middle = 0, height = 0;
  for (const Look& look : looks) {
    middle += look.inward / static_cast<double>(looks.size());
    height += look.height / static_cast<double>(looks.size());
  }
  RoofLine line = start;
  for (std::int64_t round = 0; round < options.rounds; ++round) {
    geometry::LineSums sums;
    for (const Look& look : looks)
      sums.add(look.inward - middle, look.height - height, weight_of(look, line, options.robust));
    if (!(sums.weight > 0)) return std::nullopt;
    const double x = sums.x / sums.weight, z = sums.z / sums.weight;
    const double xx = std::max(0.0, sums.xx - sums.x * x);
    const double slope = xx > 0 ? (sums.xz - sums.x * z) / xx : 0;
    if (!((1 + slope * slope) * xx >= options.min_spread * options.min_spread * sums.weight)) return std::nullopt;
    const RoofLine before = line;
    line = {height + z - slope * (middle + x), slope};
    if (std::abs(line.slope - before.slope) + std::abs(line.at_edge - before.at_edge) < settled) break;
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
    const double before = line.at_edge;
    line.at_edge = z / w;
    if (std::abs(line.at_edge - before) < settled) break;
  }
  return line;
}

auto sums_along(std::span<const Look> looks) -> std::vector<geometry::LineSums> {
  std::vector<geometry::LineSums> sums(1);
  for (const Look& look : looks) {
    sums.push_back(sums.back());
    sums.back().add(look.inward, look.height, look.weight);
  }
  return sums;
}

auto best_parting(std::span<const Look> looks, std::span<const geometry::LineSums> sums, Before before,
                  const Within& within, double least) -> std::optional<Parting> {
  constexpr double same_rest = 1e-9;  // m²: sums of some thousand squares of up to 100 m² are exact to 1e-10
  std::optional<Parting> best;
  for (std::size_t i = within.fewest_before; i + within.fewest_behind < looks.size(); ++i) {
    if (looks[i].inward < within.from) continue;
    if (looks[i].inward > within.to) break;
    if (looks[i].inward - looks[i - 1].inward <= same_distance) continue;  // rounding orders them
    const double left =
        (before == Before::level ? sums[i].residual_level() : sums[i].residual()) + (sums.back() - sums[i]).residual();
    if (left < least - same_rest) least = left, best = Parting{i, left};
  }
  return best;
}

auto middle_height(std::span<const Look> looks) -> double {
  std::vector<double> heights;
  for (const Look& look : looks) heights.push_back(look.height);
  return base::median(std::move(heights));
}

}  // namespace mansard::refine::detail
