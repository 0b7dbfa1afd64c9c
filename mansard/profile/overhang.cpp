#include "mansard/profile/overhang.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/profile/detail/runs.hpp"
#include "mansard/profile/detail/section_index.hpp"

namespace mansard::profile {
namespace {

using detail::Piece;
using geometry::Polygon;

/// Rise over run, 60°: below the steep sides of mansard roofs a soffit would be metres lower than the gutter.
constexpr double steepest = 1.75;

/// The eaves that a plan's edge has: its roof, and where its slices are read. Heights are z.
struct Edge {
  double gutter = 0, pitch = 1;    ///< z; rise over run
  double wall_low = 0, wall_high;  ///< between these the wall is read
  double top = 0;                  ///< the edge of the roof is read up to here
  double clean = 0;                ///< from here on no scan rounds the roof off
  double reach = 0;                ///< m outward of the edge
};

/// Nothing where no roof rises from the top of a vertical wall, or no wall is left below the eaves.
auto edge_of(const model::Plan& plan, const model::Profile& profile, const Options& o) -> std::optional<Edge> {
  if (profile.size() < 3 || profile[1].inward > 0) return std::nullopt;
  const double way = profile[2].inward, rise = profile[2].height - profile[1].height;
  if (!(way > 0) || !(rise > o.level_slope * way) || rise > steepest * way) return std::nullopt;
  // The last part of a profile goes on until roofs meet.
  const double run = profile.size() > 3 ? way : std::numeric_limits<double>::infinity();
  Edge edge;
  edge.gutter = plan.base + profile[1].height;
  edge.pitch = rise / way;
  edge.wall_low = plan.base + o.climb_clear;
  edge.wall_high =
      std::max(edge.gutter - o.overhang_max * edge.pitch - o.overhang_clear, edge.wall_low + o.overhang_wall);
  if (edge.wall_high > edge.gutter - o.overhang_clear) return std::nullopt;
  // A scan that rounds edges off by overhang_melt shows the roof itself from about three times that on.
  edge.clean = edge.gutter + std::min(3 * o.overhang_melt, run / 2) * edge.pitch;
  edge.top = edge.gutter + std::min(5 * o.overhang_melt, run) * edge.pitch;
  edge.reach = o.overhang_max + o.overhang_near + o.overhang_melt;
  return edge;
}

auto inward_at(const Piece& piece, double z) -> double {
  const double t = (z - piece.low.height) / (piece.high.height - piece.low.height);
  return piece.low.inward + t * (piece.high.inward - piece.low.inward);
}

/// The median, by height, of what stands upright near the plan's edge; nothing where too little does.
auto wall_in(const std::vector<Piece>& pieces, const Edge& edge, const Options& o) -> std::optional<double> {
  const double steep = o.wall_lean * geometry::tangent(o.vertical_angle);
  std::vector<std::pair<double, double>> walls;  // inward, height
  double sum = 0;
  for (const Piece& piece : pieces) {
    const double low = std::max(piece.low.height, edge.wall_low), high = std::min(piece.high.height, edge.wall_high);
    const double rise = piece.high.height - piece.low.height;
    if (!(high > low) || std::abs(piece.high.inward - piece.low.inward) > steep * rise) continue;
    const double inward = inward_at(piece, (low + high) / 2);
    if (std::abs(inward) > o.overhang_near) continue;
    walls.emplace_back(inward, high - low);
    sum += high - low;
  }
  if (sum < o.overhang_shadow * (edge.wall_high - edge.wall_low)) return std::nullopt;
  std::ranges::sort(walls);
  double passed = 0;
  for (const auto& [inward, height] : walls)
    if ((passed += height) >= sum / 2) return inward;
  return walls.back().first;
}

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

/// One slice: its wall, and by level how far inward the surface is that bounds the building; and what is next to it
/// outside.
struct Slice {
  double wall = 0;
  std::vector<double> surface;
  double outermost = 0;                                     ///< m outward of the wall
  double before = std::numeric_limits<double>::infinity();  ///< m outward of the wall: what stands before the eaves
};

auto level_count(const Edge& edge, const Options& o) -> std::size_t {
  return static_cast<std::size_t>((edge.top - edge.wall_high) / o.overhang_level) + 1;
}
auto height_of(const Edge& edge, std::size_t level, const Options& o) -> double {
  return edge.wall_high + (static_cast<double>(level) + 0.5) * o.overhang_level;
}

auto read(const std::vector<Piece>& pieces, const Edge& edge, const Options& o) -> std::optional<Slice> {
  const auto wall = wall_in(pieces, edge, o);
  if (!wall) return std::nullopt;
  Slice slice;
  slice.wall = *wall;
  std::vector<double> crossings;  // m outward of the wall, up to the gutter
  for (std::size_t level = 0; level < level_count(edge, o); ++level) {
    const double z = height_of(edge, level, o);
    // The wall, and above the gutter the roof. What is farther in is another roof behind it.
    const double expected = std::max(slice.wall, (z - edge.gutter) / edge.pitch);
    double first = nowhere;
    for (const Piece& piece : pieces) {
      if (!(piece.low.height <= z && z < piece.high.height)) continue;
      const double inward = inward_at(piece, z);
      if (inward > expected + 2 * o.overhang_melt || inward < -edge.reach) continue;
      if (std::isnan(first) || inward > first) first = inward;
      if (z <= edge.gutter + o.overhang_clear) crossings.push_back(slice.wall - inward);
    }
    slice.surface.push_back(first);
    if (!std::isnan(first) && z <= edge.gutter + o.overhang_clear)
      slice.outermost = std::max(slice.outermost, slice.wall - first);
  }
  // The underside of noisy eaves is crossed several times; a neighbour is beyond their edge.
  for (const double crossing : crossings)
    if (crossing > slice.outermost + o.overhang_melt) slice.before = std::min(slice.before, crossing);
  return slice;
}

/// The middle slice, level by level.
auto middle_of(const std::vector<const Slice*>& slices, std::size_t levels) -> std::vector<double> {
  std::vector<double> out;
  for (std::size_t level = 0; level < levels; ++level) {
    std::vector<double> at;
    for (const Slice* slice : slices)
      if (!std::isnan(slice->surface[level])) at.push_back(slice->surface[level]);
    out.push_back(2 * at.size() >= slices.size() && !at.empty() ? base::median(std::move(at)) : nowhere);
  }
  return out;
}

/// The overhang whose cross-section, a triangle below the roof's plane and beyond the wall, has as much area as the
/// scan has beyond wall and roof. Smoothing takes the edge of a roof away and puts it elsewhere: the outermost point
/// moves by the width of the smoothing, the area hardly changes.
auto by_area(const std::vector<double>& middle, double wall, const Edge& edge, const Options& o) -> double {
  // The roof itself is where the scan has it, however the plan rounds that.
  std::vector<double> off;
  for (std::size_t level = 0; level < middle.size(); ++level)
    if (const double z = height_of(edge, level, o); z > edge.clean && !std::isnan(middle[level]))
      off.push_back(middle[level] - (z - edge.gutter) / edge.pitch);
  const double shift = off.empty() ? 0 : base::median(std::move(off));
  double area = 0;
  for (std::size_t level = 0; level < middle.size(); ++level) {
    const double z = height_of(edge, level, o);
    if (z > edge.clean || std::isnan(middle[level])) continue;
    area += (std::max(wall, (z - edge.gutter) / edge.pitch + shift) - middle[level]) * o.overhang_level;
  }
  return area > 0 ? std::sqrt(2 * area / edge.pitch) : 0;
}

auto measured(const Polygon& polygon, std::size_t ring, std::size_t number, const Edge& edge,
              const detail::SectionIndex& index, const Options& o) -> std::optional<Overhang> {
  std::vector<Slice> slices;
  std::size_t attempted = 0;
  for (const auto& sample : detail::samples_of(polygon, {ring, {number}}, o)) {
    ++attempted;
    const double inward = std::min(sample.reach, (edge.top - edge.gutter) / edge.pitch + 2 * o.overhang_melt);
    if (auto slice = read(index.cut({sample.foot, sample.inward, -edge.reach, inward}), edge, o))
      slices.push_back(std::move(*slice));
  }
  if (slices.empty()) return std::nullopt;
  std::vector<double> walls;
  for (const Slice& slice : slices) walls.push_back(slice.wall);
  const double wall = base::median(std::move(walls));

  std::vector<const Slice*> agreeing;
  std::vector<double> before;
  std::size_t supporting = 0;
  for (const Slice& slice : slices) {
    if (std::abs(slice.wall - wall) > o.overhang_agree) continue;
    agreeing.push_back(&slice);
    supporting += slice.outermost >= o.overhang_min ? 1 : 0;
    if (std::isfinite(slice.before)) before.push_back(slice.before);
  }
  Overhang out;
  out.wall = wall == 0 ? 0 : -wall;
  out.support = static_cast<double>(supporting) / static_cast<double>(attempted);
  if (out.support < o.overhang_support) return std::nullopt;

  const auto middle = middle_of(agreeing, level_count(edge, o));
  for (std::size_t level = 0; level < middle.size(); ++level)
    if (!std::isnan(middle[level]) && height_of(edge, level, o) <= edge.gutter + o.overhang_clear)
      out.outermost = std::max(out.outermost, wall - middle[level]);
  if (out.outermost < o.overhang_min) return std::nullopt;
  // What smoothing hides is never more than what it leaves to be seen: an edge that sharp would be gone altogether.
  out.distance = std::clamp(by_area(middle, wall, edge, o), out.outermost,
                            out.outermost + std::min(out.outermost, o.overhang_hidden));
  // Where a fifth of the slices sees something before the eaves, it is no wire.
  if (5 * before.size() >= attempted) out.distance = std::min(out.distance, base::median(std::move(before)) / 2);
  if (out.distance < o.overhang_min || out.distance > o.overhang_max) return std::nullopt;
  return out;
}

}  // namespace

auto measure_overhangs(std::span<const model::Plan> plans, const geometry::Mesh& mesh, const Options& options,
                       const base::Run& run) -> std::vector<PlanOverhangs> {
  struct Task {
    std::size_t plan, ring, number;
    Edge edge;
  };
  const detail::SectionIndex index(mesh);
  std::vector<PlanOverhangs> out(plans.size());
  std::vector<Polygon> polygons;
  std::vector<Task> tasks;
  for (std::size_t p = 0; p < plans.size(); ++p) {
    polygons.push_back(model::polygon_of(plans[p]));
    for (std::size_t r = 0; r <= plans[p].holes.size(); ++r) {
      const auto& ring = r == 0 ? plans[p].outer : plans[p].holes[r - 1];
      out[p].emplace_back(ring.points.size());
      for (std::size_t i = 0; i < ring.points.size(); ++i) {
        // Shorter ones see too little, as for profiles; they follow their row.
        if (length(ring.points[(i + 1) % ring.points.size()] - ring.points[i]) < options.short_run) continue;
        if (const auto edge = edge_of(plans[p], plans[p].profiles[ring.profile_of_edge[i]], options))
          tasks.push_back({p, r, i, *edge});
      }
    }
  }
  base::parallel_for(tasks.size(), [&](std::size_t t) {
    const auto& [p, r, i, edge] = tasks[t];
    if (!run.cancelled()) out[p][r][i] = measured(polygons[p], r, i, edge, index, options);
  });
  return out;
}

}  // namespace mansard::profile
