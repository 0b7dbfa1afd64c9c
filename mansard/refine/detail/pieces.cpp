#include "mansard/refine/detail/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <ranges>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/order.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;
using model::Plan;
using model::PlanRing;

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
        const double common = overlap(a, b, ring.points[i], ring.points[(i + 1) % ring.points.size()], options.slit);
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

/// How flat a corner is, in units of what may be left out: metres off the line between its neighbours over `straight`,
/// or of a spike's tip the spike's width over `slit`. Below 1 it goes.
auto flatness(Point2 before, Point2 at, Point2 after, const Options::Pieces& options) -> double {
  const double off = geometry::distance({before, after}, at) / options.straight;
  const double in = geometry::length(at - before), on = geometry::length(after - at);
  const double narrow = std::min(in, on) < options.slit ? options.straight : options.slit;
  const double width = in < on ? geometry::distance({at, after}, before) : geometry::distance({before, at}, after);
  return std::min(off, width / narrow);
}

/// Without corners on straight lines and tips of spikes, the flattest first: the order must not depend on where the
/// ring begins. Operations on polygons with common edges leave both, or not, as rounding has it; a spike defeats
/// extrusion.
auto cleaned(Ring ring, const Options::Pieces& options) -> Ring {
  while (ring.size() > 3) {
    std::size_t flattest = 0;
    double least = 1;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 before = ring[(i + ring.size() - 1) % ring.size()], after = ring[(i + 1) % ring.size()];
      const double flat = flatness(before, ring[i], after, options);
      if (flat < least) {
        least = flat;
        flattest = i;
      }
    }
    if (least >= 1) break;
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(flattest));
  }
  // Where an operation lets a ring begin is a matter of rounding too. No two corners of a plan are equally far along a
  // direction of which the tangent is the golden ratio.
  std::ranges::rotate(ring, std::ranges::min_element(ring, {}, [](Point2 p) { return p.x + std::numbers::phi * p.y; }));
  return ring;
}

/// With the corners of `to` for those of its own that are as near to them.
auto snapped(Polygon polygon, const Polygon& to, double near) -> Polygon {
  const auto snap = [&](Ring& ring) {
    for (Point2& p : ring) {
      double least = near;
      const auto consider = [&](const Ring& other) {
        for (const Point2 q : other)
          if (const double d = geometry::length(q - p); d < least) {
            least = d;
            p = q;
          }
      };
      const Point2 was = p;
      consider(to.outer);
      for (const auto& hole : to.holes) consider(hole);
      if (least == 0) p = was;
    }
  };
  snap(polygon.outer);
  for (auto& hole : polygon.holes) snap(hole);
  return polygon;
}

/// Its edges pass through the corners of the other that are as near to them.
auto noded(const Polygon& polygon, const Polygon& by, double near) -> Polygon {
  const auto node = [&](const Ring& ring) {
    Ring out;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      const double length = geometry::length(b - a);
      std::vector<std::pair<double, Point2>> on;
      const auto consider = [&](const Ring& other) {
        for (const Point2 q : other)
          if (geometry::distance({a, b}, q) < near)
            if (const double t = dot(q - a, b - a) / length; t >= near && t <= length - near) on.emplace_back(t, q);
      };
      consider(by.outer);
      for (const auto& hole : by.holes) consider(hole);
      std::ranges::stable_sort(on, {}, &std::pair<double, Point2>::first);
      out.push_back(a);
      for (const auto& [t, q] : on) out.push_back(q);
    }
    return out;
  };
  Polygon out{node(polygon.outer), {}};
  for (const auto& hole : polygon.holes) out.holes.push_back(node(hole));
  return out;
}

/// Rings that touch themselves at a corner, taken apart there: what an operation leaves between two sides that meet in
/// a point is one ring with a neck of no width, or two, as rounding has it. A ring that closes around a hole stays.
auto unpinched(const Ring& ring, const Options::Pieces& options) -> std::vector<Ring> {
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t step = 1; step + 1 < n; ++step) {
      const std::size_t j = (i + step) % n, k = (j + 1) % n;
      if (geometry::distance({ring[j], ring[k]}, ring[i]) >= options.straight) continue;
      Ring first, second;
      for (std::size_t at = i; at != k; at = (at + 1) % n) first.push_back(ring[at]);
      for (std::size_t at = k; at != i; at = (at + 1) % n) second.push_back(ring[at]);
      second.push_back(ring[i]);
      std::vector<Ring> out;
      bool apart = true;
      for (const Ring* loop : {&first, &second}) {
        const double area = geometry::signed_area(*loop);
        if (loop->size() < 3 || 2 * std::abs(area) < options.slit * geometry::perimeter(*loop)) continue;
        apart = apart && area > 0;
        std::ranges::move(unpinched(*loop, options), std::back_inserter(out));
      }
      if (apart) return out;
    }
  return {ring};
}

