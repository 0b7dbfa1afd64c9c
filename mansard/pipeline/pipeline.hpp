// The only room that knows the order: a scene in, a city of labelled models out, and a report of how it went.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/derive/derive.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/formats/layers.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/fracture/fracture.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/label/label.hpp"
#include "mansard/picture/picture.hpp"
#include "mansard/profile/profile.hpp"
#include "mansard/refine/refine.hpp"
#include "mansard/roof/roof.hpp"
#include "mansard/segment/segment.hpp"
#include "mansard/slice/slice.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::pipeline {

/// The options of every room. What a run means is these and its inputs.
struct Options {
  ingest::Options ingest;
  derive::Options derive;
  block::Options block;
  slice::Options slice;
  sweep::Options sweep;
  fracture::Options fracture;
  segment::Options segment;
  profile::Options profile;
  extrude::Options extrude;
  refine::Options refine;
  roof::Options roof;
  label::Options label;
  evaluate::Options evaluate;
  formats::WriteOptions write;

  std::int64_t seed = 1;
  double assumed_height = 3.0;  ///< m; of the prism of a footprint over which the mesh shows nothing
  double roof_grid = 0.5;       ///< m; sampling of roof heights for attributes
};

/// One list per room, bound to `options`, in the order of the house.
[[nodiscard]] auto option_lists(Options& options) -> std::vector<base::OptionList>;

/// A preset's changes to the defaults: "room.name" → value.
struct Preset {
  std::string name;
  std::string meaning;
  std::vector<std::pair<std::string, std::string>> values;
};
/// `paper` (the published numbers) and `chordatlas` (what the reference implementation runs).
[[nodiscard]] auto presets() -> const std::vector<Preset>&;

/// Sets "room.name". Gives up with "option-unknown" (names the nearest known one) or "option-value".
[[nodiscard]] auto set_option(std::vector<base::OptionList>& lists, std::string_view key, std::string_view value)
    -> base::Result<void>;

