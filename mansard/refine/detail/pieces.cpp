#include "mansard/refine/detail/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/forms.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;
using model::Plan;
using model::PlanRing;

// Error bounds of polygon operations. A coordinate below 1e4 m is exact to 1e4 · 2⁻⁵³ ≈ 1e-12 m. Where two edges cross
// at an angle α, the crossing is off by at most 4e-12 / sin α m: 2e-10 m at 1°. That changes an area by at most the
// same times the edges' length: 2e-8 m² over 100 m. Both bounds have room for fifty such corners.
constexpr double on_line = 1e-6;  ///< m off the line of its neighbours: a corner that a clip left behind
constexpr double lost = 1e-6;     ///< m²; a greater difference of areas is an operation that failed, not rounding

/// Metres of a → b that lie along an edge in the same direction.
auto overlap(Point2 a, Point2 b, Point2 from, Point2 to, double aside) -> double {
  const double length = geometry::length(b - a), other = geometry::length(to - from);
  if (!(length > 0) || !(other > 0)) return 0;
  const Point2 along = (1 / length) * (b - a), across = geometry::left_of(along);
  if (dot(along, to - from) <= 0) return 0;
  if (std::abs(dot(from - a, across)) > aside || std::abs(dot(to - a, across)) > aside) return 0;
  return std::min(length, dot(to - a, along)) - std::max(0.0, dot(from - a, along));
}

/// Of which origin, and which profile there.
using Under = std::pair<std::size_t, std::uint32_t>;

/// The profile that most of a → b lies on.
auto profile_under(std::span<const Origin> origins, Point2 a, Point2 b, const Options::Pieces& options)
    -> std::optional<Under> {
  std::map<Under, double> lengths;
  for (std::size_t o = 0; o < origins.size(); ++o) {
    const auto add = [&](const PlanRing& ring) {
      for (std::size_t i = 0; i < ring.points.size(); ++i) {
        const double common = overlap(a, b, ring.points[i], ring.points[(i + 1) % ring.points.size()], options.aside);
        if (common > 0) lengths[{o, ring.profile_of_edge[i]}] += common;
      }
    };
    add(origins[o].roof.outer);
    for (const auto& hole : origins[o].roof.holes) add(hole);
  }
  const auto longest = std::ranges::max_element(lengths, {}, [](const auto& entry) { return entry.second; });
  if (longest == lengths.end() || longest->second < options.profile_share * geometry::length(b - a))
    return std::nullopt;
  return longest->first;
}

/// Corners on straight lines, which cutting and joining leave behind, and repeated ones.
auto cleaned(const Ring& ring, double straight) -> Ring {
  Ring out = ring;
  for (bool changed = true; changed && out.size() > 3;) {
    changed = false;
    for (std::size_t i = 0; i < out.size() && out.size() > 3; ++i) {
      const Point2 before = out[(i + out.size() - 1) % out.size()], after = out[(i + 1) % out.size()];
      if (geometry::distance({before, after}, out[i]) >= straight) continue;
      out.erase(out.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
    }
  }
  return out;
}

auto caps_of(const Site& site, double otherwise, const Options& options) -> std::vector<double> {
  if (site.sorted.empty()) return {otherwise};
  const auto& forms = options.forms;
  const auto share = [&](double s) { return base::percentile_of_sorted(site.sorted, s, base::Rank::below); };
  std::vector<double> caps;
  const double top = share(forms.cap_percentile);
  for (double cap : {commonest(site.sorted, options), top + forms.cap_clearance, top, share(0.5)}) {
    cap = std::max(forms.min_height, cap);
    if (std::ranges::none_of(caps, [&](double c) { return std::abs(c - cap) < forms.cap_distinct; }))
      caps.push_back(cap);
  }
  return caps;
}

}  // namespace

