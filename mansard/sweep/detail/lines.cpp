// The reference looks for peaks in histograms of angle and offset over the whole slice, and its author calls the
// number of bins the most sensitive knob. Here nothing is binned: each chain of segments is cut into straight pieces
// at the least total cost (squared distance plus a price per piece, found exactly by dynamic programming), then pieces
// on one line are joined over gaps.
#include "mansard/sweep/detail/lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "mansard/geometry/fit.hpp"
#include "mansard/sweep/detail/chains.hpp"
#include "mansard/sweep/detail/line_index.hpp"
#include "mansard/sweep/detail/units.hpp"

namespace mansard::sweep::detail {
namespace {

using geometry::Point2;
using geometry::Segment2;

struct Piece {
  geometry::AxisSums moments;  // relative to the slice's own origin
  Point2 direction, centre;
  double low = 0, high = 0;  // extent along the direction from the centre

  [[nodiscard]] auto length() const -> double { return high - low; }
  [[nodiscard]] auto start() const -> Point2 { return centre + low * direction; }
  [[nodiscard]] auto end() const -> Point2 { return centre + high * direction; }
};

/// Places along a chain where it may be cut, and the moments of all that comes before each.
struct Nodes {
  std::vector<Point2> points;
  std::vector<geometry::AxisSums> before;
};

auto place_nodes(const Chain& chain, Point2 origin, double spacing) -> Nodes {
  double total = 0;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) total += length(chain[i + 1] - chain[i]);
  const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(total / spacing)));
  const double step = total / static_cast<double>(count);

  Nodes nodes;
  nodes.points.reserve(count + 1);
  nodes.before.reserve(count + 1);
  geometry::AxisSums sum;
  double walked = 0;
  nodes.points.push_back(chain.front() - origin);
  nodes.before.push_back(sum);
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    Point2 a = chain[i] - origin;
    const Point2 b = chain[i + 1] - origin;
    double rest = length(b - a);
    while (nodes.points.size() < count && walked + rest >= step * static_cast<double>(nodes.points.size())) {
      const double go = step * static_cast<double>(nodes.points.size()) - walked;
      const Point2 p = rest > 0 ? a + (go / rest) * (b - a) : a;
      sum.add(a, p);
      nodes.points.push_back(p);
      nodes.before.push_back(sum);
      walked += go;
      rest -= go;
      a = p;
    }
    sum.add(a, b);
    walked += rest;
  }
  nodes.points.push_back(chain.back() - origin);
  nodes.before.push_back(sum);
  return nodes;
}

/// The cuts of least total cost. Optimal partitioning with the pruning of Killick, Fearnhead and Eckley (2012): the
/// residual never shrinks as a piece grows, so a start that is beaten once is beaten for good.
auto best_cuts(const Nodes& nodes, double tolerance, double price_of_a_piece) -> std::vector<std::size_t> {
  const std::size_t last = nodes.points.size() - 1;
  const double scale = 1 / (tolerance * tolerance);
  std::vector<double> best(last + 1, 0);
  std::vector<std::size_t> from(last + 1, 0), starts{0};
  std::vector<double> reached;
  for (std::size_t j = 1; j <= last; ++j) {
    reached.clear();
    best[j] = std::numeric_limits<double>::infinity();
    for (const auto i : starts) {
      const double cost = best[i] + scale * (nodes.before[j] - nodes.before[i]).residual();
      reached.push_back(cost);
      if (cost + price_of_a_piece < best[j]) best[j] = cost + price_of_a_piece, from[j] = i;
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < starts.size(); ++k)
      if (reached[k] < best[j]) starts[kept++] = starts[k];
    starts.resize(kept);
    starts.push_back(j);
  }
  std::vector<std::size_t> cuts{last};
  while (cuts.back() != 0) cuts.push_back(from[cuts.back()]);
  std::reverse(cuts.begin(), cuts.end());
  return cuts;
}

/// Fits the line and takes the extent of the points on it.
template <class Points>
void fit(Piece& piece, Point2 heading, const Points& points) {
  piece.centre = piece.moments.centre();
  piece.direction = piece.moments.direction();
  if (dot(piece.direction, heading) < 0) piece.direction = -1.0 * piece.direction;
  piece.low = std::numeric_limits<double>::infinity();
  piece.high = -piece.low;
  for (const Point2 p : points) {
    const double s = dot(p - piece.centre, piece.direction);
    piece.low = std::min(piece.low, s);
    piece.high = std::max(piece.high, s);
  }
}

