// Holes behind which a slope goes on. A plan says so in rounded numbers, twice: by the slope's profile from the eaves
// on, and by that of the hole's back edge. Rounded each for itself, they are two planes that cross or miss each other
// by micrometres, and a strip between them over the whole slope.
#include <algorithm>
#include <cmath>

#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/lines.hpp"

namespace mansard::extrude::detail {
namespace {

/// m. Lines and heights on the grid are off by a quantum each. A line that shares another's direction is off by up to
/// `Options::Lines::share_move` at its ends, by more beyond them. What is farther off is another roof.
constexpr double near = 2e-3;

/// Where the track is at a height above its base, inward of its edge, after any terrace there; m.
auto inward_at(const Track& track, const Rational& height) -> Rational {
  const auto above = std::ranges::find_if(track, [&](const TrackPart& part) { return part.height > height; });
  const TrackPart& part = *std::prev(above);
  return part.inward + part.slope * (height - part.height);
}

/// The part of the outline's edge that the hole's edge goes on with from the top of its wall, and how far the edge must
/// move inward for that.
struct Found {
  Continues roof;
  Rational move;
};
auto found(const Footprint& footprint, const CanonicalEdge& hole) -> std::optional<Found> {
  const Track& own = footprint.tracks[hole.track];
  if (own.size() < 2 || own[0].slope != 0 || own[0].horizontal || own[1].horizontal || own[1].slope <= 0)
    return std::nullopt;
  const Rational& from = own[1].height;
  std::optional<Found> best;
  const auto& outline = footprint.rings[0];
  for (std::uint32_t f = 0; f < outline.size(); ++f) {
    const CanonicalEdge& edge = outline[f];
    if (edge.direction != hole.direction) continue;
    const Track& track = footprint.tracks[edge.track];
    std::size_t part = track.size() - 1;
    while (part > 0 && track[part].height > from) --part;
    if (track[part].horizontal || track[part].slope <= 0) continue;
    const Rational apart = edge.offset - hole.offset;
    Rational move = apart + inward_at(track, from);
    const auto same_at = [&](const Rational& height) {
      const Rational off = apart + inward_at(track, height) - inward_at(own, height);
      return std::abs(off.get_d()) <= near;
    };
    const Rational highest = std::max(own.back().height, track.back().height);
    bool same = same_at(from) && same_at(highest + 1);
    for (const TrackPart& knot : own) same = same && (knot.height < from || same_at(knot.height));
    for (const TrackPart& knot : track) same = same && (knot.height < from || same_at(knot.height));
    const double by = std::abs(move.get_d());
    if (!same || (best && std::abs(best->move.get_d()) <= by)) continue;
    best = Found{{f, static_cast<std::uint32_t>(part)}, std::move(move)};
  }
  return best;
}

}  // namespace

auto continued(const Footprint& footprint) -> std::optional<Footprint> {
  std::optional<Footprint> out;
  for (std::size_t r = 1; r < footprint.rings.size(); ++r) {
    const std::size_t n = footprint.rings[r].size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (i + 1) % n;
      if (footprint.rings[r][i].joint || footprint.rings[r][next].joint) continue;
      const auto roof = found(footprint, footprint.rings[r][i]);
      if (!roof) continue;
      if (!out) out = footprint;
      auto& ring = out->rings[r];
      auto& corners = out->corners[r];
      const auto before = ring[i];
      const auto start = corners[i], end = corners[next];
      ring[i].offset += roof->move;
      ring[i].roof = roof->roof;
      corners[i] = corner_of(ring[(i + n - 1) % n], ring[i]);
      corners[next] = corner_of(ring[i], ring[next]);
      const auto goes_on = [&](std::size_t k) {
        const ExactPoint &a = corners[k], &b = corners[(k + 1) % n];
        const geometry::Point2 along{Rational(b.x - a.x).get_d(), Rational(b.y - a.y).get_d()};
        return dot(ring[k].direction.approximate(), along) >= shortest;
      };
      if (goes_on((i + n - 1) % n) && goes_on(i) && goes_on(next)) {
        out->moved = std::max(out->moved, footprint.moved + std::abs(roof->move.get_d()));
        continue;
      }
      ring[i] = before, corners[i] = start, corners[next] = end;
    }
  }
  if (out && clash_in(out->corners)) return std::nullopt;
  return out;
}

}  // namespace mansard::extrude::detail
