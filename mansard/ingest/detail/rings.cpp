#include "mansard/ingest/detail/rings.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/base/text.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/predicates.hpp"

namespace mansard::ingest::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;
using geometry::Segment2;

constexpr double same_point = 1e-3;   // m
constexpr double least_area = 0.01;   // m²: smaller than a hand is no building
constexpr double area_change = 0.01;  // of the area, by a repair
constexpr double bridge = 0.05;       // m: half the diagonal of the square put where rings touch

auto finite(const std::vector<formats::RawPolygon>& parts) -> bool {
  // Farther than twice round the earth is no place either.
  for (const auto& part : parts)
    for (const auto& ring : part)
      for (const Point2 p : ring)
        if (!(std::abs(p.x) < 1e8 && std::abs(p.y) < 1e8)) return false;
  return true;
}

void drop_repeated(Ring& ring) {
  Ring kept;
  for (const Point2 p : ring)
    if (kept.empty() || length(p - kept.back()) >= same_point) kept.push_back(p);
  while (kept.size() > 1 && length(kept.front() - kept.back()) < same_point) kept.pop_back();
  ring = std::move(kept);
}

/// Whether the ring goes out to b and back the same way.
auto is_spike(Point2 a, Point2 b, Point2 c) -> bool {
  const Point2 out = b - a, back = c - b;
  if (dot(out, back) >= 0) return false;
  return std::abs(cross(out, back)) < same_point * std::max(length(out), length(back));
}

/// Takes spikes out, a spike on a spike too; returns how many. Points are linked, and only those beside one that was
/// taken out are looked at again, so that a ring of 100,000 spikes takes as long as it is.
auto drop_spikes(Ring& ring) -> std::size_t {
  const std::size_t all = ring.size();
  std::vector<std::size_t> before(all), after(all), open(all);  // the last of `open` is next
  for (std::size_t i = 0; i < all; ++i) {
    before[i] = (i + all - 1) % all;
    after[i] = (i + 1) % all;
    open[i] = all - 1 - i;
  }
  std::vector<bool> gone(all, false);
  std::size_t left = all, count = 0;
  const auto take_out = [&](std::size_t i) {
    gone[i] = true;
    --left;
    after[before[i]] = after[i];
    before[after[i]] = before[i];
  };
  while (!open.empty() && left >= 3) {
    const std::size_t i = open.back();
    open.pop_back();
    if (gone[i] || !is_spike(ring[before[i]], ring[i], ring[after[i]])) continue;
    std::size_t a = before[i], b = after[i];
    take_out(i);
    ++count;
    while (left > 1 && length(ring[b] - ring[a]) < same_point) {  // of two points in one place the first stays
      const std::size_t second = std::max(a, b);
      take_out(second);
      if (second == b) b = after[second];
      else a = before[second];
    }
    open.push_back(b);
    open.push_back(a);
  }
  Ring kept;
  for (std::size_t i = 0; i < all; ++i)
    if (!gone[i]) kept.push_back(ring[i]);
  ring = std::move(kept);
  return count;
}

auto place(Point2 p, const std::array<double, 2>& origin) -> std::string {
  return "(" + base::to_text(p.x + origin[0], 2) + ", " + base::to_text(p.y + origin[1], 2) + ")";
}

/// Where two edges of the ring meet that should not.
auto crossing_of(const Ring& ring) -> std::optional<Point2> {
  const std::size_t n = ring.size();
  const auto edge = [&](std::size_t i) { return Segment2{ring[i], ring[(i + 1) % n]}; };
  std::vector<geometry::Box2> boxes;
  for (std::size_t i = 0; i < n; ++i) boxes.push_back(geometry::Box2::of(edge(i)));
  const geometry::BoxIndex index(boxes);
  for (std::size_t i = 0; i < n; ++i) {
    const Segment2 a = edge(i);
    const auto met = index.first_overlapping(boxes[i], 1, [&](std::uint32_t j) {
      return j >= i + 2 && !(i == 0 && j == n - 1) && geometry::meet(a, edge(j));
    });
    if (met.empty()) continue;
    const Segment2 b = edge(met.front());
    const Point2 u = a.end - a.start, v = b.end - b.start;
    const double turn = cross(u, v);
    const double t = turn != 0 ? std::clamp(cross(b.start - a.start, v) / turn, 0.0, 1.0) : 0;
    return a.start + t * u;
  }
  return std::nullopt;
}

