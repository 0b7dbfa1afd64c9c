// The steps of a comparison: who is on whose ground, what all have in common, what is different on each, and which of
// that is more than errors make of nothing.
#include "mansard/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/base/statistics.hpp"
#include "mansard/base/text.hpp"
#include "mansard/compare/detail/matching.hpp"
#include "mansard/compare/detail/places.hpp"

namespace mansard::compare {
namespace {

using detail::Ground;
using detail::Of;
using detail::Place;
using detail::Places;
using geometry::Point2;

/// Both states, and what was prepared of them.
struct Pair {
  const State& old;
  const State& now;
  const Options& options;
  detail::Outlines old_outlines, new_outlines;
  detail::Matching matching;
  detail::Surfaces old_surfaces, new_surfaces;
  Offset offset;
  std::optional<double> model_error;
  double scale = 1;

  Pair(const State& a, const State& b, const Options& asked)
      : old(a),
        now(b),
        options(asked),
        old_outlines(a),
        new_outlines(b),
        old_surfaces(a, {}, 0),
        new_surfaces(b, {}, 0) {}

  [[nodiscard]] auto shift() const -> Point2 { return offset.removed ? offset.plan : Point2{}; }
  [[nodiscard]] auto lift() const -> double { return offset.removed ? offset.height : 0; }
};

auto in_any(const State& state, const std::vector<std::uint32_t>& near, Point2 at) -> bool {
  return std::ranges::any_of(near, [&](std::uint32_t b) { return geometry::contains(state.buildings[b].outline, at); });
}

auto moved(const geometry::Box2& box, Point2 by) -> geometry::Box2 {
  return box.empty() ? box : geometry::Box2{box.least + by, box.most + by};
}

/// The ground of a new building: its own, and that of old ones which no new building has any more, where it has most of
/// them.
auto ground_of_new(const Pair& pair, std::uint32_t n) -> Ground {
  const auto& building = pair.now.buildings[n];
  std::vector<std::uint32_t> heirs_of;
  Ground out;
  out.box = pair.new_outlines.box(n);
  out.area = pair.new_outlines.area(n);
  for (const auto& shared : pair.matching.of_new[n])
    if (pair.matching.of_old[shared.building].front().building == n) {
      heirs_of.push_back(shared.building);
      out.box.include(moved(pair.old_outlines.box(shared.building), pair.shift()));
      out.area += std::max(0.0, pair.old_outlines.area(shared.building) - shared.area);
    }
  const auto near_new = pair.new_outlines.near(out.box),
             near_old = pair.old_outlines.near(moved(out.box, Point2{} - pair.shift()));
  const auto in_old = [&pair, near_old](Point2 at) { return in_any(pair.old, near_old, at - pair.shift()); };
  const auto in_new = [&pair, near_new](Point2 at) { return in_any(pair.now, near_new, at); };
  out.contains = [&pair, &building, heirs_of, in_new](Point2 at) {
    if (geometry::contains(building.outline, at)) return true;
    return in_any(pair.old, heirs_of, at - pair.shift()) && !in_new(at);
  };
  out.old_contains = in_old;
  out.new_contains = in_new;
  out.new_ground = building.ground;
  const auto& of = pair.matching.of_new[n];
  out.old_ground = of.empty() ? building.ground : pair.old.buildings[of.front().building].ground + pair.lift();
  return out;
}

/// The ground of an old building without any new one.
auto ground_of_old(const Pair& pair, std::uint32_t o) -> Ground {
  const auto& building = pair.old.buildings[o];
  Ground out;
  out.box = moved(pair.old_outlines.box(o), pair.shift());
  out.area = pair.old_outlines.area(o);
  const auto near_new = pair.new_outlines.near(out.box);
  out.contains = [&pair, &building, near_new](Point2 at) {
    return geometry::contains(building.outline, at - pair.shift()) && !in_any(pair.now, near_new, at);
  };
  out.old_contains = [](Point2) { return true; };
  out.new_contains = [](Point2) { return false; };
  out.old_ground = out.new_ground = building.ground + pair.lift();
  return out;
}

// ---- what errors make of nothing

/// m; how accurate the models of a state are that are on a ground: of several, the worst. Where nothing says it of a
/// model, it is what models differ by on unchanged buildings.
auto error_of(const Pair& pair, const State& state, const std::vector<std::uint32_t>& buildings,
              const std::optional<double>& asked) -> double {
  const double other = asked.value_or(pair.model_error.value_or(assumed_error));
  double worst = 0;
  for (const auto b : buildings) worst = std::max(worst, state.buildings[b].error.value_or(other));
  return buildings.empty() ? other : worst;
}

/// What of the variance of a mean difference one state has. A scan has its noise, of which so much as is correlated is
/// one error, and half of it in common over the building: what an adjustment leaves. A model is wrong somewhere, and
/// may be so at the one place that differs: its mean square over the building is then all there.
struct StateError {
  double noise = 0, correlated_area = 1, model = 0, building = 0;  // m, m², m, m²
  [[nodiscard]] auto variance(double area, double seen) const -> double {
    const double scan = noise * noise * (std::min(1.0, correlated_area / area) + 0.25);
    return scan + (1 - seen) * model * model * std::max(1.0, building / area);
  }
};

struct Errors {
  StateError old, now;
  double scale = 1, offset = 0;  ///< m; standard error of what was taken off
  [[nodiscard]] auto of(double area, double old_seen, double new_seen) const -> double {
    return std::sqrt(scale * scale * (old.variance(area, old_seen) + now.variance(area, new_seen)) + offset * offset);
  }
};

auto errors_of(const Pair& pair, const Change& change, double area) -> Errors {
  const auto of = [&](const State& state, const std::vector<std::uint32_t>& own, const std::optional<double>& asked) {
    return StateError{state.accuracy.noise, state.accuracy.correlated_area, error_of(pair, state, own, asked), area};
  };
  return {of(pair.old, change.old, pair.options.old_error), of(pair.now, change.now, pair.options.new_error),
          pair.scale, pair.offset.removed ? pair.offset.height_error : 0};
}

/// How far the place of a wall may differ, m, where scans round, sample and displace it; and of an outline, by how much
/// the walls of a survey are off theirs.
struct Reach {
  double wall = 0, outline = 0;

