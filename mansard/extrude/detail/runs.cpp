#include "mansard/extrude/detail/runs.hpp"
#include "mansard/geometry/angles.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

auto magnitude(Int128 value) -> Int128 { return value < 0 ? -value : value; }

/// Times the chord's length; whole, so that mirrored rings tie where the ring does.
auto scaled_deviation(GridPoint from, GridPoint to, GridPoint p) -> Int128 {
  const GridPoint chord = to - from;
  const Int128 along = dot(chord, p - from);
  return std::max({magnitude(cross(chord, p - from)), -along, along - dot(chord, chord)});
}

auto length_of(GridPoint chord) -> double {
  return length(Point2{static_cast<double>(chord.x), static_cast<double>(chord.y)});
}

/// Douglas and Peucker's rule, but all corners that are farthest away alike become ends.
void split(const GridRing& ring, std::size_t first, std::size_t last, double allowed, std::vector<Run>& runs) {
  const GridPoint from = at(ring, first), to = at(ring, last);
  Int128 most = 0;
  for (std::size_t i = first + 1; i < last; ++i) most = std::max(most, scaled_deviation(from, to, at(ring, i)));
  if (static_cast<double>(most) * grid_step <= allowed * length_of(to - from)) {
    runs.push_back({first, last, false, {}, 0});
    return;
  }
  std::size_t begin = first;
  for (std::size_t i = first + 1; i <= last; ++i)
    if (i == last || scaled_deviation(from, to, at(ring, i)) == most) {
      split(ring, begin, i, allowed, runs);
      begin = i;
    }
}

/// All corners that are farthest from a point.
auto farthest_from(const GridRing& ring, GridPoint p) -> std::vector<std::size_t> {
  std::vector<std::size_t> out;
  Int128 most = -1;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Int128 d = dot(ring[i] - p, ring[i] - p);
    if (d > most) out.clear();
    if (d >= most) out.push_back(i);
    most = std::max(most, d);
  }
  return out;
}

}  // namespace

auto deviation(const GridRing& ring, std::size_t first, std::size_t last) -> double {
  const GridPoint from = at(ring, first), to = at(ring, last);
  Int128 most = 0;
  for (std::size_t i = first + 1; i < last; ++i) most = std::max(most, scaled_deviation(from, to, at(ring, i)));
  return from == to ? HUGE_VAL : static_cast<double>(most) * grid_step / length_of(to - from);
}

auto straightened(const GridRing& ring, double merge_angle, double allowed) -> std::vector<Run> {
  const std::size_t n = ring.size();
  const double tangent = geometry::tangent(merge_angle);
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n; ++i) {
    const GridPoint before = ring[i] - ring[i > 0 ? i - 1 : n - 1], after = ring[i + 1 < n ? i + 1 : 0] - ring[i];
    const double ahead = static_cast<double>(dot(before, after));
    if (ahead <= 0 || std::abs(static_cast<double>(cross(before, after))) > tangent * ahead) corners.push_back(i);
  }
  if (corners.empty()) {  // round: from what is farthest from the middle
    geometry::Box2 box;
    for (const GridPoint p : ring) box.add(metres(p));
    const Point2 middle = (0.5 / grid_step) * (box.least + box.most);
    corners = farthest_from(ring, {std::llrint(middle.x), std::llrint(middle.y)});
  }
  if (corners.size() == 1) {
    for (const std::size_t far : farthest_from(ring, ring[corners[0]])) corners.push_back(far);
    std::ranges::sort(corners);
  }
  std::vector<Run> runs;
  runs.reserve(corners.size());
  for (std::size_t c = 0; c < corners.size(); ++c)
    split(ring, corners[c], c + 1 < corners.size() ? corners[c + 1] : corners[0] + n, allowed, runs);
  return runs;
}

