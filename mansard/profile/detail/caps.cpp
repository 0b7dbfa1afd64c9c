#include "mansard/profile/detail/caps.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/base/statistics.hpp"

namespace mansard::profile::detail {
namespace {

/// The height under which that share of the runs' length ends.
auto common_top(std::vector<ProfileTop>& tops, double share) -> std::optional<double> {
  if (tops.empty()) return std::nullopt;
  std::ranges::sort(tops, {}, &ProfileTop::height);
  return base::weighted_percentile_of_sorted(tops, share, &ProfileTop::height, &ProfileTop::length);
}

}  // namespace

auto caps_from(std::span<const double> heights, std::vector<ProfileTop> tops, bool pitched, double assumed,
               const Options& o) -> std::vector<double> {
  const auto top = common_top(tops, o.cap_top_share);
  if (heights.empty()) return {std::max(o.minimum_height, pitched && top ? *top + o.cap_clear : assumed)};

  const double median = base::percentile_of_sorted(heights, 0.5),
               high = base::percentile_of_sorted(heights, o.cap_high),
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
