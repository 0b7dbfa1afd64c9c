// Workspace: what people decided about the models, and what they are shown to decide it.
#include <utility>

#include "apps/server/workspace.hpp"
#include "mansard/base/machine.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

auto json_of(const report::Decision& one) -> Json {
  return {{"building", one.building},
          {"decision", to_string(one.verdict)},
          {"note", one.note},
          {"reviewer", one.reviewer},
          {"time", one.time}};
}

/// ReviewDecision.
auto json_of(const report::Decision& one, const Models::ModelNow& model_now) -> Json {
  auto out = json_of(one);
  out["lapsed"] = one.model != model_now.model;
  return out;
}

}  // namespace

auto Workspace::decisions() const -> std::shared_ptr<const report::Decisions> {
  const std::scoped_lock lock(mutex_);
  return decisions_;
}

auto Workspace::keep_decisions(report::Decisions now, const std::string& client) -> base::Result<void> {
  if (auto written = write_durably(project_.folder() / report::review_file, report::review_text(now)); !written)
    return written;
  {
    const std::scoped_lock lock(mutex_);
    decisions_ = std::make_shared<const report::Decisions>(std::move(now));
  }
  events_.send(text_of({{"type", "review"}, {"client", client}}));
  return {};
}

auto Workspace::review_of_project() const -> Text { return report::review_text(*decisions()); }

auto Workspace::review(const std::string& run) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  Json list = Json::array();
  for (const auto& [building, decision] : *decisions())
    if (const auto model_now = (*open)->model_now(building)) list.push_back(json_of(decision, *model_now));
  return text_of({{"reviewer", reviewer_}, {"decisions", std::move(list)}});
}

auto Workspace::review_case(const std::string& run, const std::string& building) -> Text {
  const auto open = models(run);
  return open ? (*open)->review_case(building, scene_now().get()) : Text(open.error());
}

auto Workspace::decide(const std::string& run, const ReviewRequest& request, const std::string& client) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const std::scoped_lock only_one(review_mutex_);
  const auto model_now = (*open)->model_now(request.building);
  if (!model_now)
    return base::error("edit-building", "unknown building; /api/runs/{run}/list lists those of the run",
                       request.building);
  if (model_now->revision != request.revision)
    return base::error("edit-stale",
                       "the building changed since it was shown; look at it again, and decide about what it is now",
                       request.building);
  auto now = *decisions();
  if (request.decision)
    now[request.building] = {request.building, *request.decision, request.note,
                             reviewer_,        base::utc_now(),   model_now->model};
  else now.erase(request.building);
  if (auto kept = keep_decisions(now, client); !kept) return kept.error();
  const auto made = now.find(request.building);
  return text_of({{"decided", made == now.end() ? Json(nullptr) : json_of(made->second, *model_now)}});
}

auto Workspace::merge_review(const std::string& text, const std::string& client) -> Text {
  const auto others = report::parse_review(text, "the file to merge");
  if (!others) return others.error();
  const std::scoped_lock only_one(review_mutex_);
  auto both = report::merged(*decisions(), *others);
  if (both.added + both.replaced > 0)
    if (auto kept = keep_decisions(std::move(both.decisions), client); !kept) return kept.error();
  Json conflicts = Json::array();
  for (const auto& [kept, dropped] : both.conflicts)
    conflicts.push_back({{"kept", json_of(kept)}, {"dropped", json_of(dropped)}});
  return text_of({{"added", both.added}, {"replaced", both.replaced}, {"conflicts", std::move(conflicts)}});
}

/// Decisions on models that changed since are no attributes. Those that a file had that was opened as a run stay where
/// this project has none of its own, and the model is that of the file.
auto Workspace::reviewed(std::shared_ptr<const model::City> city, const Models& models) const
    -> std::shared_ptr<const model::City> {
  const auto all = decisions();
  std::shared_ptr<model::City> copy;  // made when something is to be changed
  const auto set = [&](std::size_t b, const report::Decision* decision) {
    if (!copy) copy = std::make_shared<model::City>(*city);
    report::set_review(copy->buildings[b].attributes, decision);
  };
  for (std::size_t b = 0; b < city->buildings.size(); ++b) {
    const auto& building = city->buildings[b];
    const auto own = all->find(building.id);
    if (own != all->end()) {
      const auto model_now = models.model_now(building.id);
      set(b, model_now && model_now->model == own->second.model ? &own->second : nullptr);
    } else if (report::has_review(building.attributes)) {
      if (const auto model_now = models.model_now(building.id); model_now && model_now->changed) set(b, nullptr);
    }
  }
  return copy ? std::shared_ptr<const model::City>(std::move(copy)) : city;
}

}  // namespace mansard::server
