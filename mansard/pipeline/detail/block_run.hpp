// One block through every stage, from its mesh to its checked solids.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/confidence/evidence.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/pipeline/solids.hpp"

namespace mansard::pipeline::detail {

/// Receives the name of every stage as it begins.
using Tell = std::function<void(std::string_view)>;

/// Does the work and adds its time to that of the stage in the report.
template <class Work>
[[nodiscard]] auto stage(const char* name, const Tell& tell, report::BlockReport& report, Work&& work) {
  tell(name);
  base::Watch watch;
  auto product = work();
  const auto spent = watch.stop();
  const auto earlier = std::ranges::find(report.times.stages, name, &report::StageTime::stage);
  if (earlier == report.times.stages.end()) report.times.stages.push_back({name, spent});
  else earlier->spent = base::combined(std::array{earlier->spent, spent});
  return product;
}

/// A part before it is assigned to its building.
struct PartResult {
  std::size_t feature = 0;  ///< index into Scene::footprints
  model::Plan plan;
  model::LabelledSolid model;
  std::vector<base::Diagnostic> reasons;  ///< why it is not extruded in full; empty when it is
  bool full = true;
  std::vector<std::string> changes;  ///< what measured error changed of its plan, in words
  std::vector<double> roof;          ///< z of the model's top surface on a grid, sorted, local frame
  std::optional<double> mse;         ///< m² against the mesh
  /// The eaves that its plan has, m, how much of them overhangs in the scan, and the area below that.
  struct EavesSeen {
    double length = 0, overhanging = 0, area = 0;
  } eaves{};
};

struct BlockResult {
  report::BlockReport report;
  struct Ground {
    std::size_t feature = 0;
    double z = 0;
    block::GroundSource source = block::GroundSource::unknown;
    std::optional<block::AtWalls> at_walls{};
  };
  std::vector<Ground> grounds;                           ///< of every feature, ascending; set when placed
  std::vector<PartResult> parts;                         ///< by feature
  std::vector<std::pair<std::size_t, SolidsOf>> solids;  ///< by feature; numbers of parts count the feature's own
  evaluate::ErrorMap map;
  std::vector<std::size_t> covered;  ///< features whose ground went to their neighbours
  /// Features of which some ground has no model, because not even a prism can be extruded there, and why.
  std::vector<std::pair<std::size_t, base::Diagnostic>> failed;
  /// Features of which something is not known or not finished, and why: told as a warning of the run, too.
  std::vector<std::pair<std::size_t, base::Diagnostic>> unchecked;
  /// Features whose model is less sure than others, and why.
  std::vector<std::pair<std::size_t, base::Diagnostic>> doubts;
  /// Features with ground that is high enough for a building and has no model.
  struct LeftOut {
    std::size_t feature = 0;
    double area = 0;  ///< m²
    std::string what;
  };
  std::vector<LeftOut> left_out;
  /// Attributes by feature that take the mesh to measure: the levels of detail, and what of the footprint it covers.
  std::vector<std::pair<std::size_t, model::Attributes>> measures;
  /// What the scan says of the model of each feature that has one.
  std::vector<std::pair<std::size_t, confidence::Evidence>> evidence;
  std::vector<std::pair<std::size_t, refine::SearchWork>>
      searches;  ///< by feature; none of what is a prism from the start
  std::vector<base::Diagnostic> warnings;
  std::optional<report::SegmentedBlock> segmented;  ///< with Keep::segmentations
};

/// "ms_overhang" and "ms_overhang_share", where some eaves overhang.
void add_eaves(const PartResult::EavesSeen& eaves, model::Attributes& attributes);

/// The warning that the union of a place's footprints could not be computed for its scores.
[[nodiscard]] auto union_unknown(const std::string& subject) -> base::Diagnostic;

/// Whether a solid whose outline was moved by at most so many metres has another roof: where an outline is nearly
/// pinched, a hair decides whether the roof of one side runs through to the other. No plane moves farther than its
/// wall.
[[nodiscard]] auto is_another(const model::Solid& moved, const model::Solid& before, double most) -> bool;

/// From slices to the segmentation. Never fails: what goes wrong is in `failure`, among the warnings and in the report.
/// `options` follow from the accuracy of the scan (decided.hpp).
[[nodiscard]] auto segment_block(const block::Block& block, const rays::Scene& mesh, const Options& options,
                                 const base::Run& run, const Tell& tell, report::BlockReport& report,
                                 std::vector<base::Diagnostic>& warnings) -> report::SegmentedBlock;

/// The result of a block of which not even the ground is known: all its members are refused.
[[nodiscard]] auto refused(const block::Block& block, const block::Options& options) -> BlockResult;

[[nodiscard]] auto unsegmented(const block::Block& block, const base::Diagnostic& why) -> report::SegmentedBlock;

/// Never fails: what cannot be segmented or raised becomes prisms with a reason.
[[nodiscard]] auto run_block(const block::Block& block, const Options& options, const base::Run& run, const Tell& tell,
                             Keep keep) -> BlockResult;

}  // namespace mansard::pipeline::detail
