// O7: pairs of edges of one face that would make a sliver or a needle of it if both became walls.
#include <algorithm>
#include <cmath>
#include <set>

#include "mansard/segment/detail/candidates.hpp"
#include "mansard/segment/detail/origins.hpp"

namespace mansard::segment::detail {
namespace {

using geometry::cross, geometry::dot, geometry::Point2;

constexpr double run_turn = 0.1;       ///< rad; half-edges that turn less make one run
constexpr double shortest = 0.2;       ///< m; runs shorter than that have no direction to speak of
constexpr double least_overlap = 0.1;  ///< m; opposite runs must face each other along at least that
const double parallel_cosine = std::cos(0.3);  // tolerance of the reference, facts 5

/// Consecutive, nearly collinear half-edges of a face with one neighbour.
struct Run {
  geometry::Segment2 segment;                ///< the face on its left
  std::optional<std::uint32_t> candidate;    ///< none on the outline
  double length = 0;                         ///< m
  double facing_out = 0, facing_in = 0;      ///< m of sweep-edge whose outside lies off the face, or in it
};

auto runs_of(const fracture::Arrangement& arrangement, std::uint32_t face,
             const std::vector<std::optional<std::uint32_t>>& candidate_of) -> std::vector<Run> {
  const auto direction = [&](std::uint32_t h) {
    const auto s = arrangement.segment(h);
    return s.end - s.start;
  };
  const auto goes_on = [&](std::uint32_t h, std::uint32_t next) {
    const Point2 a = direction(h), b = direction(next);
    return candidate_of[h] == candidate_of[next] && dot(a, b) > 0 && std::abs(cross(a, b)) <= run_turn * dot(a, b);
  };
  std::uint32_t first = arrangement.faces[face].edge;
  const std::uint32_t origin = first;
  while (goes_on(arrangement.half_edges[first].previous, first)) {
    first = arrangement.half_edges[first].previous;
    if (first == origin) break;
  }
  std::vector<Run> runs;
  std::uint32_t h = first;
  do {
    const fracture::HalfEdge& edge = arrangement.half_edges[h];
    if (h == first || !goes_on(edge.previous, h)) runs.push_back({arrangement.segment(h), candidate_of[h]});
    Run& run = runs.back();
    const double length = length_of(arrangement, h);
    run.segment.end = arrangement.segment(h).end;
    run.length += length;
    // A sweep-edge has its outside on the left.
    bool in = false, out = false;
    for (const fracture::Origin& o : edge.origins)
      if (o.kind == fracture::Kind::hard && o.source < gis_source) (o.along ? in : out) = true;
    if (in) run.facing_in += length;
    if (out) run.facing_out += length;
    h = edge.next;
  } while (h != first);
  return runs;
}

/// Consecutive runs with an interior angle under the limit between them.
auto is_needle(const Run& one, const Run& next, double angle) -> bool {
  if (one.length < shortest || next.length < shortest) return false;
  const Point2 back = one.segment.start - one.segment.end, on = next.segment.end - next.segment.start;
  return cross(on, back) > 0 && dot(on, back) > std::cos(angle) * length(on) * length(back);
}

/// Runs that face each other across the face, nearer than the limit.
auto is_sliver(const Run& one, const Run& other, double distance) -> bool {
  if (one.length < shortest || other.length < shortest) return false;
  const Point2 a = one.segment.end - one.segment.start, b = other.segment.end - other.segment.start;
  const double la = length(a);
  if (dot(a, b) > -parallel_cosine * la * length(b)) return false;
  // In the frame of `one`: along it, and to its left; `other` runs backwards.
  const auto along = [&](Point2 p) { return dot(p - one.segment.start, a) / la; };
  const auto aside = [&](Point2 p) { return cross(a, p - one.segment.start) / la; };
  const double from = along(other.segment.end), to = along(other.segment.start);
  const double low = std::max(0.0, from), high = std::min(la, to);
  if (high - low < least_overlap) return false;
  const auto off = [&](double t) {
    const double s = (t - from) / (to - from);
    return (1 - s) * aside(other.segment.end) + s * aside(other.segment.start);
  };
  const double nearest = std::min(off(low), off(high)), farthest = std::max(off(low), off(high));
  return farthest > 0 && nearest < distance;
}

/// A thin wall, or a shaft, seen from both sides: sweep-edges on both, which face away from each other or towards.
auto seen_from_both_sides(const Run& one, const Run& other) -> bool {
  const auto most = [](double part, const Run& run) { return part > run.length / 2; };
  return (most(one.facing_out, one) && most(other.facing_out, other)) ||
         (most(one.facing_in, one) && most(other.facing_in, other));
}

}  // namespace

auto bad_pairs_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                  const std::vector<std::optional<std::uint32_t>>& candidate_of, const Options& options)
    -> std::vector<BadPair> {
  std::set<BadPair> pairs;
  const auto note = [&](const Run& one, const Run& other) {
    if (!one.candidate && !other.candidate) return;  // the outline is there whatever is chosen
    if (!one.candidate || !other.candidate || *one.candidate == *other.candidate) {
      pairs.insert({one.candidate ? *one.candidate : *other.candidate, std::nullopt});
    } else {
      pairs.insert({std::min(*one.candidate, *other.candidate), std::max(*one.candidate, *other.candidate)});
    }
  };
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (!faces[f].inside) continue;
    const std::vector<Run> runs = runs_of(arrangement, f, candidate_of);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const Run& next = runs[(i + 1) % runs.size()];
      if (runs.size() > 2 && is_needle(runs[i], next, options.thin_angle)) note(runs[i], next);
      for (std::size_t j = i + 1; j < runs.size(); ++j) {
        if (!is_sliver(runs[i], runs[j], options.thin_distance)) continue;
        if (options.thin_rule == ThinRule::unsupported && seen_from_both_sides(runs[i], runs[j])) continue;
        note(runs[i], runs[j]);
      }
    }
  }
  return {pairs.begin(), pairs.end()};
}

}  // namespace mansard::segment::detail
