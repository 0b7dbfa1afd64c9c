#include "mansard/refine/detail/known.hpp"

#include <algorithm>

namespace mansard::refine::detail {
namespace {

/// Of one site nearly all plans have the same outline: what differs comes first.
auto same(const model::Plan& a, const model::Plan& b) -> bool {
  return a.cap == b.cap && a.profiles == b.profiles && a == b;
}

}  // namespace

auto KnownRoofs::find(const model::Plan& plan) const -> const Known* {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(roofs_, [&](const Known& one) { return same(one.plan, plan); });
  return found == roofs_.end() ? nullptr : &*found;
}

auto KnownRoofs::costs_at_least(const model::Plan& plan) const -> double {
  const std::lock_guard lock(mutex_);
  double most = 0;
  for (const auto& one : too_dear_)
    if (same(one.plan, plan)) most = std::max(most, one.least_cost);
  return most;
}

void KnownRoofs::add(Known roof) {
  const std::lock_guard lock(mutex_);
  roofs_.push_back(std::move(roof));
}

void KnownRoofs::add_too_dear(const model::Plan& plan, double least_cost) {
  const std::lock_guard lock(mutex_);
  too_dear_.push_back({plan, least_cost});
}

}  // namespace mansard::refine::detail