namespace {

/// The directions handed out so far, by k; `rank` says how early.
class Table {
 public:
  struct Entry {
    Direction direction;
    Point2 unit;
    std::size_t rank = 0;
  };
  void add(std::int64_t k, std::size_t rank) {
    const Direction d = direction_of({k, 0});
    entries_.try_emplace(k, Entry{d, d.approximate(), rank});
  }
  /// The nearest to a vector of bearing k (turned to within 45° of the x axis), if its end need not move by more than
  /// `off` for it; between two that are alike the earlier.
  [[nodiscard]] auto nearest(std::int64_t k, Point2 vector, double off) const -> std::optional<Direction> {
    std::optional<Direction> best;
    std::size_t rank = 0;
    bool tie = false;
    const auto consider = [&](const Entry& entry, int quarters) {
      Direction d = entry.direction;
      for (int q = 0; q < quarters; ++q) d = d.left();
      const Point2 unit = quarters == 0 ? entry.unit : d.approximate();
      const double here = std::abs(cross(unit, vector));
      if (here > off || dot(unit, vector) <= 0) return;
      if (best && here == off && rank <= entry.rank) {
        tie = tie || rank == entry.rank;
        return;
      }
      tie = false;
      best = d;
      off = here;
      rank = entry.rank;
    };
    if (entries_.empty()) return best;
    const auto above = entries_.lower_bound(k);
    if (above != entries_.end()) consider(above->second, 0);
    if (above != entries_.begin()) consider(std::prev(above)->second, 0);
    // Beyond 45° the table begins again.
    if (above == entries_.end() || std::next(above) == entries_.end()) consider(entries_.begin()->second, 1);
    if (above == entries_.begin() || std::prev(above) == entries_.begin())
      consider(std::prev(entries_.end())->second, 3);
    return tie ? std::nullopt : best;
  }

 private:
  std::map<std::int64_t, Entry> entries_;
};

auto turned(Direction d, int quarters) -> Direction {
  for (int q = 0; q < quarters; ++q) d = d.left();
  return d;
}

}  // namespace

void share_directions(const std::vector<GridRing>& rings, std::vector<std::vector<Run>>& runs, double end_may_move,
                      double may_turn) {
  struct Entry {
    Int128 squared;
    Bearing bearing;
    Point2 vector;  ///< metres, turned to within 45° of the x axis
    Run* run;
  };
  std::vector<Entry> order;
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (Run& run : runs[r]) {
      const GridPoint chord = chord_of(rings[r], run);
      const Bearing bearing = bearing_of(metres(chord));
      Point2 v = metres(chord);
      for (int q = 0; q < bearing.quarters; ++q) v = {v.y, -v.x};
      order.push_back({dot(chord, chord), bearing, v, &run});
    }
  std::sort(order.begin(), order.end(), [](const Entry& p, const Entry& q) {
    return p.squared != q.squared ? p.squared > q.squared : std::abs(p.bearing.k) < std::abs(q.bearing.k);
  });
  // Runs of one length and one |k| go together, none before the other: a mirrored ring has the same.
  Table table;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    const std::int64_t k = std::abs(order[begin].bearing.k);
    bool left = false, right = false;
    for (end = begin;
         end < order.size() && order[end].squared == order[begin].squared && std::abs(order[end].bearing.k) == k;
         ++end) {
      left = left || order[end].bearing.k > 0;
      right = right || order[end].bearing.k < 0;
    }
    std::vector<std::int64_t> fresh;
    for (std::size_t i = begin; i < end; ++i) {
      const Entry& entry = order[i];
      const double off = std::min(2 * end_may_move, may_turn * length(entry.vector));
      std::optional<Direction> shared;
      if (!entry.run->own_direction) {
        shared = table.nearest(entry.bearing.k, entry.vector, off);
        // To either side of an axis alike: the axis.
        if (!shared && left && right && std::abs(entry.vector.y) <= off) {
          shared = Direction{};
          fresh.push_back(0);
        }
      }
      if (!shared) {
        shared = direction_of({entry.bearing.k, 0});
        fresh.push_back(entry.bearing.k);
      }
      entry.run->direction = turned(*shared, entry.bearing.quarters);
    }
    for (const std::int64_t mine : fresh) table.add(mine, begin);
  }
}

}  // namespace mansard::extrude::detail
