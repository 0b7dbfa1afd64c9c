// Workspace: runs are started, imported, renamed and deleted here, and their results read.
#include <algorithm>

#include "apps/server/exports.hpp"
#include "apps/server/import.hpp"
#include "apps/server/inputs.hpp"
#include "apps/server/options.hpp"
#include "apps/server/workspace.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/machine.hpp"

namespace mansard::server {

namespace fs = std::filesystem;

auto Workspace::start_run(const RunRequest& request) -> Text {
  const bool reading = jobs_.pending("read");
  const auto scene = scene_or_error();
  if (!scene && !reading) return scene.error();
  Texts with;
  {
    const std::scoped_lock lock(mutex_);
    if (project_.inputs()) with = project_.inputs()->reading;
  }
  auto options = run_options(request, with);
  if (!options) return options.error();
  if (scene)
    for (const auto& block : request.blocks)
      if (!(*scene)->has_block(block))
        return base::error("pipeline-block-unknown", "unknown block '" + block + "'; /api/scene lists the blocks",
                           block);
  Run run;
  run.record.label = request.label;
  run.record.preset = request.preset;
  run.record.options = differing(*options);
  run.record.blocks = request.blocks;
  return submit(std::move(run), [this](RunRecord record, const base::Run& how) -> base::Result<RunOutcome> {
    const auto now = scene_or_error();
    if (!now) return now.error();
    return reconstruct(**now, std::move(record), how);
  });
}

auto Workspace::import_model(const ImportRequest& request) -> Text {
  const auto path = absolute_name(request.path);
  if (auto known = check_import(path); !known) return known.error();
  if (jobs_.pending("read"))
    return base::error("server-busy", "the inputs are being read; wait until the job has ended");
  {
    const std::scoped_lock lock(mutex_);
    if (project_.inputs() && !scene_)
      return base::error(
          "server-no-scene",
          "the project's inputs could not be read, so the model cannot be placed relative to them; read the "
          "inputs again first");
  }
  Run run;
  run.record.label = request.label.empty() ? fs::path(path).filename().string() : request.label;
  return submit(std::move(run), [this, path](RunRecord record, const base::Run& how) -> base::Result<RunOutcome> {
    std::optional<model::Frame> frame;
    if (const auto scene = scene_now()) frame = scene->scene().frame;
    return import_city(path, work_folder(project_.folder() / "exports", next_work_++), frame, std::move(record), how);
  });
}

auto Workspace::submit(Run run, Make make) -> Text {
  {
    const std::scoped_lock lock(mutex_);
    auto id = project_.new_run();
    if (!id) return id.error();
    run.record.id = *id;
    if (run.record.label.empty()) run.record.label = *id;
    run.record.created = base::utc_now();
    if (auto saved = project_.save(run.record); !saved) return saved.error();
    runs_.push_back(run);
  }
  const auto id = run.record.id;
  const auto job = jobs_.submit(
      "run", id, [this, id, make = std::move(make)](const base::Run& how) { return carry_out(id, make, how); },
      [this, id](State state, const std::optional<base::Diagnostic>& failure) { ended(id, state, failure); });
  send_project();
  return text_of(json_of(job));
}

auto Workspace::carry_out(const std::string& id, const Make& make, const base::Run& how) -> base::Result<void> {
  RunRecord record;
  fs::path folder;
  {
    const std::scoped_lock lock(mutex_);
    auto* run = find(id);
    if (run == nullptr) return unknown_run(id);
    run->record.state = State::running;
    if (auto saved = project_.save(run->record); !saved) return saved.error();
    record = run->record;
    folder = project_.run_folder(id);
  }
  send_project();
  auto outcome = make(std::move(record), how);
  if (!outcome) return outcome.error();
  for (const auto& [name, bytes] : outcome->files)
    if (auto written = write_durably(folder / name, bytes); !written) return written;
  const std::scoped_lock lock(mutex_);
  auto* run = find(id);
  if (run == nullptr) return unknown_run(id);
  outcome->record.label = run->record.label;  // it may have been renamed meanwhile
  run->record = std::move(outcome->record);
  return {};
}

/// The record is written last: a run in the state "done" has all of its files.
void Workspace::ended(const std::string& id, State state, const std::optional<base::Diagnostic>& failure) {
  {
    const std::scoped_lock lock(mutex_);
    auto* run = find(id);
    if (run == nullptr) return;
    run->record.state = state;
    run->record.failure = failure;
    if (auto saved = project_.save(run->record); !saved) {
      run->record.state = State::failed;
      run->record.failure = saved.error();
    }
  }
  send_project();
}

auto Workspace::remove_run(const std::string& run) -> Text {
  {
    const std::scoped_lock lock(mutex_);
    const auto* found = find(run);
    if (found == nullptr) return unknown_run(run);
    if (!over(found->record.state))
      return base::error("server-busy", "the run has not ended; cancel its job before deleting it", run);
    if (auto moved = project_.trash(run); !moved) return moved.error();
    std::erase_if(runs_, [&](const auto& known) { return known.record.id == run; });
  }
  send_project();
  return std::string("{}");
}

auto Workspace::rename_run(const std::string& run, const std::string& label) -> Text {
  Json summary;
  {
    const std::scoped_lock lock(mutex_);
    auto* found = find(run);
    if (found == nullptr) return unknown_run(run);
    if (found->record.damaged) return *found->record.failure;  // saving would replace what may be restored
    auto renamed = found->record;
    renamed.label = label;
    if (auto saved = project_.save(renamed); !saved) return saved.error();
    found->record = std::move(renamed);
    summary = json_of(found->record, found->edits);
  }
  send_project();
  return text_of(summary);
}

auto Workspace::report(const std::string& run) const -> Text {
  const auto known = done(run);
  if (!known) return known.error();
  return base::read_file(project_.run_folder(run) / "report.json");
}

auto Workspace::layers(const std::string& run) const -> Text {
  const auto known = done(run);
  if (!known) return known.error();
  return base::read_file(project_.run_folder(run) / "layers.json");
}

auto Workspace::error_maps(const std::string& run) const -> Text {
  const auto known = done(run);
  if (!known) return known.error();
  Json maps = Json::array();
  for (const auto& map : known->maps) maps.push_back(json_of(map));
  return text_of({{"maps", std::move(maps)}});
}

auto Workspace::measured(const RunRecord& run) -> base::Result<std::optional<Models::Measured>> {
  using None = std::optional<Models::Measured>;
  if (run.maps.empty()) return None();
  const auto open = models(run.id);
  if (!open) return open.error();
  {
    const std::scoped_lock lock(mutex_);
    const auto* found = find(run.id);
    if (found == nullptr) return unknown_run(run.id);
    if (found->edits == 0) return None();
  }
  const auto scene = scene_or_error();
  if (!scene) return scene.error();
  std::vector<std::string> blocks;
  for (const auto& map : run.maps) blocks.push_back(map.block);
  auto now = (*open)->measured(blocks, *scene);
  if (!now) return now.error();
  return None(std::move(*now));
}

auto Workspace::scores(const std::string& run) -> Text {
  const auto known = done(run);
  if (!known) return known.error();
  auto now = measured(*known);
  if (!now) return now.error();
  auto scores = known->scores;
  if (*now) scores = scores_of((*now)->blocks);
  return text_of({{"edits", *now ? (*now)->applied : 0}, {"scores", json_of(scores)}});
}

auto Workspace::error_map(const std::string& run, const std::string& block) -> Text {
  const auto known = done(run);
  if (!known) return known.error();
  const auto at = std::ranges::find(known->maps, block, &MapInfo::block);
  if (at == known->maps.end())
    return base::error("server-unknown", "the run has no error map of this block; /api/runs/{run}/error lists them",
                       block);
  const auto number = static_cast<std::size_t>(at - known->maps.begin());
  const auto now = measured(*known);
  if (!now) return now.error();
  if (!*now) return base::read_file(project_.run_folder(run) / error_name(number));
  const auto& map = (*now)->blocks[number]->map;
  if (map.columns != at->columns || map.rows != at->rows)
    return base::error("server-unknown", "the error map has another size than when the run was made", block);
  return bytes_of(map.difference);
}

}  // namespace mansard::server
