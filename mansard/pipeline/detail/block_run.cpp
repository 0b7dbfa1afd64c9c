#include "mansard/pipeline/detail/block_run.hpp"

#include "mansard/base/statistics.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/decided.hpp"
#include "mansard/pipeline/detail/left_out.hpp"
#include "mansard/pipeline/detail/overhangs.hpp"
#include "mansard/pipeline/detail/shown.hpp"
#include "mansard/pipeline/detail/uncovered.hpp"
#include "mansard/report/attributes.hpp"
#include "mansard/report/measures.hpp"
#include "mansard/report/standard_errors.hpp"
#include "mansard/solid/solid.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "mansard/extrude/align.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;

auto no_mesh(const Options& options) -> base::Diagnostic {
  return base::warning("pipeline-no-mesh", options.assumed_height > 0
                                               ? "the scan does not cover this footprint; its height is assumed"
                                               : "the scan does not cover this footprint");
}

/// The flat prism of a polygon at the median of the mesh's heights over it (sorted; assumed where there are none), and
/// why it is no more than that.
auto plain_prism(std::size_t feature, const Polygon& polygon, double ground, const std::vector<double>& heights,
                 const Options& options, const base::Diagnostic& why, const base::Run& run)
    -> base::Result<PartResult> {
  PartResult part;
  part.feature = feature;
  part.full = false;
  part.reasons = {why};
  double height = options.assumed_height;
  if (!heights.empty()) {
    constexpr double least_height = 0.5;  // lower than a step is no building; keeps the prism a solid
    height = std::max(least_height, base::percentile_of_sorted(heights, 0.5) - ground);
  }
  part.plan = profile::vertical_plan(polygon, ground, height);
  auto raised = raise_part(part.plan, options, run);
  if (!raised) return raised.failure();
  part.model.solid = std::move(raised->solid);
  return part;
}

/// The heights of the model's roof and its vertical error against the mesh.
void measure(PartResult& part, const rays::Scene& mesh, const Options& options) {
  const auto polygon = model::polygon_of(part.plan);
  part.roof = report::roof_heights(part.model, part.plan, options.roof_grid);
  const double mse = evaluate::error_over(part.model.solid, polygon, mesh, options.evaluate);
  if (std::isfinite(mse)) part.mse = mse;
}

auto not_raised(const base::Diagnostic& why, const block::Block& block, std::size_t part) -> base::Diagnostic {
  return base::warning(why.code, "a part of the segmentation could not be raised: " + why.message,
                       block.name + " part " + std::to_string(part));
}

/// Parts from the segmentation, each raised along its profiles.
auto raise_parts(const segment::Segmentation& segmentation, const Shown& shown, const Options& options,
                 const base::Run& run, BlockResult& out) -> std::vector<PartResult> {
  const auto& block = shown.block();
  const auto& mesh = shown.mesh();
  base::Watch fitting;
  const auto fitted = profile::fit(segmentation, block, mesh, options.profile, run, shown.above());
  out.report.times.stages.push_back({"profile", fitting.stop()});

  base::Watch refining;
  std::vector<PartResult> parts;
  std::vector<refine::Draft> drafts;
  std::vector<std::size_t> part_of_draft, features;
  std::vector<bool> seen;
  for (const auto& source : segmentation.parts) {
    features.push_back(source.feature.value_or(block.members.front().feature));
    seen.push_back(!report::heights_over(shown.whole(), source.polygon, options.roof_grid).empty());
  }
  const auto is_seen_elsewhere = [&](std::size_t feature) {
    for (std::size_t i = 0; i < features.size(); ++i)
      if (seen[i] && features[i] == feature) return true;
    return false;
  };
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const auto& source = segmentation.parts[i];
    const std::size_t feature = features[i];
    if (!seen[i]) {  // the footprints alone say there is a building
      const bool elsewhere = is_seen_elsewhere(feature);
      if (!elsewhere && options.assumed_height == 0) continue;
      const auto why = elsewhere ? base::warning("pipeline-no-mesh",
                                                 "the scan does not cover a part of this footprint, which is as "
                                                 "high as the part beside it")
                                 : no_mesh(options);
      const auto heights = elsewhere ? std::vector<double>{source.height} : std::vector<double>();
      auto prism = plain_prism(feature, source.polygon, fitted[i].plan.base, heights, options, why, run);
      if (prism) parts.push_back(std::move(*prism));
      else out.warnings.push_back(not_raised(prism.error(), block, i));
      continue;
    }
    part_of_draft.push_back(i);
    drafts.push_back({feature, fitted[i].plan, fitted[i].caps, fitted[i].alternatives});
  }
  auto refined = refine::refine(drafts, mesh, options.refine, with_grid(options.extrude), run, shown.above());
  for (auto& from : refined.parts) {
    PartResult part;
    part.feature = from.owner;
    part.plan = std::move(from.plan);
    part.full = from.raised.outcome == extrude::Outcome::full;
    if (!part.full) part.reasons = std::move(from.raised.warnings);
    part.model.solid = std::move(from.raised.solid);
    part.changes = std::move(from.changes);
    parts.push_back(std::move(part));
  }
  for (const auto& [feature, search] : refined.searches)
    if (search.met_bound)
      out.unchecked.emplace_back(feature,
                                 base::warning("refine-bound",
                                               "the search for its roofs ended at the bound of its work; the best "
                                               "that it had by then are used"));
  out.searches = std::move(refined.searches);
  for (const auto& [draft, why] : refined.failed) out.warnings.push_back(not_raised(why, block, part_of_draft[draft]));
  out.report.times.stages.push_back({"refine", refining.stop()});
  return parts;
}

