#include "mansard/refine/detail/known.hpp"

#include <algorithm>
#include <bit>

namespace mansard::refine::detail {
namespace {

/// Of what tells the plans of one site apart, nearly all of which have the same outline: the FNV-1a hash (G. Fowler,
/// L. C. Noll, K.-P. Vo) of the words of the cap and the profiles; −0 is 0.
auto key_of(const model::Plan& plan) -> std::uint64_t {
  std::uint64_t key = 0xcbf29ce484222325;
  const auto add = [&key](double value) { key = (key ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x100000001b3; };
  add(plan.cap);
  for (const auto& profile : plan.profiles)
    for (const auto& point : profile) add(point.inward), add(point.height);
  return key;
}

}  // namespace

auto KnownRoofs::find(const model::Plan& plan) const -> const Known* {
  const auto key = key_of(plan);
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < roofs_.size(); ++i)
    if (keys_[i] == key && roofs_[i].plan == plan) return &roofs_[i];
  return nullptr;
}

auto KnownRoofs::costs_at_least(const model::Plan& plan) const -> double {
  const auto key = key_of(plan);
  const std::lock_guard lock(mutex_);
  double most = 0;
  for (const auto& one : too_dear_)
    if (one.key == key && one.plan == plan) most = std::max(most, one.least_cost);
  return most;
}

void KnownRoofs::add(Known roof) {
  const auto key = key_of(roof.plan);
  const std::lock_guard lock(mutex_);
  roofs_.push_back(std::move(roof));
  keys_.push_back(key);
}

void KnownRoofs::add_too_dear(const model::Plan& plan, double least_cost) {
  const auto key = key_of(plan);
  const std::lock_guard lock(mutex_);
  too_dear_.push_back({key, plan, least_cost});
}

}  // namespace mansard::refine::detail
