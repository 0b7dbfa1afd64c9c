#include "mansard/profile/profile.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/profile/detail/caps.hpp"
#include "mansard/profile/detail/climb.hpp"
#include "mansard/profile/detail/columns.hpp"
#include "mansard/profile/detail/pitches.hpp"
#include "mansard/profile/detail/refine.hpp"
#include "mansard/profile/detail/runs.hpp"
#include "mansard/profile/detail/section_index.hpp"
#include "mansard/rays/hidden.hpp"

namespace mansard::profile {
namespace {

using detail::Run;
using geometry::Polygon;
using model::Plan;

/// What one run gave.
struct Fitted {
  detail::Choices choices;  ///< the greedy profile first
  Evidence evidence;
};

auto ground_of(const segment::Part& part, const block::Block& block) -> double {
  for (const auto& member : block.members)
    if (part.feature == member.feature) return member.ground;
  return block.ground;
}

/// Slices the mesh across the run and climbs each slice.
auto slices_of(const Polygon& polygon, const Run& run, const detail::SectionIndex& index, double base,
               const Options& options, Fitted& fitted) -> std::vector<detail::SliceColumns> {
  Evidence& evidence = fitted.evidence;
  std::vector<detail::SliceColumns> slices;
  std::vector<double> walls;
  for (auto sample : detail::samples_of(polygon, run, options)) {
    ++evidence.attempted;
    fitted.choices.reach = std::max(fitted.choices.reach, sample.reach);
    sample.reach = std::min(sample.reach, options.slice_inward);
    const auto pieces = index.cut({sample.foot, sample.inward, -options.slice_outward, sample.reach});
    const auto climb = detail::climb(pieces, options, base);
    if (!climb) continue;
    ++evidence.slices;
    const auto wall = detail::wall_position(*climb, options);
    if (wall) walls.push_back(*wall);
    slices.push_back(detail::columns_of(pieces, sample, base, wall, options));
  }
  if (!walls.empty()) {
    std::ranges::sort(walls);
    evidence.offset = -base::median_of_sorted(walls);
  }
  return slices;
}

/// Whether the roof behind the run is its own: enough of its slices rise inward.
auto is_pitched(const std::vector<detail::SliceColumns>& slices, const Options& options) -> bool {
  const auto rising = std::ranges::count_if(slices, [](const auto& slice) { return slice.first < slice.last; });
  return !slices.empty() && static_cast<double>(rising) >= options.pitched_share * static_cast<double>(slices.size());
}

/// The roof that the slices agree on, with at most that many pitches; just the wall where they agree on none.
auto pitched_profile(const std::vector<detail::SliceColumns>& slices, std::size_t pitches, const Options& options)
    -> std::optional<model::Profile> {
  const double tolerance = pitches == 1 ? options.single_pitch_tolerance : options.pitch_tolerance;
  const auto line =
      detail::supported(detail::fit_line(detail::pool(slices, options), pitches, options), slices, tolerance, options);
  if (line.empty()) return std::nullopt;
  auto profile = detail::profile_from(line, options);
  if (profile.back().inward == 0) return std::nullopt;
  return profile;
}

/// Adds the profiles that the slices suggest, most pitches first; the wall is always the last of them.
void suggest(std::vector<detail::SliceColumns>& slices, double height, const Options& options,
             std::vector<model::Profile>& profiles) {
  const auto wall = detail::vertical_profile(detail::edge_height(slices, options).value_or(height), options);
  detail::find_rising(slices, options);
  if (options.quality != Quality::simple && is_pitched(slices, options)) {
    for (const std::size_t pitches : {3U, 1U}) {
      if (options.quality == Quality::moderate && pitches > 1) continue;
      auto profile = pitched_profile(slices, pitches, options);
      if (profile && std::ranges::find(profiles, *profile) == profiles.end()) profiles.push_back(std::move(*profile));
    }
  }
  profiles.push_back(wall);
}

/// A level lower part before the profile.
auto set_back(const model::Profile& profile, const detail::Setback& setback) -> model::Profile {
  model::Profile out{{0, 0}, {0, setback.height}, {setback.depth, setback.height}};
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const model::ProfilePoint next{profile[i].inward + setback.depth, std::max(profile[i].height, setback.height)};
    if (!(next == out.back())) out.push_back(next);
  }
  return out;
}

/// The candidates of a run. The greedy choice is the first.
auto fit_run(const Polygon& polygon, const Run& run, const detail::SectionIndex& index, double base, double height,
             const Options& options) -> Fitted {
  Fitted fitted;
  auto& profiles = fitted.choices.profiles;
  auto slices = slices_of(polygon, run, index, base, options, fitted);
  suggest(slices, height, options, profiles);
  if (options.quality != Quality::high) return fitted;
  // Evidence for a step back comes from the scan as a whole, so only refine() may choose it.
  if (const auto setback = detail::find_setback(slices, options)) {
    auto upper = detail::behind(slices, *setback, options);
    std::vector<model::Profile> beyond;
    suggest(upper, height, options, beyond);
    for (const auto& profile : beyond) profiles.push_back(set_back(profile, *setback));
  }
  return fitted;
}

/// One part on its way to a plan.
struct Work {
  std::vector<detail::RoofSample> samples;
  std::vector<double> heights;  ///< the samples', sorted
  std::vector<Run> runs;
  std::vector<detail::Choices> choices;  ///< per run, as `evidence` and `chosen`
  std::vector<Evidence> evidence;
  std::vector<std::size_t> chosen;
  std::vector<double> caps;
  double base = 0, height = 0;

