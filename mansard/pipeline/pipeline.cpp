// The steps of a reconstruction, a call each.
#include "mansard/pipeline/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/block_run.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"
#include "mansard/pipeline/detail/place.hpp"

namespace mansard::pipeline {
namespace {

auto combined(const std::vector<report::BlockReport>& blocks) -> evaluate::Scores {
  std::vector<evaluate::Scores> scores;
  for (const auto& block : blocks) scores.push_back(block.scores);
  return evaluate::combined(scores);
}

/// Per stage over all blocks, after the one before them.
auto stage_times(const report::StageTime& before, const std::vector<report::BlockReport>& blocks)
    -> std::vector<report::StageTime> {
  std::vector<std::string> names;
  std::map<std::string, std::vector<base::Spent>> of_stage;
  for (const auto& block : blocks)
    for (const auto& [name, spent] : block.times.stages) {
      auto& pieces = of_stage[name];
      if (pieces.empty()) names.push_back(name);
      pieces.push_back(spent);
    }
  std::vector<report::StageTime> out{before};
  for (const auto& name : names) out.push_back({name, base::combined(of_stage[name])});
  return out;
}

struct Division {
  std::vector<block::Block> blocks;
  report::StageTime time;
};

auto divide(const model::Scene& scene, const Options& options, const base::Run& run) -> base::Result<Division> {
  const bool usable = std::ranges::any_of(scene.footprints, [](const auto& f) { return !f.defect.has_value(); });
  if (!usable) {
    std::string why = "there are no footprints";
    if (!scene.footprints.empty())
      if (const auto& defect = scene.footprints.front().defect)
        why = "none of the " + std::to_string(scene.footprints.size()) +
              " footprints can be used; the first: " + defect->message;
    return base::error("pipeline-nothing", why);
  }
  base::Watch watch;
  auto blocks = block::partition(scene, options.block, run);
  return Division{std::move(blocks), {"block", watch.stop()}};
}

/// A result per block. Blocks are independent: they run side by side, and each writes only to its own place.
template <class Work>
auto for_every(const std::vector<block::Block>& blocks, const base::Run& run, const Work& work) {
  using BlockResult = decltype(work(blocks.front(), run, detail::Tell{}));
  std::vector<BlockResult> results(blocks.size());
  std::mutex progress;
  std::size_t done = 0;
  base::Run inner = run;
  inner.progress = nullptr;
  base::parallel_for(blocks.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    const auto tell = [&](std::string_view stage) {
      const std::scoped_lock lock(progress);
      run.report(stage, blocks[i].name, static_cast<double>(done) / static_cast<double>(blocks.size()));
    };
    results[i] = work(blocks[i], inner, tell);
    const std::scoped_lock lock(progress);
    ++done;
    run.report("done", blocks[i].name, static_cast<double>(done) / static_cast<double>(blocks.size()));
  });
  return results;
}

/// Leaves the blocks that are named; all where none is.
auto keep_only(std::vector<block::Block>& blocks, std::span<const std::string> only) -> base::Result<void> {
  if (only.empty()) return {};
  for (const auto& name : only) {
    if (std::ranges::find(blocks, name, &block::Block::name) != blocks.end()) continue;
    std::vector<std::string> known;
    for (const auto& block : blocks) known.push_back(block.name);
    return base::error("pipeline-block-unknown",
                       "no block has this name" + base::did_you_mean(base::nearest_word(name, known)) +
                           "; blocks are named by the first id of their footprints",
                       name);
  }
  std::erase_if(blocks, [&](const auto& block) { return std::ranges::find(only, block.name) == only.end(); });
  return {};
}

/// Takes out what belongs to no block of these.
void keep_only(const std::vector<block::Block>& blocks, report::Reconstruction& out) {
  std::vector<bool> kept(out.buildings.size(), false);
  for (const auto& block : blocks)
    for (const auto& member : block.members)
      if (member.feature < kept.size()) kept[member.feature] = true;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    if (count != i) {
      out.buildings[count] = std::move(out.buildings[i]);
      out.city.buildings[count] = std::move(out.city.buildings[i]);
    }
    ++count;
  }
  out.buildings.resize(count);
  out.city.buildings.resize(count);
}

auto cancelled() -> base::Diagnostic { return base::error("cancelled", "stopped on request; nothing was written"); }

}  // namespace

auto reconstruct(const model::Scene& scene, const Options& options, const base::Run& run, Keep keep,
                 std::span<const std::string> only) -> base::Result<report::Reconstruction> {
  base::Watch watch;
  auto division = divide(scene, options, run);
  if (!division) return division.error();
  if (auto known = keep_only(division->blocks, only); !known) return known.error();
  auto results = for_every(division->blocks, run, [&](const auto& block, const auto& inner, const auto& tell) {
    if (!block.ground_known) return detail::refused(block, options.block);
    const auto own = block::in_own_frame(block);
    auto result = detail::run_block(own.block, options, inner, tell, keep);
    detail::place(result, own);
    return result;
  });
  if (run.cancelled()) return cancelled();

  std::vector<report::SegmentedBlock> segmented;
  for (auto& result : results)
    if (result.segmented) segmented.push_back(std::move(*result.segmented));
  report::Reconstruction out = detail::assemble(scene, division->blocks, std::move(results), options);
  if (!only.empty()) keep_only(division->blocks, out);
  out.segmented = std::move(segmented);
  out.scores = combined(out.blocks);
  detail::report_overlaps(out);
  out.times = {watch.stop(), stage_times(division->time, out.blocks)};
  return out;
}

auto segment(const model::Scene& scene, const Options& options, const base::Run& run)
    -> base::Result<report::Segmented> {
  base::Watch watch;
  const auto division = divide(scene, options, run);
  if (!division) return division.error();
  struct Result {
    report::BlockReport report;
    report::SegmentedBlock segmented;
    std::vector<base::Diagnostic> warnings;
  };
  auto results = for_every(division->blocks, run, [&](const auto& block, const auto& inner, const auto& tell) {
    base::Watch own_watch;
    Result result;
    if (!block.ground_known) {
      auto none = detail::refused(block, options.block);
      result.report = std::move(none.report);
      result.segmented = detail::unsegmented(block, none.failed.front().second);
      result.warnings.push_back(*result.segmented.failure);
      return result;
    }
    const auto own = block::in_own_frame(block);
    const rays::Scene mesh(own.block.mesh);
    result.segmented = detail::segment_block(own.block, mesh, options, inner, tell, result.report, result.warnings);
    detail::place(result.segmented, own);
    result.report.times.total = own_watch.stop();
    return result;
  });
  if (run.cancelled()) return cancelled();

  report::Segmented out;
  out.made_by = detail::made_by(scene, options);
  for (auto& result : results) {
    out.blocks.push_back(std::move(result.report));
    out.segmented.push_back(std::move(result.segmented));
    out.warnings.insert(out.warnings.end(), result.warnings.begin(), result.warnings.end());
  }
  out.times = {watch.stop(), stage_times(division->time, out.blocks)};
  return out;
}

auto raise_part(const model::Plan& plan, const Options& options, const base::Run& run)
    -> base::Result<extrude::Raised> {
  return extrude::raise(plan, detail::with_grid(options.extrude), run);
}

}  // namespace mansard::pipeline