  explicit Reach(const Pair& pair) {
    constexpr double sure = 2, most = 1.5;  // standard deviations; m, as wide as no error of a wall is
    const auto spread = [](const model::Accuracy& a) { return a.offset_spread * a.offset_spread; };
    const auto blur = [](const model::Accuracy& a) { return a.edge() * a.edge() + a.spacing * a.spacing / 12; };
    const auto& [old, now] = std::pair(pair.old.accuracy, pair.now.accuracy);
    const auto of = [&](double variance) {
      const double least = pair.options.smallest;
      return std::clamp(sure * std::sqrt(variance), least, std::max(most, least));
    };
    // Where the shift of the outlines is not taken off, it is what they are displaced against their scans by.
    const auto apart = pair.offset.removed ? Point2{} : old.offset - now.offset;
    const double survey = spread(old) + spread(now) + dot(apart, apart) / (sure * sure);
    outline = of(survey);
    wall = of(survey + blur(old) + blur(now));
  }
};

/// Twice the part of a normal distribution beyond so many standard deviations.
auto chance_of(double sigmas) -> double {
  return static_cast<double>(std::erfc(static_cast<long double>(std::abs(sigmas)) / std::sqrt(2.0L)));
}

// ---- one building

auto share_seen(const Places& places, const std::vector<bool>& marked, bool Place::*seen) -> double {
  double all = 0, found = 0;
  for (std::size_t c = 0; c < marked.size(); ++c)
    if (marked[c]) all += 1, found += places.all[c].*seen ? 1 : 0;
  return all > 0 ? found / all : 0;
}

/// The measures of the marked places as a part of a change.
auto part_of(const Places& places, const std::vector<bool>& marked, Kind kind) -> Part {
  Part out;
  out.kind = kind;
  std::vector<double> heights;
  double sum = 0;
  for (std::size_t c = 0; c < marked.size(); ++c)
    if (marked[c]) heights.push_back(places.all[c].models), sum += places.all[c].difference;
  if (heights.empty()) return out;
  const auto count = static_cast<double>(heights.size());
  out.area = count * places.step * places.step;
  for (const double height : heights) out.volume += height * places.step * places.step;
  out.height = base::mean_median(std::move(heights));
  out.mean = sum / count;
  out.old_seen = share_seen(places, marked, &Place::old_seen);
  out.new_seen = share_seen(places, marked, &Place::new_seen);
  return out;
}

enum class By : std::uint8_t { pairs, models };

/// Where the difference is above the smallest change in one direction, over a disc that walls cannot make.
auto marked_where(const Places& places, Of of, double sign, double smallest, double reach, By by, bool only)
    -> std::vector<bool> {
  std::vector<bool> marked(places.all.size());
  for (std::size_t c = 0; c < marked.size(); ++c) {
    const auto& place = places.all[c];
    marked[c] = place.of == of && sign * (by == By::pairs ? place.difference : place.models) > smallest;
  }
  return detail::opened(places, marked, reach, only ? std::optional(of) : std::nullopt);
}

constexpr double level = 0.0875;  // tangent of 5°: less is no slope (ms_roof_type)

/// Where both states have a roof, and one is higher or lower than the other.
struct Roofs {
  std::vector<bool> up, down;

