// Workspace: the models of a run are shown, previewed and edited here.
#include <utility>

#include "apps/server/workspace.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {

auto Workspace::buildings(const std::string& run, const std::optional<std::string>& building) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  return building ? (*open)->single(*building) : Text((*open)->all());
}

auto Workspace::list(const std::string& run) -> Text {
  const auto open = models(run);
  return open ? Text((*open)->list()) : Text(open.error());
}

auto Workspace::tile_of_models(const std::string& run, const std::string& name) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto between = name.find('_');
  const auto column = base::to_integer(name.substr(0, between));
  const auto row = between == std::string::npos ? std::nullopt : base::to_integer(name.substr(between + 1));
  if (!column || !row)
    return base::error("server-body", "expected the column and the row of a tile, as in '-2_14'",
                       base::on_one_line(name.substr(0, 40)));
  return (*open)->tile(*column, *row);
}

auto Workspace::decided(const Models& models) const -> std::map<std::string, model::Attributes, std::less<>> {
  std::map<std::string, model::Attributes, std::less<>> more;
  for (const auto& [building, decision] : *decisions())
    if (const auto model_now = models.model_now(building); model_now && model_now->model == decision.model)
      more.emplace(building, report::attributes_of(decision));
  return more;
}

auto Workspace::search(const std::string& run, const std::string& words) -> Text {
  const auto open = models(run);
  return open ? Text((*open)->search(words, decided(**open))) : Text(open.error());
}

auto Workspace::column(const std::string& run, const std::string& attribute) -> Text {
  const auto open = models(run);
  return open ? (*open)->column(attribute, decided(**open)) : Text(open.error());
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

auto Workspace::unedited(const std::string& run) -> Text {
  const auto open = models(run);
  return open ? Text((*open)->unedited(scene_now().get())) : Text(open.error());
}

auto Workspace::roofs(const std::string& run, const RoofsRequest& request) -> Text {
  const auto open = models(run);
  return open ? (*open)->roofs(request, scene_now().get()) : Text(open.error());
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

auto Workspace::carry_over(const std::string& run, const std::string& from, const std::string& client) -> Text {
  if (run == from)
    return base::error("server-body", "the edits are those of the same run; name another run in \"from\"", from);
  const auto source = models(from);
  if (!source) return source.error();
  const auto target = models(run);
  if (!target) return target.error();
  const auto scene = scene_now();
  std::string label = from;
  if (const auto known = record(from)) label = known->label;
  Json carried = Json::array(), refused = Json::array();
  // Where a neighbour is in the way, its own edit may make room: what does not fit is tried again after the others.
  auto left = (*source)->edited_plans();
  std::vector<base::Diagnostic> why;
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::vector<std::vector<edit::Change>> again;
    why.clear();
    for (auto& wanted : left) {
      std::string names;
      for (const auto& one : wanted) names += (names.empty() ? "" : ", ") + one.building;
      auto edit = (*target)->edit_to(wanted, "edit of " + names + " taken from " + label);
      auto failure = edit ? std::optional<base::Diagnostic>() : std::optional(edit.error());
      if (edit && *edit) {
        const auto changed = (*target)->apply(std::move(**edit), scene.get());
        if (changed) (void)send_change(run, *changed, client);
        else failure = changed.error();
      }
      if (failure) {
        failure->subject = names;
        why.push_back(std::move(*failure));
        again.push_back(std::move(wanted));
      } else {
        for (const auto& one : wanted) carried.push_back(one.building);
      }
    }
    left = std::move(again);
  }
  for (const auto& one : why) refused.push_back(json_of(one));
  return text_of({{"carried", std::move(carried)}, {"refused", std::move(refused)}});
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
  const auto both = both_of(changed.buildings, changed.history);
  const auto head = text_of({{"type", "buildings"}, {"run", run}, {"client", client}});
  events_.send(head.substr(0, head.size() - 1) + ',' + both.substr(1));
  return both;
}

}  // namespace mansard::server
