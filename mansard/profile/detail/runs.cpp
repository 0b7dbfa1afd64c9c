#include "mansard/profile/detail/runs.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/arcs.hpp"
#include "mansard/geometry/edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::profile::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;

auto ring_of(const Polygon& polygon, std::size_t ring) -> const Ring& {
  return ring == 0 ? polygon.outer : polygon.holes[ring - 1];
}

auto edge_vector(const Ring& ring, std::size_t edge) -> Point2 { return ring[(edge + 1) % ring.size()] - ring[edge]; }

auto turns(const Ring& ring, std::size_t vertex, double tangent) -> bool {
  const Point2 before = edge_vector(ring, (vertex + ring.size() - 1) % ring.size()), after = edge_vector(ring, vertex);
  return std::abs(cross(before, after)) >= tangent * dot(before, after);
}

/// Whether another run begins at a vertex: chords of one curve are one run, and so are edges that hardly turn.
auto corners_of(const Ring& ring, double tangent) -> std::vector<bool> {
  const std::size_t n = ring.size();
  std::vector<bool> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = turns(ring, i, tangent);
  for (const auto& arc : geometry::arcs_of(ring)) {
    for (std::size_t k = 0; k <= arc.count; ++k) out[(arc.first + k) % n] = arc.count < n && (k == 0 || k == arc.count);
  }
  return out;
}

/// How far the ray goes before it leaves the polygon. The half-open rule at vertices counts each crossing once.
auto reach_of(const Polygon& polygon, Point2 foot, Point2 inward) -> double {
  // The ray starts on its own edge, but for the rounding of the foot: coordinates up to 10⁷ m carry 2⁻³⁰ m, and nearly
  // parallel edges stretch that up to a thousandfold, which is still a thousandth of this.
  constexpr double own_edge = 1e-3;  // m
  const Point2 across = geometry::left_of(inward);
  double least = std::numeric_limits<double>::infinity();
  geometry::each_edge(polygon, [&](Point2 from, Point2 to) {
    const Point2 a = from - foot, b = to - foot;
    const double da = dot(a, across), db = dot(b, across);
    if ((da >= 0) == (db >= 0)) return;
    const double t = da / (da - db);
    const double u = dot(a, inward) + t * (dot(b, inward) - dot(a, inward));
    if (u > own_edge) least = std::min(least, u);
  });
  return std::isfinite(least) ? least : 0;
}

}  // namespace

auto runs_of(const Polygon& polygon, double angle) -> std::vector<Run> {
  const double tangent = geometry::tangent(angle);
  std::vector<Run> runs;
  for (std::size_t r = 0; r <= polygon.holes.size(); ++r) {
    const Ring& ring = ring_of(polygon, r);
    const std::size_t n = ring.size();
    const auto corners = corners_of(ring, tangent);
    // Start at a corner, so that no run is cut by where the ring happens to begin; a circle is one run.
    std::size_t first = 0;
    while (first < n && !corners[first]) ++first;
    if (first == n) first = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t edge = (first + k) % n;
      if (k == 0 || corners[edge]) runs.push_back({r, {}});
      runs.back().edges.push_back(edge);
    }
  }
  return runs;
}

auto samples_of(const Polygon& polygon, const Run& run, const Options& o) -> std::vector<Sample> {
  const Ring& ring = ring_of(polygon, run.ring);
  std::vector<Sample> samples;
  double passed = 0;
  for (const std::size_t edge : run.edges) {
    const Point2 vector = edge_vector(ring, edge);
    const double length = geometry::length(vector);
    if (!(length > 0)) continue;
    const Point2 direction = (1 / length) * vector, inward = geometry::left_of(direction);
    const double skip = std::min(o.slice_margin, length / 4);
    const double usable = length - 2 * skip;
    const auto count = static_cast<std::size_t>(std::clamp(std::round(usable / o.spacing), 1.0, o.slices_per_edge));
    for (std::size_t i = 0; i < count; ++i) {
      const double along = skip + (static_cast<double>(i) + 0.5) / static_cast<double>(count) * usable;
      const Point2 foot = ring[edge] + along * direction;
      samples.push_back({foot, inward, passed + along, reach_of(polygon, foot, inward)});
    }
    passed += length;
  }
  return samples;
}

auto length_of(const Polygon& polygon, const Run& run) -> double {
  const Ring& ring = ring_of(polygon, run.ring);
  double sum = 0;
  for (const std::size_t edge : run.edges) sum += geometry::length(edge_vector(ring, edge));
  return sum;
}

auto gentle_neighbours(const Polygon& polygon, const std::vector<Run>& runs, std::size_t run, const Options& o)
    -> std::vector<std::size_t> {
  const double tangent = o.gentle_turn;
  const auto same_ring = [&](std::size_t r) { return runs[r].ring == runs[run].ring; };
  std::size_t first = run, last = run;  // the ring's runs stand together
  while (first > 0 && same_ring(first - 1)) --first;
  while (last + 1 < runs.size() && same_ring(last + 1)) ++last;
  if (first == last) return {};
  const Ring& ring = ring_of(polygon, runs[run].ring);
  const std::size_t before = run > first ? run - 1 : last, after = run < last ? run + 1 : first;
  std::vector<std::size_t> out;
  if (!turns(ring, runs[run].edges.front(), tangent)) out.push_back(before);
  if (!turns(ring, runs[after].edges.front(), tangent) && after != before) out.push_back(after);
  return out;
}

}  // namespace mansard::profile::detail
