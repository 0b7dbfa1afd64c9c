// The models of an open run with its edits: shown, previewed and changed.
//
//   models.cpp        queries, previews and proposals
//   models_list.cpp   large runs: the list of buildings, tiles, search
//   models_open.cpp   from the files of the run
//   models_edits.cpp  edits, undo, redo
//   models_scores.cpp the scores of the edited models
//   models_kept.cpp   what was measured, kept in the folder of the run
//   models_roofs.cpp  roofs in one step
//   models_review.cpp what a person who reviews a building is shown beside it
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "apps/server/disk.hpp"
#include "apps/server/json.hpp"
#include "apps/server/project.hpp"
#include "apps/server/requests.hpp"
#include "apps/server/run_buildings.hpp"
#include "apps/server/scene.hpp"
#include "mansard/base/result.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/review.hpp"

namespace mansard::server {

using SceneOrNone = std::shared_ptr<const OpenScene>;

/// What an edit, an undo or a redo changed.
struct Changed {
  std::string buildings;    ///< an array of Building
  Json history;             ///< History
  std::size_t applied = 0;  ///< edits, after undos
};

/// Readers use the state at that moment; they neither wait for an edit nor delay one. Edits run one after the other,
/// and each is on disk before it becomes visible.
class Models {
 public:
  /// Runs with more buildings than this are large: their models are made when they are asked for.
  static constexpr std::size_t most_at_once = 5'000;

  /// From the files in the folder of the run. An incomplete last line of the journal is cut off. Fails with
  /// "edit-journal", "server-project", "write-plan-…", "file-…". Cost: every plan is extruded, on all threads; of a
  /// large run only those of edited buildings, and its plans stay in their file. All functions of a large
  /// run may throw Unreadable.
  /// `inputs`: what key_of gives of the scene's. What was measured with the same inputs is not measured again.
  [[nodiscard]] static auto open(const std::filesystem::path& folder, const RunRecord& run, const SceneOrNone& scene,
                                 const std::string& inputs) -> base::Result<std::shared_ptr<Models>>;

  /// {"buildings": …, "history": …}
  [[nodiscard]] auto all() const -> std::string;
  /// The same with one building. Fails with "edit-building".
  [[nodiscard]] auto single(const std::string& building) const -> base::Result<std::string>;
  /// What a page needs of every building, without plans and models: BuildingList.
  [[nodiscard]] auto list() const -> std::string;
  /// The buildings in a tile of the list: those whose box in plan has its centre there.
  [[nodiscard]] auto tile(std::int64_t column, std::int64_t row) const -> std::string;
  /// AttributeColumn: the values of one attribute of all buildings, in the order of the list; of an attribute of parts
  /// that of the first part that has it. Attributes that mansard computed are null where the building was edited since.
  /// `more` as for `search`. Fails with "server-unknown" where no building has it.
  [[nodiscard]] auto column(const std::string& attribute,
                            const std::map<std::string, model::Attributes, std::less<>>& more) const
      -> base::Result<std::string>;
  /// {"ids": …}: the buildings with every word in their id, block, outcome or attributes, as the page finds them.
  /// `more`: attributes of buildings that are not in the files of the run, by id.
  [[nodiscard]] auto search(const std::string& words,
                            const std::map<std::string, model::Attributes, std::less<>>& more) const -> std::string;
  /// {"buildings": [RaisedBuilding]}. Fails with "edit-building".
  [[nodiscard]] auto preview(const std::vector<edit::Change>& changes, const OpenScene* scene) const
      -> base::Result<std::string>;
  /// {"buildings": [RaisedBuilding]}: those that were edited, as they were before all edits, with revision 0.
  [[nodiscard]] auto unedited(const OpenScene* scene) const -> std::string;
  /// {"roofs": …}: plans with the best roofs of a kind for the scan, each among the parts as they are now; applies
  /// nothing. What cannot have such a roof has none, and says why. Fails with "edit-building", "edit-unseen".
  [[nodiscard]] auto roofs(const RoofsRequest& request, const OpenScene* scene) const -> base::Result<std::string>;
  /// Proposals. They fail with "edit-building", "edit-part", "edit-split", "edit-merge".
  [[nodiscard]] auto split(const SplitRequest& request) const -> base::Result<std::string>;
  [[nodiscard]] auto merge(const MergeRequest& request) const -> base::Result<std::string>;
  /// Fails with "edit-building", "edit-part".
  [[nodiscard]] auto plan_of(const PartName& name) const -> base::Result<model::Plan>;

