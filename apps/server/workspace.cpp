#include "apps/server/workspace.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "apps/server/exports.hpp"
#include "apps/server/import.hpp"
#include "apps/server/inputs.hpp"
#include "apps/server/outcome.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/formats/input_name.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

/// Of folders in which exports are made; one that ended in the midst of it leaves them.
constexpr std::string_view work_name = ".work-";

auto refuse(const char* code, std::string message, std::string subject = {}) -> base::Diagnostic {
  return base::error(code, std::move(message), std::move(subject));
}

auto unknown_run(const std::string& run) -> base::Diagnostic {
  return refuse("server-unknown", "the project has no such run; it may have been deleted", run);
}

/// A name that cannot leave its folder, nor hide in it.
auto plain_name(const std::string& name) -> bool {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-'; };
  return !name.empty() && name.size() <= 128 && name.front() != '.' && std::ranges::all_of(name, plain);
}

auto now_as_text() -> std::string {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

/// Reading, preset, then the run's own.
auto options_of(const RunRequest& request, const Texts& reading) -> base::Result<pipeline::Options> {
  pipeline::Options options;
  if (auto set = set_all(options, reading); !set) return set.error();
  if (!request.preset.empty()) {
    const auto& presets = pipeline::presets();
    const auto preset = std::ranges::find(presets, request.preset, &pipeline::Preset::name);
    if (preset == presets.end()) return refuse("option-value", "there is no such preset", request.preset);
    if (auto set = set_all(options, {preset->values.begin(), preset->values.end()}); !set) return set.error();
  }
  for (const auto& [key, value] : request.options)
    if (of_reading(key))
      return refuse("option-value", "this says how the inputs are read; open the inputs again with it", key);
  if (auto set = set_all(options, request.options); !set) return set.error();
  return options;
}

}  // namespace

auto Workspace::open(Project project, fs::path sample) -> base::Result<std::unique_ptr<Workspace>> {
  auto runs = project.runs();
  if (!runs) return runs.error();
  std::error_code status;
  for (const auto& left : fs::directory_iterator(project.folder() / "exports", status))
    if (left.path().filename().string().starts_with(work_name)) fs::remove_all(left.path(), status);
  std::unique_ptr<Workspace> workspace(new Workspace(std::move(project), std::move(sample)));
  for (auto& run : *runs) {
    const auto edits = standing_edits(workspace->project_.run_folder(run.id) / "journal.jsonl");
    auto& known = workspace->runs_.emplace_back();
    known.record = std::move(run);
    known.edits = edits;
  }
  if (workspace->project_.inputs()) (void)workspace->read_again(*workspace->project_.inputs(), false);
  return workspace;
}

Workspace::Workspace(Project project, fs::path sample)
    : sample_(std::move(sample)), project_(std::move(project)), jobs_([this](const Job& job) {
        events_.tell(text_of({{"type", "job"}, {"job", json_of(job)}}), job.id);
      }) {}

Workspace::~Workspace() { stop(); }

void Workspace::stop() {
  jobs_.stop();
  events_.close();
}

// ---- the project

auto Workspace::status() const -> Text { return text_of({{"version", MANSARD_VERSION}, {"busy", jobs_.busy()}}); }

/// Size and time are looked at; the contents only where these differ.
auto Workspace::changed(const KnownFile& file) const -> bool {
  const auto place = formats::disk_place_of(file.path);
  if (!place) return false;  // a database or a server: they are asked when they are read
  const auto stamp = stamp_of(*place);
  if (!stamp) return true;
  if (*stamp == file.stamp) return false;
  const std::scoped_lock lock(inputs_mutex_);
  auto& known = input_states_[file.path + " " + file.sha256];
  if (known.stamp != *stamp) {
    const auto now = formats::input_file(file.path);
    known = {*stamp, !now || now->sha256 != file.sha256};
  }
  return known.changed;
}