/// Whether the holes lie within the shell and not within each other, given that no rings meet.
auto nested(const Polygon& polygon) -> bool {
  for (std::size_t i = 0; i < polygon.holes.size(); ++i) {
    const Point2 p = polygon.holes[i].front();
    if (!geometry::contains(polygon.outer, p)) return false;
    for (std::size_t j = 0; j < polygon.holes.size(); ++j)
      if (i != j && geometry::contains(polygon.holes[j], p)) return false;
  }
  return true;
}

/// Places of an outline that are nearer to each other than repeated points are one place, as they are in files: such
/// corners become one, and an edge that a corner is as near to gets that corner. What comes of that touches itself.
class Closing {
 public:
  explicit Closing(const Polygon& polygon) {
    rings_.push_back(&polygon.outer);
    for (const auto& hole : polygon.holes) rings_.push_back(&hole);
    for (std::uint32_t r = 0; r < rings_.size(); ++r)
      for (std::uint32_t i = 0; i < rings_[r]->size(); ++i) {
        edges_.push_back({r, i, {(*rings_[r])[i], (*rings_[r])[(i + 1) % rings_[r]->size()]}});
        first_.resize(r + 1, static_cast<std::uint32_t>(edges_.size() - 1));
      }
  }

  /// None where no places are as near as that.
  auto closed() -> std::optional<Polygon> {
    std::vector<geometry::Box2> boxes;
    for (const Edge& edge : edges_) boxes.push_back(geometry::Box2::of(edge.line));
    const geometry::BoxIndex index(boxes);
    base::DisjointSets same(edges_.size());
    std::vector<std::vector<std::uint32_t>> corners(edges_.size());  // of each edge, those that it gets
    bool any = false;
    for (std::uint32_t v = 0; v < edges_.size(); ++v) {
      const Point2 p = edges_[v].line.start;
      for (const auto e : index.overlapping(geometry::Box2::of(geometry::Segment2{p, p}).grown(same_point))) {
        const std::uint32_t end = after(e);
        if (e == v || end == v || geometry::distance(edges_[e].line, p) >= same_point) continue;
        any = true;
        if (length(p - edges_[e].line.start) < same_point) same.join(v, e);
        else if (length(p - edges_[e].line.end) < same_point) same.join(v, end);
        else corners[e].push_back(v);
      }
    }
    if (!any) return std::nullopt;
    std::vector<Ring> rings(rings_.size());
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      const auto& [ring, corner, line] = edges_[e];
      rings[ring].push_back(edges_[same.of(e)].line.start);
      std::ranges::sort(corners[e], {}, [&](auto v) { return length(edges_[v].line.start - line.start); });
      for (const auto v : corners[e]) rings[ring].push_back(edges_[same.of(v)].line.start);
    }
    for (auto& ring : rings) {
      drop_repeated(ring);
      drop_spikes(ring);
    }
    Polygon out{std::move(rings.front()), {}};
    for (std::size_t r = 1; r < rings.size(); ++r)
      if (rings[r].size() >= 3) out.holes.push_back(std::move(rings[r]));
    return out;
  }

 private:
  struct Edge {
    std::uint32_t ring = 0, corner = 0;
    Segment2 line;
  };
  [[nodiscard]] auto after(std::uint32_t e) const -> std::uint32_t {
    const auto& [ring, corner, line] = edges_[e];
    return corner + 1 < rings_[ring]->size() ? e + 1 : first_[ring];
  }

  std::vector<const Ring*> rings_;
  std::vector<Edge> edges_;           ///< of all rings; each starts in the corner of its number
  std::vector<std::uint32_t> first_;  ///< edge of each ring
};

