#include "mansard/rays/hidden.hpp"

#include "mansard/base/statistics.hpp"

namespace mansard::rays {

auto hidden_height(std::span<const double> seen, std::span<const double> all) -> std::optional<double> {
  constexpr double most_seen = 0.2, low = 0.1, quarter = 0.25;
  if (all.empty() || static_cast<double>(seen.size()) > most_seen * static_cast<double>(all.size()))
    return std::nullopt;
  const double height = base::percentile_of_sorted(all, low);
  return seen.empty() || base::percentile_of_sorted(seen, quarter) < height / 2 ? std::optional(height) : std::nullopt;
}

}  // namespace mansard::rays
