#include "mansard/refine/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/extrude/corner_edges.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/judge.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/refit.hpp"
#include "mansard/refine/detail/work.hpp"

namespace mansard::refine {
namespace {

using detail::Judge;
using detail::Judged;
using detail::Site;
using geometry::Point2;
using model::Plan;
using model::Profile;

/// Sides that face one way, to within some 14°, have one profile.
constexpr double one_way = 0.97;
/// m; a cap so much above the ridge does not cut it.
constexpr double above_ridge = 0.01;
/// m; no apex is nearer to a side, whose roof would be a wall (as roof::Options::apex_distance).
constexpr double apex_distance = 0.2;

/// The outline, each way that its free edges face with a profile of its own; the last profile is of all other edges.
struct Ways {
  Plan plan;
  std::vector<Point2> inward;  ///< unit; by profile but for the last
};
auto ways_of(const Plan& plan, const std::vector<bool>& shared) -> Ways {
  Ways out{plan, {}};
  auto& ring = out.plan.outer;
  ring.profile_of_edge.assign(ring.points.size(), 0);
  std::vector<std::size_t> walls;
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    const Point2 along = ring.points[(i + 1) % ring.points.size()] - ring.points[i];
    if ((i < shared.size() && shared[i]) || !(geometry::length(along) > 0)) {
      walls.push_back(i);
      continue;
    }
    const Point2 inward = geometry::left_of(geometry::normalised(along));
    const auto known = std::ranges::find_if(out.inward, [&](Point2 other) { return dot(other, inward) > one_way; });
    ring.profile_of_edge[i] = static_cast<std::uint32_t>(known - out.inward.begin());
    if (known == out.inward.end()) out.inward.push_back(inward);
  }
  const auto wall = static_cast<std::uint32_t>(out.inward.size());
  for (const std::size_t i : walls) ring.profile_of_edge[i] = wall;
  for (auto& hole : out.plan.holes) hole.profile_of_edge.assign(hole.points.size(), wall);
  out.plan.profiles.assign(out.inward.size() + 1, Profile());
  return out;
}

/// Which ways carry roof, for every direction that a kind may have.
auto choices_of(Kind kind, const std::vector<Point2>& inward, double across) -> std::vector<std::vector<bool>> {
  std::vector<std::vector<bool>> out;
  const auto add = [&](std::vector<bool> carries) {
    carries.push_back(false);  // walls
    if (std::ranges::find(out, carries) == out.end()) out.push_back(std::move(carries));
  };
  if (kind == Kind::hip || kind == Kind::mansard) {
    add(std::vector<bool>(inward.size(), true));
    return out;
  }
  for (const Point2 axis : inward) {
    std::vector<bool> carries(inward.size());
    bool forward = false, back = false;
    for (std::size_t p = 0; p < inward.size(); ++p) {
      const double cosine = dot(inward[p], axis);
      carries[p] = cosine > across || (kind != Kind::shed && cosine < -across);
      forward = forward || cosine > across;
      back = back || cosine < -across;
    }
    if (kind == Kind::shed || (forward && back)) add(std::move(carries));
  }
  return out;
}

/// Of the sides with neighbours those that get walls: all, none, and of a few every choice.
auto choices_of_walls(const std::vector<bool>& shared) -> std::vector<std::vector<bool>> {
  constexpr std::size_t few = 3;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < shared.size(); ++i)
    if (shared[i]) which.push_back(i);
  std::vector<std::vector<bool>> out{shared};
  if (which.empty()) return out;
  out.emplace_back(shared.size(), false);
  for (std::size_t choice = 1; which.size() > 1 && which.size() <= few && choice + 1 < (std::size_t{1} << which.size());
       ++choice) {
    auto& walls = out.emplace_back(shared.size(), false);
    for (std::size_t k = 0; k < which.size(); ++k) walls[which[k]] = ((choice >> k) & 1) != 0;
  }
  return out;
}

auto highest_of(const model::Solid& solid) -> double {
  double top = -std::numeric_limits<double>::infinity();
  for (const auto& vertex : solid.vertices) top = std::max(top, vertex.z);
  return top;
}

/// The centre of gravity of a polygon.
auto centroid_of(const geometry::Ring& ring) -> Point2 {
  Point2 sum{0, 0};
  double area = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {  // triangles from the first corner
    const Point2 a = ring[i] - ring.front(), b = ring[(i + 1) % ring.size()] - ring.front();
    area += cross(a, b);
    sum = sum + cross(a, b) * (a + b);
  }
  return area == 0 ? ring.front() : ring.front() + (1 / (3 * area)) * sum;
}

