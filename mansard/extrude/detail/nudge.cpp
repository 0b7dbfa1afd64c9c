// Small changes to a footprint whose true solid is no manifold.
#include <algorithm>
#include <array>
#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/lines.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

/// One rung: what is taken off the runs, in 4096ths, for all tracks or for each another amount; and how far lines move
/// inward, as a multiple (times `step`) modulo `modulus` of their rank: distinct for as many lines.
struct Nudge {
  int shorter = 0;
  bool each_track = false;
  int step = 0, modulus = 1;
};
// Moduli are primes: 61 quanta are 0.93 mm, 193 are 2.9 mm.
constexpr std::array<Nudge, most_nudges> nudges{{
    {4, false, 0, 1},
    {0, false, 23, 61},
    {12, false, 71, 193},
    {2, true, 0, 1},
    {0, false, 50, 193},
    {5, true, 37, 193},
}};

/// Every edge's line moved inward by its rank's quanta; collinear neighbours stay on one line. How far the outline
/// moved at most, metres; nothing when an edge would turn round.
auto moved_inward(Footprint& footprint, int step, int modulus) -> std::optional<double> {
  using Line = std::pair<Direction, Rational>;
  std::vector<Line> lines;
  for (const auto& ring : footprint.rings)
    for (const CanonicalEdge& e : ring) lines.emplace_back(e.direction, e.offset);
  std::ranges::sort(
      lines, [](const Line& p, const Line& q) { return p.first != q.first ? p.first < q.first : p.second < q.second; });
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  double most = 0;
  for (std::size_t r = 0; r < footprint.rings.size(); ++r) {
    auto& ring = footprint.rings[r];
    const std::size_t n = ring.size();
    const std::vector<ExactPoint> old = footprint.corners[r];
    for (CanonicalEdge& e : ring) {
      const Line line{e.direction, e.offset};
      const auto rank = std::ranges::lower_bound(lines, line,
                                                 [](const Line& p, const Line& q) {
                                                   return p.first != q.first ? p.first < q.first : p.second < q.second;
                                                 }) -
                        lines.begin();
      Rational by(static_cast<long>((rank + 1) * step % modulus), 65536);
      by.canonicalize();
      most = std::max(most, by.get_d());
      e.offset += by;
      if (!e.joint) continue;
      const Rational along = by / e.direction.l;
      e.joint->x -= e.direction.b * along;
      e.joint->y += e.direction.a * along;
    }
    auto& corners = footprint.corners[r];
    for (std::size_t i = 0; i < n; ++i) {
      const auto& joint = ring[i].joint;
      corners[i] = joint ? *joint : corner_of(ring[(i + n - 1) % n], ring[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Point2 a = corners[i].approximate(), b = corners[(i + 1) % n].approximate();
      if (dot(ring[i].direction.approximate(), b - a) < shortest) return std::nullopt;
      // Between the feet of the old corners the outline moved with its line; past them, towards its neighbour's.
      const Point2 before = old[(i + n - 1) % n].approximate(), here = old[i].approximate(),
                   after = old[(i + 1) % n].approximate();
      const Point2 was = corners[(i + n - 1) % n].approximate();
      most = std::max(most, std::min(geometry::distance({before, here}, a), geometry::distance({here, after}, a)));
      most = std::max(most, std::min(geometry::distance({was, a}, here), geometry::distance({a, b}, here)));
    }
  }
  return most;
}

}  // namespace

auto nudged(const Footprint& footprint, int attempt, const Options& options, std::string& how)
    -> std::optional<Footprint> {
  const Nudge& nudge = nudges.at(static_cast<std::size_t>(attempt));
  Footprint out = footprint;
  how.clear();
  if (nudge.shorter > 0) {
    int most = 0;
    for (std::size_t t = 0; t < out.tracks.size(); ++t) {
      const int part = nudge.each_track ? nudge.shorter * (1 + static_cast<int>(t % 7)) : nudge.shorter;
      most = std::max(most, part);
      shorten_runs(out.tracks[t], part);
    }
    how = "runs were shortened by " + base::to_text(100.0 * most / 4096, 1) + " %";
  }
  if (nudge.step > 0) {
    const auto moved = moved_inward(out, nudge.step, nudge.modulus);
    if (!moved || out.moved + *moved > options.tolerance || clash_in(out.corners)) return std::nullopt;
    out.moved += *moved;
    how +=
        (how.empty() ? "" : " and ") + ("walls were moved inward by up to " + base::to_text(1000 * *moved, 1) + " mm");
  }
  return out;
}

}  // namespace mansard::extrude::detail
