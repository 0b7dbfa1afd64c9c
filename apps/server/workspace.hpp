// The project while it is served: inputs, scene, runs, jobs, and the events sent to the pages.
//
//   workspace.cpp          opening and closing, the project, jobs, runs by their ids
//   workspace_scene.cpp    inputs are read, the scene is queried
//   workspace_runs.cpp     runs are started, imported, renamed, deleted; their results
//   workspace_edits.cpp    models are shown, previewed and edited
//   workspace_exports.cpp  models are exported
//   workspace_inspect.cpp  attributes, levels of detail, models of others, alignment
//   workspace_review.cpp   what people decided about the models
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "apps/server/changed_files.hpp"
#include "apps/server/events.hpp"
#include "apps/server/jobs.hpp"
#include "apps/server/models.hpp"
#include "apps/server/outcome.hpp"
#include "apps/server/project.hpp"
#include "apps/server/requests.hpp"
#include "apps/server/scene.hpp"
#include "apps/server/server.hpp"
#include "apps/server/textures.hpp"
#include "mansard/base/result.hpp"
#include "mansard/formats/ground_picture.hpp"

namespace mansard::server {

/// The text of an answer, or the diagnostic of the refusal.
using Text = base::Result<std::string>;

/// Every function may be called from any thread. `client` is the id of the browser tab that a change comes from.
class Workspace {
 public:
  /// `sample`: a folder with meshes and footprints; empty for none. If the project has inputs, they are read again in
  /// the background. Fails with "server-project", "file-…".
  [[nodiscard]] static auto open(Project project, std::filesystem::path sample)
      -> base::Result<std::unique_ptr<Workspace>>;
  ~Workspace();
  /// Stops the running job and disconnects every listener. Files on disk stay as they are.
  void stop();

  [[nodiscard]] auto status() const -> Text;
  [[nodiscard]] auto project() const -> Text;
  [[nodiscard]] auto jobs() const -> Text;
  [[nodiscard]] auto cancel(const std::string& job) -> Text;
  [[nodiscard]] auto listen() { return events_.listen(); }

  [[nodiscard]] auto open_inputs(const InputsRequest& request) -> Text;
  [[nodiscard]] auto open_sample() -> Text;
  /// The path of an uploaded file: in the folder of the inputs, or in one of its subfolders "2", "3" …, so that files
  /// that belong together stay together when one of their names is taken. `length` in bytes, if known. Fails with
  /// "server-upload", "server-exists" (another file has the name), "file-write".
  [[nodiscard]] auto upload_path(const std::string& name, const std::optional<std::string>& folder,
                                 const std::optional<std::uint64_t>& length) const
      -> base::Result<std::filesystem::path>;

  [[nodiscard]] auto scene() const -> Text;
  [[nodiscard]] auto tiles() const -> Text;
  [[nodiscard]] auto tile(const std::string& id) const -> Text;
  /// Reads the textures of the scan, once; the others need them and fail with "server-no-textures" without.
  [[nodiscard]] auto read_textures() -> Text;
  [[nodiscard]] auto tile_texture(const std::string& id) const -> Text;
  [[nodiscard]] auto building_texture(const std::string& run, const std::string& building) -> Text;

  [[nodiscard]] auto start_run(const RunRequest& request) -> Text;
  /// Opens models that mansard wrote as a finished run. If there is a scene, they are moved into its frame.
  [[nodiscard]] auto import_model(const ImportRequest& request) -> Text;
  [[nodiscard]] auto remove_run(const std::string& run) -> Text;
  [[nodiscard]] auto rename_run(const std::string& run, const std::string& label) -> Text;
  [[nodiscard]] auto report(const std::string& run) const -> Text;
  /// All buildings, or one.
  [[nodiscard]] auto buildings(const std::string& run, const std::optional<std::string>& building) -> Text;
  /// Of a large run: what a page needs of every building, those in a tile, and those that a search finds.
  [[nodiscard]] auto list(const std::string& run) -> Text;
  [[nodiscard]] auto tile_of_models(const std::string& run, const std::string& name) -> Text;
  [[nodiscard]] auto search(const std::string& run, const std::string& words) -> Text;
  [[nodiscard]] auto layers(const std::string& run) const -> Text;
  /// The scores of the run as it is now; as it was reconstructed if nothing was edited.
  [[nodiscard]] auto scores(const std::string& run) -> Text;
  [[nodiscard]] auto error_maps(const std::string& run) const -> Text;
  [[nodiscard]] auto error_map(const std::string& run, const std::string& block) -> Text;

