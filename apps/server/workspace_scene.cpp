// Workspace: inputs, and the scene that is read from them.
#include <algorithm>
#include <utility>

#include "apps/server/disk.hpp"
#include "apps/server/inputs.hpp"
#include "apps/server/workspace.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t maximum_name = 128;        // bytes; temporary names are longer, and file systems allow 255
constexpr std::int64_t maximum_folders = 1'000;  // of uploads with equal names

/// Whether the name is one file in any folder, can be shown, and can be typed on one line of a form: valid UTF-8
/// without separators and control characters, no leading dot, no space at either end.
auto is_safe_name(const std::string& name) -> bool {
  const auto plain = [](unsigned char c) { return c >= 0x20 && c != 0x7f && c != '/' && c != '\\'; };
  if (name.empty() || name.size() > maximum_name || !std::ranges::all_of(name, plain)) return false;
  if (name.front() == '.' || name.front() == ' ' || name.back() == ' ') return false;
  try {
    (void)Json(name).dump();
  } catch (const Json::exception&) {
    return false;  // not UTF-8
  }
  return true;
}

auto unknown_tile(const std::string& id) -> base::Diagnostic {
  return base::error("server-unknown", "unknown tile; /api/scene/tiles lists the tiles of the scene", id);
}

/// The first file that is not the one that was read before; none if all are. Databases have no hash.
auto first_changed(const Inputs& before, const Inputs& now) -> std::optional<std::string> {
  for (const auto files : {&Inputs::mesh_files, &Inputs::terrain_files, &Inputs::footprint_files}) {
    const auto &old = before.*files, &read = now.*files;
    for (const auto& file : read) {
      const auto same = std::ranges::find(old, file.path, &KnownFile::path);
      if (same == old.end() || same->sha256 != file.sha256) return file.path;
    }
    for (const auto& file : old)
      if (std::ranges::find(read, file.path, &KnownFile::path) == read.end()) return file.path;
  }
  return std::nullopt;
}

}  // namespace

auto Workspace::open_inputs(const InputsRequest& request) -> Text {
  std::optional<Inputs> known;
  {
    const std::scoped_lock lock(mutex_);
    known = project_.inputs();
  }
  auto asked = requested_inputs(request, known);
  if (!asked) return asked.error();
  const auto& inputs = *asked;
  {
    const std::scoped_lock lock(mutex_);
    // Models that were imported into a project without inputs keep their own frame.
    if (!runs_.empty() && !project_.inputs())
      return base::error(
          "server-inputs",
          "the project has models that were opened without a mesh; delete them, or start 'mansard serve' "
          "with another folder, read the mesh there, and then open the models");
    if (!runs_.empty() && project_.inputs() && !project_.inputs()->same_request(inputs))
      return base::error(
          "server-inputs",
          "the project has runs with other inputs; delete them, or start 'mansard serve' with another folder");
  }
  {
    const std::scoped_lock lock(mutex_);
    if (!project_.inputs() || !project_.inputs()->same_request(inputs)) kept_view_ = nullptr;
  }
  return text_of(json_of(start_reading(inputs, true)));
}

auto Workspace::has_sample() const -> bool {
  std::error_code status;
  return !sample_.empty() && fs::is_directory(sample_, status);
}

auto Workspace::open_sample() -> Text {
  auto request = sample_inputs(sample_);
  if (!request) return request.error();
  return open_inputs(*request);
}

auto Workspace::upload_path(const std::string& name, const std::optional<std::string>& folder,
                            const std::optional<std::uint64_t>& length) const -> base::Result<fs::path> {
  if (!is_safe_name(name))
    return base::error(
        "server-upload",
        "this is not a valid file name; expected 1 to " + std::to_string(maximum_name) +
            " bytes of UTF-8 without '/', '\\' and control characters, no leading dot, and no space at either end",
        base::on_one_line(name.substr(0, maximum_name)));
  auto place = project_.folder() / "inputs";
  if (auto made = make_folder(place); !made) return made.error();
  if (folder) {
    const auto number = base::to_integer(*folder);
    if (!number || *number < 2 || *number > maximum_folders)
      return base::error("server-upload",
                         "the folder of an upload must be an integer from 2 to " + std::to_string(maximum_folders),
                         base::on_one_line(folder->substr(0, maximum_name)));
    place /= std::to_string(*number);
    if (auto made = make_folder(place); !made) return made.error();
  }
  // Another size is known to be another file before anything is sent.
  std::error_code status;
  const auto path = place / name;
  const auto kind = fs::symlink_status(path, status).type();
  const bool other = kind == fs::file_type::regular ? length && fs::file_size(path, status) != *length
                                                    : kind != fs::file_type::not_found;
  if (other) return name_taken(path);
  return path;
}

auto Workspace::start_reading(const Inputs& inputs, bool save) -> Job {
  return jobs_.submit(
      "read", std::nullopt, [this, inputs, save](const base::Run& run) { return read_scene(inputs, save, run); },
      [this](State, const std::optional<base::Diagnostic>& failure) {
        const std::scoped_lock lock(mutex_);
        scene_failure_ = failure;
        kept_view_ = nullptr;  // there is a scene now, or the inputs are not what they were
      });
}

