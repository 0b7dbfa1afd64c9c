#include "mansard/refine/detail/turned.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "mansard/extrude/corner_edges.hpp"
#include "mansard/geometry/fit.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/refit.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using model::Plan;

/// A roof plane that samples are on, in the heights of the site.
struct Inclined {
  Point3 middle;
  Point2 rise;      ///< per run
  double gain = 0;  ///< m²·m²: what it saves against the roof, on these samples
  [[nodiscard]] auto at(Point2 place) const -> double { return middle.z + dot(rise, place - xy(middle)); }
};

/// Samples that one plane may explain.
using Group = std::vector<std::size_t>;

/// The plane through some samples, those far off it left out; none where they are too few, or on one line.
auto plane_through(const Group& group, const Site& site, const Options& options) -> std::optional<Inclined> {
  constexpr int rounds = 4;
  constexpr double flat_share = 1e-3;  // of the spread: what is narrower across is a line
  std::optional<Inclined> best;
  for (int round = 0; round < rounds; ++round) {
    double weight = 0;
    Point3 sum;
    const auto each = [&](auto use) {
      for (const std::size_t i : group) {
        if (best && std::abs(best->at(site.places[i]) - site.z[i]) > options.lines.robust) continue;
        use(Point3{site.places[i].x, site.places[i].y, site.z[i]}, site.weight[i]);
      }
    };
    std::int64_t count = 0;
    each([&](Point3 p, double w) { weight += w, sum = sum + w * p, ++count; });
    if (count < options.lines.min_samples || !(weight > 0)) return std::nullopt;
    const Point3 middle = (1 / weight) * sum;
    geometry::SlopeEquations equations;
    each([&](Point3 p, double w) { equations.add(p.x - middle.x, p.y - middle.y, p.z - middle.z, w); });
    const double spread = equations.xx + equations.yy;
    if (!(equations.determinant() > flat_share * spread * spread)) return std::nullopt;
    best = Inclined{middle, equations.slopes(), 0};
  }
  return best;
}

/// Of points, their own planes. Of a surface, that of the samples over each face that rises from an edge, where most of
/// them are on it: what a roof is not yet, its faces mix, and a plane through that explains nothing.
auto seen_slopes(const Judged& judged, const Site& site, const Options& options) -> std::vector<Inclined> {
  constexpr double on_one_plane = 0.8;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Group> groups;  // by plane, or by edge and part of its profile
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    if (std::isnan(judged.view.z_of(site, i))) continue;
    if (site.of_points) {
      if (site.plane_of[i] < site.planes.size()) groups[{site.plane_of[i], 0}].push_back(i);
      continue;
    }
    const auto& face = judged.sketch.faces[judged.view.face_of(site, i)];
    if (face.kind == model::FaceKind::side && face.provenance && face.provenance->ring == 0)
      groups[{face.provenance->edge, face.provenance->part}].push_back(i);
  }
  const auto plane_of = [&](std::uint32_t number, const Group& group) -> std::optional<Inclined> {
    if (site.of_points) {
      const auto& plane = site.planes[number];
      return Inclined{{plane.middle.x, plane.middle.y, plane.middle.z - site.base}, plane.slope, 0};
    }
    auto slope = plane_through(group, site, options);
    if (!slope) return slope;
    const auto on_it = std::ranges::count_if(
        group, [&](std::size_t i) { return std::abs(slope->at(site.places[i]) - site.z[i]) <= options.lines.robust; });
    if (static_cast<double>(on_it) < on_one_plane * static_cast<double>(group.size())) return std::nullopt;
    return slope;
  };
  const auto off = [&](double difference) {
    return site.of_points ? stray_loss(difference, options.samples.stray) : loss(difference, options.robust);
  };
  std::vector<Inclined> out;
  for (const auto& [key, group] : groups) {
    if (std::ssize(group) < options.lines.min_samples) continue;
    auto slope = plane_of(key.first, group);
    if (!slope) continue;
    const double steep = length(slope->rise);
    if (steep < options.forms.min_slope || steep > options.forms.max_slope) continue;
    for (const std::size_t i : group)
      slope->gain +=
          site.weight[i] * (off(judged.view.z_of(site, i) - site.z[i]) - off(slope->at(site.places[i]) - site.z[i]));
    slope->gain *= site.sample_area;
    out.push_back(*slope);
  }
  return out;
}

