#include "mansard/extrude/canonical.hpp"

#include <set>

#include "mansard/base/text.hpp"
#include "mansard/extrude/detail/corner_edges.hpp"
#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/source.hpp"

namespace mansard::extrude {
namespace {

auto ring_of(const detail::Footprint& footprint, std::size_t r, const model::PlanRing& from,
             const detail::Source& source, const Options& options) -> model::PlanRing {
  model::PlanRing ring;
  for (std::size_t i = 0; i < footprint.rings[r].size(); ++i) {
    const detail::ExactPoint& p = footprint.corners[r][i];
    ring.points.push_back(p.approximate() + footprint.origin);
    const auto edge = footprint.rings[r][i].provenance.edge;
    ring.profile_of_edge.push_back(from.profile_of_edge[edge]);
    if (!from.overhang_of_edge.empty()) ring.overhang_of_edge.push_back(from.overhang_of_edge[edge]);
  }
  detail::put_corner_edges(ring, from, footprint, r, source, options);
  return ring;
}

auto directions_in(const detail::Footprint& footprint) -> std::size_t {
  std::set<detail::Direction> directions;
  for (const auto& ring : footprint.rings)
    for (const auto& edge : ring) {
      detail::Direction d = edge.direction;
      while (d.a <= 0 || d.b < 0) d = d.left();
      directions.insert(d);
    }
  return directions.size();
}

auto reasons_of(const Canonical& made) -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> reasons;
  const auto tell = [&](std::size_t count, const std::string& what, const std::string& then) {
    if (count > 0) reasons.push_back(base::warning("extrude-straightened", std::to_string(count) + " " + what + then));
  };
  tell(made.repeated_points, "repeated points", " were dropped");
  tell(made.straightened, "corners at shallow turns",
       " were straightened; the outline moved by up to " + base::to_text(made.moved, 3) +
           " m; lower --extrude-merge-angle to keep them");
  tell(made.collinear, "corners on a straight line", " were dropped");
  tell(made.slivers, "edges or stretches under a millimetre", " were given to their neighbours");
  tell(made.empty_parts, "parts of profiles without run and rise", " were dropped");
  tell(made.straight_knots, "knots on straight runs of profiles", " were dropped");
  return reasons;
}

}  // namespace

auto canonical(const model::Plan& plan, const Options& options) -> base::Result<Canonical> {
  const auto source = detail::prepared(plan);
  if (!source) return source.error();
  std::string why;
  const auto footprint = detail::canonical(*source, options, why);
  if (!footprint) return base::error("extrude-canonical", why);

  Canonical made;
  made.plan.base = plan.base;
  made.plan.cap = plan.cap;
  made.plan.outer = ring_of(*footprint, 0, plan.outer, *source, options);
  for (std::size_t h = 0; h < plan.holes.size(); ++h)
    made.plan.holes.push_back(ring_of(*footprint, h + 1, plan.holes[h], *source, options));
  for (const auto& profile : plan.profiles) {
    auto onto_grid = detail::canonical_profile(profile);
    made.plan.profiles.push_back(std::move(onto_grid.profile));
    made.empty_parts += onto_grid.empty_parts;
    made.straight_knots += onto_grid.straight_knots;
  }
  made.moved = footprint->moved;
  made.repeated_points = source->repeated_points;
  made.straightened = footprint->tally.straightened;
  made.collinear = footprint->tally.collinear;
  made.joints = footprint->tally.joints;
  made.slivers = footprint->tally.slivers;
  made.directions = directions_in(*footprint);
  made.reasons = reasons_of(made);
  return made;
}

}  // namespace mansard::extrude
