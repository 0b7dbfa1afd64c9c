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

/// The height under which nine tenths of the runs' length end (chordatlas: nine tenths of the profiles).
auto common_top(std::vector<ProfileTop>& tops) -> std::optional<double> {
  if (tops.empty()) return std::nullopt;
  std::ranges::sort(tops, {}, &ProfileTop::height);
  double total = 0, passed = 0;
  for (const auto& top : tops) total += top.length;
  for (const auto& top : tops)
    if ((passed += top.length) >= 0.9 * total) return top.height;
  return tops.back().height;
}

}  // namespace

auto caps_from(std::span<const double> heights, std::vector<ProfileTop> tops, bool pitched, double assumed)
    -> std::vector<double> {
  constexpr double least = 0.5;     // m; the cap of ground-level "buildings", so that there is a solid at all
  constexpr double distinct = 0.1;  // m
  constexpr double clear = 0.5;     // m; above the profiles' tops, so that roofs can close
  const auto top = common_top(tops);
  if (heights.empty()) return {std::max(least, pitched && top ? *top + clear : assumed)};

  const double median = percentile(heights, 0.5), high = percentile(heights, 0.95), ridge = percentile(heights, 0.99);
  std::vector<double> wanted;
  if (pitched) {
    // First a cap the roofs close under: a ridge cut off flat a little too low would be seen on every house.
    wanted = {ridge + clear, ridge, *top + clear, high, median};
  } else {
    constexpr double breadth = 0.5;  // m; a flat roof's level, whatever stands on it
    wanted = {base::commonest(heights, breadth), median};
    if (top) wanted.push_back(*top);
    wanted.push_back(high);
  }
  std::vector<double> caps;
  for (double cap : wanted) {
    cap = std::max(least, std::clamp(cap, heights.front(), heights.back() + (pitched ? clear : 0)));
    if (std::ranges::none_of(caps, [cap](double c) { return std::abs(c - cap) < distinct; })) caps.push_back(cap);
  }
  return caps;
}

}  // namespace mansard::profile::detail
