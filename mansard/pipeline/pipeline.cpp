// The story of a reconstruction, a call a sentence.
#include "mansard/pipeline/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline {
namespace {

/// Scores of the whole from the scores of the blocks. Medians and percentiles cannot be added up: they are weighted
/// means, good enough for a headline; the blocks have the exact ones.
auto combined(const std::vector<BlockReport>& blocks) -> evaluate::Scores {
  evaluate::Scores sum;
  for (const auto& block : blocks) {
    const auto& s = block.scores;
    const auto cells = static_cast<double>(s.cells), inside = static_cast<double>(s.footprint_cells);
    sum.cells += s.cells;
    sum.footprint_cells += s.footprint_cells;
    sum.mse += cells * s.mse;
    sum.median += cells * s.median;
    sum.median_absolute += cells * s.median_absolute;
    sum.p95_absolute += cells * s.p95_absolute;
    sum.footprint_mse += inside * s.footprint_mse;
    sum.missed += s.missed;
    sum.invented += s.invented;
  }
  if (sum.cells > 0) {
    const auto n = static_cast<double>(sum.cells);
    sum.mse /= n;
    sum.median /= n;
    sum.median_absolute /= n;
    sum.p95_absolute /= n;
  }
  if (sum.footprint_cells > 0) sum.footprint_mse /= static_cast<double>(sum.footprint_cells);
  return sum;
}

auto summed(const std::vector<BlockReport>& blocks) -> std::vector<StageTime> {
  std::vector<StageTime> sum;
  for (const auto& block : blocks)
    for (const auto& time : block.times) {
      const auto at = std::ranges::find(sum, time.stage, &StageTime::stage);
      if (at == sum.end())
        sum.push_back(time);
      else
        at->seconds += time.seconds;
    }
  return sum;
}

}  // namespace

auto to_string(Outcome outcome) -> std::string_view {
  switch (outcome) {
    case Outcome::full: return "full";
    case Outcome::fallback: return "fallback";
    case Outcome::covered: return "covered";
    case Outcome::refused: return "refused";
  }
  return "";
}

auto reconstruct(const ingest::Scene& scene, const Options& options, const base::Run& run)
    -> base::Result<Reconstruction> {
  const bool usable = std::ranges::any_of(scene.footprints, [](const auto& f) { return !f.defect.has_value(); });
  if (!usable)
    return base::error("pipeline-nothing",
                       scene.footprints.empty() ? "there are no footprints"
                                                : "none of the " + std::to_string(scene.footprints.size()) +
                                                      " footprints can be used; the first: " +
                                                      scene.footprints.front().defect->message);

  detail::Watch watch;
  const auto blocks = block::partition(scene, options.block, run);
  const StageTime partitioning{"block", watch.seconds()};

  // Blocks are independent: they run side by side, and each writes only to its own place.
  std::vector<detail::BlockResult> results(blocks.size());
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
    results[i] = detail::run_block(blocks[i], options, inner, tell);
    const std::scoped_lock lock(progress);
    ++done;
    run.report("done", blocks[i].name, static_cast<double>(done) / static_cast<double>(blocks.size()));
  });
  if (run.cancelled()) return base::error("cancelled", "stopped on request; nothing was written");

  Reconstruction out = detail::assemble(scene, blocks, std::move(results), options);
  out.times = summed(out.blocks);
  out.times.insert(out.times.begin(), partitioning);
  out.scores = combined(out.blocks);
  return out;
}

auto raise_part(const geometry::Plan& plan, const Options& options, const base::Run& run)
    -> base::Result<extrude::Raised> {
  return extrude::raise(plan, detail::with_grid(options.extrude), run);
}

}  // namespace mansard::pipeline