auto Workspace::read_scene(Inputs inputs, bool save, const base::Run& run) -> base::Result<void> {
  auto scene = OpenScene::read(inputs, run);
  if (!scene) return explained(scene.error(), inputs);
  inputs = with_files(std::move(inputs), (*scene)->scene().inputs);
  std::string key;
  bool keeps = false;
  {
    const std::scoped_lock lock(mutex_);
    // Runs are shown over the files that they were made from, and over no others.
    if (!runs_.empty() && project_.inputs())
      if (const auto changed = first_changed(*project_.inputs(), inputs))
        return base::error("server-changed",
                           "this input has changed since the runs of the project were made from it; restore the file, "
                           "delete the runs and read the inputs again, or start 'mansard serve' with another folder",
                           *changed);
    // When a project with runs is reopened its record stays as it is: it says which files the runs were made from.
    if (save)
      if (auto saved = project_.save(inputs); !saved) return saved;
    scene_ = *scene;
    textures_ = nullptr;
    key = key_of(inputs);
    keeps = !kept_view_;
  }
  send_project();
  measure_edited();
  // Not being able to keep it costs time when the project is opened again, and nothing else.
  if (keeps && !key.empty() && make_folder(kept_view_file().parent_path()))
    (void)(*scene)->view()->keep(kept_view_file(), key);
  return {};
}

void Workspace::measure_edited() {
  std::vector<std::pair<std::string, std::shared_ptr<Models>>> open;
  SceneOrNone scene;
  {
    const std::scoped_lock lock(mutex_);
    scene = scene_;
    for (const auto& run : runs_)
      if (run.models) open.emplace_back(run.record.id, run.models);
  }
  for (const auto& [id, models] : open)
    if (const auto changed = models->measure(*scene)) (void)send_change(id, *changed, "");
}

auto Workspace::scene_now() const -> SceneOrNone {
  const std::scoped_lock lock(mutex_);
  return scene_;
}

auto Workspace::scene_or_error() const -> base::Result<SceneOrNone> {
  const bool reading = jobs_.pending("read");
  const std::scoped_lock lock(mutex_);
  if (scene_) {
    if (const auto failure = scene_->failure()) return *failure;
    return scene_;
  }
  if (reading) return base::error("server-no-scene", "the inputs are being read; wait until the job has ended");
  return base::error("server-no-scene", scene_failure_ ? "the inputs could not be read: " + scene_failure_->message
                                                       : "the project has no inputs; open a mesh and footprints first");
}

auto Workspace::kept_view_file() const -> fs::path { return project_.folder() / "kept" / "scene"; }

void Workspace::open_kept_view() {
  if (!project_.inputs()) return;
  const auto& inputs = *project_.inputs();
  for (const auto files : {&Inputs::mesh_files, &Inputs::terrain_files, &Inputs::footprint_files})
    for (const auto& file : inputs.*files)
      if (changed_files_.changed(file)) return;
  if (const auto key = key_of(inputs); !key.empty()) kept_view_ = SceneView::open(kept_view_file(), key);
}

auto Workspace::view_or_error() const -> base::Result<std::shared_ptr<const SceneView>> {
  {
    const std::scoped_lock lock(mutex_);
    if (!scene_ && kept_view_) return kept_view_;
  }
  const auto scene = scene_or_error();
  if (!scene) return scene.error();
  return (*scene)->view();
}

auto Workspace::scene() const -> Text {
  const auto view = view_or_error();
  return view ? Text((*view)->scene_json()) : Text(view.error());
}

auto Workspace::tiles() const -> Text {
  const auto view = view_or_error();
  return view ? Text((*view)->tiles_json()) : Text(view.error());
}

auto Workspace::tile(const std::string& id) const -> Text {
  const auto view = view_or_error();
  if (!view) return view.error();
  auto bytes = (*view)->tile_bytes(id);
  if (!bytes) return bytes.error();
  if (!*bytes) return unknown_tile(id);
  return std::move(**bytes);
}

auto Workspace::read_textures() -> Text {
  if (const auto scene = scene_or_error(); !scene) return scene.error();
  return text_of(json_of(jobs_.submit(
      "textures", std::nullopt,
      [this](const base::Run& run) -> base::Result<void> {
        const auto scene = scene_or_error();
        if (!scene) return scene.error();
        std::optional<Inputs> inputs;
        {
          const std::scoped_lock lock(mutex_);
          if (textures_) return {};
          inputs = project_.inputs();
        }
        const auto read = Textures::read(inputs.value_or(Inputs()), **scene, run);
        if (!read) return read.failure();
        const std::scoped_lock lock(mutex_);
        if (scene_ == *scene) textures_ = *read;
        return {};
      },
      nullptr)));
}

auto Workspace::textures_or_error() const -> base::Result<std::shared_ptr<const Textures>> {
  const std::scoped_lock lock(mutex_);
  if (textures_) return textures_;
  return base::error("server-no-textures",
                     "the textures of the scan have not been read; POST /api/scene/textures does");
}

auto Workspace::tile_texture(const std::string& id) const -> Text {
  const auto scene = scene_or_error();
  if (!scene) return scene.error();
  const auto textures = textures_or_error();
  if (!textures) return textures.error();
  const auto tile = (*scene)->view()->tile(id);
  if (!tile) return tile.error();
  return *tile ? (*textures)->of_tile(**tile) : Text(unknown_tile(id));
}

auto Workspace::building_texture(const std::string& run, const std::string& building) -> Text {
  const auto textures = textures_or_error();
  if (!textures) return textures.error();
  const auto open = models(run);
  if (!open) return open.error();
  const auto solids = (*open)->solids_of(building);
  return solids ? (*textures)->of_building(solids->models, solids->revision) : Text(solids.error());
}

}  // namespace mansard::server
