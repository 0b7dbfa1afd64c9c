#include "mansard/refine/detail/steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "mansard/geometry/arcs.hpp"
#include "mansard/geometry/fit.hpp"
#include "mansard/refine/detail/lines.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/refit.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using model::Plan;
using model::PlanRing;
using model::Profile;

constexpr double steep = 1;  // rise per run: 45°

/// What lies over the strip of an edge, nearest first, and its misfit, m²·m².
struct Strip {
  std::vector<Look> looks;
  double misfit = 0;
};
auto strip_of(const Judged& judged, const PlanRing& ring, std::uint32_t edge, double from, double to,
              const Judge& judge) -> Strip {
  const Site& site = judge.site();
  const Point2 a = ring.points[edge], b = ring.points[(edge + 1) % ring.points.size()];
  const Point2 along = geometry::normalised(b - a), inward = geometry::left_of(along);
  const double length = geometry::length(b - a);
  Strip out;
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    if (site.weight[i] < 1) continue;  // the melted wall hides how level the strip is
    const Point2 at = site.places[i] - a;
    const double t = dot(at, along), d = dot(at, inward), z = site.z[i];
    if (t <= 0 || t >= length || d <= from || d >= to) continue;
    out.looks.push_back({d, z, 1});
    if (const double off = judged.view.z_of(site, i) - z; !std::isnan(off))
      out.misfit += loss(off, judge.options().robust) * site.sample_area;
  }
  std::ranges::stable_sort(out.looks, {}, &Look::inward);
  return out;
}

/// m: where a level and the line behind it leave least of the looks.
struct Step {
  double level = 0, depth = 0;
};
auto step_in(const std::vector<Look>& looks, double most, const Options& options) -> std::optional<Step> {
  const auto sums = sums_along(looks);
  const auto fewest = static_cast<std::size_t>(options.lines.min_samples);
  const auto found =
      best_parting(looks, sums, Before::level,
                   {.fewest_before = std::max<std::size_t>(1, fewest / 3), .fewest_behind = fewest, .to = most},
                   std::numeric_limits<double>::infinity());
  if (!found) return std::nullopt;
  return Step{middle_height(std::span(looks).first(found->at)),
              (looks[found->at - 1].inward + looks[found->at].inward) / 2};
}

/// The profile with a level and a wall instead of its parts `from` to `to`.
auto with_step_in(const Profile& profile, std::size_t from, std::size_t to, const Step& step)
    -> std::optional<Profile> {
  const auto &foot = profile[from], &head = profile[to + 1];
  Profile out(profile.begin(), profile.begin() + static_cast<std::ptrdiff_t>(from));
  // Behind a wall the level is what was seen; behind a roof it is where that ends.
  const bool behind_wall = out.back().inward == foot.inward;
  const double level = behind_wall ? std::max(step.level, out.back().height) : foot.height;
  add_point(out, foot.inward, level);
  add_point(out, step.depth, level);
  if (to + 2 < profile.size()) {
    const auto& next = profile[to + 2];
    if (step.depth >= next.inward) return std::nullopt;
    const double rise = next.inward > head.inward ? (next.height - head.height) / (next.inward - head.inward) : 0;
    add_point(out, step.depth, std::max(level, head.height - rise * (head.inward - step.depth)));
    out.insert(out.end(), profile.begin() + static_cast<std::ptrdiff_t>(to) + 2, profile.end());
  }
  return out;
}

}  // namespace