/// Whether a corner is so near to another edge that rounding decides on which side of it.
auto touches_itself(const Polygon& polygon, double near) -> bool {
  std::vector<const Ring*> rings{&polygon.outer};
  for (const auto& hole : polygon.holes) rings.push_back(&hole);
  const auto touched = [&](const Ring& ring, std::size_t corner) {
    return std::ranges::any_of(rings, [&](const Ring* other) {
      const std::size_t n = other->size();
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = (i + 1) % n;
        const bool own = other == &ring && (i == corner || j == corner);
        if (!own && geometry::distance({(*other)[i], (*other)[j]}, ring[corner]) < near) return true;
      }
      return false;
    });
  };
  return std::ranges::any_of(rings, [&](const Ring* ring) {
    for (std::size_t i = 0; i < ring->size(); ++i)
      if (touched(*ring, i)) return true;
    return false;
  });
}

/// The part less those pieces; empty where the operation fails.
auto without(const Polygon& part, const std::vector<Polygon>& pieces, const Options::Pieces& options)
    -> std::vector<Polygon> {
  std::vector<Polygon> left{part};
  for (const auto& piece : pieces) {
    std::vector<Polygon> next;
    for (const auto& polygon : left) {
      const auto [from, what] = fitted(polygon, piece, options);
      auto rest = geometry::subtract(from, what);
      if (!rest) return {};
      std::ranges::move(*rest, std::back_inserter(next));
    }
    left = std::move(next);
  }
  return tidied(std::move(left), options);
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

auto fitted(const Polygon& a, const Polygon& b, const Options::Pieces& options) -> std::pair<Polygon, Polygon> {
  const Polygon other = snapped(b, a, options.straight);
  return {noded(a, other, options.straight), noded(other, a, options.straight)};
}

auto around(const Polygon& polygon) -> double {
  double out = geometry::perimeter(polygon.outer);
  for (const auto& hole : polygon.holes) out += geometry::perimeter(hole);
  return out;
}

auto mean_width(const Polygon& polygon) -> double { return 2 * geometry::area(polygon) / around(polygon); }

auto tidied(std::vector<Polygon> all, const Options::Pieces& options) -> std::vector<Polygon> {
  std::erase_if(all, [&](const Polygon& piece) { return mean_width(piece) < options.slit; });
  std::vector<Polygon> overlay;
  for (auto& piece : all) {
    auto rings = unpinched(cleaned(std::move(piece.outer), options), options);
    if (rings.size() == 1) {
      overlay.push_back({std::move(rings.front()), std::move(piece.holes)});
      continue;
    }
    for (auto& ring : rings) overlay.push_back({std::move(ring), {}});
    for (auto& hole : piece.holes)
      for (auto& one : overlay | std::views::drop(std::ssize(overlay) - std::ssize(rings)))
        if (geometry::contains(one.outer, hole.front())) one.holes.push_back(hole);
  }
  for (auto& piece : overlay) {
    std::erase_if(piece.holes, [&](const Ring& hole) {
      return 2 * std::abs(geometry::signed_area(hole)) < options.straight * geometry::perimeter(hole);
    });
    piece.outer = cleaned(std::move(piece.outer), options);
    for (auto& hole : piece.holes) hole = cleaned(std::move(hole), options);
  }
  return overlay;
}

auto cut(const Polygon& part, const Polygon& structure, const Options& options, std::optional<double> narrowest)
    -> std::vector<Polygon> {
  const double width = narrowest.value_or(options.pieces.min_width);
  const auto [whole, taken] = fitted(part, structure, options.pieces);
  auto inside = geometry::intersect(whole, taken), rest = geometry::subtract(whole, taken);
  if (!inside || !rest) return {};
  // A sliver of one side belongs to the other.
  auto in = tidied(*inside, options.pieces), out = tidied(*rest, options.pieces);
  const auto is_sliver = [&](const Polygon& piece) { return mean_width(piece) < options.pieces.slit; };
  if (std::ranges::any_of(*inside, is_sliver)) out = without(part, in, options.pieces);
  if (std::ranges::any_of(*rest, is_sliver)) in = without(part, out, options.pieces);
  if (in.empty() || out.empty()) return {};
  rank(
      out, [](const Polygon& piece) { return -geometry::area(piece); }, same_area);
  out.insert(out.end(), in.begin(), in.end());
  // Along shared walls rounding can make an operation keep what it should take off.
  double covered = 0;
  for (const auto& piece : out) covered += geometry::area(piece);
  if (std::abs(covered - geometry::area(part)) > options.pieces.straight * around(part)) return {};
  for (const auto& piece : out)
    if (geometry::area(piece) < options.cuts.min_area || mean_width(piece) < width || !geometry::is_simple(piece) ||
        touches_itself(piece, options.pieces.straight))
      return {};
  return out;
}

auto joined(const Polygon& a, const Polygon& b, const Options& options) -> std::optional<Polygon> {
  const double slit = options.pieces.slit;
  const auto [first, second] = fitted(a, b, options.pieces);
  const Polygon both[]{first, second};
  auto united = geometry::unite(both);
  if (!united || united->empty()) return std::nullopt;
  Polygon out = united->front();
  if (united->size() > 1 || !geometry::is_simple(out)) return std::nullopt;
  std::erase_if(out.holes, [slit](const Ring& hole) {
    return std::abs(geometry::signed_area(hole)) < slit * geometry::perimeter(hole);
  });
  out.outer = cleaned(std::move(out.outer), options.pieces);
  for (auto& hole : out.holes) hole = cleaned(std::move(hole), options.pieces);
  if (!geometry::is_simple(out) || touches_itself(out, options.pieces.straight)) return std::nullopt;
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
