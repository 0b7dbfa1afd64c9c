#include "mansard/extrude/align.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <string>
#include <tuple>

#include "mansard/extrude/detail/corner_edges.hpp"
#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/grid.hpp"
#include "mansard/extrude/detail/lines.hpp"
#include "mansard/extrude/detail/source.hpp"

namespace mansard::extrude {
namespace {

using detail::Direction;
using detail::ExactPoint;
using detail::Footprint;
using detail::Rational;
using geometry::Point2;
using model::Plan;

constexpr std::size_t nobody = static_cast<std::size_t>(-1);

/// A vertical wall of a plan, from corner to corner: the edges of its canonical footprint from one that begins at a
/// corner up to the next; those between begin at joints.
struct Wall {
  std::size_t plan = 0, ring = 0, first = 0, count = 1;
  Point2 from, to;  ///< metres, in the frame of all plans
  double length = 0;
  std::size_t line = nobody;  ///< the wall whose line it takes

  [[nodiscard]] auto along() const -> Point2 { return (1 / length) * (to - from); }
};

auto place(const ExactPoint& p, Point2 origin) -> Point2 { return p.approximate() + origin; }

void add_walls(const Footprint& footprint, std::size_t plan, std::vector<Wall>& walls) {
  for (std::size_t r = 0; r < footprint.rings.size(); ++r) {
    const auto& edges = footprint.rings[r];
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (edges[i].joint) continue;  // no ring begins with one
      Wall wall{plan, r, i, 1, {}, {}, 0, nobody};
      while (i + wall.count < edges.size() && edges[i + wall.count].joint) ++wall.count;
      wall.from = place(footprint.corners[r][i], footprint.origin);
      wall.to = place(footprint.corners[r][(i + wall.count) % edges.size()], footprint.origin);
      wall.length = length(wall.to - wall.from);
      walls.push_back(wall);
    }
  }
}

/// Metres that two walls stand back to back, one on either side of about one line.
auto shared(const Wall& a, const Wall& b, double near) -> double {
  const Point2 along = a.along();
  if (dot(along, b.to - b.from) >= 0) return 0;
  const double start = dot(along, b.to - a.from), end = dot(along, b.from - a.from);
  const double low = std::max(0.0, start), high = std::min(a.length, end);
  if (high <= low) return 0;
  // How far b is from a's line at both ends of what they share.
  const double at_start = cross(along, b.to - a.from), at_end = cross(along, b.from - a.from);
  const auto off = [&](double s) { return at_start + (at_end - at_start) * (s - start) / (end - start); };
  return std::abs(off(low)) <= near && std::abs(off(high)) <= near ? high - low : 0;
}

/// Gives every wall the line of the longest that it is connected with, wall by wall, as long as it lies near that line.
void share_lines(std::vector<Wall>& walls, const std::vector<std::vector<std::size_t>>& neighbours, double near,
                 const Options::Shared& options) {
  std::vector<std::size_t> order(walls.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rank = [&](std::size_t w) {
    const auto& wall = walls[w];
    return std::tuple(-wall.length, wall.from, wall.to, wall.plan, wall.ring, wall.first);
  };
  std::ranges::sort(order, {}, rank);
  std::vector<std::vector<std::size_t>> of_plan(neighbours.size());
  for (const std::size_t w : order) of_plan[walls[w].plan].push_back(w);
  for (const std::size_t leader : order) {
    if (walls[leader].line != nobody) continue;
    walls[leader].line = leader;
    const Wall& line = walls[leader];
    const Point2 along = line.along();
    const auto lies_near = [&](const Wall& wall) {
      const double from = cross(along, wall.from - line.from), to = cross(along, wall.to - line.from);
      return std::abs(from) <= near && std::abs(to) <= near && std::abs(to - from) <= options.max_turn * wall.length;
    };
    std::deque<std::size_t> due{leader};
    for (; !due.empty(); due.pop_front()) {
      const Wall& wall = walls[due.front()];
      for (const std::size_t p : neighbours[wall.plan])
        for (const std::size_t w : of_plan[p])
          if (walls[w].line == nobody && lies_near(walls[w]) &&
              shared(wall, walls[w], near) >=
                  std::min(options.min_overlap, 0.5 * std::min(wall.length, walls[w].length))) {
            walls[w].line = leader;
            due.push_back(w);
          }
    }
  }
}

/// A plan with some of its walls on others' lines.
class Moved {
 public:
  Moved(const Plan& plan, const detail::Source& source, const Footprint& before, const Options& options)
      : plan_(plan), source_(source), options_(options), out_(before), most_(options.tolerance / 2) {}

  /// Puts a wall on the line of another.
  void put(const Wall& wall, const Wall& other, const Footprint& owner) {
    const auto& line = owner.rings[other.ring][other.first];
    Direction d = line.direction;
    // n · x = offset is relative to the owner's origin; here it is relative to this one's, and a whole quantum again.
    const Point2 apart = owner.origin - out_.origin;
    Rational offset =
        line.offset + (Rational(-d.b) * Rational(apart.x) + Rational(d.a) * Rational(apart.y)) / Rational(d.l);
    if (dot(d.approximate(), wall.to - wall.from) < 0) {
      d = d.reversed();
      offset = -offset;
    }
    offset = detail::on_grid(offset.get_d());
    const auto& first = out_.rings[wall.ring][wall.first];
    if (first.direction == d && first.offset == offset) return;
    put_.push_back({wall, first.direction, first.offset});
    set(wall, d, offset);
  }

  /// The canonical plan where nothing was to be changed, or where it cannot be.
  auto plan() -> Plan {
    std::ranges::sort(put_, {}, [](const Put& p) { return -p.wall.length; });
    const auto corners = out_.corners;
    while (!put_.empty()) {
      if (!place_corners(corners)) continue;
      if (!detail::clash_in(out_.corners))
        if (Plan made = as_plan(); stays(made, options_)) return made;
      take_back(std::prev(put_.end()));
    }
    out_.corners = corners;
    return as_plan();
  }

 private:
  struct Put {
    Wall wall;
    Direction direction;  ///< its own
    Rational offset;
  };

  [[nodiscard]] auto as_plan() const -> Plan {
    Plan made = plan_;
    for (std::size_t r = 0; r < out_.rings.size(); ++r) {
      // Rings of the source are those of the plan, in its order.
      const auto& from = r == 0 ? plan_.outer : plan_.holes[r - 1];
      auto& ring = r == 0 ? made.outer : made.holes[r - 1];
      ring = {};
      for (std::size_t i = 0; i < out_.rings[r].size(); ++i) {
        ring.points.push_back(place(out_.corners[r][i], out_.origin));
        const auto edge = out_.rings[r][i].provenance.edge;
        ring.profile_of_edge.push_back(from.profile_of_edge[edge]);
        if (!from.overhang_of_edge.empty()) ring.overhang_of_edge.push_back(from.overhang_of_edge[edge]);
      }
      detail::put_corner_edges(ring, from, out_, r, source_, options_);
    }
    return made;
  }

  /// Whether raise() takes it as it is. Not where a turn has become so shallow that it would be straightened.
  static auto stays(const Plan& made, const Options& options) -> bool {
    constexpr double rounding = 5e-5;  // m; half of the tenth of a millimetre that files keep
    const auto source = detail::prepared(made);
    std::string why;
    const auto footprint = source ? detail::canonical(*source, options, why) : std::nullopt;
    return footprint && footprint->moved < rounding;
  }

  void set(const Wall& wall, const Direction& d, const Rational& offset) {
    for (std::size_t i = wall.first; i < wall.first + wall.count; ++i) {
      out_.rings[wall.ring][i].direction = d;
      out_.rings[wall.ring][i].offset = offset;
    }
  }

  /// The point of an edge's line beside p, an integer number of quanta along it.
  static auto beside(const detail::CanonicalEdge& edge, const ExactPoint& p) -> ExactPoint {
    const auto& [a, b, l] = edge.direction;
    const Rational w = detail::on_grid(Rational((p.x * a + p.y * b) / l).get_d());
    return {(w * a - edge.offset * b) / l, (w * b + edge.offset * a) / l};
  }

  /// False where a wall was taken back, so that the corners have to be placed again.
  auto place_corners(const std::vector<std::vector<ExactPoint>>& before) -> bool {
    for (std::size_t r = 0; r < out_.rings.size(); ++r) {
      auto& edges = out_.rings[r];
      const std::size_t n = edges.size();
      for (std::size_t i = 0; i < n; ++i) {
        auto& edge = edges[i];
        const auto& last = edges[(i + n - 1) % n];
        const bool parallel = cross(last.direction, edge.direction) == 0;
        const bool one_line = last.direction == edge.direction && last.offset == edge.offset;
        if (parallel && !one_line) return take_back(r, i), false;
        // Two walls on one line now: a joint, if their profiles differ.
        out_.corners[r][i] = edge.joint || parallel ? beside(edge, before[r][i]) : detail::corner_of(last, edge);
        if (edge.joint) edge.joint = out_.corners[r][i];
        if (length(place(out_.corners[r][i], {}) - place(before[r][i], {})) > most_) return take_back(r, i), false;
      }
      for (std::size_t i = 0; i < n; ++i) {
        const Point2 edge = place(out_.corners[r][(i + 1) % n], {}) - place(out_.corners[r][i], {});
        if (dot(edge, edges[i].direction.approximate()) < detail::shortest) return take_back(r, i), false;
      }
    }
    return true;
  }

  /// The shortest wall at a corner that was put on another's line goes back to its own; if there is none, all do.
  void take_back(std::size_t ring, std::size_t corner) {
    const std::size_t n = out_.rings[ring].size();
    const auto is_at = [&](const Put& put) {
      if (put.wall.ring != ring) return false;
      for (std::size_t i = 0; i < put.wall.count; ++i)
        for (const std::size_t edge : {corner, (corner + 1) % n, (corner + n - 1) % n})
          if (put.wall.first + i == edge) return true;
      return false;
    };
    const auto shortest = std::find_if(put_.rbegin(), put_.rend(), is_at);
    if (shortest == put_.rend()) put_.clear();
    else take_back(std::next(shortest).base());
  }
  void take_back(std::vector<Put>::iterator put) {
    set(put->wall, put->direction, put->offset);
    put_.erase(put);
  }

  const Plan& plan_;
  const detail::Source& source_;
  const Options& options_;
  Footprint out_;
  std::vector<Put> put_;  ///< the longest first
  double most_;           ///< m; no corner moves farther
};

}  // namespace

auto align(std::span<const Plan> plans, const Options& options) -> std::vector<std::optional<Plan>> {
  const double near = options.tolerance / 2;
  std::vector<std::optional<detail::Source>> sources(plans.size());
  std::vector<std::optional<Footprint>> footprints(plans.size());
  std::vector<geometry::Box2> boxes(plans.size());
  base::parallel_for(plans.size(), [&](std::size_t p) {
    auto source = detail::prepared(plans[p]);
    if (!source) return;
    sources[p] = std::move(*source);
    std::string why;
    footprints[p] = detail::canonical(*sources[p], options, why);
    if (footprints[p]) boxes[p] = geometry::bounds(plans[p].outer.points).grown(2 * options.tolerance);
  });
  std::vector<std::vector<std::size_t>> neighbours(plans.size());
  detail::for_each_overlap(boxes, [&](std::size_t p, std::size_t q) {
    neighbours[p].push_back(q);
    neighbours[q].push_back(p);
    return true;
  });
  std::vector<Wall> walls;
  for (std::size_t p = 0; p < plans.size(); ++p)
    if (const auto& footprint = footprints[p]) add_walls(*footprint, p, walls);
  share_lines(walls, neighbours, near, options.shared);

  // What stands on one line with a neighbour is canonical from now on, whoever gave the line.
  std::vector<bool> meets(plans.size(), false);
  for (const Wall& wall : walls)
    if (walls[wall.line].plan != wall.plan) meets[wall.plan] = meets[walls[wall.line].plan] = true;
  std::vector<std::vector<const Wall*>> of_plan(plans.size());
  for (const Wall& wall : walls) of_plan[wall.plan].push_back(&wall);
  std::vector<std::optional<Plan>> out(plans.size());
  base::parallel_for(plans.size(), [&](std::size_t p) {
    if (!meets[p]) return;
    Moved moved(plans[p], *sources[p], *footprints[p], options);
    for (const Wall* wall : of_plan[p])
      if (const Wall& line = walls[wall->line]; line.plan != p) moved.put(*wall, line, *footprints[line.plan]);
    if (auto plan = moved.plan(); !(plan == plans[p])) out[p] = std::move(plan);
  });
  return out;
}

}  // namespace mansard::extrude
