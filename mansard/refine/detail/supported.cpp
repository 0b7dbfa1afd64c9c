#include "mansard/refine/detail/supported.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/refit.hpp"
#include "mansard/refine/detail/steps.hpp"

namespace mansard::refine::detail {
namespace {

using model::Plan;
using model::PlanRing;
using model::Profile;

/// What an edge may carry instead of a profile that makes a bare face of its part.
auto without_part(const Profile& profile, std::uint32_t part, const Options& options) -> std::vector<Profile> {
  std::vector<Profile> out;
  const auto add = [&](Profile other) {
    if (other.size() > 1 && other != profile && std::ranges::find(out, other) == out.end())
      out.push_back(std::move(other));
  };
  for (std::size_t i = 1; i < profile.size(); ++i) add(wall(profile[i].height, options.forms));
  if (part + 2 >= profile.size()) return out;
  // The part's foot or its head goes, and what is behind it moves out to it, or goes on down to it.
  Profile direct = profile;
  direct.erase(direct.begin() + part + (part == 0 ? 1 : 0));
  add(std::move(direct));
  const auto &foot = profile[part], &head = profile[part + 1], &next = profile[part + 2];
  Profile upright(profile.begin(), profile.begin() + part + 1);
  const double slope = next.inward > head.inward ? (next.height - head.height) / (next.inward - head.inward) : 0;
  const double at = next.inward > head.inward ? head.height - slope * (head.inward - foot.inward) : next.height;
  if (at > foot.height) {
    if (upright.size() > 1 && upright[upright.size() - 2].inward == foot.inward) upright.pop_back();
    upright.push_back({foot.inward, at});
  }
  if (next.inward > head.inward) upright.push_back(next);
  upright.insert(upright.end(), profile.begin() + part + 3, profile.end());
  if (next.inward == head.inward)  // behind a terrace: the upper wall moves out
    for (std::size_t i = upright.size(); i-- > 0;)
      if (upright[i].inward > foot.inward) upright[i].inward -= head.inward - foot.inward;
  add(std::move(upright));
  return out;
}

auto variants_of(const Judged& judged, std::uint32_t bare, const Judge& judge) -> std::vector<Plan> {
  const auto& options = judge.options();
  const auto& face = judged.sketch.faces[bare];
  const Plan& plan = judged.plan;
  std::vector<Plan> out;
  if (face.kind == model::FaceKind::cap) {
    const auto& forms = options.forms;
    Plan higher = plan;
    higher.cap =
        base::percentile_of_sorted(judge.site().sorted, forms.cap_percentile, base::Rank::below) + forms.cap_clearance;
    if (higher.cap > plan.cap) out.push_back(std::move(higher));
    return out;
  }
  if (!face.provenance) return out;
  const auto [ring, edge, part] = *face.provenance;
  const PlanRing& of = ring == 0 ? plan.outer : plan.holes[ring - 1];
  const auto n = static_cast<std::uint32_t>(of.profile_of_edge.size());
  const auto& own = plan.profiles[of.profile_of_edge[edge]];
  auto others = without_part(own, part, options);
  for (const auto beside : {(edge + n - 1) % n, (edge + 1) % n}) {
    const auto& profile = plan.profiles[of.profile_of_edge[beside]];
    if (profile != own) others.push_back(profile);
  }
  for (auto& profile : others) out.push_back(carrying(plan, ring, edge, std::move(profile)));
  return out;
}

/// The cheapest roof without that bare face; none where that costs no less.
auto without(const Judged& judged, std::uint32_t bare, const Judge& judge) -> std::optional<Judged> {
  auto plans = variants_of(judged, bare, judge);
  std::ranges::move(with_step(judged, bare, judge), std::back_inserter(plans));
  std::vector<std::optional<Judged>> each(plans.size());
  base::parallel_for(plans.size(), [&](std::size_t i) {
    auto next = judge(plans[i]);
    if (!next) return;
    const Plan moved = refitted(*next, judge.site(), judge.options());
    if (auto better = moved == next->plan ? std::nullopt : judge.cheaper(moved, std::min(next->cost, judged.cost)))
      each[i] = std::move(*better);
    else if (cheaper(next->cost, judged.cost, judge.options().same_cost)) each[i] = std::move(*next);
  });
  std::optional<Judged> best;
  for (auto& next : each)
    if (next && cheaper(next->cost, best ? best->cost : judged.cost, judge.options().same_cost))
      best = std::move(*next);
  return best;
}

}  // namespace

auto supported(Judged judged, const Judge& judge) -> Judged {
  if (judge.site().sorted.empty()) return judged;
  std::vector<std::optional<model::Provenance>> tried;  // a cap has none
  bool changed = false;
  for (std::size_t left = 2 * judged.bare.size(); left > 0; --left) {
    const auto next = std::ranges::find_if(judged.bare, [&](auto bare) {
      return std::ranges::find(tried, judged.sketch.faces[bare].provenance) == tried.end();
    });
    if (next == judged.bare.end()) {
      if (!std::exchange(changed, false)) break;
      tried.clear();  // beside what changed, others may do now
      continue;
    }
    tried.push_back(judged.sketch.faces[*next].provenance);
    if (auto better = without(judged, *next, judge)) {
      judged = std::move(*better);
      changed = true;
    }
  }
  return judged;
}

}  // namespace mansard::refine::detail
