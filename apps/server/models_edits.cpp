// Models: edits, undo and redo, and what is shown after them.
#include <algorithm>
#include <set>

#include "apps/server/model_boxes.hpp"
#include "apps/server/models.hpp"

namespace mansard::server {

/// Extrudes the changed buildings, and those close enough that their party walls may change, and replaces the view.
auto Models::publish(const std::vector<std::string>& changed, const OpenScene* scene) -> Changed {
  const auto before = view();
  std::vector<geometry::Box2> boxes;
  for (const auto& id : changed) {
    boxes.push_back(before->buildings[index_.find(id)->second]->box);
    boxes.push_back(box_of(*history_.parts(id)));
  }
  std::vector<edit::Change> now;
  for (const auto& id : changed) now.push_back({id, 0, *history_.parts(id)});
  for (const auto& building : before->buildings) {
    auto own = building->box;  // a neighbour's error changes with what covers its footprint
    if (const auto* member = scene == nullptr ? nullptr : scene->member_of(building->id); member != nullptr)
      own.include(geometry::bounds(member->polygons));
    const auto near_by = [&](const geometry::Box2& box) { return touch(box, own); };
    if (std::ranges::find(changed, building->id) == changed.end() && !building->box.empty() &&
        std::ranges::any_of(boxes, near_by))
      now.push_back({building->id, 0, *parts_of(index_.find(building->id)->second, *building)});
  }
  std::vector<std::shared_ptr<const Seen>> renewed(now.size());
  base::parallel_for(now.size(), [&](std::size_t i) {
    const auto at = index_.find(now[i].building)->second;
    const auto building = raised(now[i], at, now, *before, scene);
    renewed[i] = seen(now[i].building, building, scene != nullptr);
  });

  auto after = std::make_shared<View>(*before);
  std::string buildings;
  for (std::size_t i = 0; i < now.size(); ++i) {
    auto& slot = after->buildings[index_.find(now[i].building)->second];
    // A neighbour of which nothing changed keeps its place; in a large run it may never have been made.
    if (i >= changed.size() && slot->made && slot->json == renewed[i]->json) continue;
    if (i >= changed.size() && scene == nullptr) continue;  // it would lose its measured error
    slot = renewed[i];
    (buildings += buildings.empty() ? "" : ",") += slot->json;
  }
  after->history = json_of(history_);
  after->applied = history_.done();
  ++after->number;
  {
    const std::scoped_lock lock(view_mutex_);
    view_ = after;
  }
  return {'[' + buildings + ']', after->history, history_.done()};
}

auto Models::apply(edit::Edit edit, const OpenScene* scene) -> base::Result<Changed> {
  const std::scoped_lock lock(edits_);
  const auto now = view();
  auto tried = history_;  // finds what is wrong with the edit before anything is extruded
  if (auto applied = tried.apply(edit); !applied) return applied.error();
  std::vector<std::string> changed;
  for (const auto& change : edit.changes) {
    const auto at = known(change, *now);
    if (!at) return at.error();
    const auto building = raised(change, *at, edit.changes, *now, scene);
    changed.push_back(change.building);
    if (building.valid()) continue;
    auto why = building.diagnostics;
    for (const auto& part : building.parts) why.insert(why.end(), part.diagnostics.begin(), part.diagnostics.end());
    const auto worst = std::ranges::find(why, base::Severity::error, &base::Diagnostic::severity);
    return base::error("edit-invalid",
                       "the edit was not applied: the models would not be valid" +
                           (worst == why.end() ? std::string() : ": " + worst->message + " [" + worst->code + "]"),
                       worst == why.end() || worst->subject.empty() ? change.building : worst->subject);
  }
  if (auto written = journal_.append(edit::journal_line(edit)); !written) return written.error();
  history_ = std::move(tried);
  return publish(changed, scene);
}

auto Models::edited_plans() -> std::vector<std::vector<edit::Change>> {
  const std::scoped_lock lock(edits_);
  std::vector<std::set<std::string>> groups;
  for (std::size_t e = 0; e < history_.done(); ++e) {
    std::set<std::string> together;
    for (const auto& change : history_.edits()[e].changes) together.insert(change.building);
    std::erase_if(groups, [&](const auto& group) {
      const bool meets = std::ranges::any_of(group, [&](const auto& id) { return together.contains(id); });
      if (meets) together.insert(group.begin(), group.end());
      return meets;
    });
    groups.push_back(std::move(together));
  }
  std::vector<std::vector<edit::Change>> out;
  for (const auto& group : groups) {
    std::vector<edit::Change> changes;
    for (const auto& id : group)
      if (history_.edited(id)) changes.push_back({id, 0, *history_.parts(id)});
    if (!changes.empty()) out.push_back(std::move(changes));
  }
  return out;
}

auto Models::unedited(const OpenScene* scene) const -> std::string {
  auto first = *view();  // as it was before the edits
  std::vector<edit::Change> changes;
  for (auto& building : first.buildings) {
    if (!building->edited) continue;
    edit::Change change{building->id, 0, {}};
    auto seen = std::make_shared<Seen>(*building);
    seen->parts = first_->plans(index_.find(building->id)->second);
    change.parts = *seen->parts;
    seen->box = box_of(*seen->parts);
    building = std::move(seen);
    changes.push_back(std::move(change));
  }
  std::vector<edit::RaisedBuilding> models(changes.size());
  base::parallel_for(changes.size(), [&](std::size_t i) {
    models[i] = raised(changes[i], index_.find(changes[i].building)->second, {}, first, scene);
  });
  Json buildings = Json::array();
  for (std::size_t i = 0; i < changes.size(); ++i)
    buildings.push_back(json_of(changes[i].building, 0, changes[i].parts, models[i]));
  return text_of({{"buildings", std::move(buildings)}});
}

auto Models::edit_to(const std::vector<edit::Change>& wanted, const std::string& what) const
    -> base::Result<std::optional<edit::Edit>> {
  const auto now = view();
  edit::Edit edit{what, {}};
  for (const auto& change : wanted) {
    const auto at = known(change, *now);
    if (!at) return at.error();
    const auto& building = *now->buildings[*at];
    if (*parts_of(*at, building) != change.parts)
      edit.changes.push_back({building.id, building.revision, change.parts});
  }
  return edit.changes.empty() ? std::optional<edit::Edit>() : std::optional(std::move(edit));
}

auto Models::step(base::Result<std::vector<std::string>> (edit::History::*one)(), std::string_view line,
                  const OpenScene* scene) -> base::Result<Changed> {
  const std::scoped_lock lock(edits_);
  auto tried = history_;
  const auto changed = (tried.*one)();
  if (!changed) return changed.error();
  if (auto written = journal_.append(line); !written) return written.error();
  history_ = std::move(tried);
  return publish(*changed, scene);
}

auto Models::undo(const OpenScene* scene) -> base::Result<Changed> {
  return step(&edit::History::undo, edit::undo_line, scene);
}

auto Models::redo(const OpenScene* scene) -> base::Result<Changed> {
  return step(&edit::History::redo, edit::redo_line, scene);
}

auto Models::measure(const OpenScene& scene) -> std::optional<Changed> {
  const std::scoped_lock lock(edits_);
  std::vector<std::string> unmeasured;
  for (const auto& building : view()->buildings)
    if (!building->measured) unmeasured.push_back(building->id);
  if (unmeasured.empty()) return std::nullopt;
  auto changed = publish(unmeasured, &scene);
  keep_measures(scene);
  return changed;
}

auto Models::edited(const SceneOrNone& scene) -> base::Result<std::shared_ptr<const model::City>> {
  const std::scoped_lock lock(export_mutex_);
  std::optional<edit::History> history;
  std::uint64_t number = 0;
  {
    const std::scoped_lock edits(edits_);
    number = view()->number;
    if (export_ && export_->number == number && export_->with_scene == (scene != nullptr)) return export_->city;
    history = history_;
  }
  std::mutex mutex;
  std::vector<std::shared_ptr<const rays::Scene>> used;  // until the city is made
  const auto mesh_of = [&](std::string_view id) -> const rays::Scene* {
    auto mesh = scene ? scene->rays_of(id) : nullptr;
    const std::scoped_lock adding(mutex);
    return used.emplace_back(std::move(mesh)).get();
  };
  auto city = edit::edited_city(*first_->city(), *history, mesh_of, options_);  // all in memory
  if (!city) return city.error();
  export_ = Export{number, scene != nullptr, std::make_shared<const model::City>(std::move(*city))};
  return export_->city;
}

}  // namespace mansard::server