/// Searches over one outline.
class Shaping {
 public:
  Shaping(const Site& site, const Options& options, const extrude::Options& raising, const base::Run& run)
      : site_(site), options_(options), judge_(site, options, raising, run) {}

  [[nodiscard]] auto flat(Plan plan) const -> std::optional<Judged> {
    std::optional<Judged> best;
    for (const double level : {detail::commonest(site_.sorted, options_),
                               base::percentile_of_sorted(site_.sorted, 0.5, base::Rank::below)}) {
      plan.cap = std::max(options_.forms.min_height, level);
      for (auto& profile : plan.profiles) profile = detail::wall(plan.cap, options_.forms);
      take(judge_(plan), best);
    }
    return best;
  }

  [[nodiscard]] auto sloped(Kind kind, const Ways& ways) const -> std::optional<Judged> {
    const bool steep_foot = kind == Kind::gambrel || kind == Kind::mansard;
    std::optional<Judged> best;
    for (const auto& carries : choices_of(kind, ways.inward, options_.forms.across_cosine)) {
      const auto roof = detail::roof_over(ways.plan, site_, carries, steep_foot, options_);
      if (!roof) continue;
      Plan plan = ways.plan;
      for (std::size_t p = 0; p < plan.profiles.size(); ++p)
        plan.profiles[p] = carries[p] ? *roof : detail::wall(roof->at(1).height, options_.forms);
      auto judged = judge_(uncut(std::move(plan)));
      if (!judged) continue;
      auto gable = not_above(settled(std::move(*judged), true));
      if (kind != Kind::half_hip && kind != Kind::gablet) take(std::move(gable), best);
      else if (auto with = ended(kind, gable, carries)) take(not_above(std::move(*with)), best);
    }
    if (best) take(not_above(settled_by_edge(*best)), best);
    return best;
  }

  /// A gable whose ends slope above, or below, a share of its height; none where no end is free.
  [[nodiscard]] static auto with_ends(Kind kind, const Judged& gable, const std::vector<bool>& carries, double share)
      -> std::optional<Plan> {
    Plan plan = gable.plan;
    const double top = highest_of(gable.sketch) - plan.base;
    double gutter = 0, slope = 0;  // of the steepest side
    for (std::size_t p = 0; p < plan.profiles.size(); ++p) {
      if (!carries[p] || plan.profiles[p].size() < 3) continue;
      const auto &foot = plan.profiles[p][1], &head = plan.profiles[p].back();
      const double own = (head.height - foot.height) / std::max(head.inward - foot.inward, apex_distance);
      if (own > slope) slope = own, gutter = foot.height;
    }
    if (!(slope > 0) || !(top > gutter)) return std::nullopt;
    const double height = gutter + share * (top - gutter), run = (height - gutter) / slope;
    bool any = false;
    for (std::size_t p = 0; p + 1 < plan.profiles.size(); ++p) {  // the last is of edges with neighbours
      if (carries[p]) continue;
      any = true;
      plan.profiles[p] = kind == Kind::half_hip ? detail::pitched(height, slope)
                                                : Profile{{0, 0}, {0, gutter}, {run, height}, {run, top}};
    }
    return any ? std::optional(uncut(std::move(plan))) : std::nullopt;
  }

  /// The same at the share that suits the scan: lines through samples find where a slope is, but no wall between two.
  [[nodiscard]] auto ended(Kind kind, const Judged& gable, const std::vector<bool>& carries) const
      -> std::optional<Judged> {
    constexpr int shares = 16;
    std::optional<Judged> best;
    for (int i = 1; i < shares; ++i)
      if (const auto plan = with_ends(kind, gable, carries, static_cast<double>(i) / shares)) take(judge_(*plan), best);
    if (best) best = settled(std::move(*best), true);
    return best;
  }

