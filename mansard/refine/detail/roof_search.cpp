#include "mansard/refine/detail/roof_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "mansard/base/statistics.hpp"
#include "mansard/base/text.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/refit.hpp"
#include "mansard/refine/detail/supported.hpp"
#include "mansard/refine/detail/turned.hpp"

namespace mansard::refine::detail {
namespace {

using model::Plan;
using model::Profile;

/// Of the caps the best, one after the other: later ones must be clearly better, so that noise does not choose; the
/// likeliest come first. A cap cuts a roof off and changes nothing below, so that one sketch shows them all.
auto best_of(const std::vector<double>& caps, const Judge& judge, const Judged& uncut) -> double {
  double best = caps.front(), least = std::numeric_limits<double>::infinity();
  for (const double cap : caps) {
    const double misfit = judge.misfit_of(uncut.view, cap);
    if (misfit < judge.options().search.cap_gain * least) {
      least = misfit;
      best = cap;
    }
  }
  return best;
}

/// The same, each cap with a sketch of its own: some roofs can be sketched only below where they go wrong.
auto best_of_each(const Draft& draft, const Judge& judge) -> base::Result<Judged> {
  std::optional<Judged> best;
  std::optional<base::Diagnostic> failure;
  for (const double cap : draft.caps) {
    Plan plan = draft.plan;
    plan.cap = cap;
    auto judged = judge(plan);
    if (!judged) failure = judged.error();
    else if (!best || judged->misfit < judge.options().search.cap_gain * best->misfit) best = std::move(*judged);
  }
  if (best) return std::move(*best);
  return *failure;
}

auto best_cap(const Draft& draft, const Judge& judge) -> base::Result<Judged> {
  Plan plan = draft.plan;
  plan.cap = std::ranges::max(draft.caps);
  auto uncut = judge(plan);
  if (!uncut) return best_of_each(draft, judge);
  const double best = best_of(draft.caps, judge, *uncut);
  if (best == plan.cap) return uncut;
  plan.cap = best;
  auto judged = judge(plan);
  return judged ? std::move(judged) : best_of_each(draft, judge);
}

/// Moves the planes until that no longer helps.
auto settle(Judged judged, const Judge& judge) -> Judged {
  for (std::int64_t round = 0; round < judge.options().search.settle_rounds; ++round) {
    const Plan plan = refitted(judged, judge.site(), judge.options());
    if (plan == judged.plan) break;
    auto next = judge.cheaper(plan, judged.cost);
    if (!next) break;
    judged = std::move(*next);
  }
  return judged;
}

/// What an edge might carry instead of what it carries now.
auto others_of(const Draft& draft, const Plan& plan, std::size_t p, const std::vector<Side>& sides,
               const Options& options) -> std::vector<Profile> {
  std::vector<Profile> out;
  const auto add = [&](Profile profile) {
    if (profile != plan.profiles[p] && std::ranges::find(out, profile) == out.end()) out.push_back(std::move(profile));
  };
  if (!is_wall(plan.profiles[p])) add(wall(plan.profiles[p][1].height, options.forms));
  if (p < draft.alternatives.size())
    for (const auto& profile : draft.alternatives[p]) add(profile);
  // What the opposite and the longest pitched side carry.
  std::optional<std::size_t> opposite, longest;
  for (std::size_t q = 0; q < sides.size(); ++q) {
    if (q == p || is_wall(plan.profiles[q])) continue;
    const auto longer_than = [&](std::size_t other) { return sides[q].length > sides[other].length + same_length; };
    if (!longest || longer_than(*longest)) longest = q;
    if (dot(sides[q].inward, sides[p].inward) < -options.search.opposite_cosine &&
        (!opposite || longer_than(*opposite)))
      opposite = q;
  }
  if (opposite) add(plan.profiles[*opposite]);
  if (longest) add(plan.profiles[*longest]);
  return out;
}

/// m²·m² by profile: weighed squared differences of the looks whose nearest side, in a strip widened by 45°, it is.
auto misfit_by_side(const Judged& judged, const Judge& judge) -> std::vector<double> {
  const auto edges = eaves_of(judged.plan, std::vector<bool>(judged.plan.profiles.size(), true));
  const auto& site = judge.site();
  std::vector<double> out(judged.plan.profiles.size(), 0);
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    if (const auto nearest = nearest_eaves(edges, site.places[i]))
      out[nearest->profile] += judge.reducible_at(judged, i) * site.sample_area;
  }
  return out;
}

/// One edge after the other, the longest first: whatever it carries better is taken.
auto descend(Judged judged, const Draft& draft, const Judge& judge) -> Judged {
  const auto most_sides = static_cast<std::size_t>(judge.options().search.max_sides);
  const auto sides = sides_of(judged.plan);
  std::vector<std::size_t> order;
  for (std::size_t p = 0; p < sides.size(); ++p)
    if (sides[p].length > 0) order.push_back(p);
  rank(
      order, [&](std::size_t p) { return -sides[p].length; }, same_length);
  if (order.size() > most_sides) order.resize(most_sides);
  const auto misfit = misfit_by_side(judged, judge);
  std::optional<std::vector<std::vector<Profile>>> setbacks;
  for (const std::size_t p : order) {
    if (misfit[p] < judge.options().face_price) continue;  // nothing to gain that a face would not cost
    if (!setbacks) setbacks = setbacks_of(judged.plan, judge.site(), judge.options());
    auto others = others_of(draft, judged.plan, p, sides, judge.options());
    others.insert(others.end(), (*setbacks)[p].begin(), (*setbacks)[p].end());
    for (auto& profile : others) {
      if (judge.is_tired(judged.plan)) return judged;
      Plan plan = judged.plan;
      plan.profiles[p] = std::move(profile);
      if (auto next = judge.cheaper(plan, judged.cost)) judged = std::move(*next);
    }
  }
  return judged;
}

/// Side after side a wall instead of its roof, where that is cheaper.
auto with_fewer_pitches(Judged judged, const Judge& judge) -> Judged {
  for (std::size_t p = 0; p < judged.plan.profiles.size(); ++p) {
    if (is_wall(judged.plan.profiles[p]) || judge.is_tired(judged.plan)) continue;
    Plan plan = judged.plan;
    plan.profiles[p] = wall(plan.profiles[p][1].height, judge.options().forms);
    if (auto next = judge.cheaper(plan, judged.cost)) judged = std::move(*next);
  }
  return judged;
}

/// Roof planes that rise in another direction than across a wall, one after the other, as long as that pays. Pitches
/// that made up for one go.
auto turn(Judged judged, const Judge& judge) -> Judged {
  for (std::int64_t round = 0; round < judge.options().search.rounds; ++round) {
    std::optional<Judged> best;
    for (const Plan& plan : turned_roofs(judged, judge)) {
      if (judge.is_tired(plan)) break;
      auto next = judge(plan);
      if (!next || next->cost > judge.options().search.hopeless * judged.cost) continue;
      *next = settle(std::move(*next), judge);
      if (cheaper(next->cost, best ? best->cost : judged.cost, judge.options().same_cost) && judge.stands(next->plan))
        best = std::move(*next);
    }
    if (!best) break;
    judged = settle(with_fewer_pitches(std::move(*best), judge), judge);
  }
  return judged;
}

/// A roof that nothing was seen of, not above the crown that hides it.
auto below_ceilings(Judged judged, const Judge& judge) -> Judged {
  std::vector<double> heights;
  for (const auto& [cell, ceiling] : judge.site().ceilings) heights.push_back(ceiling);
  if (heights.empty()) return judged;
  Plan plan = judged.plan;
  plan.cap = std::max(judge.options().forms.min_height, base::median(std::move(heights)));
  if (plan.cap >= judged.plan.cap) return judged;
  for (auto& profile : plan.profiles) profile = wall(plan.cap, judge.options().forms);
  auto lower = judge.cheaper(plan, judged.cost);
  return lower ? std::move(*lower) : std::move(judged);
}

auto pitched_sides(const Plan& plan) -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count_if(plan.profiles, [](const auto& p) { return !is_wall(p); }));
}

