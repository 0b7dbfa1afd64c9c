#include "mansard/extrude/detail/corner_edges.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <ranges>

#include "mansard/extrude/corner_edges.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

/// The direction of an edge of the ring, or one at right angles to that, where no point of the ring is moved by more
/// than `most` m for it; else that of the table which is nearest.
auto direction_like(const std::vector<CanonicalEdge>& ring, const std::vector<ExactPoint>& corners, Point2 along,
                    double most) -> Direction {
  geometry::Box2 box;
  for (const auto& corner : corners) box.add(corner.approximate());
  const double off = most / length(box.most - box.least);
  std::optional<Direction> best;
  double least = off;
  for (const CanonicalEdge& edge : ring) {
    Direction d = edge.direction;
    for (int quarter = 0; quarter < 4; ++quarter, d = d.left()) {
      const Point2 unit = d.approximate();
      if (dot(unit, along) <= 0 || std::abs(cross(unit, along)) >= least) continue;
      least = std::abs(cross(unit, along));
      best = d;
    }
  }
  return best.value_or(direction_of(bearing_of(along)));
}

/// Where a corner edge of the source is in the footprint.
struct Located {
  std::size_t corner = 0;
  Direction direction;
  const CornerEdge* edge = nullptr;
};

/// Those of a ring, the last corner first.
auto located(const Footprint& footprint, std::size_t r, const Source& source, const Options& options)
    -> std::vector<Located> {
  const auto& ring = footprint.rings[r];
  const auto& corners = footprint.corners[r];
  const std::size_t n = ring.size();
  std::vector<Located> out;
  for (const CornerEdge& edge : source.corner_edges) {
    if (edge.ring != r) continue;
    std::optional<std::size_t> nearest;
    double least = options.tolerance;
    for (std::size_t i = 0; i < n; ++i) {
      const double off = length(corners[i].approximate() + footprint.origin - edge.corner);
      if (ring[i].joint || off > least) continue;
      least = off;
      nearest = i;
    }
    if (!nearest) continue;
    const Direction& before = ring[(*nearest + n - 1) % n].direction;
    const Direction& after = ring[*nearest].direction;
    const Direction own = direction_like(ring, corners, edge.along, options.lines.share_move);
    if (cross(before, own) <= 0 || cross(own, after) <= 0 ||
        !lies_between(before.approximate(), own.approximate(), after.approximate()))
      continue;
    if (std::ranges::find(out, *nearest, &Located::corner) != out.end()) continue;
    out.push_back({*nearest, own, &edge});
  }
  std::ranges::sort(out, std::greater(), &Located::corner);
  return out;
}

/// Of a line at a corner: a micrometre further inside, a multiple of a quarter of that. The edge is then as long as it
/// is apart from its neighbours' directions: 0.2 mm at half a degree.
auto offset_beside(const Direction& direction, const ExactPoint& corner) -> Rational {
  constexpr long steps = 1L << 22;  // to the metre
  const Rational at = (corner.y * direction.a - corner.x * direction.b) / direction.l * steps;
  const mpz_class whole = at.get_num() / at.get_den();  // rounded towards zero
  Rational offset(whole + 4, steps);
  offset.canonicalize();
  return offset;
}

/// m: how high a profile's wall is.
auto wall_of(const model::Profile& profile) -> double { return profile[1].inward > 0 ? 0 : profile[1].height; }

/// The profile, its roof from where that of an edge beside it begins where that is as high to within a millimetre: one
/// corner of the roof, which two numbers would make into two. Where that begins lower, the edge has lost its place when
/// its own would begin: up to `most` m lower, it begins there too.
auto begun_alike(model::Profile profile, const model::Profile& before, const model::Profile& after, double most)
    -> model::Profile {
  constexpr double alike = 1e-3;
  double off = alike;
  for (const auto* beside : {&before, &after}) {
    const double other = wall_of(*beside) - wall_of(profile);
    if (wall_of(*beside) > 0 && beside->back().inward > 0 && other >= -most) off = std::min(off, other);
  }
  if (off == alike || wall_of(profile) + off <= 0 || wall_of(profile) == 0) return profile;
  for (auto& knot : profile | std::views::drop(1)) knot.height += off;
  return profile;
}

