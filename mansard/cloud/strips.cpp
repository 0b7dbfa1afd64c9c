#include "mansard/cloud/strips.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "mansard/base/text.hpp"

namespace mansard::cloud {
namespace {

constexpr std::size_t most_pairs = 2'000;
/// Half of what the USGS allows two swaths to differ in its best quality level (Lidar Base Specification, relative
/// vertical accuracy of QL0: 0.04 m).
constexpr double noticeable_height = 0.02;  // m
constexpr double standard_errors = 3;
/// So many differences say what their spread is, to an eighth.
constexpr std::uint64_t enough_area = 30;  // m²

using Heights = std::map<std::int16_t, std::uint32_t>;

auto area_of(const Heights& heights) -> std::uint64_t {
  std::uint64_t sum = 0;
  for (const auto& [height, area] : heights) sum += area;
  return sum;
}

/// In metres: the height below which this share of the area is, evenly spread within each millimetre.
auto quantile(const Heights& heights, double share) -> double {
  const double wanted = share * static_cast<double>(area_of(heights));
  double below = 0;
  for (const auto& [height, area] : heights) {
    const auto here = static_cast<double>(area);
    if (below + here >= wanted) return 0.001 * (height - 0.5 + (wanted - below) / here);
    below += here;
  }
  return 0;  // nothing is in it
}

auto difference_of(StripOverlaps::Pair pair, const Heights& heights) -> StripDifference {
  // Of a normal distribution: the quartiles are 1.349 standard deviations apart, and the standard error of the median
  // is √(π/2) times that of the mean (Kendall and Stuart, The Advanced Theory of Statistics, vol. 1).
  constexpr double quartiles = 1.349, of_median = 1.2533;
  StripDifference out;
  const double median = quantile(heights, 0.5);
  const double spread = (quantile(heights, 0.75) - quantile(heights, 0.25)) / quartiles;
  out.height = std::abs(median);
  out.area = area_of(heights);
  out.error = of_median * spread / std::sqrt(static_cast<double>(out.area));
  std::tie(out.above, out.below) = median > 0 ? std::pair(pair.second, pair.first) : pair;
  return out;
}

}  // namespace

void StripOverlaps::add(Pair pair, double height) {
  if (too_many_) return;
  ++pairs_[pair][static_cast<std::int16_t>(std::floor(1000 * std::clamp(height, -1.0, 1.0) + 0.5))];
  limit();
}

void StripOverlaps::include(const StripOverlaps& other) {
  too_many_ = too_many_ || other.too_many_;
  for (const auto& [pair, heights] : other.pairs_)
    for (const auto& [height, area] : heights) pairs_[pair][height] += area;
  limit();
}

void StripOverlaps::limit() {
  too_many_ = too_many_ || pairs_.size() > most_pairs;
  if (too_many_) pairs_.clear();
}

auto strip_differences(const StripOverlaps& overlaps) -> std::vector<StripDifference> {
  std::vector<StripDifference> out;
  for (const auto& [pair, heights] : overlaps.pairs()) {
    const auto difference = difference_of(pair, heights);
    if (difference.area >= enough_area && difference.height > noticeable_height &&
        difference.height > standard_errors * difference.error)
      out.push_back(difference);
  }
  std::ranges::stable_sort(out, std::greater<>(), &StripDifference::height);
  return out;
}

auto differences_in_words(const std::vector<StripDifference>& differences) -> std::string {
  constexpr std::size_t most = 5;
  std::string out;
  for (std::size_t i = 0; i < std::min(most, differences.size()); ++i) {
    const auto& d = differences[i];
    // Below a millimetre nothing is measured.
    const double error = std::max(d.error, 0.001);
    out += (i == 0 ? "strip " : "; strip ") + std::to_string(d.above) + " is " + base::to_text(d.height, 3) + " ± " +
           base::to_text(error, 3) + " m above strip " + std::to_string(d.below) + ", over " + std::to_string(d.area) +
           " m²";
  }
  if (differences.size() > most) out += "; and " + std::to_string(differences.size() - most) + " more";
  return out;
}

}  // namespace mansard::cloud
