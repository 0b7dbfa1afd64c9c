// The oracle's wavefront: closed loops of moving lines.
#pragma once

#include <cstdint>
#include <map>

#include "oracle.hpp"

namespace oracle {

using mansard::extrude::detail::CanonicalEdge;
using mansard::extrude::detail::Direction;

/// A moving line a y − b x = offset + speed t, (a, b) whole multiples of its direction. t is the height, or the share
/// of their run while terraces run.
struct Line {
  Direction direction;
  Rational offset, speed;
  const CanonicalEdge* edge = nullptr;  ///< none for a connector
  std::size_t part = 0;                 ///< of the edge's track

  [[nodiscard]] auto across(const Point& p) const -> Rational { return direction.a * p.y - direction.b * p.x; }
  [[nodiscard]] auto along(const Point& p) const -> Rational { return direction.a * p.x + direction.b * p.y; }
};

struct WaveEdge {
  std::size_t line = 0;
  Point start;        ///< at the present moment
  Point from, speed;  ///< the start vertex is from + speed t
  [[nodiscard]] auto at(const Rational& t) const -> Point { return {from.x + speed.x * t, from.y + speed.y * t}; }
};
using Loop = std::vector<WaveEdge>;

class Wave {
 public:
  std::vector<Line> lines;
  std::vector<Loop> loops;  ///< edge i of a loop ends where i + 1 starts

  /// Merges neighbours in one plane, puts an upright connector between others on one line, and gives every vertex its
  /// motion from the moment t on.
  void connect(const Rational& t);

  /// The first moment after `now`, and not after `limit`, when an edge has no length or a vertex lies on another edge
  /// that it ran towards.
  [[nodiscard]] auto next_event(const Rational& now, const Rational& limit) const -> std::optional<Rational>;

  /// Moves every vertex to its place at t.
  void move(const Rational& t);

  /// Resolves what touches at the present moment: cuts edges at every vertex on them, cancels what lies on each other
  /// in opposite directions, and joins what is left so that each incoming edge goes on with the next outgoing one
  /// clockwise.
  void relink();

  [[nodiscard]] auto twice_area() const -> Rational;

 private:
  [[nodiscard]] auto one_wall(std::size_t p, std::size_t q) const -> bool;
  [[nodiscard]] auto connector(const Line& before, const Line& after, const Point& at) -> std::size_t;
};

/// Calls with every edge of the loops and the one after it.
template <class Call>
void for_each_edge(const std::vector<Loop>& loops, Call call) {
  for (const Loop& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) call(loop[i], loop[(i + 1) % loop.size()]);
}

}  // namespace oracle