  /// Every side rises to one point, at the height that suits the samples best.
  [[nodiscard]] auto pyramid(const Plan& given, const std::vector<bool>& shared) const -> std::optional<Judged> {
    Plan plan = given;
    const Point2 apex = centroid_of(plan.outer.points);
    const std::size_t n = plan.outer.points.size();
    plan.outer.profile_of_edge.resize(n);
    std::vector<double> distance(n, 0);
    const auto edges = detail::edges_of(given);
    for (std::size_t i = 0; i < n; ++i) {
      plan.outer.profile_of_edge[i] = static_cast<std::uint32_t>(i);
      const double to_apex = edges.front()[i].to(apex);
      if (!(i < shared.size() && shared[i]) && to_apex > apex_distance) distance[i] = to_apex;
    }
    for (auto& hole : plan.holes) hole.profile_of_edge.assign(hole.points.size(), static_cast<std::uint32_t>(n));
    if (std::ranges::count_if(distance, [](double d) { return d > 0; }) < 3) return std::nullopt;
    std::vector<detail::Look> looks;
    double sum = 0;
    for (std::size_t k = 0; k < site_.places.size(); ++k) {
      double share = 1;
      for (std::size_t i = 0; i < n; ++i)
        if (distance[i] > 0) share = std::min(share, edges.front()[i].to(site_.places[k]) / distance[i]);
      looks.push_back({share, site_.z[k], site_.weight[k]});
      sum += site_.z[k];
    }
    auto line = detail::line_through(looks, {sum / static_cast<double>(looks.size()), 0}, options_.lines);
    const double least = options_.forms.min_slope * std::ranges::max(distance);
    if (!line || line->slope < least) line = detail::raised_line(looks, {0, least}, options_.lines);
    const double gutter = std::max(0.0, line->at_edge);
    plan.profiles.assign(n + 1, detail::wall(gutter, options_.forms));
    for (std::size_t i = 0; i < n; ++i)
      if (distance[i] > 0) plan.profiles[i] = detail::pitched(gutter, line->slope / distance[i]);
    std::optional<Judged> best;
    take(judge_(uncut(std::move(plan))), best);
    return best;
  }

  /// The same with a gutter, pitch and knot for each edge.
  [[nodiscard]] auto settled_by_edge(const Judged& judged) const -> Judged {
    Plan plan = judged.plan;
    std::vector<Profile> profiles;
    const auto apart = [&](model::PlanRing& ring) {
      for (auto& p : ring.profile_of_edge) {
        profiles.push_back(plan.profiles[p]);
        p = static_cast<std::uint32_t>(profiles.size() - 1);
      }
    };
    apart(plan.outer);
    for (auto& hole : plan.holes) apart(hole);
    plan.profiles = std::move(profiles);
    auto again = judge_(plan);
    return again ? settled(std::move(*again), true) : judged;
  }

  /// Less steep where it rises above all that the scan shows, by more than a structure on a roof does.
  [[nodiscard]] auto not_above(Judged judged) const -> Judged {
    constexpr double above = 1;  // m
    constexpr int rounds = 3;    // gutters stay, so that one is mostly enough
    for (int round = 0; round < rounds; ++round) {
      const double top = highest_of(judged.sketch) - judged.plan.base, most = site_.sorted.back() + above;
      if (top <= most) break;
      Plan plan = judged.plan;
      for (auto& profile : plan.profiles) {
        if (detail::is_wall(profile)) continue;
        auto &a = profile[profile.size() - 2], &b = profile.back();
        const double share = std::clamp((most - a.height) / std::max(top - a.height, above), 0.1, 1.0);
        b.height = a.height + share * (b.height - a.height);
      }
      auto next = judge_(uncut(std::move(plan)));
      if (!next) break;
      judged = std::move(*next);
    }
    return judged;
  }

  /// With the planes moved until that no longer helps. `whole`: nothing cuts the ridge off.
  [[nodiscard]] auto settled(Judged judged, bool whole) const -> Judged {
    for (std::int64_t round = 0; round < 2 * options_.search.settle_rounds; ++round) {
      Plan plan = detail::refitted(judged, site_, options_);
      if (whole) plan = uncut(std::move(plan));
      if (plan == judged.plan) break;
      auto next = judge_.cheaper(plan, judged.cost);
      if (!next) break;
      judged = std::move(*next);
    }
    return judged;
  }

  [[nodiscard]] auto judge(const Plan& plan) const -> base::Result<Judged> { return judge_(plan); }

 private:
  /// The cap where no roof over the outline can be: walls end at the roof.
  static auto uncut(Plan plan) -> Plan {
    const auto box = geometry::bounds(plan.outer.points);
    const double reach = geometry::length(box.most - box.least);
    plan.cap = 0;
    for (const auto& profile : plan.profiles) {
      if (profile.empty() || detail::is_wall(profile)) continue;
      const auto &a = profile[profile.size() - 2], &b = profile.back();
      const double slope = b.inward > a.inward ? (b.height - a.height) / (b.inward - a.inward) : 0;
      plan.cap = std::max(plan.cap, b.height + slope * reach);
    }
    return plan;
  }