auto mean_width(const Polygon& polygon) -> double {
  double around = geometry::perimeter(polygon.outer);
  for (const auto& hole : polygon.holes) around += geometry::perimeter(hole);
  return 2 * geometry::area(polygon) / around;
}

auto cut(const Polygon& part, const Polygon& structure, const Options& options) -> std::vector<Polygon> {
  const auto inside = geometry::intersect(part, structure), rest = geometry::subtract(part, structure);
  if (!inside || !rest || inside->empty() || rest->empty()) return {};
  std::vector<Polygon> out = *rest;
  std::ranges::stable_sort(out, [](const auto& a, const auto& b) { return geometry::area(a) > geometry::area(b); });
  out.insert(out.end(), inside->begin(), inside->end());
  // Along shared walls rounding can make an operation keep what it should take off.
  double covered = 0;
  for (const auto& piece : out) covered += geometry::area(piece);
  if (std::abs(covered - geometry::area(part)) > lost) return {};
  for (auto& piece : out) {
    piece.outer = cleaned(piece.outer, on_line);
    for (auto& hole : piece.holes) hole = cleaned(hole, on_line);
    if (geometry::area(piece) < options.least_area || mean_width(piece) < options.pieces.min_width ||
        !geometry::is_simple(piece))
      return {};
  }
  return out;
}

auto joined(const Polygon& a, const Polygon& b, const Options& options) -> std::optional<Polygon> {
  const double slit = options.pieces.slit, straight = options.pieces.straight;
  const Polygon both[]{a, b};
  auto united = geometry::unite(both);
  if (!united || united->empty()) return std::nullopt;
  Polygon out = united->front();
  if (united->size() > 1 || !geometry::is_simple(out)) return std::nullopt;
  std::erase_if(out.holes, [slit](const Ring& hole) {
    return std::abs(geometry::signed_area(hole)) < slit * geometry::perimeter(hole);
  });
  out.outer = cleaned(out.outer, straight);
  for (auto& hole : out.holes) hole = cleaned(hole, straight);
  if (!geometry::is_simple(out)) return std::nullopt;
  const double closed = slit * (geometry::perimeter(a.outer) + geometry::perimeter(b.outer));  // m², at most
  if (std::abs(geometry::area(out) - geometry::area(a) - geometry::area(b)) > closed) return std::nullopt;
  return out;
}

auto draft_of(std::span<const Origin> origins, const Site& piece, const Options& options) -> Draft {
  Draft out;
  const auto& first = origins.front();
  out.owner = first.draft.owner;
  std::map<Under, std::uint32_t> kept;  // profiles of the origins, by their new numbers
  const double level = piece.sorted.empty() ? first.roof.cap : commonest(piece.sorted, options);
  const auto ring_of = [&](const Ring& points) {
    PlanRing ring{points, {}};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto next = static_cast<std::uint32_t>(out.plan.profiles.size());
      const auto under = profile_under(origins, points[i], points[(i + 1) % points.size()], options.pieces);
      if (!under) {
        out.plan.profiles.push_back(wall(level, options.forms));
        out.alternatives.emplace_back();
        ring.profile_of_edge.push_back(next);
        continue;
      }
      const auto [at, is_new] = kept.try_emplace(*under, next);
      if (is_new) {
        const auto& [origin, profile] = *under;
        const auto& others = origins[origin].draft.alternatives;
        out.plan.profiles.push_back(origins[origin].roof.profiles[profile]);
        out.alternatives.push_back(profile < others.size() ? others[profile] : std::vector<model::Profile>{});
      }
      ring.profile_of_edge.push_back(at->second);
    }
    return ring;
  };
  out.plan.outer = ring_of(piece.polygon.outer);
  for (const auto& hole : piece.polygon.holes) out.plan.holes.push_back(ring_of(hole));
  out.plan.base = first.roof.base;
  out.caps = caps_of(piece, first.roof.cap, options);
  out.plan.cap = out.caps.front();
  return out;
}

}  // namespace mansard::refine::detail