auto Workspace::files_json(const std::vector<KnownFile>& files) const -> Json {
  Json out = Json::array();
  for (const auto& file : files)
    out.push_back({{"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}, {"changed", changed(file)}});
  return out;
}

auto Workspace::project_json() const -> Json {
  std::optional<Inputs> inputs;
  Json runs = Json::array();
  {
    const std::scoped_lock lock(mutex_);
    inputs = project_.inputs();
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
          {"runs", std::move(runs)},    {"sample", sample_at_hand()}};
}

auto Workspace::project() const -> Text { return text_of(project_json()); }

void Workspace::tell_project() { events_.tell(text_of({{"type", "project"}, {"project", project_json()}}), "project"); }

auto Workspace::jobs() const -> Text {
  Json all = Json::array();
  for (const auto& job : jobs_.all()) all.push_back(json_of(job));
  return text_of({{"jobs", std::move(all)}});
}

auto Workspace::cancel(const std::string& job) -> Text {
  if (!jobs_.cancel(job)) return refuse("server-unknown", "there is no such job", job);
  return std::string("{}");
}

// ---- the scene

auto Workspace::open_inputs(const InputsRequest& request) -> Text {
  std::optional<Inputs> known;
  {
    const std::scoped_lock lock(mutex_);
    known = project_.inputs();
  }
  auto asked = inputs_asked_for(request, known);
  if (!asked) return asked.error();
  const auto& inputs = *asked;
  {
    const std::scoped_lock lock(mutex_);
    // Models that were imported before there was a scene are in a frame of their own.
    if (!runs_.empty() && !project_.inputs())
      return refuse("server-inputs",
                    "the project has models that were opened without a scan; delete them, or start 'mansard serve' "
                    "with another folder, read the scan, and open them there");
    if (!runs_.empty() && project_.inputs() && !project_.inputs()->same_request(inputs))
      return refuse("server-inputs",
                    "the project has runs of other inputs; delete them, or start 'mansard serve' with another folder");
  }
  return text_of(json_of(read_again(inputs, true)));
}

auto Workspace::sample_at_hand() const -> bool {
  std::error_code status;
  return !sample_.empty() && fs::is_directory(sample_, status);
}

/// Meshes and the footprints of a folder by their endings; reading.json beside them has the options to read them with.
auto Workspace::open_sample() -> Text {
  InputsRequest request;
  std::set<std::string> names;
  std::error_code status;
  if (sample_at_hand())
    for (const auto& entry : fs::directory_iterator(sample_, status)) names.insert(entry.path().string());
  for (const auto& name : names) {
    const fs::path path(name);
    if (path.filename() == "reading.json") {
      const auto text = base::read_file(path);
      const auto json = text ? Json::parse(*text, nullptr, false) : Json(nullptr);
      if (!json.is_object()) return refuse("server-sample", "the options of the sample cannot be read", name);
      for (const auto& [key, value] : json.items())
        if (value.is_string()) request.reading[key] = value.get<std::string>();
    } else if (named_as_mesh(path)) {
      request.meshes.push_back(name);
    } else if (path.stem() == "footprints" && request.footprints.empty()) {
      request.footprints = name;
    }
  }
  if (request.meshes.empty() || request.footprints.empty())
    return refuse("server-sample",
                  "there is no sample at hand; start 'mansard serve' with --sample DIR, a folder with "
                  "meshes and a file 'footprints'",
                  sample_.string());
  return open_inputs(request);
}

auto Workspace::upload_path(const std::string& name) const -> base::Result<fs::path> {
  if (!plain_name(name))
    return refuse("server-upload",
                  "a file name has 1 to 128 letters, digits, '.', '_', '-', and does not begin with a dot",
                  base::on_one_line(name.substr(0, 128)));
  return project_.folder() / "inputs" / name;
}

auto Workspace::read_again(const Inputs& inputs, bool save) -> Job {
  return jobs_.submit(
      "read", std::nullopt, [this, inputs, save](const base::Run& run) { return read_scene(inputs, save, run); },
      [this](State, const std::optional<base::Diagnostic>& failure) {
        const std::scoped_lock lock(mutex_);
        scene_failure_ = failure;
      });
}

auto Workspace::read_scene(Inputs inputs, bool save, const base::Run& run) -> base::Result<void> {
  auto scene = OpenScene::read(inputs, run);
  if (!scene) return explained(scene.error(), inputs);
  inputs = with_files(std::move(inputs), (*scene)->scene().inputs);
  {
    const std::scoped_lock lock(mutex_);
    // The record of a project that is opened again stays: it says what the runs were made of.
    if (save)
      if (auto saved = project_.save(inputs); !saved) return saved;
    scene_ = *scene;
  }
  tell_project();
  measure_what_was_edited();
  return {};
}

void Workspace::measure_what_was_edited() {
  std::vector<std::pair<std::string, std::shared_ptr<Models>>> open;
  SceneOrNone scene;
  {
    const std::scoped_lock lock(mutex_);
    scene = scene_;
    for (const auto& run : runs_)
      if (run.models) open.emplace_back(run.record.id, run.models);
  }
  for (const auto& [id, models] : open)
    if (const auto changed = models->measure(*scene)) (void)answer(id, *changed, "");
}

auto Workspace::scene_now() const -> SceneOrNone {
  const std::scoped_lock lock(mutex_);
  return scene_;
}

auto Workspace::scene_or_why() const -> base::Result<SceneOrNone> {
  const bool reading = jobs_.pending("read");
  const std::scoped_lock lock(mutex_);
  if (scene_) return scene_;
  if (reading) return refuse("server-no-scene", "the inputs are being read; wait for the job to end");
  return refuse("server-no-scene", scene_failure_ ? "the inputs could not be read: " + scene_failure_->message
                                                  : "no inputs have been opened yet");
}

auto Workspace::scene() const -> Text {
  const auto scene = scene_or_why();
  return scene ? Text((*scene)->scene_json()) : Text(scene.error());
}

auto Workspace::tiles() const -> Text {
  const auto scene = scene_or_why();
  return scene ? Text((*scene)->tiles_json()) : Text(scene.error());
}

auto Workspace::tile(const std::string& id) const -> Text {
  const auto scene = scene_or_why();
  if (!scene) return scene.error();
  auto bytes = (*scene)->tile_bytes(id);
  if (!bytes) return refuse("server-unknown", "the scene has no such tile", id);
  return std::move(*bytes);
}

// ---- runs

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
    return refuse("server-not-done", "the run has no results: it is " + std::string(to_string(found->state)), run);
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
  fs::path folder;
  {
    const std::scoped_lock lock(mutex_);
    const auto* found = find(run);
    if (found == nullptr) return unknown_run(run);
    if (found->models) return found->models;
    scene = scene_;
    folder = project_.run_folder(run);
  }
  auto models = Models::open(folder, *known, scene);
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

auto Workspace::start_run(const RunRequest& request) -> Text {
  const bool reading = jobs_.pending("read");
  const auto scene = scene_or_why();
  if (!scene && !reading) return scene.error();
  Texts with;
  {
    const std::scoped_lock lock(mutex_);
    if (project_.inputs()) with = project_.inputs()->reading;
  }
  auto options = options_of(request, with);
  if (!options) return options.error();
  if (scene)
    for (const auto& block : request.blocks)
      if (!(*scene)->has_block(block)) return refuse("pipeline-block-unknown", "the scene has no such block", block);
  Run run;
  run.record.label = request.label;
  run.record.preset = request.preset;
  run.record.options = differing(*options);
  run.record.blocks = request.blocks;
  return submit(std::move(run), [this](RunRecord record, const base::Run& how) -> base::Result<RunOutcome> {
    const auto now = scene_or_why();
    if (!now) return now.error();
    return reconstruct(**now, std::move(record), how);
  });
}

auto Workspace::import_model(const ImportRequest& request) -> Text {
  const auto path = whole_name(request.path);
  if (auto known = check_import(path); !known) return known.error();
  if (jobs_.pending("read")) return refuse("server-busy", "the inputs are being read; wait for the job to end");
  {
    const std::scoped_lock lock(mutex_);
    if (project_.inputs() && !scene_)
      return refuse("server-no-scene",
                    "the project's inputs are not there, and the model could not be put beside them");
  }
  Run run;
  run.record.label = request.label.empty() ? fs::path(path).filename().string() : request.label;
  return submit(std::move(run), [this, path](RunRecord record, const base::Run& how) -> base::Result<RunOutcome> {
    std::optional<model::Frame> frame;
    if (const auto scene = scene_now()) frame = scene->scene().frame;
    return import_city(path, frame, std::move(record), how);
  });
}

auto Workspace::submit(Run run, Make make) -> Text {
  {
    const std::scoped_lock lock(mutex_);
    auto id = project_.new_run();
    if (!id) return id.error();
    run.record.id = *id;
    if (run.record.label.empty()) run.record.label = *id;
    run.record.created = now_as_text();
    if (auto saved = project_.save(run.record); !saved) return saved.error();
    runs_.push_back(run);
  }
  const auto id = run.record.id;
  const auto job = jobs_.submit(
      "run", id, [this, id, make = std::move(make)](const base::Run& how) { return carry_out(id, make, how); },
      [this, id](State state, const std::optional<base::Diagnostic>& failure) { ended(id, state, failure); });
  tell_project();
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
  tell_project();
  auto outcome = make(std::move(record), how);
  if (!outcome) return outcome.error();
  for (const auto& [name, bytes] : outcome->files)
    if (auto written = write_durably(folder / name, bytes); !written) return written;
  const std::scoped_lock lock(mutex_);
  auto* run = find(id);
  if (run == nullptr) return unknown_run(id);
  outcome->record.label = run->record.label;  // it may have got another name meanwhile
  run->record = std::move(outcome->record);
  return {};
}

/// The record is written last: a run that is done has all of its files.
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
  tell_project();
}

auto Workspace::remove_run(const std::string& run) -> Text {
  {
    const std::scoped_lock lock(mutex_);
    const auto* found = find(run);
    if (found == nullptr) return unknown_run(run);
    if (!over(found->record.state)) return refuse("server-busy", "the run has not ended; cancel its job first", run);
    if (auto moved = project_.trash(run); !moved) return moved.error();
    std::erase_if(runs_, [&](const auto& known) { return known.record.id == run; });
  }
  tell_project();
  return std::string("{}");
}

auto Workspace::rename_run(const std::string& run, const std::string& label) -> Text {
  Json summary;
  {
    const std::scoped_lock lock(mutex_);
    auto* found = find(run);
    if (found == nullptr) return unknown_run(run);
    auto renamed = found->record;
    renamed.label = label;
    if (auto saved = project_.save(renamed); !saved) return saved.error();
    found->record = std::move(renamed);
    summary = json_of(found->record, found->edits);
  }
  tell_project();
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

auto Workspace::error_map(const std::string& run, const std::string& block) const -> Text {
  const auto known = done(run);
  if (!known) return known.error();
  const auto at = std::ranges::find(known->maps, block, &MapInfo::block);
  if (at == known->maps.end()) return refuse("server-unknown", "the run has no error map of such a block", block);
  return base::read_file(project_.run_folder(run) / error_name(static_cast<std::size_t>(at - known->maps.begin())));
}

// ---- models

auto Workspace::buildings(const std::string& run) -> Text {
  const auto open = models(run);
  return open ? Text((*open)->all()) : Text(open.error());
}

auto Workspace::section(const std::string& run, const PartName& part, std::size_t ring, std::size_t edge, double share)
    -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto scene = scene_or_why();
  if (!scene) return scene.error();
  const auto plan = (*open)->plan_of(part);
  if (!plan) return plan.error();
  if (auto checked = check_edge(*plan, ring, edge, share); !checked) return checked.error();
  return text_of((*scene)->section(*plan, ring, edge, share, part.building, (*open)->options()));
}

auto Workspace::section(const std::string& run, const SectionRequest& request) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto scene = scene_or_why();
  if (!scene) return scene.error();
  if (auto checked = check_edge(request.plan, request.ring, request.edge, request.share); !checked)
    return checked.error();
  return text_of(
      (*scene)->section(request.plan, request.ring, request.edge, request.share, std::nullopt, (*open)->options()));
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

/// Tells every page, and gives the answer for the one that asked.
auto Workspace::answer(const std::string& run, const Changed& changed, const std::string& client) -> std::string {
  {
    const std::scoped_lock lock(mutex_);
    if (auto* found = find(run)) found->edits = changed.standing;
  }
  const auto both = R"("buildings":)" + changed.buildings + R"(,"history":)" + changed.history + "}";
  events_.tell(R"({"type":"buildings","run":)" + text_of(Json(run)) + R"(,"client":)" + text_of(Json(client)) + "," +
               both);
  return "{" + both;
}

auto Workspace::apply(const std::string& run, edit::Edit edit, const std::string& client) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto scene = scene_now();
  const auto changed = (*open)->apply(std::move(edit), scene.get());
  return changed ? Text(answer(run, *changed, client)) : Text(changed.error());
}

auto Workspace::undo(const std::string& run, const std::string& client) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto scene = scene_now();
  const auto changed = (*open)->undo(scene.get());
  return changed ? Text(answer(run, *changed, client)) : Text(changed.error());
}

