#include "mansard/pipeline/compared.hpp"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <string>

#include "mansard/base/pack.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/pipeline/detail/city_builder.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"

namespace mansard::pipeline {

struct ComparedSolids::Kept {
  struct Place {
    std::uint64_t offset = 0;
    std::size_t bytes = 0;
  };
  std::unique_ptr<base::Spool> spool;
  std::mutex mutex;  ///< of the spool
  std::vector<Place> places;
  std::vector<detail::Extent> extents;
};

ComparedSolids::ComparedSolids(std::unique_ptr<Kept> kept) : kept_(std::move(kept)) {}
ComparedSolids::ComparedSolids(ComparedSolids&&) noexcept = default;
auto ComparedSolids::operator=(ComparedSolids&&) noexcept -> ComparedSolids& = default;
ComparedSolids::~ComparedSolids() = default;

auto ComparedSolids::open() -> base::Result<ComparedSolids> {
  auto spool = base::Spool::open();
  if (!spool) return spool.failure();
  auto kept = std::make_unique<Kept>();
  kept->spool = std::move(*spool);
  return ComparedSolids(std::move(kept));
}

void ComparedSolids::add(const model::Building& building) {
  const std::size_t number = kept_->places.size();
  const auto solids = [&] {
    if (!building.solids.empty()) return detail::standing(number, building);
    auto with_solids = building;
    for (std::size_t p = 0; p < building.parts.size(); ++p)
      if (!building.parts[p].model.solid.faces.empty()) with_solids.solids.push_back({{p}, building.parts[p].model});
    return detail::standing(number, with_solids);
  }();
  std::string bytes;
  base::pack(solids, bytes);
  kept_->places.push_back({kept_->spool->size(), bytes.size()});
  kept_->spool->append(bytes);
  std::ranges::move(detail::extents(solids), std::back_inserter(kept_->extents));
}

auto ComparedSolids::overlapping(const base::Run& run) -> base::Result<Overlapping> {
  if (const auto written = kept_->spool->read(0, 0); !written) return written.failure();
  const auto load = [&](std::uint32_t building) -> base::Result<std::vector<detail::Standing>> {
    auto bytes = [&] {
      const std::scoped_lock lock(kept_->mutex);
      return kept_->spool->read(kept_->places[building].offset, kept_->places[building].bytes);
    }();
    if (!bytes) return bytes.failure();
    std::vector<detail::Standing> solids;
    base::Unpacker from(*bytes);
    if (!from.take(solids) || !from.done()) return detail::put_aside_changed();
    return solids;
  };
  auto found = detail::overlaps(kept_->extents, load, run);
  if (run.cancelled()) return base::stopped();
  Overlapping out;
  for (auto& one : found.of_each) out.of_each.push_back(std::move(one.what));
  out.in_all = std::move(found.in_all);
  return out;
}

}  // namespace mansard::pipeline
