// The blocks of a scene, made and worked through side by side; each is gone from memory when it is done.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mansard/pipeline/detail/block_kept.hpp"
#include "mansard/pipeline/detail/block_run.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// The blocks that are to be worked through, by their places in the partition.
struct Division {
  block::Partition blocks;
  std::vector<std::size_t> wanted;
  report::StageTime time;

  /// Without its mesh.
  [[nodiscard]] auto outlined(std::size_t i) const -> const block::Block& { return blocks.outlined(wanted[i]); }
};

/// Fails with "pipeline-nothing" where no footprint can be used.
[[nodiscard]] auto check_usable(const model::Scene& scene) -> base::Result<void>;
/// All blocks. Fails with "pipeline-nothing".
[[nodiscard]] auto divide(const model::Scene& scene, const Options& options, const base::Run& run)
    -> base::Result<Division>;
/// Leaves the blocks that are named; all where none is. Fails with "pipeline-block-unknown".
[[nodiscard]] auto keep_only(Division& division, std::span<const std::string> only) -> base::Result<void>;

/// The stages' times over all blocks, those of `division` among them.
[[nodiscard]] auto stage_times(const report::StageTime& division, const std::vector<report::BlockReport>& blocks)
    -> std::vector<report::StageTime>;
[[nodiscard]] auto combined_scores(const std::vector<report::BlockReport>& blocks) -> evaluate::Scores;

/// How many blocks of a run were worked through before, and how many there are in all; 0: those of the division.
struct Progress {
  std::size_t before = 0, all = 0;
};

/// work(block, run, tell, time of making the block) for every block; a result for each.
template <class Work>
auto for_every(const Division& division, const base::Run& run, const Work& work, Progress of_all = {}) {
  using Made = decltype(work(std::declval<const block::Block&>(), run, Tell{}, report::StageTime{}));
  const std::size_t count = division.wanted.size();
  std::vector<Made> results(count);
  std::mutex progress;
  std::size_t done = of_all.before;
  const std::size_t all = std::max(of_all.all, count);
  base::Run inner = run;
  inner.progress = nullptr;
  base::parallel_for(count, [&](std::size_t i) {
    if (run.cancelled()) return;
    const auto report = [&](std::string_view stage) {
      run.report(stage, division.outlined(i).name, static_cast<double>(done) / static_cast<double>(all));
    };
    base::Watch making;
    const auto block = division.blocks.make(division.wanted[i]);
    const report::StageTime made{"block", making.stop()};
    const auto tell = [&](std::string_view stage) {
      const std::scoped_lock lock(progress);
      report(stage);
    };
    results[i] = work(block, inner, tell, made);
    const std::scoped_lock lock(progress);
    ++done;
    report("done");
  });
  return results;
}

/// One block: as it was kept, or else made and kept. Thread-safe; one for all blocks of a run.
class Maker {
 public:
  Maker(const Options& options, Keep keep, const Schedule& schedule);
  /// How much there is to do.
  void announce(std::size_t blocks, std::size_t buildings);
  void announce(const Division& division);

  /// A result without anything once the run is cancelled or something could not be kept.
  [[nodiscard]] auto operator()(const block::Block& block, const base::Run& run, const Tell& tell,
                                const report::StageTime& made) -> BlockResult;

  /// After the last one. Fails with what could not be kept.
  [[nodiscard]] auto finish(bool whole) -> base::Result<report::Reuse>;

 private:
  [[nodiscard]] auto made(const block::Block& block, const base::Run& run, const Tell& tell) -> BlockResult;
  [[nodiscard]] auto kept_or_made(const block::Block& own, const base::Run& run, const Tell& tell) -> BlockResult;
  [[nodiscard]] auto kept(const block::Block& own, const BlockKey& key) -> std::optional<BlockResult>;

  const Options& options_;
  Keep keep_;
  const Schedule& schedule_;
  BlockKey shared_;
  std::mutex mutex_;
  report::Reuse reuse_;
  std::map<std::string, BlockKey> keys_;
  std::optional<base::Failure> failure_;
  std::atomic<bool> failed_{false};
};

}  // namespace mansard::pipeline::detail
