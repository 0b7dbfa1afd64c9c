// The order of the stages: a scene in, a city of labelled models out, and what report/report.hpp tells of it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/derive/derive.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/fracture/fracture.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/label/label.hpp"
#include "mansard/pipeline/kept.hpp"
#include "mansard/profile/profile.hpp"
#include "mansard/refine/refine.hpp"
#include "mansard/report/report.hpp"
#include "mansard/roof/roof.hpp"
#include "mansard/segment/segment.hpp"
#include "mansard/slice/slice.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/sweep/sweep.hpp"
#include "mansard/terrain/terrain.hpp"
#include "mansard/texture/options.hpp"
#include "mansard/vegetation/vegetation.hpp"

namespace mansard::pipeline {

/// What the checks of a scan do (scan_checks.hpp).
enum class ScanChecks : std::uint8_t { stop, warn, off };

/// The options of every module. What a run means is these and its inputs.
struct Options {
  ingest::Options ingest;
  derive::Options derive;
  block::Options block;
  accuracy::Options accuracy;
  vegetation::Options vegetation;
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
  texture::Options texture;
  terrain::Options terrain;

  std::int64_t seed = 1;
  ScanChecks scan_checks = ScanChecks::stop;
  double partly_seen = 0.1;                ///< of a footprint: more without scan is reported
  double assumed_height = 0;               ///< m; of the prism of a footprint that the scan does not cover; 0 for none
  double roof_grid = 0.5;                  ///< m; sampling of roof heights for attributes
  std::string survey_source, survey_date;  ///< of the scan, for the attributes of buildings; empty: not known
};

/// One list per module, bound to `options`, in the order of the modules.
[[nodiscard]] auto option_lists(Options& options) -> std::vector<base::OptionList>;

/// A preset's changes to the defaults: "module.name" → value.
struct Preset {
  std::string name;
  std::string meaning;
  std::vector<std::pair<std::string, std::string>> values;
};
/// `paper` (the published numbers) and `chordatlas` (what the reference implementation runs).
[[nodiscard]] auto presets() -> const std::vector<Preset>&;

/// Of an option "module.name" that there was once: a sentence that says so, and which one has the same meaning now.
/// Empty for all other names.
[[nodiscard]] auto why_removed(std::string_view key) -> std::string;

/// Sets "module.name". Fails with "option-unknown" (names the nearest known one, or says that it was removed) or
/// "option-value".
[[nodiscard]] auto set_option(std::vector<base::OptionList>& lists, std::string_view key, std::string_view value)
    -> base::Result<void>;

/// What is kept beside the models: memory grows with the number of blocks when all their segmentations are.
enum class Keep : std::uint8_t { models, segmentations };

/// Guarantees: 1 every usable footprint ends in a valid solid, its own or (`covered`) a neighbour's · 2 every solid
/// passed solid::check · 3 one failing building or block leaves the others as they would be without it · 4 the same
/// scene, options and seed give the same city at any thread count.
/// With `only`, the names of some blocks, nothing else is reconstructed and no other feature is in the city or the
/// report; these blocks come out as in a run of all. Blocks that `schedule` has are not made again. Fails with
/// "cancelled", "pipeline-nothing" (no usable footprint), "pipeline-block-unknown", and as KeptBlocks does.
[[nodiscard]] auto reconstruct(const model::Scene& scene, const Options& options, const base::Run& run = {},
                               Keep keep = Keep::models, std::span<const std::string> only = {},
                               const Schedule& schedule = {}) -> base::Result<report::Reconstruction>;

/// The first stages of reconstruct, with the same segmentations as there. Guarantees: 1 one failing block leaves the
/// others as they would be without it · 2 the same scene, options and seed give the same at any thread count.
/// Fails with "cancelled", "pipeline-nothing" (no usable footprint).
[[nodiscard]] auto segment(const model::Scene& scene, const Options& options, const base::Run& run = {})
    -> base::Result<report::Segmented>;

/// Footprints without a mesh: each raised by its attributes, or along options.roof.profile. No blocks, no scores.
/// Guarantees: 1 to 4 of reconstruct · 5 a building is `full` only with the roof its attributes ask for; values that
/// could not be used are among its reasons either way.
/// Fails with "cancelled", "pipeline-nothing", "roof-profile", "roof-attribute".
[[nodiscard]] auto raise_footprints(const model::Scene& scene, const Options& options, const base::Run& run = {})
    -> base::Result<report::Reconstruction>;

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
  /// On parts that are as their plans say ("extrude-small-edge"), and those of solid::unite, by building.
  std::vector<base::Diagnostic> remarks;
  /// Why parts have no solid, and are missing from the city: as raise_part gives up. The subject is the part's id.
  std::vector<base::Diagnostic> refused;
};
/// The same plans and options give the same models at any thread count. Fails with "cancelled", and where no part
/// has a solid with the reasons of all.
[[nodiscard]] auto raise_plans(model::City city, const Options& options, const base::Run& run = {})
    -> base::Result<RaisedPlans>;

/// The codes of every module.
[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::pipeline
