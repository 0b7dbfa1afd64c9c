// Workspace: the models of a run as files.
#include <algorithm>

#include "apps/server/exports.hpp"
#include "apps/server/ground.hpp"
#include "apps/server/workspace.hpp"
#include "mansard/base/files.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

}  // namespace

auto Workspace::export_file(const std::string& run, const std::string& file) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  if (file == run_layers) {
    auto layers = layers_file(run);
    if (!layers) return layers.error();
    if (!*layers)
      return base::error("server-unknown",
                         "the run has no segmentation layers: its models were imported, not reconstructed", file);
    return std::move(**layers);
  }
  const auto scene = scene_now();
  const auto city = (*open)->edited(scene);
  if (!city) return city.error();
  const auto work = work_folder(project_.folder() / "exports", next_work_++);
  if (std::ranges::find(terrain_files(), file) != terrain_files().end()) {
    if (!scene) return base::error("server-no-scene", "the terrain is made from the mesh, which has not been read");
    return terrain_file(**city, *scene, (*open)->options(), file, work);
  }
  return exported(*reviewed(*city, **open), (*open)->options().write, file, work);
}

/// None for imported models.
auto Workspace::layers_file(const std::string& run) const -> base::Result<std::optional<std::string>> {
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
  const auto layers = layers_file(run);
  if (!layers) return layers.error();
  const auto city = (*open)->edited(scene_now());
  if (!city) return city.error();
  const std::scoped_lock only_one(exports_mutex_);
  const auto folder = project_.folder() / "exports" / run;
  std::error_code status;
  if (!request.overwrite && fs::exists(folder, status) && !fs::is_empty(folder, status))
    return base::error("output-exists", "the folder is not empty; send \"overwrite\": true to replace its files",
                       folder.string());
  if (auto made = make_folder(folder); !made) return made.error();
  const auto written = export_to(folder, *reviewed(*city, **open), (*open)->options().write, *formats, *layers);
  if (!written) return written.error();
  return text_of({{"folder", folder.string()}, {"files", written->files}, {"warnings", json_of(written->warnings)}});
}

}  // namespace mansard::server
