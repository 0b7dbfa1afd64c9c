// Puts finished features aside, and sees what only all of them together show.
#pragma once

#include <algorithm>
#include <iterator>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/pack.hpp"
#include "mansard/pipeline/city.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"

namespace mansard::pipeline::detail {

/// Takes finished features from any thread.
class CityBuilder {
 public:
  CityBuilder(PutAside& city, std::size_t features) : city_(city), standing_(features) {
    city.places_.resize(features);
  }

  [[nodiscard]] auto open() -> base::Result<void> {
    auto spool = base::Spool::open();
    if (!spool) return spool.failure();
    city_.spool_ = std::move(*spool);
    return {};
  }

  /// Features beyond those of the city are around it, and not put aside.
  void take(std::size_t feature, const Finished& one) {
    if (feature >= city_.places_.size()) return;
    std::string bytes;
    base::pack(one, bytes);
    auto standing = pipeline::detail::standing(feature, one.building);
    const std::scoped_lock lock(mutex_);
    city_.places_[feature] = {city_.spool_->size(), static_cast<std::uint32_t>(bytes.size())};
    city_.spool_->append(bytes);
    city_.outcomes.add(one.report.outcome);
    standing_[feature] = std::move(standing);
  }

  [[nodiscard]] auto has(std::size_t feature) const -> bool { return city_.places_[feature].bytes > 0; }

  /// After the last one: what only all of them together show.
  void finish(const base::Run& run) {
    std::vector<Standing> all;
    for (auto& some : standing_) std::ranges::move(some, std::back_inserter(all));
    auto [of_each, in_all] = pipeline::detail::overlaps(all, run);
    for (auto& [building, what] : of_each) city_.afterwards_[building].push_back(std::move(what));
    std::ranges::move(in_all, std::back_inserter(city_.summary.warnings));
  }

 private:
  PutAside& city_;
  std::mutex mutex_;
  std::vector<std::vector<Standing>> standing_;  ///< by feature
};

}  // namespace mansard::pipeline::detail