/// Every feature without a part becomes a prism, or is reported as covered by its neighbours, or as refused where
/// nothing can be extruded on the ground that is left.
void fill_in(const block::Block& block, const rays::Scene& mesh, const Options& options,
             const std::optional<base::Diagnostic>& block_failure, std::vector<PartResult>& parts, BlockResult& out,
             const base::Run& run) {
  for (const auto& member : block.members) {
    if (std::ranges::any_of(parts, [&](const auto& part) { return part.feature == member.feature; })) continue;
    std::vector<Polygon> others;
    for (const auto& part : parts) others.push_back(model::polygon_of(part.plan));
    const auto left = uncovered(member.polygons, others);
    for (const auto& warning : left.warnings) out.unchecked.emplace_back(member.feature, warning);
    bool any = false;
    std::optional<base::Diagnostic> failure;
    for (const auto& polygon : left.polygons) {
      const auto heights = report::heights_over(mesh, polygon, options.roof_grid);
      if (heights.empty() && options.assumed_height == 0) {
        failure = no_mesh(options);
        continue;
      }
      const bool low =
          !heights.empty() && base::percentile_of_sorted(heights, 0.5) - member.ground < options.segment.min_height;
      const auto why =
          heights.empty() ? no_mesh(options)
          : block_failure ? *block_failure
          : low ? base::warning("pipeline-low", "the mesh is under segment.min_height here; raised as a prism")
                : base::warning("pipeline-outside", "no face of the fractured ground is its; raised as a prism");
      if (auto part = plain_prism(member.feature, polygon, member.ground, heights, options, why, run)) {
        parts.push_back(std::move(*part));
        any = true;
      } else {
        failure = part.error();
      }
    }
    if (failure) out.failed.emplace_back(member.feature, *failure);
    if (!any && !failure) out.covered.push_back(member.feature);
  }
  std::ranges::stable_sort(parts, {}, &PartResult::feature);
}

/// Parts with the walls that they share on one line. Where that would cost a part its roof, it stays as it was
/// extruded.
void align(std::vector<PartResult>& parts, const Options& options, const base::Run& run) {
  std::vector<model::Plan> plans;
  for (const auto& part : parts) plans.push_back(part.plan);
  const auto aligned = extrude::align(plans, options.extrude);
  base::parallel_for(parts.size(), [&](std::size_t i) {
    if (!aligned[i] || run.cancelled()) return;
    auto raised = raise_part(*aligned[i], options, run);
    if (!raised || raised->outcome != extrude::Outcome::full) return;
    auto& part = parts[i];
    if (raised->solid.faces.size() > part.model.solid.faces.size()) return;
    if (is_another(raised->solid, part.model.solid, options.extrude.tolerance)) return;
    part.plan = *aligned[i];
    part.model.solid = std::move(raised->solid);
  });
}

void classify(std::vector<PartResult>& parts, const Options& options, const base::Run& run) {
  std::vector<model::Solid> solids;
  for (auto& part : parts) solids.push_back(std::move(part.model.solid));
  auto labelled = label::classify(std::move(solids), options.label, run);
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].model = std::move(labelled[i]);
}

}  // namespace

auto union_unknown(const std::string& subject) -> base::Diagnostic {
  return base::warning("pipeline-evaluation-unchecked",
                       "the union of the footprints could not be computed; the scores `inside` leave out a strip along "
                       "party walls too",
                       subject);
}

auto refused(const block::Block& block, const block::Options& options) -> BlockResult {
  BlockResult out;
  out.report.name = block.name;
  out.report.buildings = block.members.size();
  out.report.status = "failed";
  for (const auto& member : block.members)
    out.failed.emplace_back(
        member.feature,
        base::warning("pipeline-no-ground",
                      "there is no mesh within " + base::to_text(options.ground_reach, 0) +
                          " m of it, so that its ground is not known; give the mesh there, or a terrain"));
  return out;
}