void add_pieces(const Chain& chain, Point2 origin, double tolerance, const Options& o, std::vector<Piece>& pieces) {
  const auto nodes = place_nodes(chain, origin, o.line_node_spacing);
  const auto cuts = best_cuts(nodes, tolerance, o.line_piece_price);
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    const auto a = cuts[k], b = cuts[k + 1];
    // A cut falls within half a spacing of the corner: the first and last bit may belong around it.
    const auto trim = b - a >= o.line_trim_nodes ? std::size_t{1} : std::size_t{0};
    Piece piece;
    piece.moments = nodes.before[b - trim] - nodes.before[a + trim];
    const double arc = nodes.before[b].weight - nodes.before[a].weight;
    fit(piece, nodes.points[b] - nodes.points[a],
        std::vector<Point2>(nodes.points.begin() + static_cast<std::ptrdiff_t>(a),
                            nodes.points.begin() + static_cast<std::ptrdiff_t>(b) + 1));
    if (piece.length() > 0 && length(nodes.points[b] - nodes.points[a]) >= o.line_straightness * arc)
      pieces.push_back(piece);
  }
}

auto longer(const Piece& a, const Piece& b) -> bool {
  if (in_units(a.length()) != in_units(b.length())) return a.length() > b.length();
  return comes_before({a.start(), a.end()}, {b.start(), b.end()});
}

/// Where a piece must have a part to be joined to that line.
auto reach_of(const Piece& line, double tolerance, const Options& o) -> geometry::Box2 {
  constexpr double rounding = 1e-6;  // m; of products of coordinates within a block, far more than they have
  geometry::Box2 box;
  box.add(line.centre + (line.low - o.line_gap) * line.direction);
  box.add(line.centre + (line.high + o.line_gap) * line.direction);
  return box.grown(tolerance + rounding);
}

/// Grows each piece, longest first, by the pieces that lie on its line no farther than line_gap along it.
auto merge(std::vector<Piece> pieces, double tolerance, const Options& o) -> std::vector<Piece> {
  std::sort(pieces.begin(), pieces.end(), longer);
  std::vector<Segment2> places;
  places.reserve(pieces.size());
  for (const auto& piece : pieces) places.push_back({piece.start(), piece.end()});
  const LineIndex index(places, 8);
  std::vector<char> used(pieces.size(), 0);
  std::vector<Piece> merged;
  for (std::size_t seed = 0; seed < pieces.size(); ++seed) {
    if (used[seed] != 0) continue;
    used[seed] = 1;
    Piece line = pieces[seed];
    std::vector<Point2> ends{line.start(), line.end()};
    const auto joins = [&](std::uint32_t k) {
      const auto& other = pieces[k];
      if (used[k] != 0 || dot(other.direction, line.direction) < o.line_merge_cosine) return false;
      const Point2 a = other.start() - line.centre, b = other.end() - line.centre;
      if (std::abs(cross(line.direction, a)) > tolerance || std::abs(cross(line.direction, b)) > tolerance)
        return false;
      const double s = dot(line.direction, a), t = dot(line.direction, b);
      return std::min(s, t) <= line.high + o.line_gap && std::max(s, t) >= line.low - o.line_gap;
    };
    // All pieces in their order, again and again until none joins. The line changes with every one that does, and with
    // it which others may; those near it are then looked up again, and the round goes on behind the last one.
    for (bool grown = true; grown;) {
      grown = false;
      auto near = index.near(reach_of(line, tolerance, o));
      for (auto at = std::upper_bound(near.begin(), near.end(), seed); at != near.end();) {
        const auto k = *at++;
        if (!joins(k)) continue;
        used[k] = 1;
        grown = true;
        line.moments = line.moments + pieces[k].moments;
        ends.push_back(pieces[k].start());
        ends.push_back(pieces[k].end());
        fit(line, line.direction, ends);
        near = index.near(reach_of(line, tolerance, o));
        at = std::upper_bound(near.begin(), near.end(), k);
      }
    }
    merged.push_back(line);
  }
  return merged;
}

}  // namespace

auto find_lines(const std::vector<Segment2>& segments, const Options& o) -> std::vector<Segment2> {
  std::vector<Segment2> usable;
  usable.reserve(segments.size());
  for (const auto& s : segments)
    if (length(s.end - s.start) < o.line_maximum_segment) usable.push_back(s);
  const auto chains = join(std::move(usable));
  if (chains.empty()) return {};
  const double tolerance = std::max(o.line_distance, 1e-3);
  const Point2 origin = chains.front().front();  // keeps the moments' digits far from the frame's origin

  std::vector<Piece> pieces;
  for (const auto& chain : chains) add_pieces(chain, origin, tolerance, o, pieces);
  std::vector<Piece> lines = merge(std::move(pieces), tolerance, o);
  std::erase_if(lines, [&](const Piece& line) { return line.length() < o.line_minimum_length; });
  std::sort(lines.begin(), lines.end(), longer);

  std::vector<Segment2> result;
  result.reserve(lines.size());
  for (const auto& line : lines) result.push_back({origin + line.start(), origin + line.end()});
  return result;
}

}  // namespace mansard::sweep::detail
