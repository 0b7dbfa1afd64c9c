// Workspace: the models of a run are shown, previewed and edited here.
#include <utility>

#include "apps/server/workspace.hpp"

namespace mansard::server {

auto Workspace::buildings(const std::string& run) -> Text {
  const auto open = models(run);
  return open ? Text((*open)->all()) : Text(open.error());
}

auto Workspace::section(const std::string& run, const PartName& part, std::size_t ring, std::size_t edge, double share)
    -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto scene = scene_or_error();
  if (!scene) return scene.error();
  const auto plan = (*open)->plan_of(part);
  if (!plan) return plan.error();
  if (auto checked = check_edge(*plan, ring, edge, share); !checked) return checked.error();
  return text_of((*scene)->section(*plan, ring, edge, share, part.building, (*open)->options()));
}

auto Workspace::section(const std::string& run, const SectionRequest& request) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto scene = scene_or_error();
  if (!scene) return scene.error();
  const auto& [plan, ring, edge, share] = request;
  if (auto checked = check_edge(plan, ring, edge, share); !checked) return checked.error();
  return text_of((*scene)->section(plan, ring, edge, share, std::nullopt, (*open)->options()));
}

auto Workspace::preview(const std::string& run, const std::vector<edit::Change>& changes) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  return (*open)->preview(changes, scene_now().get());
}

auto Workspace::split(const std::string& run, const SplitRequest& request) -> Text {
  const auto open = models(run);
  return open ? (*open)->split(request) : Text(open.error());
}

auto Workspace::merge(const std::string& run, const MergeRequest& request) -> Text {
  const auto open = models(run);
  return open ? (*open)->merge(request) : Text(open.error());
}

auto Workspace::apply(const std::string& run, edit::Edit edit, const std::string& client) -> Text {
  return change(run, client, [&](auto& models, const auto* scene) { return models.apply(std::move(edit), scene); });
}

auto Workspace::undo(const std::string& run, const std::string& client) -> Text {
  return change(run, client, [](auto& models, const auto* scene) { return models.undo(scene); });
}

auto Workspace::redo(const std::string& run, const std::string& client) -> Text {
  return change(run, client, [](auto& models, const auto* scene) { return models.redo(scene); });
}

auto Workspace::change(const std::string& run, const std::string& client,
                       const std::function<base::Result<Changed>(Models&, const OpenScene*)>& make) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto scene = scene_now();
  const auto changed = make(**open, scene.get());
  return changed ? Text(send_change(run, *changed, client)) : Text(changed.error());
}

auto Workspace::send_change(const std::string& run, const Changed& changed, const std::string& client) -> std::string {
  {
    const std::scoped_lock lock(mutex_);
    if (auto* found = find(run)) found->edits = changed.applied;
  }
  const Json both{{"buildings", changed.buildings}, {"history", changed.history}};
  Json event{{"type", "buildings"}, {"run", run}, {"client", client}};
  event.update(both);
  events_.send(text_of(event));
  return text_of(both);
}

}  // namespace mansard::server
