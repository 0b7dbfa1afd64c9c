#include "mansard/profile/detail/climb.hpp"
#include "mansard/geometry/angles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mansard::profile::detail {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

auto squared(SectionPoint a, SectionPoint b) -> double {
  const double u = a.inward - b.inward, h = a.height - b.height;
  return u * u + h * h;
}

/// The pieces' ends, sorted by inward distance, so that those near a point are found in a window.
class Ends {
 public:
  explicit Ends(std::span<const Piece> pieces) : pieces_(pieces) {
    entries_.reserve(2 * pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      entries_.emplace_back(pieces[i].low.inward, i);
      entries_.emplace_back(pieces[i].high.inward, i);
    }
    std::ranges::sort(entries_);
  }

  /// The acceptable piece with an end nearest to `at`, within `radius`; the lowest number among equals. Pieces of a
  /// surface are joined, so that it is mostly found right there: what is nearest is so within any reach.
  template <class Accept>
  [[nodiscard]] auto nearest(SectionPoint at, double radius, Accept accept) const -> std::size_t {
    for (const double share : {1.0 / 64, 1.0 / 8, 1.0 / 3, 1.0})
      if (const auto found = nearest_of_all(at, share * radius, accept); found != none) return found;
    return none;
  }

 private:
  template <class Accept>
  [[nodiscard]] auto nearest_of_all(SectionPoint at, double radius, Accept accept) const -> std::size_t {
    std::size_t best = none;
    double least = radius * radius;
    auto entry = std::ranges::lower_bound(entries_, std::pair{at.inward - radius, std::size_t{0}});
    for (; entry != entries_.end() && entry->first <= at.inward + radius; ++entry) {
      const std::size_t i = entry->second;
      const double d = std::min(squared(pieces_[i].low, at), squared(pieces_[i].high, at));
      if (d > least || (d == least && best != none && i >= best) || !accept(i)) continue;
      best = i;
      least = d;
    }
    return best;
  }

  std::span<const Piece> pieces_;
  std::vector<std::pair<double, std::size_t>> entries_;
};

/// Walks from the piece to ever higher ones, or ever lower ones for `sign` −1. Returns the points passed, in order.
auto walk(std::span<const Piece> pieces, const Ends& ends, std::size_t start, double sign, const Options& options,
          double limit) -> std::vector<SectionPoint> {
  const auto far_end = [&](std::size_t i) { return sign > 0 ? pieces[i].high : pieces[i].low; };
  const auto near_end = [&](std::size_t i) { return sign > 0 ? pieces[i].low : pieces[i].high; };
  std::vector<SectionPoint> points{far_end(start)};
  while (sign * points.back().height < sign * limit) {
    const SectionPoint end = points.back();
    const auto goes_on = [&](std::size_t i) { return sign * far_end(i).height > sign * end.height; };
    const std::size_t next = ends.nearest(end, options.jump, goes_on);
    if (next == none) break;
    // A piece that dips behind the point reached (a parapet's back) joins where it comes level with it.
    const SectionPoint from = near_end(next), to = far_end(next);
    if (sign * from.height >= sign * end.height) {
      if (squared(from, end) > 0) points.push_back(from);
    } else if (to.height != from.height) {
      const double t = (end.height - from.height) / (to.height - from.height);
      points.push_back({from.inward + t * (to.inward - from.inward), end.height});
    }
    points.push_back(to);
  }
  return points;
}

/// The piece nearest to the foot of the wall.
auto wall_start(std::span<const Piece> pieces, const Options& options, double ground) -> std::size_t {
  const double target = ground + options.climb_clear;
  std::size_t best = none;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& p = pieces[i];
    if (p.high.height < target) continue;
    const double height = std::max(target, p.low.height);
    const double rise = p.high.height - p.low.height;
    const double t = rise > 0 ? (height - p.low.height) / rise : 0;
    const double inward = std::abs(p.low.inward + t * (p.high.inward - p.low.inward));
    if (inward > options.climb_near) continue;
    const double d = squared({inward, height}, {0, target});
    if (d < least) {
      least = d;
      best = i;
    }
  }
  return best;
}

/// The topmost piece over the first place inward of the foot that has one.
auto roof_start(std::span<const Piece> pieces, const Options& options, double ground) -> std::size_t {
  for (double at = options.climb_roof_first; at <= options.climb_near; at += options.climb_roof_next) {
    std::size_t best = none;
    double top = ground + options.climb_clear;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Piece& p = pieces[i];
      const double u0 = std::min(p.low.inward, p.high.inward), u1 = std::max(p.low.inward, p.high.inward);
      if (u0 > at || u1 < at) continue;
      const double t = u1 > u0 ? (at - p.low.inward) / (p.high.inward - p.low.inward) : 1;
      const double height = p.low.height + t * (p.high.height - p.low.height);
      if (height <= top) continue;
      top = height;
      best = i;
    }
    if (best != none) return best;
  }
  return none;
}

}  // namespace

auto climb(std::span<const Piece> pieces, const Options& options, double ground) -> std::optional<Climb> {
  const std::size_t wall = wall_start(pieces, options, ground), roof = roof_start(pieces, options, ground);
  std::size_t start = wall != none ? wall : roof;
  if (start == none) return std::nullopt;

  const Ends ends(pieces);
  constexpr double sky = std::numeric_limits<double>::infinity();
  auto up = walk(pieces, ends, start, 1, options, sky);
  if (roof != none && up.back().height < pieces[roof].low.height) {  // a hedge, a stump of wall: the roof is above it
    start = roof;
    up = walk(pieces, ends, start, 1, options, sky);
  }
  const auto down = walk(pieces, ends, start, -1, options, ground);

  Climb result;
  result.points.assign(down.rbegin(), down.rend());
  result.points.insert(result.points.end(), up.begin(), up.end());
  return result;
}

auto wall_position(const Climb& climb, const Options& options) -> std::optional<double> {
  const double steep =
      options.wall_lean *
      geometry::tangent(options.vertical_angle);  // single noisy triangles lean more than the wall they make
  std::vector<std::pair<double, double>> walls;   // (inward, weight)
  double total = 0;
  for (std::size_t i = 0; i + 1 < climb.points.size(); ++i) {
    const SectionPoint a = climb.points[i], b = climb.points[i + 1];
    const double rise = b.height - a.height;
    if (rise <= 0 || std::abs(b.inward - a.inward) > steep * rise) continue;
    walls.emplace_back((a.inward + b.inward) / 2, rise);
    total += rise;
  }
  if (total < options.wall_minimum) return std::nullopt;
  std::ranges::sort(walls);
  double sum = 0;
  for (const auto& [inward, weight] : walls)
    if ((sum += weight) >= total / 2) return inward;
  return walls.back().first;
}

}  // namespace mansard::profile::detail