  [[nodiscard]] auto section(const std::string& run, const PartName& part, std::size_t ring, std::size_t edge,
                             double share) -> Text;
  [[nodiscard]] auto section(const std::string& run, const SectionRequest& request) -> Text;
  [[nodiscard]] auto preview(const std::string& run, const std::vector<edit::Change>& changes) -> Text;
  [[nodiscard]] auto unedited(const std::string& run) -> Text;
  [[nodiscard]] auto roofs(const std::string& run, const RoofsRequest& request) -> Text;
  [[nodiscard]] auto split(const std::string& run, const SplitRequest& request) -> Text;
  [[nodiscard]] auto merge(const std::string& run, const MergeRequest& request) -> Text;
  [[nodiscard]] auto apply(const std::string& run, edit::Edit edit, const std::string& client) -> Text;
  /// Applies the edits of another run to this one, building by building; answers which could not be and why.
  [[nodiscard]] auto carry_over(const std::string& run, const std::string& from, const std::string& client) -> Text;
  [[nodiscard]] auto undo(const std::string& run, const std::string& client) -> Text;
  [[nodiscard]] auto redo(const std::string& run, const std::string& client) -> Text;

  [[nodiscard]] auto column(const std::string& run, const std::string& attribute) -> Text;
  /// The attributes of all buildings and parts as they are now, or of one building, with units and meanings.
  [[nodiscard]] auto attributes(const std::string& run, const std::optional<std::string>& building) -> Text;
  /// The buildings at a lower level of detail: "1.2", "1.3" or "2.0".
  [[nodiscard]] auto level(const std::string& run, const std::string& lod) -> Text;
  /// The basemap in the frame of the run, as openapi.json describes it. Fails with "server-no-basemap" without one, and
  /// as formats::read_ground_picture and read_ground_tiles do.
  [[nodiscard]] auto basemap(const std::string& run) -> Text;
  void set_basemap(Basemap basemap) { basemap_ = std::move(basemap); }
  /// The terrain around the models as they are.
  [[nodiscard]] auto terrain(const std::string& run) -> Text;
  /// Models of any producer, in the frame of the scene, to be shown beside those of a run. Nothing is stored.
  [[nodiscard]] auto other_model(const ImportRequest& request) -> Text;
  /// What makes mesh and footprints match: a CRS, or an offset of the mesh. Reads the inputs as a whole.
  [[nodiscard]] auto alignment(const InputsRequest& request) const -> Text;

  /// The decisions on the buildings of a run, and which of them have lapsed.
  [[nodiscard]] auto review(const std::string& run) -> Text;
  /// Those of the project, as its file has them.
  [[nodiscard]] auto review_of_project() const -> Text;
  [[nodiscard]] auto review_case(const std::string& run, const std::string& building) -> Text;
  /// Fails with "edit-stale" where the building is not the one that was looked at any more.
  [[nodiscard]] auto decide(const std::string& run, const ReviewRequest& request, const std::string& client) -> Text;
  /// Adds the decisions of a file of another person.
  [[nodiscard]] auto merge_review(const std::string& text, const std::string& client) -> Text;
  void set_reviewer(std::string reviewer) { reviewer_ = std::move(reviewer); }

  [[nodiscard]] auto export_file(const std::string& run, const std::string& file) -> Text;
  [[nodiscard]] auto export_all(const std::string& run, const ExportRequest& request) -> Text;

 private:
  struct Run {
    RunRecord record;
    std::size_t edits = 0;
    std::shared_ptr<std::mutex> opening = std::make_shared<std::mutex>();
    std::shared_ptr<Models> models;  ///< opened on first use
  };

  Workspace(Project project, std::filesystem::path sample);

