#include "apps/server/workspace.hpp"

#include <algorithm>
#include <utility>

#include "apps/server/exports.hpp"
#include "apps/server/inputs.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

}  // namespace

auto Workspace::open(Project project, fs::path sample) -> base::Result<std::unique_ptr<Workspace>> {
  auto runs = project.runs();
  if (!runs) return runs.error();
  auto decisions = report::read_review(project.folder());
  if (!decisions) return decisions.failure();
  remove_work_folders(project.folder() / "exports");
  std::unique_ptr<Workspace> workspace(new Workspace(std::move(project), std::move(sample)));
  for (auto& run : *runs) {
    const auto edits = workspace->project_.applied_edits(run.id);
    auto& known = workspace->runs_.emplace_back();
    known.record = std::move(run);
    known.edits = edits;
  }
  workspace->decisions_ = std::make_shared<const report::Decisions>(std::move(*decisions));
  workspace->open_kept_view();
  if (workspace->project_.inputs())
    (void)workspace->start_reading(*workspace->project_.inputs(), workspace->runs_.empty());
  return workspace;
}

Workspace::Workspace(Project project, fs::path sample)
    : sample_(std::move(sample)), project_(std::move(project)), jobs_([this](const Job& job) {
        events_.send(text_of({{"type", "job"}, {"job", json_of(job)}}), job.id);
      }) {}

Workspace::~Workspace() { stop(); }

void Workspace::stop() {
  jobs_.stop();
  events_.close();
}

// ---- project and jobs

auto Workspace::status() const -> Text { return text_of({{"version", MANSARD_VERSION}, {"busy", jobs_.busy()}}); }

auto Workspace::files_json(const std::vector<KnownFile>& files) const -> Json {
  Json out = Json::array();
  for (const auto& file : files)
    out.push_back({{"path", file.path},
                   {"bytes", file.bytes},
                   {"sha256", file.sha256},
                   {"changed", changed_files_.changed(file)}});
  return out;
}

auto Workspace::project_json() const -> Json {
  std::optional<Inputs> inputs;
  Json runs = Json::array();
  bool scene = false;
  {
    const std::scoped_lock lock(mutex_);
    inputs = project_.inputs();
    scene = scene_ || kept_view_;
    for (const auto& run : runs_) runs.push_back(json_of(run.record, run.edits));
  }
  Json files = nullptr;
  if (inputs)
    files = {{"given", shown_json(*inputs)},
             {"meshes", files_json(inputs->mesh_files)},
             {"terrain", files_json(inputs->terrain_files)},
             {"footprints", files_json(inputs->footprint_files)}};
  return {{"name", project_.name()},    {"folder", project_.folder().string()},
          {"inputs", std::move(files)}, {"reading", inputs ? Json(inputs->reading) : Json::object()},
          {"runs", std::move(runs)},    {"scene", scene},
          {"sample", has_sample()},     {"basemap_attribution", basemap_.attribution}};
}

auto Workspace::project() const -> Text { return text_of(project_json()); }

void Workspace::send_project() { events_.send(text_of({{"type", "project"}, {"project", project_json()}}), "project"); }

auto Workspace::jobs() const -> Text {
  Json all = Json::array();
  for (const auto& job : jobs_.all()) all.push_back(json_of(job));
  return text_of({{"jobs", std::move(all)}});
}

auto Workspace::cancel(const std::string& job) -> Text {
  if (jobs_.cancel(job)) return std::string("{}");
  return base::error("server-unknown", "unknown job; /api/jobs lists those of this server", job);
}

// ---- runs by their ids

auto Workspace::find(const std::string& run) const -> const Run* {
  const auto at = std::ranges::find(
      runs_, run, [](const auto& known) -> const auto& { return known.record.id; });
  return at == runs_.end() ? nullptr : &*at;
}

auto Workspace::find(const std::string& run) -> Run* {
  return const_cast<Run*>(std::as_const(*this).find(run));  // NOLINT: this is not const here
}

auto Workspace::record(const std::string& run) const -> base::Result<RunRecord> {
  const std::scoped_lock lock(mutex_);
  const auto* found = find(run);
  return found != nullptr ? base::Result<RunRecord>(found->record) : unknown_run(run);
}

auto Workspace::done(const std::string& run) const -> base::Result<RunRecord> {
  auto found = record(run);
  if (found && found->state != State::done)
    return base::error("server-not-done", "the run has no results: it is " + std::string(to_string(found->state)), run);
  return found;
}

auto Workspace::models(const std::string& run) -> base::Result<std::shared_ptr<Models>> {
  const auto known = done(run);
  if (!known) return known.error();
  std::shared_ptr<std::mutex> opening;
  {
    const std::scoped_lock lock(mutex_);
    const auto* found = find(run);
    if (found == nullptr) return unknown_run(run);
    if (found->models) return found->models;
    opening = found->opening;
  }
  const std::scoped_lock only_one(*opening);
  SceneOrNone scene;
  std::string key;
  fs::path folder;
  {
    const std::scoped_lock lock(mutex_);
    const auto* found = find(run);
    if (found == nullptr) return unknown_run(run);
    if (found->models) return found->models;
    scene = scene_;
    key = project_.inputs() ? key_of(*project_.inputs()) : std::string();
    folder = project_.run_folder(run);
  }
  auto models = Models::open(folder, *known, scene, key);
  if (!models) return models.error();
  SceneOrNone read_meanwhile;
  {
    const std::scoped_lock lock(mutex_);
    auto* found = find(run);
    if (found == nullptr) return unknown_run(run);
    found->models = *models;
    if (scene != scene_) read_meanwhile = scene_;
  }
  if (read_meanwhile) (void)(*models)->measure(*read_meanwhile);
  return models;
}

}  // namespace mansard::server
