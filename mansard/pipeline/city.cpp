#include "mansard/pipeline/city.hpp"

#include <algorithm>

#include "mansard/base/pack.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/every_block.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"

namespace mansard::pipeline {

/// Takes finished features from any thread.
class CityBuilder {
 public:
  CityBuilder(PutAside& city, std::size_t features) : city_(city), standing_(features) {
    city.places_.resize(features);
  }

  [[nodiscard]] auto open() -> base::Result<void> {
    auto spool = base::Spool::open();
    if (!spool) return spool.failure();
    city_.spool_ = std::move(*spool);
    return {};
  }

  /// Features beyond those of the city are around it, and not put aside.
  void take(std::size_t feature, const detail::Finished& one) {
    if (feature >= city_.places_.size()) return;
    std::string bytes;
    base::pack(one, bytes);
    auto standing = detail::standing(feature, one.building);
    const std::scoped_lock lock(mutex_);
    city_.places_[feature] = {city_.spool_->size(), static_cast<std::uint32_t>(bytes.size())};
    city_.spool_->append(bytes);
    city_.outcomes.add(one.report.outcome);
    standing_[feature] = std::move(standing);
  }

  [[nodiscard]] auto has(std::size_t feature) const -> bool { return city_.places_[feature].bytes > 0; }

  /// After the last one: what only all of them together show.
  void finish(const base::Run& run) {
    std::vector<detail::Standing> all;
    for (auto& some : standing_) std::ranges::move(some, std::back_inserter(all));
    auto [of_each, in_all] = detail::overlaps(all, run);
    for (auto& [building, what] : of_each) city_.afterwards_[building].push_back(std::move(what));
    std::ranges::move(in_all, std::back_inserter(city_.summary.warnings));
  }

 private:
  PutAside& city_;
  std::mutex mutex_;
  std::vector<std::vector<detail::Standing>> standing_;  ///< by feature
};

auto PutAside::each(const Visit& visit) const -> base::Result<void> {
  for (std::size_t f = 0; f < places_.size(); ++f) {
    const auto bytes = spool_->read(places_[f].offset, places_[f].bytes);
    if (!bytes) return bytes.failure();
    detail::Finished one;
    base::Unpacker from(*bytes);
    if (!from.take(one) || !from.done())
      return base::error("file-write",
                         "what was put aside in the folder for temporary files (TMPDIR) was changed there");
    if (const auto more = afterwards_.find(f); more != afterwards_.end())
      one.report.reasons.insert(one.report.reasons.end(), more->second.begin(), more->second.end());
    if (auto visited = visit(std::move(one.building), std::move(one.report)); !visited) return visited;
  }
  return {};
}

auto reconstruct_aside(const model::Scene& scene, const Options& options, const base::Run& run,
                       const Schedule& schedule) -> base::Result<PutAside> {
  base::Watch watch;
  PutAside out;
  const auto division = detail::divide(scene, options, run);
  if (!division) return division.error();

  CityBuilder builder(out, scene.footprints.size());
  if (auto opened = builder.open(); !opened) return opened.failure();
  detail::Maker maker(*division, options, Keep::models, schedule);
  struct Made {
    report::BlockReport report;
    std::vector<base::Diagnostic> warnings;
  };
  auto made = detail::for_every(*division, run,
                                [&](const auto& block, const auto& inner, const auto& tell, const auto& making) {
                                  auto result = maker(block, inner, tell, making);
                                  Made own;
                                  for (const auto& [feature, one] : detail::finish_block(scene, result, own.warnings))
                                    builder.take(feature, one);
                                  own.report = std::move(result.report);
                                  return own;
                                });
  if (run.cancelled()) return detail::cancelled();
  auto reuse = maker.finish(true);
  if (!reuse) return reuse.failure();

  for (std::size_t f = 0; f < scene.footprints.size(); ++f)
    if (!builder.has(f)) builder.take(f, detail::unbuilt(scene, f));
  auto& summary = out.summary;
  for (auto& [report, warnings] : made) {
    summary.blocks.push_back(std::move(report));
    std::ranges::move(warnings, std::back_inserter(summary.warnings));
  }
  builder.finish(run);
  if (run.cancelled()) return detail::cancelled();
  out.frame = scene.frame;
  out.made_by = detail::made_by(scene, options);
  summary.reuse = std::move(*reuse);
  summary.scores = detail::combined_scores(summary.blocks);
  summary.times = {watch.stop(), detail::stage_times(division->time, summary.blocks)};
  return out;
}

}  // namespace mansard::pipeline