  // The scene. With `save`, the inputs become those of the project.
  auto start_reading(const Inputs& inputs, bool save) -> Job;
  [[nodiscard]] auto read_scene(Inputs inputs, bool save, const base::Run& run) -> base::Result<void>;
  void measure_edited();
  /// Opens what was kept of the scene, if its inputs are as they were.
  void open_kept_view();
  [[nodiscard]] auto kept_view_file() const -> std::filesystem::path;
  /// What pages show: of the scene, or kept until there is one.
  [[nodiscard]] auto view_or_error() const -> base::Result<std::shared_ptr<const SceneView>>;
  [[nodiscard]] auto has_sample() const -> bool;
  [[nodiscard]] auto scene_now() const -> SceneOrNone;
  [[nodiscard]] auto scene_or_error() const -> base::Result<SceneOrNone>;
  [[nodiscard]] auto textures_or_error() const -> base::Result<std::shared_ptr<const Textures>>;

  // Runs. `Make` computes the outcome of a run from its record.
  using Make = std::function<base::Result<RunOutcome>(RunRecord, const base::Run&)>;
  [[nodiscard]] auto submit(Run run, Make make) -> Text;
  [[nodiscard]] auto carry_out(const std::string& id, const Make& make, const base::Run& run) -> base::Result<void>;
  void ended(const std::string& id, State state, const std::optional<base::Diagnostic>& failure);
  [[nodiscard]] auto find(const std::string& run) const -> const Run*;  // with mutex_ held, as the next one
  [[nodiscard]] auto find(const std::string& run) -> Run*;
  [[nodiscard]] auto record(const std::string& run) const -> base::Result<RunRecord>;
  [[nodiscard]] auto done(const std::string& run) const -> base::Result<RunRecord>;
  /// The run measured again after its edits; none if there are none, or it was imported and never measured.
  [[nodiscard]] auto measured(const RunRecord& run) -> base::Result<std::optional<Models::Measured>>;
  [[nodiscard]] auto models(const std::string& run) -> base::Result<std::shared_ptr<Models>>;
  [[nodiscard]] auto layers_file(const std::string& run) const -> base::Result<std::optional<std::string>>;

  // Edits. `send_change` sends the change to every page and returns the answer for the page that made it.
  [[nodiscard]] auto change(const std::string& run, const std::string& client,
                            const std::function<base::Result<Changed>(Models&, const OpenScene*)>& make) -> Text;
  [[nodiscard]] auto send_change(const std::string& run, const Changed& changed, const std::string& client)
      -> std::string;

  // Decisions. `reviewed`: the city with those that hold as attributes.
  [[nodiscard]] auto decisions() const -> std::shared_ptr<const report::Decisions>;
  /// Those that hold, as attributes by building.
  [[nodiscard]] auto decided(const Models& models) const -> std::map<std::string, model::Attributes, std::less<>>;
  [[nodiscard]] auto reviewed(std::shared_ptr<const model::City> city, const Models& models) const
      -> std::shared_ptr<const model::City>;
  /// With review_mutex_ held.
  [[nodiscard]] auto keep_decisions(report::Decisions now, const std::string& client) -> base::Result<void>;

  [[nodiscard]] auto files_json(const std::vector<KnownFile>& files) const -> Json;
  [[nodiscard]] auto project_json() const -> Json;
  void send_project();

  std::filesystem::path sample_;
  mutable std::mutex mutex_;  // guards the next five; held for moments only
  Project project_;
  std::vector<Run> runs_;
  SceneOrNone scene_;
  /// Of the project as it was when it was last open, until the inputs have been read.
  std::shared_ptr<const SceneView> kept_view_;
  Basemap basemap_;  ///< set before anything is asked
  std::mutex basemap_mutex_;
  std::map<std::string, formats::GroundPicture, std::less<>> basemaps_;  ///< by CRS; of tiles, by place as well
  std::shared_ptr<const Textures> textures_;                             // of the scene; null until they are asked for
  std::optional<base::Diagnostic> scene_failure_;
  mutable ChangedFiles changed_files_;
  std::string reviewer_;     ///< set before anything is asked
  std::mutex review_mutex_;  // of those who change the decisions
  std::shared_ptr<const report::Decisions> decisions_ =
      std::make_shared<const report::Decisions>();  // guarded by mutex_
  std::mutex exports_mutex_;
  std::atomic<std::uint64_t> next_work_ = 1;
  Events events_;
  Jobs jobs_;  // last: its thread uses the others
};

}  // namespace mansard::server