namespace {

/// The solids of every feature; parts without one go. What stands beyond the block does not matter: its parts come no
/// nearer than footprints that do not touch.
auto unite(std::vector<PartResult>& parts) -> std::vector<std::pair<std::size_t, SolidsOf>> {
  std::vector<std::size_t> features;
  std::vector<std::vector<model::LabelledSolid*>> models;
  for (auto& part : parts) {
    if (features.empty() || features.back() != part.feature) {
      features.push_back(part.feature);
      models.emplace_back();
    }
    models.back().push_back(&part.model);
  }
  auto united = unite_parts(models);
  std::vector<std::pair<std::size_t, SolidsOf>> out;
  std::vector<PartResult> kept;
  auto part = parts.begin();
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (std::size_t p = 0; p < models[i].size(); ++p, ++part)
      if (!std::ranges::binary_search(united[i].lost, p)) kept.push_back(std::move(*part));
    renumber(united[i]);
    out.emplace_back(features[i], std::move(united[i]));
  }
  parts = std::move(kept);
  return out;
}

}  // namespace

void add_eaves(const PartResult::EavesSeen& eaves, model::Attributes& attributes) {
  if (eaves.overhanging == 0) return;
  attributes.emplace_back("ms_overhang", report::rounded_measure(eaves.area / eaves.overhanging));
  attributes.emplace_back("ms_overhang_share", report::rounded_measure(eaves.overhanging / eaves.length));
}

namespace {

/// m²: ground that is not seen may hide a structure of this size, such as a lift house.
constexpr double hidden_structure = 4;

/// Whether the scan misses enough of a footprint to hide something.
auto partly_seen(const block::Member& member, double share, const Options& options) -> std::optional<base::Diagnostic> {
  double area = 0;
  for (const auto& polygon : member.polygons) area += geometry::area(polygon);
  if (share < options.partly_seen || share * area < hidden_structure) return std::nullopt;
  return base::warning("pipeline-partly-seen", "the scan does not cover " + base::to_text(100 * share, 0) +
                                                   " % of the footprint; the roof there is continued from what it "
                                                   "shows");
}

/// The evidence for the models of a block.
auto evidence_for(const block::Block& block, const Shown& shown, const model::Accuracy& accuracy,
                  const std::vector<std::pair<std::size_t, SolidsOf>>& solids)
    -> std::vector<std::pair<std::size_t, confidence::Evidence>> {
  std::vector<std::pair<std::size_t, confidence::Evidence>> out(solids.size());
  base::parallel_for(solids.size(), [&](std::size_t s) {
    const auto& [feature, made] = solids[s];
    const auto own = std::ranges::find(block.members, feature, &block::Member::feature);
    const auto reach = geometry::bounds(own->polygons).grown(block::beside_reach);
    std::vector<geometry::Polygon> others;
    const auto add_near = [&](const std::vector<geometry::Polygon>& polygons) {
      for (const auto& polygon : polygons)
        if (reach.overlaps(geometry::bounds(polygon.outer))) others.push_back(polygon);
    };
    add_near(block.beside);
    for (const auto& member : block.members)
      if (member.feature != feature) add_near(member.polygons);
    std::vector<const model::LabelledSolid*> models;
    for (const auto& one : made.solids) models.push_back(&one.model);
    out[s] = {feature, confidence::evidence_of(
                           {own->polygons, others, models, shown.whole(), shown.mesh(), own->ground, accuracy})};
  });
  return out;
}

struct Measured {
  std::vector<std::pair<std::size_t, model::Attributes>> attributes;  ///< that take the mesh; by feature
  std::vector<std::pair<std::size_t, base::Diagnostic>> doubts;       ///< of features with a model
};
/// `known`: the mesh where it shows what is built.
auto measured(const block::Block& block, const rays::Scene& mesh, const rays::Scene& known,
              const model::Accuracy& accuracy, const std::vector<PartResult>& parts,
              const std::vector<std::pair<std::size_t, SolidsOf>>& solids, const Options& options) -> Measured {
  Measured out;
  out.attributes.resize(block.members.size());
  std::vector<std::optional<base::Diagnostic>> doubts(block.members.size());
  base::parallel_for(block.members.size(), [&](std::size_t m) {
    const auto& member = block.members[m];
    model::Building building;
    for (const auto& part : parts) {
      if (part.feature != member.feature) continue;
      auto& own = building.parts.emplace_back(
          model::Part{std::to_string(building.parts.size()), part.plan, {}, model::Attributes()});
      own.attributes.emplace_back("ms_h_roof_70p", report::rounded_measure(base::percentile_of_sorted(part.roof, 0.7)));
    }
    const auto made = std::ranges::find(solids, member.feature, &std::pair<std::size_t, SolidsOf>::first);
    if (made != solids.end()) building.solids = made->second.solids;
    auto& [feature, attributes] = out.attributes[m];
    feature = member.feature;
    if (!building.solids.empty())
      attributes = report::level_measures(building, {}, options.write.levels, &mesh, options.evaluate);
    if (!building.solids.empty()) {
      const auto ground = member.at_walls ? std::optional(member.at_walls->error) : std::nullopt;
      std::ranges::move(report::standard_errors(building, {known, accuracy, ground}), std::back_inserter(attributes));
    }
    PartResult::EavesSeen eaves;
    for (const auto& part : parts)
      if (part.feature == member.feature) {
        eaves.length += part.eaves.length;
        eaves.overhanging += part.eaves.overhanging;
        eaves.area += part.eaves.area;
      }
    add_eaves(eaves, attributes);
    const auto seen = report::coverage(known, member.polygons, options.roof_grid);
    attributes.emplace_back("ms_nodata_share", seen.missing);
    attributes.emplace_back("ms_nodata_radius", seen.radius);
    if (!building.solids.empty()) doubts[m] = partly_seen(member, seen.missing, options);
  });
  for (std::size_t m = 0; m < doubts.size(); ++m)
    if (doubts[m]) out.doubts.emplace_back(block.members[m].feature, *std::move(doubts[m]));
  return out;
}

}  // namespace