auto is_good(const Polygon& polygon) -> bool { return geometry::is_simple(polygon) && nested(polygon); }

auto total(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

/// Puts a small square over every point where two rings of a polygon touch (which OGC allows, but a wall of no
/// thickness is not to be built).
auto bridged(const Polygon& polygon) -> std::optional<std::vector<Polygon>> {
  std::vector<const Ring*> rings{&polygon.outer};
  for (const auto& hole : polygon.holes) rings.push_back(&hole);
  std::vector<Polygon> pieces{polygon};
  const Polygon shell{polygon.outer, {}};
  for (const Ring* ring : rings)
    for (const Point2 p : *ring)
      for (const Ring* other : rings) {
        if (other == ring) continue;
        const bool touches = std::ranges::any_of(*other, [&, i = std::size_t{0}](Point2) mutable {
          const Segment2 edge{(*other)[i], (*other)[(i + 1) % other->size()]};
          ++i;
          return geometry::distance(edge, p) < 1e-6;
        });
        if (!touches) continue;
        const Polygon square{{{p.x + bridge, p.y}, {p.x, p.y + bridge}, {p.x - bridge, p.y}, {p.x, p.y - bridge}}, {}};
        const auto within = geometry::intersect(square, shell);
        if (!within) return std::nullopt;
        pieces.insert(pieces.end(), within->begin(), within->end());
      }
  auto united = geometry::unite(pieces);
  if (!united || !std::ranges::all_of(*united, is_good)) return std::nullopt;
  return *std::move(united);
}

/// Shell without holes, each read by the even-odd rule first.
auto rebuilt(const Polygon& polygon) -> base::Result<std::vector<Polygon>> {
  auto shells = geometry::make_valid({polygon.outer, {}});
  if (!shells) return shells;
  std::vector<Polygon> holes;
  for (const auto& hole : polygon.holes) {
    auto valid = geometry::make_valid({hole, {}});
    if (!valid) return valid;
    holes.insert(holes.end(), valid->begin(), valid->end());
  }
  auto united = geometry::unite(holes);
  if (!united) return united;
  for (const auto& hole : *united) {
    std::vector<Polygon> left;
    for (const auto& shell : *shells) {
      auto rest = geometry::subtract(shell, hole);
      if (!rest) return rest;
      left.insert(left.end(), rest->begin(), rest->end());
    }
    *shells = std::move(left);
  }
  std::erase_if(*shells, [](const Polygon& p) { return geometry::area(p) < least_area; });
  return shells;
}

/// Good polygons for one that is not, or the reason why there are none.
auto mended(const Polygon& polygon, const std::array<double, 2>& origin) -> base::Result<std::vector<Polygon>> {
  const bool shell_crosses = !geometry::is_simple({polygon.outer, {}});
  const auto give_up = [&]() -> base::Diagnostic {
    if (!shell_crosses)
      return base::error("ingest-footprint-holes",
                         "its holes cross, overlap or lie outside it; correct them in the source");
    const auto at = crossing_of(polygon.outer);
    return base::error("ingest-footprint-crossing", "its outline crosses itself" +
                                                        (at ? " near " + place(*at, origin) : std::string()) +
                                                        "; correct it in the source");
  };
  const double expected = std::abs(geometry::area(polygon));
  const auto candidates = rebuilt(polygon);
  if (!candidates || std::abs(total(*candidates) - expected) > area_change * expected) return give_up();
  std::vector<Polygon> out;
  for (const auto& candidate : *candidates) {
    if (is_good(candidate)) {
      out.push_back(candidate);
      continue;
    }
    const auto pieces = bridged(candidate);
    if (!pieces) return give_up();
    out.insert(out.end(), pieces->begin(), pieces->end());
  }
  if (out.empty()) return give_up();
  return out;
}

/// Good polygons for one whose rings come nearer to each other than repeated points; none where they do not, or where
/// that leaves too little of it.
auto where_it_nearly_touches(const Polygon& polygon, const std::array<double, 2>& origin)
    -> std::optional<std::vector<Polygon>> {
  if (polygon.outer.size() < 3) return std::nullopt;
  auto closed = Closing(polygon).closed();
  if (!closed || closed->outer.size() < 3) return std::nullopt;
  *closed = geometry::oriented(std::move(*closed));
  auto good = is_good(*closed) ? base::Result<std::vector<Polygon>>(std::vector{*closed}) : mended(*closed, origin);
  const double area = std::abs(geometry::area(polygon));
  if (!good || good->empty() || std::abs(total(*good) - area) > area_change * area) return std::nullopt;
  return std::move(*good);
}

void note(Repaired& out, const std::string& words) {
  if (std::ranges::find(out.repairs, words) == out.repairs.end()) out.repairs.push_back(words);
}

/// Parts of one feature that overlap are made one; they may touch.
void unite_overlapping(Repaired& out) {
  if (out.polygons.size() < 2) return;
  auto united = geometry::unite(out.polygons);
  if (!united) return note(out, "whether its parts overlap could not be computed");
  if (total(out.polygons) - total(*united) <= 1e-6 * total(out.polygons)) return;
  std::erase_if(*united, [](const Polygon& p) { return geometry::area(p) < least_area; });
  std::vector<Polygon> good;
  for (const auto& polygon : *united) {
    if (is_good(polygon)) {
      good.push_back(polygon);
    } else if (auto pieces = bridged(polygon)) {
      good.insert(good.end(), pieces->begin(), pieces->end());
    } else {
      return note(out, "its parts overlap and could not be united");
    }
  }
  if (good.empty()) return note(out, "its parts overlap and could not be united");
  out.polygons = std::move(good);
  note(out, "parts that overlap were united");
}

}  // namespace

