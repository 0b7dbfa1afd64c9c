// A city being edited by hand: plans changed, split and merged, extruded again and measured at once, undone without
// limit.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/label/label.hpp"
#include "mansard/model/city.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::edit {

/// The attribute of buildings and parts that were edited, in exported files.
inline constexpr const char* edited_mark = "ms_edited";

struct NamedPlan {
  std::string id;  ///< of the part; unique in its building
  model::Plan plan;
  friend auto operator==(const NamedPlan&, const NamedPlan&) -> bool = default;
};

/// A building's parts as they shall be: all of them, in their order. None: the building loses its model.
struct Change {
  std::string building;
  std::uint64_t revision = 0;  ///< of the building that the change was made to
  std::vector<NamedPlan> parts;
  friend auto operator==(const Change&, const Change&) -> bool = default;
};

/// Done and undone as one: a merge of two neighbours changes two buildings.
struct Edit {
  std::string what;  ///< in words, for the list of edits: "gutter of b-12 to 7.40 m"
  std::vector<Change> changes;
  friend auto operator==(const Edit&, const Edit&) -> bool = default;
};

/// The plans of a building. Immutable: an edit makes others.
using Parts = std::shared_ptr<const std::vector<NamedPlan>>;

/// The plans that a history starts with, of a city that is not in memory.
class FirstPlans {
 public:
  FirstPlans() = default;
  FirstPlans(const FirstPlans&) = delete;
  auto operator=(const FirstPlans&) -> FirstPlans& = delete;
  virtual ~FirstPlans() = default;
  /// Null: there is no such building. From any thread.
  [[nodiscard]] virtual auto parts(std::string_view building) const -> Parts = 0;
};

/// Plans before and after every edit. Replaying the lines of a journal gives the same state again.
class History {
 public:
  /// Starts with the plans of the city; models and attributes play no part.
  explicit History(const model::City& city);
  /// Only the plans of buildings that were changed are in memory.
  explicit History(std::shared_ptr<const FirstPlans> first) : first_(std::move(first)) {}

  [[nodiscard]] auto parts(std::string_view building) const -> Parts;  ///< null: no such one
  /// How often the building changed, by edits, undo or redo; what a Change has to name. 0 where there is no such one.
  [[nodiscard]] auto revision(std::string_view building) const -> std::uint64_t;
  /// Whether the building's plans differ from those that it started with.
  [[nodiscard]] auto edited(std::string_view building) const -> bool;
  /// What was done, oldest first; the first `done()` of them stand, the rest can be redone.
  [[nodiscard]] auto edits() const -> const std::vector<Edit>&;
  [[nodiscard]] auto done() const -> std::size_t;

  /// What could be redone is forgotten. That the plans can be raised is the caller's to check: see raise(). All of the
  /// edit or nothing. Fails with "edit-building" (no such building, or named twice), "edit-stale" (its revision is
  /// another: someone else changed it), "edit-empty" (no change, or none that changes anything), "edit-duplicate-id".
  [[nodiscard]] auto apply(Edit edit) -> base::Result<void>;
  /// The buildings that changed. Fails with "edit-nothing" where there is nothing to undo or redo.
  [[nodiscard]] auto undo() -> base::Result<std::vector<std::string>>;
  [[nodiscard]] auto redo() -> base::Result<std::vector<std::string>>;

  friend auto operator==(const History& a, const History& b) -> bool {
    return a.first_ == b.first_ && a.buildings_ == b.buildings_ && a.edits_ == b.edits_ && a.done_ == b.done_ &&
           std::ranges::equal(a.before_, b.before_, [](const auto& x, const auto& y) {
             return std::ranges::equal(x, y, [](const Parts& one, const Parts& other) { return *one == *other; });
           });
  }

 private:
  struct State {
    std::uint64_t revision = 0;
    Parts parts;
    Parts first{};  ///< since the first change: most buildings never have one
    friend auto operator==(const State& a, const State& b) -> bool {
      const auto same = [](const Parts& x, const Parts& y) { return x && y ? *x == *y : x == y; };
      return a.revision == b.revision && same(a.parts, b.parts) && same(a.first, b.first);
    }
  };
  /// Puts plans in place of a building's own, which come back.
  auto replace(const std::string& building, Parts parts) -> Parts;

  std::shared_ptr<const FirstPlans> first_;  // null: `buildings_` has all
  std::map<std::string, State, std::less<>> buildings_;
  std::vector<Edit> edits_;
  std::vector<std::vector<Parts>> before_;  // per edit, per change
  std::size_t done_ = 0;
};

/// One line of a journal, without its line break: an edit, or "undo", or "redo".
[[nodiscard]] auto journal_line(const Edit& edit) -> std::string;
inline constexpr std::string_view undo_line = R"({"undo":true})", redo_line = R"({"redo":true})";
/// Replays a journal. A last line that is cut short (no line break) is dropped, as a crash leaves it. Anything else
/// that cannot be read fails with "edit-journal" and the number of the line. `kept` is how many bytes of the journal
/// count: the file is to be cut there before more is appended.
struct Replayed {
  History history;
  std::size_t kept = 0;
};
[[nodiscard]] auto replay(const model::City& city, std::string_view journal) -> base::Result<Replayed>;
[[nodiscard]] auto replay(History start, std::string_view journal) -> base::Result<Replayed>;

