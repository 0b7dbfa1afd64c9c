#include "mansard/extrude/detail/eaves.hpp"

#include <algorithm>
#include <utility>

#include "mansard/geometry/polygon.hpp"

namespace mansard::extrude::detail {
namespace {

/// Whether a roof rises straight from the top of a vertical wall.
auto has_eave(const Track& track) -> bool {
  return track.size() > 1 && !track[0].horizontal && track[0].slope == 0 && !track[1].horizontal && track[1].slope > 0;
}

auto quanta_below(const Rational& metres) -> std::int64_t {
  const Rational quanta = metres * quanta_per_metre;
  mpz_class whole;
  mpz_fdiv_q(whole.get_mpz_t(), quanta.get_num_mpz_t(), quanta.get_den_mpz_t());
  return whole.get_si();
}

}  // namespace

auto eaves_of(const Footprint& footprint, const Rational& cap, const Options& options, std::string& why)
    -> std::optional<Eaves> {
  why.clear();
  const auto refuse = [&](std::string reason) {
    why = std::move(reason);
    return std::nullopt;
  };
  std::optional<Rational> lowest, shallowest;  // eaves; the greatest run over rise among them
  for (const auto& ring : footprint.rings)
    for (const CanonicalEdge& edge : ring)
      if (const Track& track = footprint.tracks[edge.track]; has_eave(track))
        if (!lowest || track[1].height < *lowest) lowest = track[1].height;
  if (!lowest || *lowest >= cap) return std::nullopt;
  const auto at_eaves = [&](const CanonicalEdge& edge) {
    const Track& track = footprint.tracks[edge.track];
    return has_eave(track) && track[1].height == *lowest;
  };
  for (const auto& ring : footprint.rings)
    for (const CanonicalEdge& edge : ring) {
      if (!at_eaves(edge)) continue;
      const Rational& slope = footprint.tracks[edge.track][1].slope;
      if (!shallowest || slope > *shallowest) shallowest = slope;
    }

  Eaves eaves;
  eaves.soffit = quanta_below(*lowest - on_grid(options.overhang) / *shallowest);
  const Rational soffit(eaves.soffit, quanta_per_metre);
  if (eaves.soffit < static_cast<std::int64_t>(options.eaves.min_soffit / quantum))
    return refuse("the soffit would be below ground");
  for (const auto& ring : footprint.rings)
    for (const CanonicalEdge& edge : ring) {
      const Track& track = footprint.tracks[edge.track];
      const bool upright =
          !track[0].horizontal && track[0].slope == 0 && (track.size() < 2 || track[1].height > soffit);
      if (!upright) return refuse("a wall leans or steps back below the soffit");
    }

  for (const auto& ring : footprint.rings)
    for (const CanonicalEdge& edge : ring)
      if (has_eave(footprint.tracks[edge.track]) && !at_eaves(edge)) why = "only the lowest eaves overhang";

  eaves.rings = footprint.rings;
  std::vector<std::vector<ExactPoint>> corners;
  for (auto& ring : eaves.rings) {
    auto& overhangs = eaves.overhangs.emplace_back();
    for (CanonicalEdge& edge : ring) {
      overhangs.push_back(at_eaves(edge));
      if (overhangs.back()) edge.offset -= footprint.tracks[edge.track][1].slope * (*lowest - soffit);
    }
    auto& outline = corners.emplace_back();
    geometry::Ring rounded;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const CanonicalEdge &before = ring[(i + ring.size() - 1) % ring.size()], &edge = ring[i];
      if (edge.joint && before.offset != edge.offset) return refuse("eaves along one facade line would differ");
      if (edge.joint) {
        // Across the line the joint stays where it is along it.
        const Direction& d = edge.direction;
        const Rational along = (Rational(d.a) * edge.joint->x + Rational(d.b) * edge.joint->y) / d.l;
        outline.push_back({(d.a * along - d.b * edge.offset) / d.l, (d.b * along + d.a * edge.offset) / d.l});
      } else {
        outline.push_back(corner_of(before, edge));
      }
      rounded.push_back(outline.back().approximate());
      // The eaves of a spike would meet far outside.
      const ExactPoint& foot = footprint.corners[corners.size() - 1][i];
      const geometry::Point2 out = rounded.back() - foot.approximate();
      if (length(out) > options.eaves.mitre * options.overhang)
        return refuse("eaves would meet too far out at a sharp corner");
    }
    if ((geometry::signed_area(rounded) > 0) != (corners.size() == 1)) return refuse("a courtyard would be covered");
    // An edge that turned round encloses the wrong side even where the whole is simple.
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const ExactPoint &a = outline[i], &b = outline[(i + 1) % ring.size()];
      if (Rational(ring[i].direction.a) * (b.x - a.x) + Rational(ring[i].direction.b) * (b.y - a.y) <= 0)
        return refuse("eaves would run into each other");
    }
  }
  if (clash_in(corners)) return refuse("eaves would run into each other");
  return eaves;
}

}  // namespace mansard::extrude::detail