/// m and rad: of a profile with a roof, at its gutter.
struct Foot {
  double gutter = 0, pitch = 0;
};
auto foot_of(const Profile& profile) -> Foot {
  std::size_t i = 0;
  while (i + 2 < profile.size() && profile[i + 1].inward <= profile[i].inward) ++i;
  return {profile[i].height,
          geometry::arc_tangent(profile[i + 1].height - profile[i].height, profile[i + 1].inward - profile[i].inward)};
}

/// What became of a roof, in numbers: sides, the largest changes of gutters and pitches, the cap.
auto change_of(const Plan& before, const Plan& after) -> std::string {
  constexpr double degree = std::numbers::pi / 180, least_height = 0.005, least_pitch = 0.05 * degree;
  const auto metres = [](double value) { return base::to_text(value, 2) + " m"; };
  std::string text;
  const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
  const auto was = pitched_sides(before), is = pitched_sides(after);
  if (was != is) add("roof rises from " + std::to_string(is) + " of its sides instead of " + std::to_string(was));
  Foot most;
  for (std::size_t p = 0; p < std::min(before.profiles.size(), after.profiles.size()); ++p) {
    if (is_wall(before.profiles[p]) || is_wall(after.profiles[p])) continue;
    const Foot old = foot_of(before.profiles[p]), now = foot_of(after.profiles[p]);
    most.gutter = std::max(most.gutter, std::abs(now.gutter - old.gutter));
    most.pitch = std::max(most.pitch, std::abs(now.pitch - old.pitch));
  }
  if (most.gutter >= least_height) add("gutters moved by up to " + metres(most.gutter));
  if (most.pitch >= least_pitch) add("pitches by up to " + base::to_text(most.pitch / degree, 1) + "°");
  if (std::abs(after.cap - before.cap) >= least_height) add("cap " + metres(before.cap) + " → " + metres(after.cap));
  return text.empty() ? "profiles changed" : text;
}