auto carrying(const Plan& plan, std::uint32_t ring, std::uint32_t edge, Profile profile) -> Plan {
  Plan out = plan;
  PlanRing& of = ring == 0 ? out.outer : out.holes[ring - 1];
  const auto number = of.profile_of_edge[edge];
  std::vector<std::uint32_t> side{edge};
  for (const auto& arc : geometry::arcs_of(of.points)) {
    const std::size_t n = of.points.size();
    if ((edge + n - arc.first) % n >= arc.count) continue;
    side.clear();
    for (std::size_t k = 0; k < arc.count; ++k)
      if (const auto chord = (arc.first + k) % n; of.profile_of_edge[chord] == number)
        side.push_back(static_cast<std::uint32_t>(chord));
  }
  std::ptrdiff_t users = std::ranges::count(out.outer.profile_of_edge, number);
  for (const auto& hole : out.holes) users += std::ranges::count(hole.profile_of_edge, number);
  if (users > std::ssize(side)) {
    for (const auto other : side) of.profile_of_edge[other] = static_cast<std::uint32_t>(out.profiles.size());
    out.profiles.push_back(std::move(profile));
  } else {
    out.profiles[number] = std::move(profile);
  }
  return out;
}

auto steep_faces(const Judged& judged) -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> out;
  for (std::uint32_t f = 0; f < judged.sketch.faces.size(); ++f) {
    const auto& n = judged.sketch.faces[f].normal;
    if (n.z > wall_normal && n.x * n.x + n.y * n.y > steep * steep * n.z * n.z) out.push_back(f);
  }
  return out;
}

auto with_step(const Judged& judged, std::uint32_t face, const Judge& judge) -> std::vector<Plan> {
  const auto& options = judge.options();
  const auto& of = judged.sketch.faces[face];
  if (of.kind == model::FaceKind::cap || !of.provenance) return {};
  const auto [ring_number, edge, part] = *of.provenance;
  const Plan& plan = judged.plan;
  const PlanRing& ring = ring_number == 0 ? plan.outer : plan.holes[ring_number - 1];
  const Profile& profile = plan.profiles[ring.profile_of_edge[edge]];
  if (part == 0 || part + 1 >= profile.size()) return {};
  const auto &foot = profile[part], &head = profile[part + 1];
  const double run = head.inward - foot.inward;
  if (run <= 0 || head.height - foot.height <= steep * run) return {};
  const bool goes_on = part + 2 >= profile.size();  // up to the cap
  const double end =
      foot.inward + (goes_on ? std::max(0.0, plan.cap - foot.height) * run / (head.height - foot.height) : run);
  std::vector<Plan> out;
  for (std::uint32_t from = part; from > 0; from = from > 1 ? 1 : 0) {
    const double start = profile[from].inward;
    const Strip strip = strip_of(judged, ring, edge, start, end + options.setback.behind / 2, judge);
    if (strip.misfit < options.value_price) continue;
    const auto step = step_in(strip.looks, end, options);
    if (!step || step->level < options.forms.min_height) continue;  // not the ground beside it
    for (const double moved : {0.0, -options.grid / 2, options.grid / 2}) {
      if (step->depth + moved <= start + options.mansard.min_depth) continue;
      if (auto other = with_step_in(profile, from, part, {step->level, step->depth + moved}))
        out.push_back(carrying(plan, ring_number, edge, std::move(*other)));
    }
  }
  return out;
}

auto stepped(Judged judged, const Judge& judge, double most) -> Judged {
  // One edge after the other. Faces have other numbers in every roof, edges keep theirs.
  const auto next_of = [](const Judged& of, const std::optional<model::Provenance>& last) {
    std::optional<std::pair<model::Provenance, std::uint32_t>> next;
    for (const auto face : steep_faces(of))
      if (const auto& from = of.sketch.faces[face].provenance; from && (!last || *from > *last))
        if (!next || *from < next->first) next.emplace(*from, face);
    return next;
  };
  for (auto at = next_of(judged, std::nullopt); at; at = next_of(judged, at->first)) {
    std::optional<Judged> best;
    for (const Plan& plan : with_step(judged, at->second, judge)) {
      auto next = judge(plan);
      if (!next) continue;
      const Plan moved = refitted(*next, judge.site(), judge.options());
      if (cheaper(next->cost, best ? best->cost : most, judge.options().same_cost)) best = std::move(*next);
      if (moved == plan) continue;
      if (auto better = judge.cheaper(moved, best ? best->cost : most)) best = std::move(*better);
    }
    if (best) judged = std::move(*best);
  }
  return judged;
}

}  // namespace mansard::refine::detail
