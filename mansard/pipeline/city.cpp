#include "mansard/pipeline/city.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include "mansard/base/pack.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/city_builder.hpp"
#include "mansard/pipeline/detail/city_tasks.hpp"
#include "mansard/pipeline/detail/every_block.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"
#include "mansard/report/measures.hpp"

namespace mansard::pipeline {

auto PutAside::each(const Visit& visit) const -> base::Result<void> {
  for (std::size_t f = 0; f < places_.size(); ++f) {
    const auto bytes = spool_->read(places_[f].offset, places_[f].bytes);
    if (!bytes) return bytes.failure();
    detail::Finished one;
    base::Unpacker from(*bytes);
    if (!from.take(one) || !from.done()) return detail::put_aside_changed();
    if (const auto more = afterwards_.find(f); more != afterwards_.end()) {
      one.report.reasons.insert(one.report.reasons.end(), more->second.begin(), more->second.end());
      report::set_reasons(one.building.attributes, one.report.reasons);
    }
    if (auto visited = visit(std::move(one.building), std::move(one.report)); !visited) return visited;
  }
  return {};
}

auto PutAside::each_error_map(const std::function<void(const evaluate::ErrorMap&)>& visit) const -> base::Result<void> {
  for (const auto& place : error_maps_) {
    const auto bytes = spool_->read(place.offset, place.bytes);
    if (!bytes) return bytes.failure();
    evaluate::ErrorMap map;
    base::Unpacker from(*bytes);
    if (!from.take(map) || !from.done()) return detail::put_aside_changed();
    visit(map);
  }
  return {};
}

namespace {

/// Blocks that are worked through together, with the part of the mesh that they need in memory.
struct Task {
  std::vector<const block::Group*> groups;
  std::set<ingest::MeshCells::Cell> cells;
};

/// Of groups by place, those whose middle lies in the share, by the triangles near them.
auto share_of(const std::vector<const block::Group*>& groups, const ingest::CityScene& city, std::size_t share,
              std::size_t shares) -> std::vector<const block::Group*> {
  constexpr std::size_t own_work = 200;  // triangles; about what a block costs beside its mesh
  std::vector<std::size_t> works;
  std::size_t all = 0, before = 0;
  for (const auto* group : groups) {
    std::size_t work = own_work;
    if (city.cells) {
      for (const auto& cell : city.cells->cells_in(group->box)) work += city.cells->triangles_in(cell);
    } else {
      work +=
          static_cast<std::size_t>((group->box.most.x - group->box.least.x) * (group->box.most.y - group->box.least.y));
    }
    works.push_back(work);
    all += work;
  }
  std::vector<const block::Group*> own;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if ((2 * before + works[i]) * shares / (2 * all) == share) own.push_back(groups[i]);
    before += works[i];
  }
  return own;
}

auto tasks_of(const std::vector<const block::Group*>& groups, const ingest::CityScene& city, double most)
    -> std::vector<Task> {
  const auto most_triangles = static_cast<std::size_t>(most);
  std::vector<Task> out;
  std::size_t triangles = 0;
  for (const auto* group : groups) {
    std::set<ingest::MeshCells::Cell> cells;
    std::size_t more = 0;
    if (city.cells)
      for (const auto& cell : city.cells->cells_in(group->reach)) {
        cells.insert(cell);
        if (out.empty() || !out.back().cells.contains(cell)) more += city.cells->triangles_in(cell);
      }
    if (out.empty() || triangles + more > most_triangles) {
      out.emplace_back();
      triangles = more = 0;
      for (const auto& cell : cells) more += city.cells->triangles_in(cell);
    }
    triangles += more;
    out.back().groups.push_back(group);
    out.back().cells.merge(cells);
  }
  return out;
}

/// work(scene, division, progress, feature numbers of the whole; empty where they are the scene's own) for every task,
/// until one fails.
template <class Work>
auto for_every_task(const ingest::CityScene& city, const Options& options, const base::Run& run, detail::Maker& maker,
                    std::optional<std::pair<std::size_t, std::size_t>> share, const Work& work) -> base::Result<void> {
  if (!city.cells && !share) {  // one task, whose division has the groups
    auto division = detail::divide(city.scene, options, run);
    if (!division) return division.failure();
    maker.announce(*division);
    return work(city.scene, *division, detail::Progress{}, std::vector<std::size_t>());
  }
  const auto groups = block::groups(city.scene, options.block);
  auto wanted = detail::by_place(groups, city.scene.frame);
  if (share) wanted = share_of(wanted, city, share->first, share->second);
  std::size_t buildings = 0;
  for (const auto* group : wanted) buildings += group->features.size();
  maker.announce(wanted.size(), buildings);
  if (!city.cells) {
    auto division = detail::divide(city.scene, options, run);
    if (!division) return division.failure();
    std::set<std::size_t> firsts;
    for (const auto* group : wanted) firsts.insert(group->features.front());
    std::erase_if(division->wanted, [&](std::size_t i) {
      return !firsts.contains(division->blocks.outlined(i).members.front().feature);
    });
    return work(city.scene, *division, detail::Progress{}, std::vector<std::size_t>());
  }
  const auto index = detail::index_of(city.scene);
  detail::Progress progress{0, wanted.size()};
  for (const auto& task : tasks_of(wanted, city, options.ingest.task_triangles)) {
    if (run.cancelled()) return base::stopped();
    auto part = detail::part_of(city.scene, task.groups, index, false);
    auto mesh = city.cells->load(task.cells);
    if (!mesh) return mesh.failure();
    part.scene.mesh = std::move(*mesh);
    auto inner = run;
    inner.progress = nullptr;  // the division of a part is no stage of the whole
    auto division = detail::divide(part.scene, options, inner);
    if (!division) return division.failure();
    if (auto worked = work(part.scene, *division, progress, part.features); !worked) return worked;
    progress.before += division->wanted.size();
  }
  return {};
}

}  // namespace