struct StageTime {
  std::string stage;
  double seconds = 0;  ///< summed over blocks; blocks run side by side, so this is work, not waiting
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
  evaluate::Scores scores;
  std::vector<StageTime> times;
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

/// What is kept beside the models: memory grows with the number of blocks when all their segmentations are.
enum class Keep : std::uint8_t { models, segmentations };

enum class Outcome : std::uint8_t {
  full,      ///< every part was raised from its full profiles
  fallback,  ///< at least one part is a simpler solid; the reason says why
  covered,   ///< its ground went to neighbouring buildings; no solid of its own
  refused,   ///< the footprint cannot be used
};
[[nodiscard]] auto to_string(Outcome outcome) -> std::string_view;

struct BuildingReport {
  std::string id, block;
  Outcome outcome = Outcome::full;
  bool derived = false;  ///< its footprint was drawn from the mesh
  std::vector<base::Diagnostic> reasons;
  std::size_t parts = 0;
  double ground = 0, roof_min = 0, roof_max = 0;  ///< z, metres, file frame
  double volume = 0;                              ///< m³
  label::Areas areas;
  std::optional<double> rmse;     ///< m, vertical, over its parts; none where the mesh shows nothing
  std::string roof, height_from;  ///< the shape made and where its height comes from; of raise_footprints only
};

struct Reconstruction {
  model::City city;
  std::vector<BlockReport> blocks;
  std::vector<BuildingReport> buildings;       ///< every input feature, in the source's order
  std::vector<evaluate::ErrorMap> error_maps;  ///< per block
  std::vector<StageTime> times;
  evaluate::Scores scores;  ///< over all blocks, weighted by cells
  std::vector<base::Diagnostic> warnings;
  std::vector<SegmentedBlock> segmented;  ///< per block with Keep::segmentations, else empty
};

/// Guarantees: 1 every usable footprint ends in a valid solid, its own or (`covered`) a neighbour's · 2 every solid
/// passed solid::check · 3 one failing building or block leaves the others as they would be without it · 4 the same
/// scene, options and seed give the same city at any thread count.
/// With `only`, the names of some blocks, nothing else is reconstructed and no other feature is in the city or the
/// report; these blocks come out as in a run of all. Gives up with "cancelled", "pipeline-nothing" (no usable
/// footprint), "pipeline-block-unknown".
[[nodiscard]] auto reconstruct(const model::Scene& scene, const Options& options, const base::Run& run = {},
                               Keep keep = Keep::models, std::span<const std::string> only = {})
    -> base::Result<Reconstruction>;

/// Every block up to its segmentation, without models.
struct Segmented {
  model::MadeBy made_by;
  std::vector<BlockReport> blocks;        ///< without scores
  std::vector<SegmentedBlock> segmented;  ///< per block
  std::vector<StageTime> times;
  std::vector<base::Diagnostic> warnings;
};

/// The first stages of reconstruct, with the same segmentations as there. Guarantees: 1 one failing block leaves the
/// others as they would be without it · 2 the same scene, options and seed give the same at any thread count.
/// Gives up with "cancelled", "pipeline-nothing" (no usable footprint).
[[nodiscard]] auto segment(const model::Scene& scene, const Options& options, const base::Run& run = {})
    -> base::Result<Segmented>;

/// How many parts each feature got: by Scene::footprints.
[[nodiscard]] auto parts_by_feature(const model::Scene& scene, const std::vector<SegmentedBlock>& blocks)
    -> std::vector<std::size_t>;

/// Why a wall was drawn or not, as layers for formats::geopackage: gis_footprints, sweep_edges, faces, edges,
/// conflicts, footprints, made_by. Their fields are listed in docs/pipeline.md. Heights are z of the file frame.
[[nodiscard]] auto segment_layers(const model::Scene& scene, const std::vector<SegmentedBlock>& blocks,
                                  const model::MadeBy& made_by) -> std::vector<formats::Layer>;

/// What went otherwise than it should, as one more layer: `diagnostics`, a row per reason of a building and per
/// warning. `reconstruction` must be of the whole scene.
[[nodiscard]] auto diagnostics_layer(const Reconstruction& reconstruction, const model::Scene& scene) -> formats::Layer;

/// Footprints without a mesh: each raised by its attributes, or along options.roof.profile. No blocks, no scores.
/// Guarantees: 1 to 4 of reconstruct · 5 a building is `full` only with the roof its attributes ask for; values that
/// could not be used are among its reasons either way.
/// Gives up with "cancelled", "pipeline-nothing", "roof-profile", "roof-attribute".
[[nodiscard]] auto raise_footprints(const model::Scene& scene, const Options& options, const base::Run& run = {})
    -> base::Result<Reconstruction>;

/// One plan to one labelled, checked solid: what reconstruct does with each part once its profiles are known.
[[nodiscard]] auto raise_part(const model::Plan& plan, const Options& options, const base::Run& run = {})
    -> base::Result<extrude::Raised>;

/// The plans of a city raised and classified all together, by nothing but the plans: `mansard extrude plans.json`.
struct RaisedPlans {
  model::City city;  ///< as given, with every model in place; made by this version
  struct Short {
    std::size_t building = 0, part = 0;  ///< of the city
    extrude::Outcome outcome = extrude::Outcome::full;
    std::vector<base::Diagnostic> reasons;  ///< the subject is the part's id
  };
  std::vector<Short> fell_short;  ///< the parts that are simpler than their plans, in order
};
/// The same plans and options give the same models at any thread count. Gives up with "cancelled", and as raise_part
/// does with the first part that has no solid.
[[nodiscard]] auto raise_plans(model::City city, const Options& options, const base::Run& run = {})
    -> base::Result<RaisedPlans>;

/// The attributes of a part that speak of its model (heights, roof type, volume, areas, error, fallback), measured
/// anew; all others stay as `part` has them. `mesh` may be null: no error then. `fallback`: the code of the reason why
/// the model is simpler than its plan; empty when it is not. `z0`: z of the frame's origin, metres.
[[nodiscard]] auto part_attributes(const model::Part& part, const std::string& fallback, const rays::Scene* mesh,
                                   double z0, const Options& options) -> model::Attributes;
/// The same for a building, of the attributes of its parts.
[[nodiscard]] auto building_attributes(const model::Building& building, double z0) -> model::Attributes;

/// The report as JSON. Everything but the members called "seconds" is the same in every run. Without a mesh it has no
/// "mesh", "scores" and "blocks".
[[nodiscard]] auto report_json(const Reconstruction& reconstruction, const model::Scene& scene) -> std::string;
/// The same for blocks without models: no "scores", no "buildings".
[[nodiscard]] auto report_json(const Segmented& segmented, const model::Scene& scene) -> std::string;

/// Figure 5 of the paper, twice: the scan with the footprints beside the models, from above and at an angle; and the
/// vertical error on a scale of ±`limit` metres.
struct Pictures {
  picture::Image above, angle, error;
};
[[nodiscard]] auto pictures(const Reconstruction& reconstruction, const model::Scene& scene, double limit,
                            const base::Run& run = {}) -> Pictures;

/// The models alone.
[[nodiscard]] auto picture_of(const model::City& city, const picture::View& view = {}, const base::Run& run = {})
    -> picture::Image;

/// The codes of every room.
[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::pipeline
