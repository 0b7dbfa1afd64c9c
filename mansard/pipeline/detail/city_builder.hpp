// Puts finished features aside, and sees what only all of them together show.
#pragma once

#include <algorithm>
#include <iterator>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/pack.hpp"
#include "mansard/pipeline/city.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"

namespace mansard::pipeline::detail {

inline auto put_aside_changed() -> base::Diagnostic {
  return base::error("file-write", "what was put aside in the folder for temporary files (TMPDIR) was changed there");
}

/// Takes finished features from any thread.
class CityBuilder {
 public:
  CityBuilder(PutAside& city, std::size_t features) : city_(city) { city.places_.resize(features); }

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
    const auto extents = pipeline::detail::extents(standing(feature, one.building));
    const std::scoped_lock lock(mutex_);
    city_.places_[feature] = {city_.spool_->size(), static_cast<std::uint32_t>(bytes.size())};
    city_.spool_->append(bytes);
    city_.outcomes.add(one.report.outcome);
    extents_.insert(extents_.end(), extents.begin(), extents.end());
  }

  /// Gives the number by which order_error_maps knows it.
  auto take(const evaluate::ErrorMap& map) -> std::size_t {
    const auto bytes = base::packed(map);
    const std::scoped_lock lock(mutex_);
    city_.error_maps_.push_back({city_.spool_->size(), static_cast<std::uint32_t>(bytes.size())});
    city_.spool_->append(bytes);
    return city_.error_maps_.size() - 1;
  }
  /// After the last one: the maps with these numbers, in this order.
  void order_error_maps(std::span<const std::size_t> numbers) {
    std::vector<PutAside::Place> ordered;
    for (const std::size_t number : numbers) ordered.push_back(city_.error_maps_[number]);
    city_.error_maps_ = std::move(ordered);
  }

  /// Whether all could be put aside until now: asked from time to time, so that a full disk ends a run of hours at
  /// once. Fails with "file-write".
  [[nodiscard]] auto check() -> base::Result<void> {
    const std::scoped_lock lock(mutex_);
    if (const auto bytes = city_.spool_->read(0, 0); !bytes) return bytes.failure();
    return {};
  }

  [[nodiscard]] auto has(std::size_t feature) const -> bool { return city_.places_[feature].bytes > 0; }

  /// After the last one: what only all of them together show.
  void finish(const base::Run& run) {
    std::ranges::sort(extents_, {}, [](const Extent& extent) { return std::pair(extent.building, extent.solid); });
    const auto load = [&](std::uint32_t building) -> base::Result<std::vector<Standing>> {
      auto bytes = [&] {
        const std::scoped_lock lock(mutex_);
        return city_.spool_->read(city_.places_[building].offset, city_.places_[building].bytes);
      }();
      if (!bytes) return bytes.failure();
      Finished one;
      base::Unpacker from(*bytes);
      if (!from.take(one) || !from.done()) return put_aside_changed();
      return standing(building, one.building);
    };
    auto [of_each, in_all, pairs] = overlaps(extents_, load, run);
    extents_ = std::vector<Extent>();
    for (auto& [building, what] : of_each) city_.afterwards_[building].push_back(std::move(what));
    std::ranges::move(in_all, std::back_inserter(city_.summary.warnings));
    city_.summary.overlaps = std::move(pairs);
  }

 private:
  PutAside& city_;
  std::mutex mutex_;
  std::vector<Extent> extents_;
};

}  // namespace mansard::pipeline::detail
