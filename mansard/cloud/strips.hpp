// Heights of flight strips compared with each other where they overlap.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace mansard::cloud {

/// How much higher the strip with the larger number is than the other, in mm, and on how many m²: where both have a
/// flat surface. Strips are what LAS has as point source IDs: flight lines. Memory: 2,001 numbers for each pair of
/// strips at most.
class StripOverlaps {
 public:
  using Pair = std::pair<std::uint16_t, std::uint16_t>;  ///< the smaller number first

  /// One square metre, on which `pair.second` is that much higher (m). More than 1 m counts as 1 m.
  void add(Pair pair, double height);
  void include(const StripOverlaps& other);
  /// Pairs with the differences that were found, in millimetres. None where there are more than 2,000 pairs, which no
  /// survey has: the numbers are no flight lines then.
  [[nodiscard]] auto pairs() const -> const std::map<Pair, std::map<std::int16_t, std::uint32_t>>& { return pairs_; }

 private:
  void limit();

  std::map<Pair, std::map<std::int16_t, std::uint32_t>> pairs_;
  bool too_many_ = false;
};

struct StripDifference {
  std::uint16_t above = 0, below = 0;
  double height = 0;       ///< m, ≥ 0: the median
  double error = 0;        ///< m: its standard error
  std::uint64_t area = 0;  ///< m²
};

/// Of the pairs with enough area, those that differ by more than three standard errors and 0.02 m; the largest first.
[[nodiscard]] auto strip_differences(const StripOverlaps& overlaps) -> std::vector<StripDifference>;

/// "strip 12 is 0.08 ± 0.01 m above strip 11, over 340 m²; …"; empty without differences.
[[nodiscard]] auto differences_in_words(const std::vector<StripDifference>& differences) -> std::string;

}  // namespace mansard::cloud