  [[nodiscard]] auto profile(std::size_t run) const -> const model::Profile& {
    return choices[run].profiles[chosen[run]];
  }
};

auto sorted_heights(const std::vector<detail::RoofSample>& samples) -> std::vector<double> {
  std::vector<double> heights;
  for (const auto& sample : samples) heights.push_back(sample.height);
  std::ranges::sort(heights);
  return heights;
}

auto prepare(const segment::Part& part, const block::Block& block, const rays::Scene& mesh, const rays::Scene* above,
             const Options& options) -> Work {
  Work work;
  work.base = ground_of(part, block);
  work.runs = detail::runs_of(part.polygon, options.run_angle);
  work.choices.resize(work.runs.size());
  work.evidence.resize(work.runs.size());
  work.chosen.assign(work.runs.size(), 0);
  work.samples = detail::look_over(mesh, part.polygon, work.base, options);
  work.heights = sorted_heights(work.samples);
  std::optional<double> hidden;
  if (above)
    hidden =
        rays::hidden_height(work.heights, sorted_heights(detail::look_over(*above, part.polygon, work.base, options)));
  if (hidden) work.samples.clear(), work.heights.clear();
  const double least = options.minimum_height;
  if (!work.heights.empty()) work.height = std::max(least, base::median_of_sorted(work.heights));
  else if (hidden) work.height = std::max(least, *hidden);
  else work.height = part.height - work.base > least ? part.height - work.base : options.assumed_height;
  return work;
}

auto caps_of(const Work& work, const Options& options) -> std::vector<double> {
  std::vector<double> tops;
  bool pitched = false;
  for (std::size_t r = 0; r < work.runs.size(); ++r) {
    if (work.evidence[r].slices == 0) continue;
    tops.push_back(work.profile(r).back().height);
    pitched = pitched || work.profile(r).back().inward > 0;
  }
  return detail::caps_from(work.heights, tops, pitched, work.height, options);
}

/// Short runs (bevels, jogs, pieces of curves) see too little: they follow a neighbour that they hardly turn from, or
/// stand as walls, unless the scan clearly says otherwise.
void lead_short_runs(const Polygon& polygon, Work& work, const Options& options) {
  for (std::size_t r = 0; r < work.runs.size(); ++r) {
    if (work.evidence[r].slices == 0 || detail::length_of(polygon, work.runs[r]) >= options.short_run) continue;
    auto& profiles = work.choices[r].profiles;
    const auto wall = std::ranges::find_if(profiles, [](const auto& p) { return p.back().inward == 0; });
    if (wall != profiles.end()) std::rotate(profiles.begin(), wall, wall + 1);
    for (const auto neighbour : detail::gentle_neighbours(polygon, work.runs, r, options)) {
      if (detail::length_of(polygon, work.runs[neighbour]) < options.short_run) continue;
      const auto lead = work.choices[neighbour].profiles.front();
      if (lead.back().inward > 0) profiles.insert(profiles.begin(), lead);
    }
  }
}

/// Weighs the runs' candidates against each other and against the scan.
void settle(Work& work, const Polygon& polygon, const Options& options) {
  lead_short_runs(polygon, work, options);
  work.caps = caps_of(work, options);
  if (work.samples.empty()) return;
  work.chosen = detail::refine(polygon, work.runs, work.choices, work.samples, work.caps, options).chosen;
  work.caps = caps_of(work, options);
}

/// The plan of a part, one profile a run.
auto plan_of(const Polygon& polygon, const Work& work) -> Plan {
  Plan plan;
  plan.base = work.base;
  plan.cap = work.caps.front();
  plan.outer = {polygon.outer, std::vector<std::uint32_t>(polygon.outer.size(), 0)};
  for (const auto& hole : polygon.holes) plan.holes.push_back({hole, std::vector<std::uint32_t>(hole.size(), 0)});
  for (std::size_t r = 0; r < work.runs.size(); ++r) {
    const Run& run = work.runs[r];
    auto& ring = run.ring == 0 ? plan.outer : plan.holes[run.ring - 1];
    for (const std::size_t edge : run.edges) ring.profile_of_edge[edge] = static_cast<std::uint32_t>(r);
    plan.profiles.push_back(work.profile(r));
  }
  return plan;
}

auto alternatives_of(const Work& work) -> std::vector<std::vector<model::Profile>> {
  std::vector<std::vector<model::Profile>> out(work.runs.size());
  for (std::size_t r = 0; r < work.runs.size(); ++r)
    for (std::size_t c = 0; c < work.choices[r].profiles.size(); ++c)
      if (c != work.chosen[r]) out[r].push_back(work.choices[r].profiles[c]);
  return out;
}

}  // namespace

