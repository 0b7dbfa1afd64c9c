#include "mansard/profile/detail/caps.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/base/sorted.hpp"

namespace mansard::profile::detail {
namespace {

auto percentile(std::span<const double> sorted, double share) -> double {
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::floor(share * last + 0.5))];
}

/// The height under which that share of the runs' length ends.
auto common_top(std::vector<ProfileTop>& tops, double share) -> std::optional<double> {
  if (tops.empty()) return std::nullopt;
  std::ranges::sort(tops, {}, &ProfileTop::height);
  double total = 0, passed = 0;
  for (const auto& top : tops) total += top.length;
  for (const auto& top : tops)
    if ((passed += top.length) >= share * total) return top.height;
  return tops.back().height;
}

}  // namespace

auto caps_from(std::span<const double> heights, std::vector<ProfileTop> tops, bool pitched, double assumed,
               const Options& o) -> std::vector<double> {
  const auto top = common_top(tops, o.cap_top_share);
  if (heights.empty()) return {std::max(o.minimum_height, pitched && top ? *top + o.cap_clear : assumed)};

  const double median = percentile(heights, 0.5), high = percentile(heights, o.cap_high),
               ridge = percentile(heights, o.cap_ridge);
  std::vector<double> wanted;
  if (pitched) {
    // First a cap the roofs close under: a ridge cut off flat a little too low would be seen on every house.
    wanted = {ridge + o.cap_clear, ridge, *top + o.cap_clear, high, median};
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
