// What a run made and how it went, per block and per building, and its report as JSON.
//
// Guarantees: 1 everything in the report but the members called "times" is the same in every run of the same scene,
// options and seed · 2 every input feature is in it once, in the order of the source · 3 the terms of a block's
// objective add up to its total. Cost: linear in blocks and buildings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/watch.hpp"
#include "mansard/confidence/confidence.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/fracture/fracture.hpp"
#include "mansard/label/label.hpp"
#include "mansard/model/accuracy.hpp"
#include "mansard/model/city.hpp"
#include "mansard/model/scene.hpp"
#include "mansard/refine/refine.hpp"
#include "mansard/segment/segment.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::report {

/// What a stage took, of a block or of all blocks. Blocks run side by side: over several, the stages' times by the
/// clock overlap and do not add up to the total.
struct StageTime {
  std::string stage;
  base::Spent spent;
};

/// Reading and writing files are not included.
struct Times {
  base::Spent total;  ///< also of what belongs to no stage
  std::vector<StageTime> stages;
};

/// What a run took over from an earlier one, and what it made anew although an earlier one had made it.
struct Reuse {
  std::size_t blocks = 0;                                 ///< taken over
  std::vector<std::pair<std::string, std::string>> made;  ///< block and why, as pipeline::KeptBlocks::why_made says
};

/// Table 1 of the paper, for one block.
struct BlockReport {
  std::string name;
  std::size_t buildings = 0, parts = 0;
  std::size_t triangles = 0, slices = 0, slice_segments = 0, sweep_edges = 0, faces = 0, inside_faces = 0;
  std::size_t candidates = 0, variables = 0, conflicts = 0;
  segment::Terms terms;
  double objective = 0, bound = 0;
  std::string status;
  std::int64_t rounds = 0, nodes = 0;
  model::Accuracy accuracy;  ///< of the scan over it
  evaluate::Scores scores;
  Times times;
};

/// (objective − bound) / |objective|: how much cheaper, at most, a segmentation of the block could be. 0 without a gap,
/// and where nothing costs anything.
[[nodiscard]] auto relative_gap(const BlockReport& block) -> double;

/// What a block's walls were chosen from, and how.
struct SegmentedBlock {
  std::string name;
  std::vector<std::size_t> features;  ///< indices into Scene::footprints
  std::vector<sweep::SweepEdge> sweep_edges;
  fracture::Arrangement arrangement;                  ///< empty where the ground could not be fractured
  std::optional<segment::Segmentation> segmentation;  ///< none where the block failed
  std::optional<base::Diagnostic> failure;            ///< why there is none: "pipeline-block"
};

enum class Outcome : std::uint8_t {
  full,      ///< every part was extruded along its full profiles
  fallback,  ///< at least one part is a simpler solid; the reason says why
  covered,   ///< its ground went to neighbouring buildings; no solid of its own
  refused,   ///< the footprint cannot be used
};
[[nodiscard]] auto to_string(Outcome outcome) -> std::string_view;

struct BuildingReport {
  std::string id, block;
  Outcome outcome = Outcome::full;
  bool derived = false;  ///< its footprint was derived from the mesh
  std::vector<base::Diagnostic> reasons;
  std::size_t parts = 0;
  double ground = 0, roof_min = 0, roof_max = 0;  ///< z, metres, file frame
  std::optional<double> ground_mean, ground_max;  ///< z along its walls, where terrain or scan shows them
  std::string ground_source;                      ///< what says that ground: block::GroundSource; empty without a block
  double volume = 0;                              ///< m³
  label::Areas areas;
  std::optional<double> rmse;                        ///< m, vertical, over its parts; none without mesh coverage
  std::optional<confidence::Evidence> evidence;      ///< of a model that was made with a scan
  std::optional<confidence::Confidence> confidence;  ///< by that
  std::optional<refine::SearchWork> search;          ///< of a model whose roofs were looked for in a scan
  double left_out = 0;            ///< m² of the footprint that are high enough for a building and have no model
  std::string roof, height_from;  ///< the shape made and where its height comes from; only of models without a mesh
};

/// How many buildings ended in each outcome.
struct Outcomes {
  std::size_t full = 0, fallback = 0, covered = 0, refused = 0;
  void add(Outcome outcome);
  [[nodiscard]] auto all() const -> std::size_t { return full + fallback + covered + refused; }
};

/// Two solids that share ground.
struct Overlap {
  std::string first, second;                ///< their first parts
  double area = 0, height = 0;              ///< m² of ground, and m of height that both have
  std::vector<geometry::Polygon> polygons;  ///< the ground that they share; m, in the frame
};

/// A run without its buildings.
struct Summary {
  std::vector<BlockReport> blocks;
  Times times;
  Reuse reuse;
  evaluate::Scores scores;  ///< over all blocks, weighted by cells
  std::vector<base::Diagnostic> warnings;
  std::vector<Overlap> overlaps;  ///< all that were found, in the order of the buildings
};

/// Of all its blocks together; none where a run has no blocks of its own (a city in tasks).
[[nodiscard]] auto accuracy_of(const Summary& summary) -> std::optional<model::Accuracy>;

struct Reconstruction : Summary {
  model::City city;
  std::vector<BuildingReport> buildings;       ///< every input feature, in the source's order
  std::vector<evaluate::ErrorMap> error_maps;  ///< per block
  std::vector<SegmentedBlock> segmented;       ///< per block with Keep::segmentations, else empty
};
[[nodiscard]] auto outcomes(const Reconstruction& reconstruction) -> Outcomes;

/// Every block up to its segmentation, without models.
struct Segmented {
  model::MadeBy made_by;
  std::vector<BlockReport> blocks;        ///< without scores
  std::vector<SegmentedBlock> segmented;  ///< per block
  Times times;
  std::vector<base::Diagnostic> warnings;
};

/// How many parts each feature got: by Scene::footprints.
[[nodiscard]] auto parts_by_feature(const model::Scene& scene, const std::vector<SegmentedBlock>& blocks)
    -> std::vector<std::size_t>;

/// The report as JSON, building by building: memory does not grow with their number. `sink` must outlive it.
class RunJson {
 public:
  RunJson(const Summary& summary, const Outcomes& outcomes, const model::MadeBy& made_by, const model::Scene& scene,
          base::Sink& sink);
  void add(const BuildingReport& building);
  /// After the last one.
  void finish();

 private:
  base::Sink& sink_;
  bool first_ = true;
};

/// The report as JSON. Everything but the members called "times" is the same in every run. Without a mesh it has no
/// "mesh", "scores" and "blocks".
[[nodiscard]] auto run_json(const Reconstruction& reconstruction, const model::Scene& scene) -> std::string;
/// The same for blocks without models: no "scores", no "buildings".
[[nodiscard]] auto run_json(const Segmented& segmented, const model::Scene& scene) -> std::string;

}  // namespace mansard::report
