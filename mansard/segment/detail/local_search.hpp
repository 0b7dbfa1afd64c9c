// Good labellings fast: greedy joining, then Kernighan–Lin sequences with joins (Keuper et al., ICCV 2015).
#pragma once

#include <optional>

#include "mansard/segment/detail/multicut.hpp"

namespace mansard::segment::detail {

/// Joins pieces, best gain first, from all nodes apart until no join gains. Keeps forced edges cut.
[[nodiscard]] auto greedy(const Multicut& problem) -> Labels;

/// Never worse than what it is given, which must keep forced edges cut.
[[nodiscard]] auto improved(const Multicut& problem, const Labels& labels, const SearchLimits& limits = {}) -> Labels;

/// Joins neighbouring pieces for as long as that costs nothing, lowest edge first.
[[nodiscard]] auto joined_where_free(const Multicut& problem, const Labels& labels) -> Labels;

}  // namespace mansard::segment::detail