/// How many edits of a journal are applied after its undos and redos. Cost: the plans are not parsed.
[[nodiscard]] auto applied_edits(std::string_view journal) -> std::size_t;

/// A building's parts raised, labelled and measured. What cannot be extruded has no solid and says why.
struct RaisedPart {
  std::string id;
  std::optional<model::LabelledSolid> model;
  extrude::Outcome outcome = extrude::Outcome::full;  ///< anything but `full` is not what the plan asks for
  std::vector<base::Diagnostic> diagnostics;
  std::optional<double> mse;  ///< m², vertical, over its polygon; none where the mesh shows nothing
  double volume = 0;          ///< m³
};
struct RaisedBuilding {
  std::vector<RaisedPart> parts;
  /// Of the parts together, the subject the part's id: "edit-overlap" where they or `neighbours` share ground,
  /// "edit-duplicate-id".
  std::vector<base::Diagnostic> diagnostics;
  /// m², vertical: over the footprint as `mansard evaluate` measures it, ground without a model counting as missed, so
  /// that an edit cannot lower the error by covering less. Over the parts, weighted by area, without a footprint.
  std::optional<double> mse;
  /// Every part has a checked solid and nothing above is an error: may be written.
  [[nodiscard]] auto valid() const -> bool;
};
/// What stands around the parts, and what is known of them.
struct Site {
  /// Plans of other buildings: for party walls and overlap. May be all there are; those far away cost a glance.
  std::span<const model::Plan> neighbours;
  /// The building's parts as they stand: where these share ground already, as much of it is not held against a change.
  std::span<const NamedPlan> before;
  const rays::Scene* mesh = nullptr;                  ///< null: nothing is measured
  std::span<const geometry::Polygon> footprint = {};  ///< of the building
  double ground = 0;                                  ///< z around the building, m
};
/// The parts as export and `mansard extrude` make them. Two parts overlap where more than 0.01 m² is left of what they
/// share after a centimetre is taken off all around: seams of two surveys are no error, strips wider than 2 cm are.
/// Cost: milliseconds for a house of ten corners.
[[nodiscard]] auto raise(std::span<const NamedPlan> parts, const Site& site, const pipeline::Options& options,
                         const base::Run& run = {}) -> RaisedBuilding;

/// The plan cut along a polyline that crosses its polygon: two plans or more, largest first. Edges keep their profiles;
/// those along the cut rise as a wall, all the way. Ends that stop within a centimetre of the outline are moved onto
/// it, crossings that near to a corner into the corner. What of the line divides nothing is left out. Fails with
/// "edit-split" (the line does not divide the polygon, crosses itself, or cuts off less than 0.01 m²).
[[nodiscard]] auto split(const model::Plan& plan, std::span<const geometry::Point2> line)
    -> base::Result<std::vector<model::Plan>>;

/// A building's parts with one of them split: its first piece keeps its id and place, the others follow it as the next
/// free "<building>-N". Fails as split() does, and with "edit-part" (no such part).
[[nodiscard]] auto split(std::string_view building, std::vector<NamedPlan> parts, std::string_view part,
                         std::span<const geometry::Point2> line) -> base::Result<std::vector<NamedPlan>>;

/// Two plans that share a wall as one. Edges keep their profiles, lifted where the bases differ: the lower base counts,
/// as does the higher cap. Corners that lie within a centimetre of the other's outline are taken to be on it; a corner
/// that only the wall needed goes. Fails with "edit-merge" (they do not touch along 0.1 m, overlap, or touch
/// elsewhere in a single point).
[[nodiscard]] auto merge(const model::Plan& first, const model::Plan& second) -> base::Result<model::Plan>;

/// The mesh cut by a vertical plane: pieces as (inward, height) of the foot's frame, metres, those with |inward| at
/// most `reach` and heights at most `reach` below it.
struct Section {
  std::vector<std::array<model::ProfilePoint, 2>> pieces;
};
/// Across an edge at `share` (0 … 1) of its length, at right angles; heights above `base`. Cost: O(triangles).
[[nodiscard]] auto section(const geometry::Mesh& mesh, geometry::Point2 from, geometry::Point2 to, double share,
                           double base, double reach) -> Section;

/// The scan around a building, by its id; may be null. Called from several threads.
using MeshOf = std::function<const rays::Scene*(std::string_view)>;

/// The city of a run as it was edited, for export: every plan extruded again and all labelled together, as `mansard
/// extrude` does with its plans.json, and attributes that are true of it. Parts whose plans are not those of the run,
/// and their buildings, have `ms_edited`; the others keep their attributes but for what a neighbour's edit changes, the
/// areas of walls and party walls. Without edits it is the run's city. Fails as pipeline::raise_plans does.
[[nodiscard]] auto edited_city(const model::City& city, const History& history, const MeshOf& mesh_of,
                               const pipeline::Options& options, const base::Run& run = {})
    -> base::Result<model::City>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::edit