  /// The plans of the buildings that were edited. Buildings that one edit changed together, as a merge does, are
  /// together: half of such an edit may leave ground without a model.
  [[nodiscard]] auto edited_plans() -> std::vector<std::vector<edit::Change>>;
  /// The edit that gives buildings the plans of `wanted`; none if they have them. Fails with "edit-building".
  [[nodiscard]] auto edit_to(const std::vector<edit::Change>& wanted, const std::string& what) const
      -> base::Result<std::optional<edit::Edit>>;
  /// Fails with "edit-invalid", and as edit::History::apply and Journal::append do.
  [[nodiscard]] auto apply(edit::Edit edit, const OpenScene* scene) -> base::Result<Changed>;
  [[nodiscard]] auto undo(const OpenScene* scene) -> base::Result<Changed>;
  [[nodiscard]] auto redo(const OpenScene* scene) -> base::Result<Changed>;
  /// Measures the buildings that were edited while there was no scene; none if there were none.
  [[nodiscard]] auto measure(const OpenScene& scene) -> std::optional<Changed>;

  /// The scores and the error map of the models as they are now, block by block; only blocks in which something changed
  /// since the last call are measured again. `blocks`: the names of those that the run reconstructed.
  struct Measured {
    std::vector<std::shared_ptr<const evaluate::Comparison>> blocks;  ///< in the order of the names
    std::size_t applied = 0;                                          ///< edits
  };
  [[nodiscard]] auto measured(const std::vector<std::string>& blocks, const SceneOrNone& scene)
      -> base::Result<Measured>;

  /// The edited city around one building: that building first, then those whose walls may touch its own.
  [[nodiscard]] auto edited_around(const std::string& building, const SceneOrNone& scene) const
      -> base::Result<model::City>;
  /// The edited city, for export. Fails as edit::edited_city does.
  [[nodiscard]] auto edited(const SceneOrNone& scene) -> base::Result<std::shared_ptr<const model::City>>;

  /// The solids of a building as it is now, part by part, and its revision. Fails with "edit-building".
  struct Solids {
    std::uint64_t revision = 0;
    std::vector<model::LabelledSolid> models;
  };
  [[nodiscard]] auto solids_of(const std::string& building) const -> base::Result<Solids>;

  /// What a person who reviews the building is shown beside it: ReviewCase of openapi.json. Fails with "edit-building".
  [[nodiscard]] auto review_case(const std::string& building, const OpenScene* scene) const
      -> base::Result<std::string>;
  /// model_key and revision of a building as it is now; none for an unknown one.
  struct ModelNow {
    std::string model;
    std::uint64_t revision = 0;
    bool changed = false;  ///< its plans are not those of the run
  };
  [[nodiscard]] auto model_now(std::string_view building) const -> std::optional<ModelNow>;

  [[nodiscard]] auto frame() const -> const model::Frame& { return first_->frame(); }
  /// The box of all plans, in the frame; empty if there are none.
  [[nodiscard]] auto extent() const -> geometry::Box2;
  [[nodiscard]] auto options() const -> const pipeline::Options& { return options_; }

 private:
  /// A building in one state. Immutable: the next state has another.
  struct Seen {
    std::string id;
    std::uint64_t revision = 0;
    edit::Parts parts;  ///< null: those of the run, in its file
    geometry::Box2 box;
    bool edited = false;
    bool measured = false;
    double volume = 0;          ///< m³
    std::optional<double> mse;  ///< m²
    std::vector<std::optional<double>> mse_of_parts;
    bool made = false;  ///< whether the rest is there
    std::vector<model::LabelledSolid> models;
    std::string json;  ///< Building
  };
  struct View {
    std::vector<std::shared_ptr<const Seen>> buildings;  ///< in the source's order
    Json history;
    std::size_t applied = 0;   ///< edits
    std::uint64_t number = 0;  ///< of the state
  };

