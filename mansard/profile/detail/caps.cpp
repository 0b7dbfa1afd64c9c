#include "mansard/profile/detail/caps.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/base/statistics.hpp"

namespace mansard::profile::detail {

auto caps_from(std::span<const double> heights, std::span<const double> tops, bool pitched, double assumed,
               const Options& o) -> std::vector<double> {
  const auto top = tops.empty() ? std::nullopt : std::optional(std::ranges::max(tops));
  if (heights.empty()) return {std::max(o.minimum_height, pitched && top ? *top + o.cap_clear : assumed)};

  const double median = base::percentile_of_sorted(heights, 0.5), high = heights.back(),
               ridge = base::percentile_of_sorted(heights, o.cap_ridge);
  std::vector<double> wanted;
  if (pitched) {
    // First a cap the roofs close under: a ridge cut off flat a little too low would be seen on every house.
    wanted = {ridge + o.cap_clear, ridge};
    if (top) wanted.push_back(*top + o.cap_clear);
    wanted.insert(wanted.end(), {high, median});
  } else {
    wanted = {base::commonest(heights, o.cap_level), median};
    if (top) wanted.push_back(*top);
    wanted.push_back(high);
  }
  std::vector<double> caps;
  for (double cap : wanted) {
    cap = std::max(o.minimum_height, std::clamp(cap, heights.front(), heights.back() + (pitched ? o.cap_clear : 0)));
    if (std::ranges::none_of(caps, [cap, &o](double c) { return std::abs(c - cap) < o.cap_distinct; }))
      caps.push_back(cap);
  }
  return caps;
}

}  // namespace mansard::profile::detail
