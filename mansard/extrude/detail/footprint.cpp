#include "mansard/extrude/detail/footprint.hpp"

#include <algorithm>
#include <array>

#include "mansard/extrude/detail/lines.hpp"
#include "mansard/extrude/detail/runs.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

/// Whether the outline has corners that would be straightened if it were the source: straightening one place can
/// flatten another.
auto would_be_straightened(const Footprint& footprint, const Options& options) -> bool {
  for (std::size_t r = 0; r < footprint.rings.size(); ++r) {
    geometry::Ring ring;
    for (std::size_t i = 0; i < footprint.rings[r].size(); ++i) {
      const ExactPoint& p = footprint.corners[r][i];
      if (!footprint.rings[r][i].joint) ring.push_back(p.approximate());
    }
    if (straightened(on_fine_grid(ring, {}), options.merge_angle, options.tolerance / 2).size() < ring.size())
      return true;
  }
  return false;
}

/// The footprint's outline as a source again.
auto source_of(const Footprint& footprint, const Source& from) -> Source {
  Source source;
  source.profiles = from.profiles;
  for (std::size_t r = 0; r < footprint.rings.size(); ++r) {
    SourceRing ring;
    ring.ring = from.rings[r].ring;
    for (std::size_t i = 0; i < footprint.rings[r].size(); ++i) {
      const ExactPoint& p = footprint.corners[r][i];
      ring.points.push_back(p.approximate() + footprint.origin);
      const std::uint32_t edge = footprint.rings[r][i].provenance.edge;
      ring.edge.push_back(edge);
      const auto& names = from.rings[r].edge;
      ring.profile.push_back(
          from.rings[r].profile[static_cast<std::size_t>(std::ranges::find(names, edge) - names.begin())]);
    }
    source.rings.push_back(std::move(ring));
  }
  return source;
}

}  // namespace

auto canonical(const Source& source, const Options& options, std::string& why) -> std::optional<Footprint> {
  // Straightening can close a narrow place, and dropping short edges make a spike of it: then less of both.
  const std::array<Care, 4> cares{{{options.tolerance / 2, shortest_made},
                                   {options.tolerance / 2, shortest},
                                   {options.tolerance / 16, shortest_made},
                                   {0, shortest}}};
  const auto made = [&](const Source& from, std::string& reason) {
    auto footprint = put_on_lines(from, options, cares[0], reason);
    for (std::size_t k = 1; !footprint && k < cares.size(); ++k) {
      std::string other;  // the first reason is the one to tell
      footprint = put_on_lines(from, options, cares[k], other);
      if (footprint) footprint->by_profiles = true;  // what was refused may not be with others
    }
    return footprint;
  };
  auto footprint = made(source, why);
  if (!footprint) return footprint;
  why.clear();
  // Until nothing more is flattened: the canonical form of a canonical form is that form.
  constexpr int rounds = 8;
  Footprint& best = *footprint;
  for (int round = 0; round < rounds && would_be_straightened(best, options); ++round) {
    const Source flatter = source_of(best, source);
    std::string reason;
    auto again = made(flatter, reason);
    best.by_profiles = best.by_profiles || !again || again->by_profiles;
    if (!again || again->moved + best.moved > options.tolerance) break;
    if (again->corners == best.corners) break;
    again->moved += best.moved;
    again->tally.straightened += best.tally.straightened;
    again->tally.collinear += best.tally.collinear;
    again->tally.slivers += best.tally.slivers;
    again->by_profiles = best.by_profiles;
    best = *std::move(again);
  }
  return footprint;
}

}  // namespace mansard::extrude::detail
