#include "apps/server/run_buildings.hpp"

#include <algorithm>
#include <unordered_set>

#include "mansard/base/run.hpp"

namespace mansard::server {
namespace {

constexpr std::size_t most_buildings_kept = 10'000;  // buildings, of some 2 kB each

auto plans_of(const model::Building& building) -> edit::Parts {
  std::vector<edit::NamedPlan> parts;
  for (const auto& part : building.parts) parts.push_back({part.id, part.plan});
  return std::make_shared<const std::vector<edit::NamedPlan>>(std::move(parts));
}

auto names_of(const model::City& city) -> std::vector<std::string> {
  std::vector<std::string> order;
  std::unordered_set<std::string_view> seen;
  const auto add = [&](const model::Attributes& attributes) {
    for (const auto& one : attributes)
      if (seen.emplace(one.first).second) order.push_back(one.first);
  };
  for (const auto& building : city.buildings) add(building.attributes);
  for (const auto& building : city.buildings)
    for (const auto& part : building.parts) add(part.attributes);
  return order;
}

}  // namespace

RunBuildings::RunBuildings(model::City city) : city_(std::move(city)), attributes_(names_of(city_)) {
  for (std::size_t b = 0; b < city_.buildings.size(); ++b) at_[city_.buildings[b].id] = b;
}

RunBuildings::RunBuildings(std::unique_ptr<formats::PlansFile> file, RunIndex& index)
    : city_{file->header().frame, file->header().made_by, {}},
      file_(std::move(file)),
      ids_(std::move(index.ids)),
      places_(std::move(index.places)),
      marked_(std::move(index.marked)),
      shapes_(std::move(index.shapes)),
      shape_ends_(std::move(index.shape_ends)),
      attributes_(std::move(index.attributes)) {
  at_.reserve(ids_.size());
  for (std::size_t b = 0; b < ids_.size(); ++b) at_[ids_[b]] = b;
}

auto RunBuildings::building(std::size_t building) const -> std::shared_ptr<const model::Building> {
  if (in_memory()) return {std::shared_ptr<const void>(), &city_.buildings[building]};
  auto read = file_->read(places_[building]);
  if (!read) throw Unreadable(read.error());
  return std::make_shared<const model::Building>(std::move(*read));
}

auto RunBuildings::plans(std::size_t building) const -> edit::Parts {
  if (in_memory()) return plans_of(city_.buildings[building]);
  {
    const std::scoped_lock lock(mutex_);
    if (const auto found = kept_at_.find(building); found != kept_at_.end()) {
      kept_.splice(kept_.begin(), kept_, found->second);
      return kept_.front().second;
    }
  }
  auto plans = plans_of(*this->building(building));
  const std::scoped_lock lock(mutex_);
  if (kept_at_.contains(building)) return plans;  // read by two threads
  kept_.emplace_front(building, plans);
  kept_at_[building] = kept_.begin();
  if (kept_.size() > most_buildings_kept) {
    kept_at_.erase(kept_.back().first);
    kept_.pop_back();
  }
  return plans;
}

auto RunBuildings::parts(std::string_view id) const -> edit::Parts {
  const auto found = at_.find(id);
  return found == at_.end() ? nullptr : plans(found->second);
}

auto RunBuildings::shapes(std::size_t building) const -> std::string_view {
  const auto from = building == 0 ? 0 : shape_ends_[building - 1];
  return std::string_view(shapes_).substr(from, shape_ends_[building] - from);
}

auto RunBuildings::marked(std::size_t building) const -> bool {
  return in_memory() ? has_mark(city_.buildings[building]) : marked_[building] != 0;
}

void RunBuildings::each(const std::function<void(std::size_t, const model::Building&)>& take) const {
  if (in_memory()) {
    for (std::size_t b = 0; b < city_.buildings.size(); ++b) take(b, city_.buildings[b]);
    return;
  }
  if (auto read = file_->read(places_, false, take); !read) throw Unreadable(read.error());
}

auto RunBuildings::city() const -> std::shared_ptr<const model::City> {
  if (in_memory()) return {std::shared_ptr<const void>(), &city_};
  auto all = std::make_shared<model::City>(model::City{city_.frame, city_.made_by, {}});
  all->buildings.resize(size());
  auto read =
      file_->read(places_, true, [&](std::size_t b, model::Building& one) { all->buildings[b] = std::move(one); });
  if (!read) throw Unreadable(read.error());
  return all;
}

}  // namespace mansard::server