/// The roof's own planes where they go on beyond their faces: samples off the roof that lie on one. An obstacle in the
/// outline, the wedge of a wing, keeps the plane of one side from what is behind it.
auto continued_slopes(const Judged& judged, const Site& site, const Options& options) -> std::vector<Inclined> {
  std::vector<std::size_t> off;
  for (std::size_t i = 0; i < site.cells.size(); ++i)
    if (std::abs(judged.view.z_of(site, i) - site.z[i]) > options.lines.robust) off.push_back(i);
  std::vector<Inclined> out;
  if (std::ssize(off) < options.lines.min_samples) return out;
  for (const auto& face : judged.sketch.faces) {
    if (face.kind != model::FaceKind::side || face.normal.z <= wall_normal) continue;
    const Point3 at = judged.sketch.vertices[face.loops.front().front()];
    Inclined slope{{at.x, at.y, at.z - site.base}, {-face.normal.x / face.normal.z, -face.normal.y / face.normal.z}, 0};
    Point2 sum;
    double count = 0;
    for (const std::size_t i : off) {
      if (std::abs(slope.at(site.places[i]) - site.z[i]) > options.lines.robust) continue;
      slope.gain += site.weight[i] * loss(judged.view.z_of(site, i) - site.z[i], options.robust);
      sum = sum + site.places[i];
      ++count;
    }
    if (count < static_cast<double>(options.lines.min_samples)) continue;
    slope.gain *= site.sample_area;
    const Point2 middle = (1 / count) * sum;
    slope.middle = {middle.x, middle.y, slope.at(middle)};
    out.push_back(slope);
  }
  return out;
}

/// The plan with the plane from one of its corners, and the walls on both sides of that, as far as the plane rises from
/// them, up to it.
auto with_slope(const Plan& plan, const Inclined& slope, std::size_t corner, const Options& options)
    -> std::optional<Plan> {
  constexpr double most_turn = 0.34;  // the sine of 20°: what is more oblique is no side of a roof, and mostly noise
  constexpr double same_direction = 0.035;  // the sine of 2°
  constexpr double from_wall = 0.7;         // the cosine of 45°: a roof rises from a wall, or along it
  const double height = slope.at(plan.outer.points[corner]), steep = length(slope.rise);
  if (height < options.forms.min_height) return std::nullopt;
  const Point2 up = (1 / steep) * slope.rise, along{up.y, -up.x};
  const auto& points = plan.outer.points;
  const auto direction = [&](std::size_t edge) {
    return normalised(points[(edge + 1) % points.size()] - points[edge]);
  };
  const auto turn_from = [&](std::size_t edge) { return std::abs(cross(along, direction(edge))); };
  bool is_known = std::min(turn_from(corner), turn_from((corner + points.size() - 1) % points.size())) <= most_turn;
  for (std::size_t edge = 0; edge < points.size() && !is_known; ++edge)
    is_known = std::min(turn_from(edge), std::abs(dot(along, direction(edge)))) <= same_direction;
  if (!is_known) return std::nullopt;
  const auto own = static_cast<std::uint32_t>(plan.profiles.size());
  auto ring = extrude::with_corner_edge(plan.outer, corner, along, own);
  if (!ring) return std::nullopt;
  Plan out = plan;
  out.outer = *std::move(ring);
  out.profiles.push_back(pitched(height, steep));
  out.profiles.push_back(wall(height, options.forms));
  const auto edges = edges_of(out).front();
  const std::size_t n = edges.size();
  const auto rises_from = [&](std::size_t edge) {
    return dot(edges[edge].inward, up) > from_wall && !is_wall(out.profiles[out.outer.profile_of_edge[edge]]);
  };
  for (const std::size_t step : {std::size_t{1}, n - 1})
    for (std::size_t edge = (corner + step) % n; edge != corner && rises_from(edge); edge = (edge + step) % n)
      out.outer.profile_of_edge[edge] = own + 1;
  return out;
}

}  // namespace

auto turned_roofs(const Judged& judged, const Judge& judge) -> std::vector<Plan> {
  constexpr std::size_t most_slopes = 3;
  const Site& site = judge.site();
  const Options& options = judge.options();
  auto slopes = seen_slopes(judged, site, options);
  std::ranges::move(continued_slopes(judged, site, options), std::back_inserter(slopes));
  std::erase_if(slopes, [&](const Inclined& slope) { return !(slope.gain > options.face_price); });
  rank(
      slopes, [](const Inclined& slope) { return -slope.gain; }, options.same_cost);
  if (slopes.size() > most_slopes) slopes.resize(most_slopes);
  std::vector<Plan> out;
  for (const Inclined& slope : slopes) {
    std::optional<Plan> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t corner = 0; corner < judged.plan.outer.points.size(); ++corner) {
      const double off = length(judged.plan.outer.points[corner] - xy(slope.middle));
      if (off >= least - same_distance) continue;
      if (auto plan = with_slope(judged.plan, slope, corner, options)) nearest = std::move(*plan), least = off;
    }
    if (nearest) out.push_back(*std::move(nearest));
  }
  return out;
}

}  // namespace mansard::refine::detail