/// The squared error before and after, m².
auto error_of(double before, double after, const Judge& judge) -> std::string {
  const double area = judge.site().sample_area * static_cast<double>(judge.site().cells.size());
  return ": squared error " + base::to_text(before / area, 2) + " → " + base::to_text(after / area, 2) + " m²";
}

/// From a roof, which is the draft's, to the cheapest that is found.
auto searched(Judged best, const Draft& draft, const Judge& judge, Search search, double worth) -> Judged {
  const auto& options = judge.options().search;
  const double faces_apart = judge.options().face_price;  // less misfit than one face costs: nothing can pay
  if (judge.wrong(best) < faces_apart) return best;

  if (search == Search::settled) return settle(std::move(best), judge);
  std::vector<Judged> starts;
  starts.push_back(best);
  const auto followed = static_cast<std::size_t>(search == Search::thorough ? options.starts : options.quick_starts);
  const auto forms = forms_of(draft.plan, judge.site(), judge.options());
  const std::size_t most = followed + 2;  // the most promising, one more than are followed, and the draft's
  for (std::size_t from = 0, to = 0; from < forms.size() && starts.size() < most; from = to) {
    to = std::min(forms.size(), from + most - starts.size());  // no more than are needed if all can be sketched
    std::vector<std::optional<Judged>> judged(to - from);
    base::parallel_for(judged.size(), [&](std::size_t i) {
      if (auto one = judge(forms[from + i].plan)) judged[i] = std::move(*one);
    });
    for (auto& one : judged)
      if (one) starts.push_back(std::move(*one));
  }
  rank(starts, &Judged::cost, judge.options().same_cost);
  if (starts.size() > followed) starts.erase(starts.begin() + static_cast<std::ptrdiff_t>(followed), starts.end());
  base::parallel_for(starts.size(), [&](std::size_t i) { starts[i] = settle(std::move(starts[i]), judge); });
  for (auto& judged : starts)
    if (cheaper(judged.cost, best.cost, judge.options().same_cost)) best = std::move(judged);
  if (best.cost > options.hopeless * worth) return best;
  if (search == Search::quick) return judge.wrong(best) < faces_apart ? best : turn(std::move(best), judge);
  for (std::int64_t round = 0; round < options.rounds && judge.wrong(best) >= faces_apart; ++round) {
    const double cost = best.cost;
    best = settle(descend(std::move(best), draft, judge), judge);
    if (best.cost - best.unsupported > worth) return best;
    best = supported(std::move(best), judge);
    if (best.cost > options.round_gain * cost) break;
  }
  return judge.wrong(best) >= faces_apart ? turn(std::move(best), judge) : best;
}

}  // namespace

auto best_roof(const Draft& draft, const Judge& judge, Search search, double worth, const Judged* found,
               std::vector<std::string>& changed) -> base::Result<Judged> {
  auto start = best_cap(draft, judge);
  if (start && judge.site().cells.empty()) return below_ceilings(std::move(*start), judge);
  if (!start || judge.options().effort == Effort::caps || judge.site().cells.empty()) return start;
  const auto before = start->plan;
  const double misfit = start->misfit;
  Judged best = searched(std::move(*start), draft, judge, search, worth);
  if (found && cheaper(found->cost, best.cost, judge.options().same_cost)) best = *found;
  if (search == Search::thorough && best.plan != before)
    changed.push_back(change_of(before, best.plan) + error_of(misfit, best.misfit, judge));
  return best;
}

}  // namespace mansard::refine::detail
