#include "mansard/refine/detail/sharpen.hpp"

#include <algorithm>
#include <vector>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/bends.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/refit.hpp"
#include "mansard/refine/detail/steps.hpp"

namespace mansard::refine::detail {
namespace {

using model::Plan;

/// Whether all that the plan's profiles carry rises less than that, per run.
auto nearly_level(const Plan& plan, double flattest) -> bool {
  bool any = false;
  for (const auto& profile : plan.profiles) {
    if (is_wall(profile)) continue;
    any = true;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
      const auto &a = profile[i], &b = profile[i + 1];
      if (b.inward > a.inward && b.height - a.height > flattest * (b.inward - a.inward)) return false;
    }
  }
  return any;
}

/// Flat, at the height of most of what is seen.
auto levelled(const Plan& plan, const Site& site, const Options::Forms& options) -> Plan {
  Plan flat = plan;
  flat.cap = std::max(options.min_height, base::median_of_sorted(site.sorted));
  for (auto& profile : flat.profiles) profile = wall(flat.cap, options);
  return flat;
}

/// m²·m²: of the squared differences away from the outline, along which no roof explains the melted walls.
auto misfit_inside(const Judged& judged, const Site& site) -> double {
  double sum = 0;
  for (std::size_t i = 0; i < site.cells.size(); ++i)
    if (const double d = judged.view.z_of(site, i) - site.z[i]; site.weight[i] == 1 && d == d) sum += d * d;
  return sum * site.sample_area;
}

/// Whether the pitches of a roof explain little of what a level one leaves. Over a level roof, too, some pitch suits a
/// scan's own errors a little better; where they explain nearly all that is not the walls', the roof is pitched.
auto explain_little(const Judged& pitched, const Judged& level, const Judge& judge) -> bool {
  const auto& options = judge.options();
  const double gain = options.sharpen.level_gain;
  return nearly_level(pitched.plan, options.sharpen.level_slope) && pitched.misfit >= gain * level.misfit &&
         level.cost <= pitched.cost + options.part_price &&
         misfit_inside(pitched, judge.site()) >= (1 - gain) * misfit_inside(level, judge.site());
}

/// Up to its ridge, where that is no higher than a scan rounds off: a roof that ends flat just below suits it better.
auto uncut(Judged judged, const Judge& judge, double most) -> Judged {
  const auto is_cap = [](const model::Face& face) { return face.kind == model::FaceKind::cap; };
  if (std::ranges::all_of(judged.plan.profiles, is_wall) || std::ranges::none_of(judged.sketch.faces, is_cap))
    return judged;
  Plan plan = judged.plan;
  plan.cap += judge.options().samples.melt;
  auto whole = judge(plan);
  const bool closes = whole && whole->cost <= most && std::ranges::none_of(whole->sketch.faces, is_cap);
  return closes ? std::move(*whole) : judged;
}

}  // namespace

auto sharpened(Judged judged, const Judge& judge) -> Judged {
  if (judge.site().sorted.empty()) return judged;
  const auto& options = judge.options();
  const double most = judged.cost + options.face_price;
  for (std::int64_t round = 0; round < options.sharpen.rounds; ++round) {
    auto next = judge(refitted(judged, judge.site(), options, Used::middle));
    if (!next || next->plan == judged.plan || next->cost > most) break;
    judged = std::move(*next);
  }
  judged = bent(stepped(uncut(std::move(judged), judge, most), judge, most), judge);
  if (!nearly_level(judged.plan, options.sharpen.level_slope)) return judged;
  auto flat = judge(levelled(judged.plan, judge.site(), options.forms));
  if (!flat) return judged;
  return explain_little(judged, *flat, judge) ? std::move(*flat) : judged;
}

}  // namespace mansard::refine::detail