auto fit(const segment::Segmentation& segmentation, const block::Block& block, const rays::Scene& mesh,
         const Options& options, const base::Run& run, const rays::Scene* above) -> std::vector<ProfiledFootprint> {
  run.report("profile", block.name, 0);
  const auto& parts = segmentation.parts;
  const detail::SectionIndex index(block.mesh);

  std::vector<Work> works(parts.size());
  base::parallel_for(parts.size(), [&](std::size_t i) { works[i] = prepare(parts[i], block, mesh, above, options); });

  // Runs, not parts, are the tasks: one part may own most of the edges.
  std::vector<std::pair<std::size_t, std::size_t>> tasks;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t r = 0; r < works[i].runs.size(); ++r) tasks.emplace_back(i, r);
  base::parallel_for(tasks.size(), [&](std::size_t task) {
    const auto [i, r] = tasks[task];
    Work& work = works[i];
    if (run.cancelled()) {
      work.choices[r].profiles = {detail::vertical_profile(work.height, options)};
      return;
    }
    auto fitted = fit_run(parts[i].polygon, work.runs[r], index, work.base, work.height, options);
    work.choices[r] = std::move(fitted.choices);
    work.evidence[r] = fitted.evidence;
  });
  base::parallel_for(parts.size(), [&](std::size_t i) { settle(works[i], parts[i].polygon, options); });

  std::vector<ProfiledFootprint> footprints(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    footprints[i].plan = plan_of(parts[i].polygon, works[i]);
    footprints[i].caps = works[i].caps;
    footprints[i].evidence = works[i].evidence;
    footprints[i].alternatives = alternatives_of(works[i]);
  }
  run.report("profile", block.name, 1);
  return footprints;
}

auto vertical_plan(const Polygon& polygon, double base, double cap) -> Plan {
  Plan plan;
  plan.outer = {polygon.outer, std::vector<std::uint32_t>(polygon.outer.size(), 0)};
  for (const auto& hole : polygon.holes) plan.holes.push_back({hole, std::vector<std::uint32_t>(hole.size(), 0)});
  plan.profiles = {{{0, 0}, {0, cap}}};
  plan.base = base;
  plan.cap = cap;
  return plan;
}

}  // namespace mansard::profile
