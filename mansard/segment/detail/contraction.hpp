// Joins pieces of a labelling, best gain first, with the pair penalties in every gain.
#pragma once

#include <cstdint>
#include <map>
#include <queue>
#include <tuple>
#include <vector>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/segment/detail/multicut.hpp"

namespace mansard::segment::detail {

/// Pieces and the bundles of edges between them. A bundle's change is what joining its two pieces would add to the
/// cost: less its edges' costs, less every penalty that one of its edges pays with another cut edge.
class Contraction {
 public:
  /// Labels below `count`. `pairs_of`: by edge, the pairs it is in.
  Contraction(const Multicut& problem, const std::vector<std::vector<std::uint32_t>>& pairs_of, const Labels& labels,
              std::uint32_t count);

  /// Joins while the least change is below 0, or at most 0 with `free`; ties by the lowest labels. Whether any were.
  auto run(bool free) -> bool;

  /// The label a piece has now: the lowest of those joined.
  [[nodiscard]] auto label_of(std::uint32_t label) -> std::uint32_t { return pieces_.of(label); }

 private:
  struct Bundle {
    std::vector<std::uint32_t> edges;
    std::int64_t change = 0;
    bool forced = false;
  };
  using Key = std::pair<std::uint32_t, std::uint32_t>;

  [[nodiscard]] auto key_of(std::uint32_t edge) -> Key;
  [[nodiscard]] auto is_cut(std::uint32_t edge) -> bool;
  void weigh(const Key& key, Bundle& bundle);
  void join(const Key& key);

  const Multicut& problem_;
  const std::vector<std::vector<std::uint32_t>>& pairs_of_;
  const Labels& labels_;
  base::DisjointSets pieces_;                             ///< of labels
  std::vector<std::map<std::uint32_t, Bundle>> bundles_;  ///< by lower, then by higher label
  std::vector<std::vector<std::uint32_t>> below_;         ///< by higher label, the lower ones (some long gone)
  /// Least change first; what no longer holds is passed over.
  std::priority_queue<std::tuple<std::int64_t, Key>, std::vector<std::tuple<std::int64_t, Key>>, std::greater<>> open_;
};

}  // namespace mansard::segment::detail
