#include "mansard/geometry/arcs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace mansard::geometry {
namespace {

constexpr double degrees = std::numbers::pi / 180;
constexpr double most_turn = 50 * degrees, least_turn = 0.2 * degrees, least_bend = 30 * degrees;
constexpr double most_ratio = 3;       // of the lengths of neighbouring chords: a chamfered square is no circle
constexpr std::size_t fewest = 4;      // chords
constexpr double exactness = 0.02;     // m
constexpr double share_of_height = 1;  // of the curve's height over its chords

/// The maximum distance of points from the circle that suits them best (I. Kåsa, A circle fitting procedure and its
/// error analysis, 1976); infinite where none does.
auto off_circle(std::span<const Point2> points) -> double {
  const auto n = static_cast<double>(points.size());
  Point2 middle{0, 0};
  for (const Point2 p : points) middle = middle + (1 / n) * p;
  double xx = 0, xy = 0, yy = 0, xr = 0, yr = 0, rr = 0;
  for (const Point2 p : points) {
    const Point2 q = p - middle;
    const double r = dot(q, q);
    xx += q.x * q.x, xy += q.x * q.y, yy += q.y * q.y, xr += q.x * r, yr += q.y * r, rr += r;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 0)) return std::numeric_limits<double>::infinity();
  const Point2 centre{(xr * yy - yr * xy) / (2 * determinant), (yr * xx - xr * xy) / (2 * determinant)};
  const double radius = std::sqrt(dot(centre, centre) + rr / n);
  double most = 0;
  for (const Point2 p : points) most = std::max(most, std::abs(length(p - middle - centre) - radius));
  return most;
}

/// A ring without the corners at which nothing turns: where its chords begin.
struct Chords {
  std::vector<std::size_t> corners;  ///< of the ring
  std::vector<Point2> points;
  std::vector<double> lengths;  ///< of the chord from each
  std::vector<double> turns;    ///< at each, to the left

  explicit Chords(const Ring& ring) {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Point2 in = ring[i] - ring[(i + n - 1) % n], out = ring[(i + 1) % n] - ring[i];
      if (std::abs(std::atan2(cross(in, out), dot(in, out))) < least_turn) continue;
      corners.push_back(i);
      points.push_back(ring[i]);
    }
    const std::size_t m = points.size();
    for (std::size_t i = 0; i < m; ++i) lengths.push_back(length(points[(i + 1) % m] - points[i]));
    for (std::size_t i = 0; i < m; ++i) {
      const Point2 in = points[i] - points[(i + m - 1) % m], out = points[(i + 1) % m] - points[i];
      turns.push_back(std::atan2(cross(in, out), dot(in, out)));
    }
  }
  [[nodiscard]] auto size() const -> std::size_t { return points.size(); }
  /// Whether the chords on both sides of a corner may be of one curve.
  [[nodiscard]] auto bends(std::size_t i) const -> bool {
    const double before = lengths[(i + size() - 1) % size()], after = lengths[i];
    return std::abs(turns[i]) <= most_turn && std::max(before, after) <= most_ratio * std::min(before, after);
  }
  /// Whether the four chords around a corner and the next one but one are of one curve: its corners are i − 1 … i + 3.
  [[nodiscard]] auto is_of_circle(std::size_t i) const -> bool {
    std::array<Point2, fewest + 1> corners_of_it{};
    double height = 0;
    for (std::size_t k = 0; k <= fewest; ++k) {
      const std::size_t at = (i + size() - 1 + k) % size();
      corners_of_it[k] = points[at];
      if (k == 0 || k == fewest) continue;
      if (!bends(at) || (turns[at] > 0) != (turns[i] > 0)) return false;
      const double chord = (lengths[(at + size() - 1) % size()] + lengths[at]) / 2;
      height += chord * std::abs(turns[at]) / 8 / static_cast<double>(fewest - 1);  // l² / 8 r, and r = l / turn
    }
    return off_circle(corners_of_it) <= std::max(exactness, share_of_height * height);
  }
};

}  // namespace

auto arcs_of(const Ring& ring) -> std::vector<Arc> {
  const Chords chords(ring);
  const std::size_t m = chords.size(), n = ring.size();
  if (m < fewest) return {};
  std::vector<bool> joins(m, false);  // at a corner: the chord before and the one after
  for (std::size_t i = 0; i < m; ++i)
    if (chords.is_of_circle(i))
      for (std::size_t k = 0; k + 1 < fewest; ++k) joins[(i + k) % m] = true;
  const auto same_side = [&](std::size_t a, std::size_t b) { return (chords.turns[a] > 0) == (chords.turns[b] > 0); };
  std::vector<Arc> out;
  bool has_begin = false;
  for (std::size_t i = 0; i < m; ++i) {
    std::size_t last = (i + 1) % m;                           // the corner after the first chord
    const bool bends_back = joins[i] && !same_side(i, last);  // the chord from i ends another curve
    if (!joins[last] || (joins[i] && !bends_back)) continue;
    has_begin = true;
    double bend = chords.turns[last];
    const std::size_t first = chords.corners[bends_back ? last : i];
    while (joins[(last + 1) % m] && same_side(last, (last + 1) % m)) bend += chords.turns[last = (last + 1) % m];
    if (std::abs(bend) >= least_bend) out.push_back({first, (chords.corners[(last + 1) % m] + n - first) % n});
  }
  if (!has_begin && joins.front()) return {{0, n}};
  std::ranges::sort(out, {}, &Arc::first);
  return out;
}

}  // namespace mansard::geometry