auto repair(const std::vector<formats::RawPolygon>& parts, const std::array<double, 2>& origin) -> Repaired {
  Repaired out;
  if (!finite(parts)) {
    out.defect =
        base::error("ingest-footprint-coordinates",
                    "it has a coordinate that is not a number, or far off the earth; correct it in the source");
    return out;
  }
  for (const auto& part : parts) {
    Polygon polygon;
    for (std::size_t r = 0; r < part.size(); ++r) {
      Ring ring = part[r];
      drop_repeated(ring);
      if (drop_spikes(ring) > 0) note(out, "spikes were taken out");
      if (r == 0) polygon.outer = std::move(ring);
      else if (ring.size() >= 3) polygon.holes.push_back(std::move(ring));
      else note(out, "a hole without area was left out");
    }
    polygon = geometry::oriented(std::move(polygon));
    if (auto separated = where_it_nearly_touches(polygon, origin)) {
      note(out, "rings that cross, touch or come within 1 mm of each other were separated");
      out.polygons.insert(out.polygons.end(), separated->begin(), separated->end());
      continue;
    }
    if (polygon.outer.size() >= 3 && is_good(polygon)) {
      if (geometry::area(polygon) >= least_area) out.polygons.push_back(std::move(polygon));
      else note(out, "a part without area was left out");
      continue;
    }
    // A figure of eight may add up to nothing and still be no mere line.
    const auto repaired =
        polygon.outer.size() < 3 ? base::Result<std::vector<Polygon>>(std::vector<Polygon>{}) : mended(polygon, origin);
    if (!repaired) {
      out.defect = repaired.error();
      out.polygons.clear();
      return out;
    }
    if (repaired->empty()) note(out, "a part without area was left out");
    else note(out, "rings that cross, touch or come within 1 mm of each other were separated");
    out.polygons.insert(out.polygons.end(), repaired->begin(), repaired->end());
  }
  unite_overlapping(out);
  if (out.polygons.empty())
    out.defect = base::error("ingest-footprint-area", "it has no area; remove it, or draw it in the source");
  return out;
}

}  // namespace mansard::ingest::detail