auto profile_of(const CanonicalEdge& edge, const SourceRing& ring) -> std::uint32_t {
  return ring.profile[static_cast<std::size_t>(std::ranges::find(ring.edge, edge.provenance.edge) - ring.edge.begin())];
}

}  // namespace

void insert(model::PlanRing& ring, std::size_t corner, std::pair<Point2, Point2> ends, std::uint32_t profile,
            double overhang) {
  const auto at = static_cast<std::ptrdiff_t>(corner);
  ring.points[corner] = ends.second;
  ring.points.insert(ring.points.begin() + at, ends.first);
  ring.profile_of_edge.insert(ring.profile_of_edge.begin() + at, profile);
  if (!ring.overhang_of_edge.empty()) ring.overhang_of_edge.insert(ring.overhang_of_edge.begin() + at, overhang);
}

auto without_corner_edges(SourceRing& ring, std::size_t number) -> std::vector<CornerEdge> {
  std::vector<CornerEdge> out;
  std::vector<std::size_t> edges;
  for (std::size_t i = 0; i < ring.points.size(); ++i)
    if (is_corner_edge(ring.points, i)) edges.push_back(i);
  if (edges.empty() || ring.points.size() - edges.size() < 3) return out;
  const geometry::Ring given = ring.points;
  for (const std::size_t i : edges) {
    const std::size_t next = (i + 1) % given.size();
    const Point2 corner = corner_at(given, i);
    out.push_back({number, corner, normalised(given[next] - given[i]), ring.profile[i], ring.edge[i]});
    ring.points[next] = corner;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (std::ranges::binary_search(edges, i)) continue;
    ring.points[kept] = ring.points[i];
    ring.profile[kept] = ring.profile[i];
    ring.edge[kept] = ring.edge[i];
    ++kept;
  }
  ring.points.resize(kept);
  ring.profile.resize(kept);
  ring.edge.resize(kept);
  return out;
}

auto with_corner_edges(const Footprint& footprint, const Source& source, const Options& options) -> Footprint {
  Footprint out = footprint;
  for (std::size_t r = 0; r < out.rings.size(); ++r) {
    auto& ring = out.rings[r];
    auto& corners = out.corners[r];
    for (const Located& one : located(footprint, r, source, options)) {
      CanonicalEdge edge;
      edge.direction = one.direction;
      edge.offset = offset_beside(one.direction, corners[one.corner]);
      edge.provenance = {source.rings[r].ring, one.edge->edge, 0};
      const auto n = ring.size();
      const CanonicalEdge &before = ring[(one.corner + n - 1) % n], &after = ring[one.corner];
      const auto& given = source.profiles;
      const Track track = track_of(begun_alike(given[one.edge->profile], given[profile_of(before, source.rings[r])],
                                               given[profile_of(after, source.rings[r])], options.tolerance));
      const auto known = std::ranges::find(out.tracks, track);
      edge.track = static_cast<std::uint32_t>(known - out.tracks.begin());
      if (known == out.tracks.end()) out.tracks.push_back(track);
      const ExactPoint start = corner_of(before, edge), end = corner_of(edge, after);
      const auto at = static_cast<std::ptrdiff_t>(one.corner);
      corners[one.corner] = end;
      corners.insert(corners.begin() + at, start);
      ring.insert(ring.begin() + at, std::move(edge));
    }
  }
  return out;
}

void put_corner_edges(model::PlanRing& made, const model::PlanRing& given, const Footprint& footprint, std::size_t r,
                      const Source& source, const Options& options) {
  const auto& ring = footprint.rings[r];
  for (const Located& one : located(footprint, r, source, options)) {
    const auto ends =
        ends_at(made.points[one.corner], ring[(one.corner + ring.size() - 1) % ring.size()].direction.approximate(),
                one.direction.approximate(), ring[one.corner].direction.approximate());
    insert(made, one.corner, ends, one.edge->profile,
           given.overhang_of_edge.empty() ? 0 : given.overhang_of_edge[one.edge->edge]);
  }
}

}  // namespace mansard::extrude::detail