auto Workspace::redo(const std::string& run, const std::string& client) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  const auto scene = scene_now();
  const auto changed = (*open)->redo(scene.get());
  return changed ? Text(answer(run, *changed, client)) : Text(changed.error());
}

auto Workspace::export_file(const std::string& run, const std::string& file) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  if (file == run_layers) {
    auto layers = layers_of(run);
    if (!layers) return layers.error();
    if (!*layers)
      return refuse("server-unknown", "the run has no layers: its models were opened, not reconstructed", file);
    return std::move(**layers);
  }
  const auto city = (*open)->edited(scene_now());
  if (!city) return city.error();
  const auto work = project_.folder() / "exports" / (std::string(work_name) + std::to_string(next_work_++));
  return exported(**city, (*open)->options().write, file, work);
}

/// Models that were imported have none.
auto Workspace::layers_of(const std::string& run) const -> base::Result<std::optional<std::string>> {
  const auto path = project_.run_folder(run) / run_layers;
  if (std::error_code status; !fs::exists(path, status)) return std::optional<std::string>();
  auto layers = base::read_file(path);
  if (!layers) return layers.error();
  return std::optional(std::move(*layers));
}

auto Workspace::export_all(const std::string& run, const ExportRequest& request) -> Text {
  const auto formats = formats_named(request.formats);
  if (!formats) return formats.error();
  const auto open = models(run);
  if (!open) return open.error();
  const auto layers = layers_of(run);
  if (!layers) return layers.error();
  const auto city = (*open)->edited(scene_now());
  if (!city) return city.error();
  const std::scoped_lock only_one(exports_mutex_);
  const auto folder = project_.folder() / "exports" / run;
  std::error_code status;
  if (!request.overwrite && fs::exists(folder, status) && !fs::is_empty(folder, status))
    return refuse("output-exists", "the folder is not empty; say that it may be overwritten", folder.string());
  if (auto made = make_folder(folder); !made) return made.error();
  const auto written = export_to(folder, **city, (*open)->options().write, *formats, *layers);
  if (!written) return written.error();
  return text_of({{"folder", folder.string()}, {"files", written->files}, {"warnings", json_of(written->warnings)}});
}

}  // namespace mansard::server
