// The project while it is served: the scene, the runs, the jobs, and what the pages are told.
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

#include "apps/server/events.hpp"
#include "apps/server/jobs.hpp"
#include "apps/server/models.hpp"
#include "apps/server/outcome.hpp"
#include "apps/server/project.hpp"
#include "apps/server/requests.hpp"
#include "apps/server/scene.hpp"
#include "mansard/base/result.hpp"

namespace mansard::server {

/// A JSON text, or why there is none.
using Text = base::Result<std::string>;

/// Every function may be called from any thread. `client` names the tab that a change came from.
class Workspace {
 public:
  /// `sample`: a folder with meshes and footprints, empty for none. Inputs that the project has are read again at once,
  /// in the background. Gives up with "server-project", "file-…".
  [[nodiscard]] static auto open(Project project, std::filesystem::path sample)
      -> base::Result<std::unique_ptr<Workspace>>;
  ~Workspace();
  /// Ends the job in hand, and lets every listener go. What is on the disk stays as it is.
  void stop();

  [[nodiscard]] auto status() const -> Text;
  [[nodiscard]] auto project() const -> Text;
  [[nodiscard]] auto jobs() const -> Text;
  [[nodiscard]] auto cancel(const std::string& job) -> Text;
  [[nodiscard]] auto listen() { return events_.listen(); }

  [[nodiscard]] auto open_inputs(const InputsRequest& request) -> Text;
  [[nodiscard]] auto open_sample() -> Text;
  /// Where an upload of that name goes. Gives up with "server-upload".
  [[nodiscard]] auto upload_path(const std::string& name) const -> base::Result<std::filesystem::path>;

  [[nodiscard]] auto scene() const -> Text;
  [[nodiscard]] auto tiles() const -> Text;
  [[nodiscard]] auto tile(const std::string& id) const -> Text;

  [[nodiscard]] auto start_run(const RunRequest& request) -> Text;
  /// Models that mansard wrote, as a run of their own. They are in the frame of the scene where there is one.
  [[nodiscard]] auto import_model(const ImportRequest& request) -> Text;
  [[nodiscard]] auto remove_run(const std::string& run) -> Text;
  [[nodiscard]] auto rename_run(const std::string& run, const std::string& label) -> Text;
  [[nodiscard]] auto report(const std::string& run) const -> Text;
  [[nodiscard]] auto buildings(const std::string& run) -> Text;
  [[nodiscard]] auto layers(const std::string& run) const -> Text;
  [[nodiscard]] auto error_maps(const std::string& run) const -> Text;
  [[nodiscard]] auto error_map(const std::string& run, const std::string& block) const -> Text;

  [[nodiscard]] auto section(const std::string& run, const PartName& part, std::size_t ring, std::size_t edge,
                             double share) -> Text;
  [[nodiscard]] auto section(const std::string& run, const SectionRequest& request) -> Text;
  [[nodiscard]] auto preview(const std::string& run, const std::vector<edit::Change>& changes) -> Text;
  [[nodiscard]] auto split(const std::string& run, const SplitRequest& request) -> Text;
  [[nodiscard]] auto merge(const std::string& run, const MergeRequest& request) -> Text;
  [[nodiscard]] auto apply(const std::string& run, edit::Edit edit, const std::string& client) -> Text;
  [[nodiscard]] auto undo(const std::string& run, const std::string& client) -> Text;
  [[nodiscard]] auto redo(const std::string& run, const std::string& client) -> Text;

  [[nodiscard]] auto export_file(const std::string& run, const std::string& file) -> Text;
  [[nodiscard]] auto export_all(const std::string& run, const ExportRequest& request) -> Text;

 private:
  struct Run {
    RunRecord record;
    std::size_t edits = 0;
    std::shared_ptr<std::mutex> opening = std::make_shared<std::mutex>();
    std::shared_ptr<Models> models;  ///< once somebody looked
  };
  struct InputState {  ///< of a file, as it was when it was last hashed
    Stamp stamp;
    bool changed = false;
  };

  Workspace(Project project, std::filesystem::path sample);
  auto read_again(const Inputs& inputs, bool save) -> Job;
  [[nodiscard]] auto read_scene(Inputs inputs, bool save, const base::Run& run) -> base::Result<void>;
  /// The outcome of a run, of the record that it has now.
  using Make = std::function<base::Result<RunOutcome>(RunRecord, const base::Run&)>;
  [[nodiscard]] auto submit(Run run, Make make) -> Text;
  [[nodiscard]] auto carry_out(const std::string& id, const Make& make, const base::Run& run) -> base::Result<void>;
  void ended(const std::string& id, State state, const std::optional<base::Diagnostic>& failure);
  void measure_what_was_edited();

  [[nodiscard]] auto changed(const KnownFile& file) const -> bool;
  [[nodiscard]] auto files_json(const std::vector<KnownFile>& files) const -> Json;
  [[nodiscard]] auto project_json() const -> Json;
  [[nodiscard]] auto sample_at_hand() const -> bool;
  void tell_project();

  [[nodiscard]] auto scene_now() const -> SceneOrNone;
  [[nodiscard]] auto scene_or_why() const -> base::Result<SceneOrNone>;
  [[nodiscard]] auto record(const std::string& run) const -> base::Result<RunRecord>;
  [[nodiscard]] auto done(const std::string& run) const -> base::Result<RunRecord>;
  [[nodiscard]] auto models(const std::string& run) -> base::Result<std::shared_ptr<Models>>;
  [[nodiscard]] auto layers_of(const std::string& run) const -> base::Result<std::optional<std::string>>;
  [[nodiscard]] auto find(const std::string& run) const -> const Run*;
  [[nodiscard]] auto find(const std::string& run) -> Run*;
  [[nodiscard]] auto answer(const std::string& run, const Changed& changed, const std::string& client) -> std::string;

  std::filesystem::path sample_;
  mutable std::mutex mutex_;  // of what follows until the next one; held for moments
  Project project_;
  std::vector<Run> runs_;
  SceneOrNone scene_;
  std::optional<base::Diagnostic> scene_failure_;
  mutable std::mutex inputs_mutex_;
  mutable std::map<std::string, InputState> input_states_;
  std::mutex exports_mutex_;
  std::atomic<std::uint64_t> next_work_ = 1;
  Events events_;
  Jobs jobs_;  // last: its thread uses the others
};

}  // namespace mansard::server
