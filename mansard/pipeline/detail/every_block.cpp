#include "mansard/pipeline/detail/every_block.hpp"

#include <algorithm>

#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/place.hpp"

namespace mansard::pipeline::detail {

auto check_usable(const model::Scene& scene) -> base::Result<void> {
  const bool usable = std::ranges::any_of(scene.footprints, [](const auto& f) { return !f.defect.has_value(); });
  if (!usable) {
    std::string why = "there are no footprints";
    if (!scene.footprints.empty())
      if (const auto& defect = scene.footprints.front().defect)
        why = "none of the " + std::to_string(scene.footprints.size()) +
              " footprints can be used; the first: " + defect->message;
    return base::error("pipeline-nothing", why);
  }
  return {};
}

auto divide(const model::Scene& scene, const Options& options, const base::Run& run) -> base::Result<Division> {
  if (auto usable = check_usable(scene); !usable) return usable.failure();
  base::Watch watch;
  Division out{block::Partition(scene, options.block, run), {}, {}};
  for (std::size_t i = 0; i < out.blocks.size(); ++i) out.wanted.push_back(i);
  out.time = {"block", watch.stop()};
  return out;
}

auto keep_only(Division& division, std::span<const std::string> only) -> base::Result<void> {
  if (only.empty()) return {};
  const auto name_of = [&](std::size_t i) -> const std::string& { return division.blocks.outlined(i).name; };
  for (const auto& name : only) {
    if (std::ranges::find(division.wanted, name, name_of) != division.wanted.end()) continue;
    std::vector<std::string> known;
    for (const std::size_t i : division.wanted) known.push_back(name_of(i));
    return base::error("pipeline-block-unknown",
                       "no block has this name" + base::did_you_mean(base::nearest_word(name, known)) +
                           "; blocks are named by the first id of their footprints",
                       name);
  }
  std::erase_if(division.wanted, [&](std::size_t i) { return std::ranges::find(only, name_of(i)) == only.end(); });
  return {};
}

auto stage_times(const report::StageTime& division, const std::vector<report::BlockReport>& blocks)
    -> std::vector<report::StageTime> {
  std::vector<std::string> names{division.stage};
  std::map<std::string, std::vector<base::Spent>> of_stage{{division.stage, {division.spent}}};
  for (const auto& block : blocks)
    for (const auto& [name, spent] : block.times.stages) {
      auto& pieces = of_stage[name];
      if (pieces.empty()) names.push_back(name);
      pieces.push_back(spent);
    }
  std::vector<report::StageTime> out;
  for (const auto& name : names) out.push_back({name, base::combined(of_stage[name])});
  return out;
}

auto combined_scores(const std::vector<report::BlockReport>& blocks) -> evaluate::Scores {
  std::vector<evaluate::Scores> scores;
  for (const auto& block : blocks) scores.push_back(block.scores);
  return evaluate::combined(scores);
}

Maker::Maker(const Options& options, Keep keep, const Schedule& schedule)
    : options_(options), keep_(keep), schedule_(schedule) {
  if (schedule.kept != nullptr) shared_ = key_of(options, keep);
}

void Maker::announce(std::size_t blocks, std::size_t buildings) {
  if (schedule_.tally == nullptr) return;
  schedule_.tally->buildings = buildings;
  schedule_.tally->blocks = blocks;
}

void Maker::announce(const Division& division) {
  std::size_t buildings = 0;
  for (const std::size_t i : division.wanted) buildings += division.blocks.outlined(i).members.size();
  announce(division.wanted.size(), buildings);
}

auto Maker::operator()(const block::Block& block, const base::Run& run, const Tell& tell,
                       const report::StageTime& made_in) -> BlockResult {
  if (failed_) return {};
  auto result = made(block, run, tell);
  auto& stages = result.report.times.stages;
  stages.insert(stages.begin(), made_in);
  if (schedule_.tally != nullptr && !run.cancelled() && !failed_) {
    ++schedule_.tally->blocks_done;
    schedule_.tally->buildings_done += block.members.size();
  }
  return result;
}

auto Maker::finish(bool whole) -> base::Result<report::Reuse> {
  if (failure_) return *failure_;
  if (schedule_.kept != nullptr && whole)
    if (auto settled = schedule_.kept->settle(keys_); !settled) return settled.failure();
  std::ranges::sort(reuse_.made);
  return std::move(reuse_);
}

auto Maker::made(const block::Block& block, const base::Run& run, const Tell& tell) -> BlockResult {
  BlockResult result;
  if (block.ground_known) {
    const auto own = block::in_own_frame(block);
    result = schedule_.kept == nullptr ? run_block(own.block, options_, run, tell, keep_)
                                       : kept_or_made(own.block, run, tell);
    place(result, own);
  } else {
    result = refused(block, options_.block);
  }
  for (const auto& member : block.members)
    result.grounds.push_back({member.feature, member.ground, member.ground_source, member.at_walls});
  return result;
}

auto Maker::kept_or_made(const block::Block& own, const base::Run& run, const Tell& tell) -> BlockResult {
  const auto key = key_of(own, shared_);
  if (auto result = kept(own, key)) {
    result->report.times = {};  // this run's
    return std::move(*result);
  }
  auto result = run_block(own, options_, run, tell, keep_);
  if (run.cancelled()) return result;  // not the whole of it
  if (const auto done = schedule_.kept->keep(key, bytes_of(result)); !done) {
    const std::scoped_lock lock(mutex_);
    if (!failure_) failure_ = done.failure();
    failed_ = true;
  }
  return result;
}

auto Maker::kept(const block::Block& own, const BlockKey& key) -> std::optional<BlockResult> {
  std::optional<BlockResult> result;
  if (const auto bytes = schedule_.kept->find(key)) result = result_of(*bytes);
  const std::scoped_lock lock(mutex_);
  keys_.emplace(own.name, key);
  if (result) {
    ++reuse_.blocks;
    if (schedule_.tally != nullptr) {
      ++schedule_.tally->blocks_kept;
      schedule_.tally->buildings_kept += own.members.size();
    }
  } else if (auto why = schedule_.kept->why_made(own.name, key); !why.empty()) {
    reuse_.made.emplace_back(own.name, std::move(why));
  }
  return result;
}

}  // namespace mansard::pipeline::detail