  Roofs(const Places& places, const Pair& pair, By by)
      : up(marked_where(places, Of::both, 1, pair.options.smallest, Reach(pair).wall, by, true)),
        down(marked_where(places, Of::both, -1, pair.options.smallest, Reach(pair).wall, by, true)) {}
};

/// All ways in which a building may have changed; those with places. `change` says who is on its ground.
auto parts_of(const Places& places, const Pair& pair, const Change& change, By by) -> std::vector<Part> {
  // Less than this of its ground is of neighbours, whose outlines are not quite the same in both states.
  constexpr double of_neighbours = 0.1;
  const auto there = [&](const std::vector<std::uint32_t>& own, Of only) {
    const auto built = static_cast<double>(places.count(Of::both) + places.count(only));
    return !own.empty() && built > of_neighbours * static_cast<double>(change.cells);
  };
  const bool was = there(change.old, Of::old_only), is = there(change.now, Of::new_only);
  const double smallest = pair.options.smallest, reach = Reach(pair).outline;
  const Roofs roofs(places, pair, by);
  std::vector<Part> out;
  const auto add = [&](const std::vector<bool>& marked, Kind kind) {
    auto part = part_of(places, marked, kind);
    if (part.area > 0) out.push_back(part);
  };
  const bool slopes =
      detail::slope_of_difference(places, roofs.up) > level || detail::slope_of_difference(places, roofs.down) > level;
  add(roofs.up, slopes ? Kind::reroofed : Kind::raised);
  add(roofs.down, slopes ? Kind::reroofed : Kind::lowered);
  add(marked_where(places, Of::new_only, 1, smallest, reach, by, !was), was ? Kind::extended : Kind::built);
  add(marked_where(places, Of::old_only, -1, smallest, reach, by, !is), is ? Kind::reduced : Kind::gone);
  return out;
}

/// m; root mean square difference of both models where both have a roof, but for what walls make that are not at the
/// same place.
auto rms_of(const Places& places, const Pair& pair) -> double {
  const Roofs roofs(places, pair, By::models);
  double squares = 0, count = 0;
  for (std::size_t c = 0; c < places.all.size(); ++c) {
    const auto& place = places.all[c];
    if (place.of != Of::both) continue;
    if (std::abs(place.models) > pair.options.smallest && !roofs.up[c] && !roofs.down[c]) continue;
    squares += place.models * place.models;
    count += 1;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

/// By how much the roofs of both states differ, where both have one.
void measure_height(const Places& places, Change& change) {
  std::vector<double> heights;
  for (const auto& place : places.all)
    if (place.of == Of::both) heights.push_back(place.models);
  if (heights.empty()) return;
  change.common = static_cast<double>(heights.size()) * places.step * places.step;
  change.height = base::mean_median(std::move(heights));
}

/// What is measured of one building, before it is known which chances are small enough.
void measure(const Pair& pair, const Places& places, Change& change) {
  std::vector<bool> all(places.all.size());
  for (std::size_t c = 0; c < places.all.size(); ++c) {
    all[c] = places.all[c].of != Of::nothing;
    change.cells += all[c] ? 1 : 0;
  }
  if (change.cells == 0) {
    change.kind = Kind::unseen;
    change.why.emplace_back("one of the states has neither a model nor a scan there");
    return;
  }
  change.area = static_cast<double>(change.cells) * places.step * places.step;
  change.old_seen = share_seen(places, all, &Place::old_seen);
  change.new_seen = share_seen(places, all, &Place::new_seen);
  measure_height(places, change);
  if (change.common > 0) change.rms = rms_of(places, pair);
  change.parts = parts_of(places, pair, change, By::pairs);
  std::ranges::stable_sort(change.parts,
                           [](const Part& a, const Part& b) { return std::abs(a.volume) > std::abs(b.volume); });
  for (const auto& part : change.parts) change.differing += part.area;
  // What only models say, where the scans are at hand.
  if (change.parts.empty() && (pair.old_surfaces.has_scan() || pair.new_surfaces.has_scan()))
    for (const auto& part : parts_of(places, pair, change, By::models))
      change.why.push_back("the models differ by " + base::to_text(part.height, 1) + " m over " +
                           base::to_text(part.area, 0) + " m², which the scans do not show");
}

constexpr double ways = 4;  // in which a building may have changed: raised, lowered, extended, reduced

/// What has another outline does not depend on where the roofs of the rest are wrong, and one of its heights is the
/// ground.
auto for_kind(Errors errors, Kind kind) -> Errors {
  if (kind == Kind::built || kind == Kind::extended) errors.old.model = errors.now.building = 0;
  if (kind == Kind::gone || kind == Kind::reduced) errors.now.model = errors.old.building = 0;
  return errors;
}

/// How much more than nothing the differences of a building are.
void weigh(const Pair& pair, Change& change) {
  if (change.kind == Kind::unseen) return;
  const auto errors = errors_of(pair, change, change.area);
  if (change.common > 0) change.height_error = errors.of(change.common, change.old_seen, change.new_seen);
  change.chance = 1;
  for (auto& part : change.parts) {
    part.error = for_kind(errors, part.kind).of(part.area, part.old_seen, part.new_seen);
    part.sigmas = std::abs(part.mean) / std::max(part.error, 1e-6);
    part.chance = chance_of(part.sigmas);
    change.chance = std::min(change.chance, ways * part.chance);
  }
}

auto listed(const State& state, const std::vector<std::uint32_t>& buildings) -> std::string {
  std::string out;
  for (const auto b : buildings) out += (out.empty() ? "" : ", ") + state.buildings[b].id;
  return out;
}

auto in_words(const Part& part) -> std::string {
  const auto number = [](double value) { return base::to_text(std::abs(value), std::abs(value) < 10 ? 2 : 1); };
  const std::string area = base::to_text(part.area, 0) + " m²",
                    sure = " (" + base::to_text(std::min(part.sigmas, 999.0), part.sigmas < 10 ? 1 : 0) + " σ)";
  const std::string height = number(part.height) + " ± " + base::to_text(part.error, 2) + " m";
  switch (part.kind) {
    case Kind::built: return area + " are built on, " + height + " high" + sure;
    case Kind::gone: return area + " that were built on, " + height + " high, are ground" + sure;
    case Kind::extended: return area + " of ground more are built on, " + height + " high" + sure;
    case Kind::reduced: return area + " of ground that were built on, " + height + " high, are not any more" + sure;
    case Kind::raised:
    case Kind::lowered:
    case Kind::reroofed:
      return area + " of the roof are " + height + (part.height > 0 ? " higher" : " lower") +
             (part.kind == Kind::reroofed ? " in the median, with another slope" : "") + sure;
    case Kind::unchanged:
    case Kind::unseen: break;
  }
  return {};
}

/// What the numbers of a building mean, once it is known which chances are small enough.
void conclude(const Pair& pair, double critical, Change& change) {
  if (change.kind == Kind::unseen) return;
  std::erase_if(change.parts, [&](const Part& part) { return ways * part.chance > critical; });
  change.kind = change.parts.empty() ? Kind::unchanged : change.parts.front().kind;
  std::vector<std::string> words;
  for (const auto& part : change.parts) words.push_back(in_words(part));
  if (change.old.size() > 1)
    words.push_back("it is on the ground of " + std::to_string(change.old.size()) +
                    " old buildings: " + listed(pair.old, change.old));
  if (!change.now.empty())
    for (const auto o : change.old)
      if (const auto& heirs = pair.matching.of_old[o]; heirs.size() > 1) {
        std::vector<std::uint32_t> numbers;
        for (const auto& heir : heirs) numbers.push_back(heir.building);
        words.push_back("the old building " + pair.old.buildings[o].id +
                        " is several now: " + listed(pair.now, numbers));
      }
  if (change.kind == Kind::unchanged && (change.old.empty() || change.now.empty()))
    change.why = {change.old.empty()
                      ? "it is in the new models only, but nothing was built: the old scan shows it, or it is too small"
                      : "it is in the old models only, but it is still there: other models or the new scan show it, or "
                        "it is too small"};
  // Also where a scan shows the change: what a model takes for a roof and is none, a crown, is in its scan too.
  constexpr double probably_wrong = 0.5;
  const auto doubt = [&](const State& state, const std::vector<std::uint32_t>& own, const char* which) {
    for (const auto b : own)
      if (const auto& right = state.buildings[b].right; right && *right < probably_wrong) {
        change.doubtful = true;
        words.push_back("the " + std::string(which) + " model of " + state.buildings[b].id +
                        " is probably wrong (confidence " + base::to_text(*right, 2) + ")");
      }
  };
  doubt(pair.old, change.old, "old");
  doubt(pair.now, change.now, "new");
  words.insert(words.end(), change.why.begin(), change.why.end());
  change.why = std::move(words);
}

// ---- all of them

auto numbers_of(const std::vector<detail::Shared>& shared) -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> out;
  for (const auto& one : shared) out.push_back(one.building);
  return out;
}

void prepare(Pair& pair) {
  pair.matching = detail::matched(pair.old, pair.old_outlines, pair.now, pair.new_outlines, pair.shift());
  pair.old_surfaces.move(pair.shift(), pair.lift());
}

/// Every building of the new state, then the old ones without any.
template <class Work>
auto measure_all(const Pair& pair, const base::Run& run, double from, double to, Work work) -> std::vector<Change> {
  std::vector<Change> out;
  for (std::uint32_t n = 0; n < pair.now.buildings.size(); ++n) {
    auto& change = out.emplace_back();
    change.now = {n};
    change.old = numbers_of(pair.matching.of_new[n]);
  }
  for (std::uint32_t o = 0; o < pair.old.buildings.size(); ++o)
    if (pair.matching.of_old[o].empty()) out.emplace_back().old = {o};
  constexpr std::size_t piece = 64;  // buildings between two reports
  for (std::size_t first = 0; first < out.size() && !run.cancelled(); first += piece) {
    const auto count = std::min(piece, out.size() - first);
    base::parallel_for(count, [&](std::size_t i) {
      auto& change = out[first + i];
      const auto ground =
          change.now.empty() ? ground_of_old(pair, change.old.front()) : ground_of_new(pair, change.now.front());
      work(detail::places_of(ground, pair.old_surfaces, pair.new_surfaces), change);
    });
    run.report("compare", "",
               from + (to - from) * static_cast<double>(first + count) / static_cast<double>(out.size()));
  }
  return out;
}

/// Height differences of all buildings: what they have in common, and by how much more they vary than their errors.
void measure_offset(const std::vector<Change>& found, Pair& pair) {
  std::vector<double> heights;
  for (const auto& change : found)
    if (change.common > 0) heights.push_back(change.height);
  const auto middle = detail::middle_of(heights);
  pair.offset.height = middle.value;
  pair.offset.height_error = middle.error;
  pair.offset.buildings = heights.size();
  pair.offset.removed = !pair.options.keep_offset && heights.size() >= detail::least_buildings;
  if (pair.offset.outlines < detail::least_buildings) pair.offset.plan = pair.offset.plan_error = {};
}

constexpr std::size_t enough = 20;  // of fewer a median absolute deviation is known to a quarter at best

/// m; by how much the models of an unchanged building differ: the median of all, most of which have not changed.
/// None where there are too few.
auto model_error_of(const std::vector<Change>& found) -> std::optional<double> {
  std::vector<double> all;
  for (const auto& change : found)
    if (change.common > 0) all.push_back(change.rms);
  if (all.size() < detail::least_buildings) return std::nullopt;
  return base::mean_median(std::move(all));
}

auto scale_of(const std::vector<Change>& found) -> double {
  std::vector<double> sigmas;
  for (const auto& change : found)
    if (change.common > 0) sigmas.push_back(change.height / change.height_error);
  if (sigmas.size() < enough) return 1;
  return std::max(1.0, detail::middle_of(std::move(sigmas)).spread);
}

/// The largest chance that is significant where so large a share of what is reported may be false (Benjamini and
/// Hochberg): the last of the sorted ones that is at most share · rank / count.
auto critical_chance(const std::vector<Change>& found, double share) -> double {
  std::vector<double> chances;
  for (const auto& change : found)
    if (change.kind != Kind::unseen) chances.push_back(change.chance);
  std::ranges::sort(chances);
  double out = 0;
  for (std::size_t i = 0; i < chances.size(); ++i)
    if (chances[i] <= share * static_cast<double>(i + 1) / static_cast<double>(chances.size())) out = chances[i];
  return out;
}

}  // namespace

auto changes(const State& old, const State& now, const Options& options, const base::Run& run) -> Comparison {
  Pair pair(old, now, options);
  prepare(pair);
  pair.offset = detail::displacement(old, pair.old_outlines, now, pair.new_outlines, pair.matching);
  auto found = measure_all(pair, run, 0, 0.4, measure_height);
  measure_offset(found, pair);
  prepare(pair);
  found = measure_all(pair, run, 0.4, 1, [&](const Places& places, Change& change) { measure(pair, places, change); });
  pair.model_error = model_error_of(found);
  const auto weigh_all = [&] {
    for (auto& change : found) weigh(pair, change);
  };
  weigh_all();
  pair.scale = scale_of(found);
  weigh_all();
  Comparison out;
  out.critical = critical_chance(found, options.false_share);
  for (auto& change : found) conclude(pair, out.critical, change);
  out.changes = std::move(found);
  out.offset = pair.offset;
  out.model_error = pair.model_error;
  out.scale = pair.scale;
  return out;
}

}  // namespace mansard::compare