auto is_another(const model::Solid& moved, const model::Solid& before, double most) -> bool {
  double area = 0;
  for (const auto& face : before.faces) area += solid::area(before, face);
  return std::abs(solid::volume(moved) - solid::volume(before)) > most * area;
}

auto unsegmented(const block::Block& block, const base::Diagnostic& why) -> report::SegmentedBlock {
  report::SegmentedBlock out;
  out.name = block.name;
  for (const auto& member : block.members) out.features.push_back(member.feature);
  out.failure = base::warning(why.code, why.message, block.name);
  return out;
}

auto run_block(const block::Block& block, const Options& asked, const base::Run& run, const Tell& tell, Keep keep)
    -> BlockResult {
  base::Watch watch;
  BlockResult out;
  report::BlockReport& report = out.report;
  const auto seen = shown_of(block, asked, run, tell, report, out.warnings);
  const Options options = decided_by(asked, report.accuracy);
  const Shown& shown = *seen;
  const auto& mesh = shown.whole();
  report::SegmentedBlock segmented =
      segment_block(shown.block(), shown.mesh(), options, run, tell, report, out.warnings);

  std::vector<PartResult> parts;
  if (segmented.segmentation) {
    tell("profile");
    parts = raise_parts(*segmented.segmentation, shown, options, run, out);
  }
  fill_in(block, mesh, options, segmented.failure, parts, out, run);
  align(parts, options, run);
  if (segmented.segmentation) add_left_out(block, *segmented.segmentation, mesh, options, parts, out);
  if (keep == Keep::segmentations) out.segmented = std::move(segmented);
  tell("label");
  {
    base::Watch labelling;
    classify(parts, options, run);
    base::parallel_for(parts.size(), [&](std::size_t i) { measure(parts[i], mesh, options); });
    report.times.stages.push_back({"label", labelling.stop()});
  }
  out.solids = stage("unite", tell, report, [&] { return unite(parts); });
  report.parts = parts.size();
  if (options.profile.overhangs != profile::Overhangs::off)
    out.solids = stage("overhangs", tell, report,
                       [&] { return with_overhangs(shown.block().mesh, options, run, parts, std::move(out.solids)); });
  auto found = stage("measure", tell, report,
                     [&] { return measured(block, mesh, shown.mesh(), report.accuracy, parts, out.solids, options); });
  out.evidence =
      stage("confidence", tell, report, [&] { return evidence_for(block, shown, report.accuracy, out.solids); });
  out.measures = std::move(found.attributes);
  out.doubts = std::move(found.doubts);

  std::vector<model::LabelledSolid> models;
  std::vector<Polygon> footprints;
  for (const auto& part : parts) models.push_back(part.model);
  for (const auto& member : block.members)
    footprints.insert(footprints.end(), member.polygons.begin(), member.polygons.end());
  auto comparison = stage("evaluate", tell, report, [&] {
    return evaluate::compare(models, mesh, footprints, block.ground, options.evaluate, run);
  });
  report.scores = comparison.scores;
  if (report.scores.union_unknown) out.warnings.push_back(union_unknown(block.name));
  if (comparison.lost > 0)
    out.warnings.push_back(base::warning(
        "pipeline-evaluation-unchecked",
        std::to_string(comparison.lost) +
            " solids could not be cut into triangles; the scores count them as missing, and the heights of their roofs "
            "are those of their corners",
        block.name));
  out.map = std::move(comparison.map);
  out.parts = std::move(parts);
  report.times.total = watch.stop();
  return out;
}

}  // namespace mansard::pipeline::detail
