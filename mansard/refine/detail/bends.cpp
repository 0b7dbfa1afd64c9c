#include "mansard/refine/detail/bends.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "mansard/refine/detail/lines.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/refit.hpp"

namespace mansard::refine::detail {
namespace {

using model::Plan;
using model::Profile;

/// Two lines that meet.
struct Bend {
  RoofLine low, high;
  double knot = 0;  ///< m inward
};

auto best_line(const geometry::LineSums& sums, const Options& options) -> std::optional<RoofLine> {
  if (!(sums.spread() > 0)) return std::nullopt;
  const double slope = std::max(0.0, sums.joint() / sums.spread());
  if (slope >= options.forms.max_slope) return std::nullopt;  // a wall
  return RoofLine{sums.line(slope).at_zero, slope};
}

/// What parts the samples best. `area`: m² of a look.
auto bend_in(std::vector<Look> looks, double area, const Options& options) -> std::optional<Bend> {
  const auto fewest = static_cast<std::size_t>(options.lines.min_samples);
  if (looks.size() < 2 * fewest) return std::nullopt;
  std::ranges::stable_sort(looks, {}, &Look::inward);
  const auto sums = sums_along(looks);
  const double whole = sums.back().residual();
  const double wanted = of_detail * options.detail;
  if (whole <= wanted * wanted * sums.back().weight || whole * area < options.face_price) return std::nullopt;
  const auto found = best_parting(looks, sums, Before::line, {.fewest_before = fewest, .fewest_behind = fewest}, whole);
  if (!found) return std::nullopt;
  const double gain = whole - found->left;
  const double noise = options.samples.noise * options.samples.noise * sums.back().weight;
  if (gain * area < options.face_price || gain < explained * (whole - noise)) return std::nullopt;
  // One row of samples has no slope.
  const double row = std::sqrt(area) / 2;
  if (looks[found->at - 1].inward - looks.front().inward < row || looks.back().inward - looks[found->at].inward < row)
    return std::nullopt;
  const auto low = best_line(sums[found->at], options), high = best_line(sums.back() - sums[found->at], options);
  if (!low || !high || std::abs(low->slope - high->slope) < options.forms.min_slope) return std::nullopt;
  return Bend{*low, *high, (high->at_edge - low->at_edge) / (low->slope - high->slope)};
}

/// The profile with the bend in one of its parts. None where that would be nearer to an end of the part than the scan
/// can tell, or where it does not join the rest.
auto with_bend(const Profile& profile, std::size_t part, const Bend& bend, const Options& options)
    -> std::optional<Profile> {
  const auto &foot = profile[part], &head = profile[part + 1];
  const bool goes_on = part + 2 >= profile.size();  // until it meets another face
  if (!(bend.knot > foot.inward + options.bends.min_depth)) return std::nullopt;
  if (!goes_on && !(bend.knot < head.inward - options.bends.min_depth)) return std::nullopt;
  const double height = bend.low.at_edge + bend.low.slope * bend.knot;
  Profile longer = profile;
  if (goes_on) longer.back() = {bend.knot + 1, height + bend.high.slope};
  longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(part) + 1, {bend.knot, height});
  std::vector<std::optional<RoofLine>> lines;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    if (i != part) lines.push_back(line_of(profile, i));
    else lines.insert(lines.end(), {bend.low, bend.high});
  }
  return chained(longer, lines);
}

}  // namespace

auto bent(Judged judged, const Judge& judge) -> Judged {
  const auto& options = judge.options();
  auto looks = middles_of(judged, judge.site(), options);
  /// The roof with a bend in that part, if it is cheaper.
  const auto bend = [&](std::size_t p, std::size_t part) -> std::optional<Judged> {
    const Profile& profile = judged.plan.profiles[p];
    if (!line_of(profile, part)) return std::nullopt;
    const auto found = bend_in(looks[p][part], judge.site().sample_area, options);
    auto other = found ? with_bend(profile, part, *found, options) : std::nullopt;
    if (!other) return std::nullopt;
    Plan plan = judged.plan;
    plan.profiles[p] = std::move(*other);
    auto next = judge(plan);
    if (!next) return std::nullopt;
    if (auto better = judge.cheaper(refitted(*next, judge.site(), options), next->cost)) next = std::move(*better);
    return cheaper(next->cost, judged.cost, options.same_cost) ? std::optional(std::move(*next)) : std::nullopt;
  };
  // A bend moves the ridge that the faces across have too: they are looked at before this one is again.
  constexpr int rounds = 2;
  bool any = true;
  for (int round = 0; round < rounds && any; ++round) {
    any = false;
    for (std::size_t p = 0; p < judged.plan.profiles.size(); ++p)
      for (std::size_t part = 1; part + 1 < judged.plan.profiles[p].size(); ++part)
        if (auto next = bend(p, part)) {
          judged = std::move(*next);
          looks = middles_of(judged, judge.site(), options);
          any = true;
          ++part;
        }
  }
  return judged;
}

}  // namespace mansard::refine::detail
