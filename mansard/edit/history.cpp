#include <algorithm>
#include <set>
#include <utility>

#include "mansard/edit/edit.hpp"

namespace mansard::edit {
namespace {

auto repeated_id(const std::vector<NamedPlan>& parts) -> const std::string* {
  std::set<std::string_view> seen;
  for (const auto& part : parts)
    if (!seen.insert(part.id).second) return &part.id;
  return nullptr;
}

auto buildings_of(const Edit& edit) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& change : edit.changes) out.push_back(change.building);
  return out;
}

}  // namespace

History::History(const model::City& city) {
  for (const auto& building : city.buildings) {
    std::vector<NamedPlan> parts;
    for (const auto& part : building.parts) parts.push_back({part.id, part.plan});
    buildings_[building.id] = {0, std::make_shared<const std::vector<NamedPlan>>(std::move(parts))};
  }
}

auto History::parts(std::string_view building) const -> Parts {
  const auto found = buildings_.find(building);
  if (found != buildings_.end()) return found->second.parts;
  return first_ ? first_->parts(building) : nullptr;
}

auto History::revision(std::string_view building) const -> std::uint64_t {
  const auto found = buildings_.find(building);
  return found != buildings_.end() ? found->second.revision : 0;
}

auto History::edited(std::string_view building) const -> bool {
  const auto found = buildings_.find(building);
  return found != buildings_.end() && found->second.first && *found->second.parts != *found->second.first;
}

auto History::edits() const -> const std::vector<Edit>& { return edits_; }

auto History::done() const -> std::size_t { return done_; }

auto History::replace(const std::string& building, Parts parts) -> Parts {
  State& state = buildings_[building];
  if (!state.parts) state.parts = first_->parts(building);
  ++state.revision;
  if (!state.first) state.first = state.parts;
  return std::exchange(state.parts, std::move(parts));
}

auto History::apply(Edit edit) -> base::Result<void> {
  std::set<std::string_view> named;
  bool changes = false;
  for (const auto& change : edit.changes) {
    const auto parts = this->parts(change.building);
    if (!parts)
      return base::error("edit-building", "there is no building of this id; look at the list again", change.building);
    if (!named.insert(change.building).second)
      return base::error("edit-building", "an edit names this building twice; put its parts into one change",
                         change.building);
    if (const auto now = revision(change.building); now != change.revision)
      return base::error("edit-stale",
                         "the edit was made to revision " + std::to_string(change.revision) +
                             " of this building, which is now at " + std::to_string(now) +
                             ": it was changed elsewhere; take the new state and edit again",
                         change.building);
    if (const auto* id = repeated_id(change.parts))
      return base::error("edit-duplicate-id", "two parts of a building have this id; give one of them another", *id);
    changes = changes || change.parts != *parts;
  }
  if (!changes) return base::error("edit-empty", "the edit changes nothing");

  edits_.resize(done_);
  before_.resize(done_);
  auto& before = before_.emplace_back();
  for (const auto& change : edit.changes)
    before.push_back(replace(change.building, std::make_shared<const std::vector<NamedPlan>>(change.parts)));
  edits_.push_back(std::move(edit));
  ++done_;
  return {};
}

auto History::undo() -> base::Result<std::vector<std::string>> {
  if (done_ == 0) return base::error("edit-nothing", "there is no edit to undo");
  --done_;
  const Edit& edit = edits_[done_];
  for (std::size_t i = 0; i < edit.changes.size(); ++i) replace(edit.changes[i].building, before_[done_][i]);
  return buildings_of(edit);
}

auto History::redo() -> base::Result<std::vector<std::string>> {
  if (done_ == edits_.size()) return base::error("edit-nothing", "no edit was undone that could be done again");
  const Edit& edit = edits_[done_++];
  for (const auto& change : edit.changes)
    replace(change.building, std::make_shared<const std::vector<NamedPlan>>(change.parts));
  return buildings_of(edit);
}

}  // namespace mansard::edit