auto reconstruct_aside(const ingest::CityScene& city, const Options& options, const base::Run& run,
                       const Schedule& schedule, Aside aside) -> base::Result<PutAside> {
  base::Watch watch;
  PutAside out;
  const model::Scene& scene = city.scene;
  detail::CityBuilder builder(out, scene.footprints.size());
  if (auto opened = builder.open(); !opened) return opened.failure();
  if (auto usable = detail::check_usable(scene); !usable) return usable.failure();
  detail::Maker maker(options, Keep::models, schedule);
  struct Made {
    std::size_t first = 0;  ///< of its features
    report::BlockReport report;
    std::vector<base::Diagnostic> warnings;
    std::size_t error_map = 0;  ///< its number among those that were put aside
  };
  std::vector<Made> made;
  std::vector<base::Spent> dividing;
  auto done = for_every_task(
      city, options, run, maker, std::nullopt,
      [&](const model::Scene& part, const detail::Division& division, detail::Progress progress,
          const std::vector<std::size_t>& features) -> base::Result<void> {
        dividing.push_back(division.time.spent);
        const auto number = [&](std::size_t f) { return features.empty() ? f : features[f]; };
        auto some = detail::for_every(
            division, run,
            [&](const auto& block, const auto& inner, const auto& tell, const auto& making) {
              auto result = maker(block, inner, tell, making);
              Made own;
              own.first = number(block.members.front().feature);
              for (const auto& [feature, one] : detail::finish_block(part, result, options, own.warnings))
                builder.take(number(feature), one);
              if (aside == Aside::models_and_error_maps) own.error_map = builder.take(result.map);
              own.report = std::move(result.report);
              return own;
            },
            progress);
        std::ranges::move(some, std::back_inserter(made));
        return builder.check();
      });
  if (run.cancelled()) return base::stopped();
  if (!done) return done.failure();
  auto reuse = maker.finish(true);
  if (!reuse) return reuse.failure();

  for (std::size_t f = 0; f < scene.footprints.size(); ++f)
    if (!builder.has(f)) builder.take(f, detail::unbuilt(scene, f, options));
  auto& summary = out.summary;
  std::ranges::sort(made, {}, &Made::first);
  std::vector<std::size_t> error_maps;
  for (auto& one : made) {
    error_maps.push_back(one.error_map);
    summary.blocks.push_back(std::move(one.report));
    std::ranges::move(one.warnings, std::back_inserter(summary.warnings));
  }
  if (aside == Aside::models_and_error_maps) builder.order_error_maps(error_maps);
  builder.finish(run);
  if (run.cancelled()) return base::stopped();
  out.frame = scene.frame;
  out.made_by = detail::made_by(scene, options);
  summary.reuse = std::move(*reuse);
  summary.scores = detail::combined_scores(summary.blocks);
  summary.times = {watch.stop(), detail::stage_times({"block", base::combined(dividing)}, summary.blocks)};
  return out;
}

auto make_share(const ingest::CityScene& city, const Options& options, const base::Run& run, Keep keep,
                const Schedule& schedule, std::size_t share, std::size_t shares) -> base::Result<void> {
  if (auto usable = detail::check_usable(city.scene); !usable) return usable;
  detail::Maker maker(options, keep, schedule);
  auto done = for_every_task(city, options, run, maker, std::pair(share, shares),
                             [&](const model::Scene&, const detail::Division& division, detail::Progress progress,
                                 const std::vector<std::size_t>&) -> base::Result<void> {
                               (void)detail::for_every(
                                   division, run,
                                   [&](const auto& block, const auto& inner, const auto& tell, const auto& making) {
                                     return maker(block, inner, tell, making).parts.size();  // the rest is kept
                                   },
                                   progress);
                               return {};
                             });
  if (run.cancelled()) return base::stopped();
  if (!done) return done;
  if (auto reuse = maker.finish(false); !reuse) return reuse.failure();
  return {};
}

}  // namespace mansard::pipeline
