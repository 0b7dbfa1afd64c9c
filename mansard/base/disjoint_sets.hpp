// Union-find over the numbers 0 … count − 1.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace mansard::base {

/// Every set is named by its lowest number, whatever the order of joins.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) : up_(count) { std::iota(up_.begin(), up_.end(), 0U); }

  /// A further number, in a set of its own; returns it.
  auto grow() -> std::uint32_t {
    up_.push_back(static_cast<std::uint32_t>(up_.size()));
    return up_.back();
  }
  /// The name of the set that contains v.
  auto of(std::uint32_t v) -> std::uint32_t {
    while (up_[v] != v) v = up_[v] = up_[up_[v]];
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a), b = of(b);
    up_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> up_;
};

}  // namespace mansard::base