  Models(std::shared_ptr<const RunBuildings> first, edit::History history, Journal journal, pipeline::Options options);
  [[nodiscard]] auto parts_of(std::size_t building, const Seen& seen) const -> edit::Parts;
  [[nodiscard]] auto view() const -> std::shared_ptr<const View>;
  [[nodiscard]] auto read_reports(const std::filesystem::path& path) -> base::Result<void>;
  [[nodiscard]] auto raise_all(const OpenScene* scene) -> base::Result<void>;
  /// `index`: of a run whose plans are in a file; its columns of the report are taken.
  void take_reports(RunIndex& index);
  /// `errors` and `boxes`: of buildings that were not edited.
  void list_all(const OpenScene* scene, const std::vector<std::optional<double>>& errors,
                const std::vector<geometry::Box2>& boxes);
  /// Of the attributes of buildings, then of parts, then of decisions.
  [[nodiscard]] auto names() const -> std::vector<std::string>;
  /// The building with its models: from the view, or of a large run made now. Those made last are kept.
  [[nodiscard]] auto made(std::size_t at, const View& view) const -> std::shared_ptr<const Seen>;
  [[nodiscard]] auto made_all(const std::vector<std::size_t>& which, const View& view) const
      -> std::vector<std::shared_ptr<const Seen>>;
  /// m² of a part, as the run measured it over its polygon.
  [[nodiscard]] auto mse_of_run(const model::Building& building, std::size_t part) const -> std::optional<double>;
  [[nodiscard]] auto known(const edit::Change& change, const View& view) const -> base::Result<std::size_t>;
  [[nodiscard]] auto raised(const edit::Change& change, std::size_t at, const std::vector<edit::Change>& together,
                            const View& view, const OpenScene* scene) const -> edit::RaisedBuilding;
  [[nodiscard]] auto seen(const std::string& id, const edit::RaisedBuilding& raised, bool measured) const
      -> std::shared_ptr<const Seen>;
  [[nodiscard]] auto named(const std::string& id) const -> Seen;
  [[nodiscard]] auto with_models(Seen named, const edit::RaisedBuilding& raised) const -> std::shared_ptr<const Seen>;
  /// What was measured of a building, with all that it depends on as one hash.
  struct Measure {
    geometry::Box2 over;  ///< of what it was measured over: models of others there count
    std::string key;
    std::optional<double> mse;
    std::vector<std::optional<double>> mse_of_parts;
  };
  void read_measures();
  /// Hash of what the error over a box depends on. `plans`: one hash per building.
  [[nodiscard]] auto measure_key(std::size_t building, const geometry::Box2& over,
                                 const std::vector<std::string>& plans, const std::vector<geometry::Box2>& boxes) const
      -> std::string;
  void keep_measures(const OpenScene& scene) const;
  [[nodiscard]] auto publish(const std::vector<std::string>& changed, const OpenScene* scene) -> Changed;
  [[nodiscard]] auto step(base::Result<std::vector<std::string>> (edit::History::*one)(), std::string_view line,
                          const OpenScene* scene) -> base::Result<Changed>;

  std::shared_ptr<const RunBuildings> first_;  // before edits
  pipeline::Options options_;
  std::filesystem::path folder_;
  std::string inputs_;                                    // empty: nothing is kept
  std::map<std::string, Measure, std::less<>> measures_;  // as they were kept
  std::unordered_map<std::string_view, std::size_t> index_;
  std::set<std::string, std::less<>> strings_;  // of reports: most are of many buildings
  struct Report {
    const std::string* block = nullptr;
    const std::string* outcome = nullptr;
    const std::string* reasons = nullptr;  ///< an array of Diagnostic; empty for none
    double ground = 0, volume = 0;
    std::optional<double> confidence;  ///< probability that the model of the run is right
  };
  [[nodiscard]] auto shared(std::string_view text) -> const std::string*;
  std::vector<Report> reports_;  // what edits do not change, and the volume that the run measured

  std::mutex edits_;  // guards the next two
  edit::History history_;
  Journal journal_;

  mutable std::mutex view_mutex_;
  std::shared_ptr<const View> view_;

  /// Of a large run, by the buildings that they were made from.
  struct Kept {
    std::shared_ptr<const Seen> from, made;
  };
  mutable std::mutex kept_mutex_;
  mutable std::list<Kept> kept_;  // the last one first
  mutable std::map<const Seen*, std::list<Kept>::iterator> kept_at_;

  struct Block {
    std::vector<std::shared_ptr<const Seen>> buildings;  // that were measured
    std::shared_ptr<const evaluate::Comparison> comparison;
  };
  std::mutex measured_mutex_;
  SceneOrNone measured_with_;
  std::map<std::string, Block, std::less<>> measured_;  // by name

  struct Export {
    std::uint64_t number = 0;
    bool with_scene = false;
    std::shared_ptr<const model::City> city;
  };
  std::mutex export_mutex_;
  std::optional<Export> export_;  // of the state that was exported last
};

}  // namespace mansard::server
