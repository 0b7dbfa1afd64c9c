#include "apps/server/models.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "apps/server/model_boxes.hpp"
#include "mansard/edit/roofs.hpp"

namespace mansard::server {
namespace {

/// The texts of buildings as an array.
template <class Buildings>
auto array_of(const Buildings& buildings) -> std::string {
  std::size_t length = 2;
  for (const auto& building : buildings) length += building->json.size() + 1;
  std::string out;
  out.reserve(length);
  for (const auto& building : buildings) (out += out.empty() ? '[' : ',') += building->json;
  return out.empty() ? "[]" : out + ']';
}

auto no_building(const std::string& id) -> base::Diagnostic {
  return base::error("edit-building", "unknown building; /api/runs/{run}/buildings lists those of the run", id);
}

}  // namespace

auto Models::view() const -> std::shared_ptr<const View> {
  const std::scoped_lock lock(view_mutex_);
  return view_;
}

auto Models::parts_of(std::size_t building, const Seen& seen) const -> edit::Parts {
  return seen.parts ? seen.parts : first_->plans(building);
}

auto Models::extent() const -> geometry::Box2 {
  geometry::Box2 box;
  for (const auto& building : view()->buildings) box.include(building->box);
  return box;
}

auto Models::all() const -> std::string {
  const auto now = view();
  std::vector<std::size_t> which(now->buildings.size());
  std::iota(which.begin(), which.end(), std::size_t{0});
  return both_of(array_of(made_all(which, *now)), now->history);
}

auto Models::single(const std::string& building) const -> base::Result<std::string> {
  const auto now = view();
  const auto at = index_.find(building);
  if (at == index_.end() || at->second >= now->buildings.size()) return no_building(building);
  return both_of(array_of(made_all({at->second}, *now)), now->history);
}

auto Models::known(const edit::Change& change, const View& view) const -> base::Result<std::size_t> {
  const auto at = index_.find(change.building);
  if (at == index_.end() || at->second >= view.buildings.size()) return no_building(change.building);
  return at->second;
}

/// Neighbours are taken with their changes in the same edit.
auto Models::raised(const edit::Change& change, std::size_t at, const std::vector<edit::Change>& together,
                    const View& view, const OpenScene* scene) const -> edit::RaisedBuilding {
  const auto* member = scene == nullptr ? nullptr : scene->member_of(change.building);
  auto box = box_of(change.parts);
  if (member != nullptr) box.include(geometry::bounds(member->polygons));
  std::vector<model::Plan> neighbours;
  for (std::size_t b = 0; b < view.buildings.size(); ++b) {
    if (b == at) continue;
    const auto& other = *view.buildings[b];
    const auto changed = std::ranges::find(together, other.id, &edit::Change::building);
    if (!touch(box, changed == together.end() ? other.box : box_of(changed->parts))) continue;
    const auto own = changed == together.end() ? parts_of(b, other) : nullptr;
    for (const auto& part : own ? *own : changed->parts) neighbours.push_back(part.plan);
  }
  const auto mesh = scene == nullptr ? nullptr : scene->rays_of(change.building);
  const auto before = parts_of(at, *view.buildings[at]);
  edit::Site site{neighbours, *before, mesh.get()};
  if (member != nullptr) {
    site.footprint = member->polygons;
    site.ground = member->ground;
  }
  return edit::raise(change.parts, site, options_);
}

auto Models::preview(const std::vector<edit::Change>& changes, const OpenScene* scene) const
    -> base::Result<std::string> {
  const auto now = view();
  Json buildings = Json::array();
  for (const auto& change : changes) {
    const auto at = known(change, *now);
    if (!at) return at.error();
    auto building = raised(change, *at, changes, *now, scene);
    if (const auto mesh = scene == nullptr ? nullptr : scene->rays_of(change.building))
      std::ranges::move(edit::doubts_of(building, now->buildings[*at]->mse, *mesh),
                        std::back_inserter(building.diagnostics));
    buildings.push_back(json_of(change.building, now->buildings[*at]->revision, change.parts, building));
  }
  return text_of({{"buildings", std::move(buildings)}});
}

auto Models::plan_of(const PartName& name) const -> base::Result<model::Plan> {
  const auto now = view();
  const auto at = index_.find(name.building);
  if (at == index_.end()) return no_building(name.building);
  const auto parts = parts_of(at->second, *now->buildings[at->second]);
  const auto part = std::ranges::find(*parts, name.part, &edit::NamedPlan::id);
  if (part == parts->end())
    return base::error("edit-part", "the building has no part '" + name.part + "'", name.building);
  return part->plan;
}

auto Models::solids_of(const std::string& building) const -> base::Result<Solids> {
  const auto now = view();
  const auto at = index_.find(building);
  if (at == index_.end() || at->second >= now->buildings.size()) return no_building(building);
  const auto seen = made(at->second, *now);
  return Solids{seen->revision, seen->models};
}

auto Models::split(const SplitRequest& request) const -> base::Result<std::string> {
  const auto now = view();
  const auto at = index_.find(request.at.building);
  if (at == index_.end()) return no_building(request.at.building);
  const auto& building = *now->buildings[at->second];
  auto parts = edit::split(building.id, *parts_of(at->second, building), request.at.part, request.line);
  if (!parts) return parts.error();
  const Json change = json_of(edit::Change{building.id, building.revision, std::move(*parts)});
  return text_of({{"changes", Json::array({change})}});
}

auto Models::merge(const MergeRequest& request) const -> base::Result<std::string> {
  const auto now = view();
  const auto& [first, second] = request;
  if (first.building == second.building && first.part == second.part)
    return base::error("edit-merge", "the two parts to merge are the same part; choose two different parts",
                       first.part);
  const auto a = plan_of(first), b = plan_of(second);
  if (!a) return a.error();
  if (!b) return b.error();
  auto plan = edit::merge(*a, *b);
  if (!plan) return plan.error();
  std::vector<edit::Change> changes;
  for (const auto* name : {&first, &second}) {
    if (!changes.empty() && changes.front().building == name->building) continue;
    const auto at = index_.find(name->building)->second;
    const auto& building = *now->buildings[at];
    edit::Change change{building.id, building.revision, *parts_of(at, building)};
    if (building.id == second.building)
      std::erase_if(change.parts, [&](const auto& part) { return part.id == second.part; });
    if (building.id == first.building)
      for (auto& part : change.parts)
        if (part.id == first.part) part.plan = *plan;
    changes.push_back(std::move(change));
  }
  Json all = Json::array();
  for (const auto& change : changes) all.push_back(json_of(change));
  return text_of({{"changes", std::move(all)}});
}

}  // namespace mansard::server
