// Outlines on a fixed grid of 2^-36 m, on which cross products are exact; and whether they are simple.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "mansard/extrude/detail/numbers.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::extrude::detail {

/// Multiples of 2^-36 m (15 pm) from an origin. Outlines are at most 2^22 m wide (`widest`), so that coordinates are
/// below 2^58 and differences below 2^59: cross products are below 2 · 2^118 and fit 128 bits, as do sums of 2^8 of
/// them.
struct GridPoint {
  std::int64_t x = 0, y = 0;
  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
  friend auto operator-(GridPoint a, GridPoint b) -> GridPoint { return {a.x - b.x, a.y - b.y}; }
};
using GridRing = std::vector<GridPoint>;

[[nodiscard]] inline auto cross(GridPoint a, GridPoint b) -> Int128 {
  return static_cast<Int128>(a.x) * b.y - static_cast<Int128>(a.y) * b.x;
}
[[nodiscard]] inline auto dot(GridPoint a, GridPoint b) -> Int128 {
  return static_cast<Int128>(a.x) * b.x + static_cast<Int128>(a.y) * b.y;
}
[[nodiscard]] inline auto turn(GridPoint a, GridPoint b, GridPoint c) -> int { return sign(cross(b - a, c - a)); }

inline constexpr double grid_step = 0x1.0p-36;
/// Outlines wider than this are no buildings in metres, m.
inline constexpr double widest = 0x1.0p22;

[[nodiscard]] inline auto metres(GridPoint p) -> geometry::Point2 {
  return {static_cast<double>(p.x) * grid_step, static_cast<double>(p.y) * grid_step};
}

/// The origin of a box: the half metres next to its centre, so that it goes with the box when that is mirrored, turned
/// by a quarter or shifted by whole metres.
[[nodiscard]] auto origin_of(const geometry::Box2& box) -> geometry::Point2;
/// Odd in both coordinates and even under shifts by whole metres, as round-half-even is.
[[nodiscard]] auto on_fine_grid(std::span<const geometry::Point2> ring, geometry::Point2 origin) -> GridRing;

/// Where two edges of an outline have more in common than the corner of neighbours.
struct Meeting {
  struct Edge {
    std::size_t ring = 0, index = 0;
    friend auto operator<=>(const Edge&, const Edge&) = default;
  };
  enum class Kind { spike, overlap, crossing, touch } kind = Kind::crossing;  ///< worst first
  Edge a, b;                                                                  ///< a < b
  geometry::Point2 at;                                                        ///< metres from the origin
  friend auto operator<=>(const Meeting& p, const Meeting& q) {
    return std::tie(p.kind, p.a, p.b) <=> std::tie(q.kind, q.a, q.b);
  }
  friend auto operator==(const Meeting& p, const Meeting& q) -> bool { return (p <=> q) == 0; }
};

/// The worst meeting, and how many there are up to `most`. Exact. O(n log n) but for edges that share a strip of the
/// axis the outline is longer in.
struct Meetings {
  std::optional<Meeting> first;
  std::size_t count = 0;
};
[[nodiscard]] auto meetings_of(std::span<const GridRing> rings, std::size_t most = 1) -> Meetings;

[[nodiscard]] auto contains(const GridRing& ring, GridPoint p) -> bool;
/// Twice the area in grid units, as a double; its sign is right unless the ring is a sliver of picometres.
[[nodiscard]] auto twice_area(const GridRing& ring) -> double;

/// Calls `look(i, j)` for pairs of boxes that overlap until it returns false; i, j are places in `boxes`.
template <class Look>
void for_each_overlap(std::span<const geometry::Box2> boxes, Look look) {
  // Along the axis on which the boxes are shorter all together, few are open at once.
  double wide = 0, high = 0;
  for (const auto& box : boxes) {
    wide += box.most.x - box.least.x;
    high += box.most.y - box.least.y;
  }
  const bool upright = high < wide;
  struct Span {
    double from, to, low, top;
    std::uint32_t box;
  };
  std::vector<Span> spans;
  spans.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const auto& b = boxes[i];
    if (upright) spans.push_back({b.least.y, b.most.y, b.least.x, b.most.x, i});
    else spans.push_back({b.least.x, b.most.x, b.least.y, b.most.y, i});
  }
  std::sort(spans.begin(), spans.end(),
            [](const Span& p, const Span& q) { return p.from < q.from || (p.from == q.from && p.box < q.box); });
  std::vector<Span> open;
  for (const Span& span : spans) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (open[k].to < span.from) continue;
      if (kept != k) open[kept] = open[k];
      const Span& other = open[kept++];
      if (other.low <= span.top && span.low <= other.top && !look(other.box, span.box)) return;
    }
    open.resize(kept);
    open.push_back(span);
  }
}

}  // namespace mansard::extrude::detail