  void take(base::Result<Judged> judged, std::optional<Judged>& best) const {
    if (judged && (!best || detail::cheaper(judged->cost, best->cost, options_.same_cost))) best = std::move(*judged);
  }

  const Site& site_;
  const Options& options_;
  Judge judge_;
};

/// As it is written: the cap just above the ridge, profiles that no edge has left out.
auto finished(const Judged& judged, const extrude::Options& raising, const base::Run& run) -> base::Result<Plan> {
  Plan plan = judged.plan;
  const bool is_flat =
      std::ranges::all_of(plan.profiles, [](const auto& p) { return p.empty() || detail::is_wall(p); });
  if (!is_flat) plan.cap = std::min(plan.cap, highest_of(judged.sketch) - plan.base + above_ridge);
  std::vector<std::optional<std::uint32_t>> number(plan.profiles.size());
  std::vector<Profile> used;
  const auto renumber = [&](model::PlanRing& ring) {
    for (auto& p : ring.profile_of_edge) {
      if (!number[p]) {
        number[p] = static_cast<std::uint32_t>(used.size());
        used.push_back(plan.profiles[p]);
      }
      p = *number[p];
    }
  };
  renumber(plan.outer);
  for (auto& hole : plan.holes) renumber(hole);
  plan.profiles = std::move(used);
  const auto raised = extrude::raise(plan, raising, run);
  if (!raised) return raised.failure();
  if (raised->outcome != extrude::Outcome::full) return raised->warnings.back();
  return plan;
}

auto unseen() -> base::Diagnostic {
  return base::error("refine-unseen", "the scan does not cover this part; give the roof its heights by hand");
}

}  // namespace

auto to_string(Kind kind) -> std::string_view {
  constexpr std::array<std::string_view, kinds.size()> names{"flat",   "shed",    "gable",   "hip",    "half-hip",
                                                             "gablet", "pyramid", "gambrel", "mansard"};
  return names[static_cast<std::size_t>(kind)];
}

auto roof_of(Kind kind, const model::Plan& given, const std::vector<bool>& shared_edges, const rays::Scene& mesh,
             const Options& options, const extrude::Options& raising, const base::Run& run)
    -> base::Result<model::Plan> {
  // The directions of the roof before are no sides of this one.
  const auto at_corner = extrude::corner_edges_of(given.outer.points);
  const Plan plan = extrude::without_corner_edges(given);
  std::vector<bool> shared;
  for (std::size_t i = 0; i < shared_edges.size(); ++i)
    if (!at_corner[i]) shared.push_back(shared_edges[i]);
  const detail::Work work(mesh, nullptr, options, raising, run);
  const Site site = work.look(model::polygon_of(plan), plan.base);
  if (site.cells.empty()) return unseen();
  const Shaping shaping(site, options, raising, run);
  // A roof may rise from a side at which a neighbour is lower: the scan says from which.
  std::optional<Judged> best;
  for (const auto& walls : choices_of_walls(shared)) {
    auto one = kind == Kind::flat      ? shaping.flat(ways_of(plan, walls).plan)
               : kind == Kind::pyramid ? shaping.pyramid(plan, walls)
                                       : shaping.sloped(kind, ways_of(plan, walls));
    if (one && (!best || detail::cheaper(one->cost, best->cost, options.same_cost))) best = std::move(one);
    if (kind == Kind::flat) break;
  }
  if (!best)
    return base::error("refine-kind", "no " + std::string(to_string(kind)) +
                                          " roof fits this outline; choose another roof, or split the part");
  return finished(*best, raising, run);
}

auto fitted(const model::Plan& plan, const rays::Scene& mesh, const Options& options, const extrude::Options& raising,
            const base::Run& run) -> base::Result<model::Plan> {
  const detail::Work work(mesh, nullptr, options, raising, run);
  const Site site = work.look(model::polygon_of(plan), plan.base);
  if (site.cells.empty()) return unseen();
  const Shaping shaping(site, options, raising, run);
  auto judged = shaping.judge(plan);
  if (!judged) return judged.failure();
  return finished(shaping.settled(std::move(*judged), false), raising, run);
}

}  // namespace mansard::refine
