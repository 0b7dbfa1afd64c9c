#include "mansard/refine/detail/dormers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/order.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using model::Plan;
using model::Profile;

constexpr double unseen = std::numeric_limits<double>::quiet_NaN();

/// A slope of the roof: height = gutter + slope · inward of its edge, above the base.
struct Slope {
  std::uint32_t face = 0, ring = 0, edge = 0;
  Point2 start, along, inward;
  double gutter = 0, slope = 0;
  [[nodiscard]] auto at(double v) const -> double { return gutter + slope * v; }
  [[nodiscard]] auto u_of(Point2 p) const -> double { return dot(p - start, along); }
  [[nodiscard]] auto v_of(Point2 p) const -> double { return dot(p - start, inward); }
  [[nodiscard]] auto place(double u, double v) const -> Point2 { return start + u * along + v * inward; }
};

auto slopes_of(const Judged& judged, const Options::Dormers& options) -> std::vector<Slope> {
  std::vector<Slope> out;
  for (std::uint32_t f = 0; f < judged.sketch.faces.size(); ++f) {
    const auto& face = judged.sketch.faces[f];
    if (face.kind != model::FaceKind::side || !face.provenance) continue;
    const auto [ring, edge, part] = *face.provenance;
    const auto& of = ring == 0 ? judged.plan.outer : judged.plan.holes[ring - 1];
    const auto& profile = judged.plan.profiles[of.profile_of_edge[edge]];
    if (part + 1 >= profile.size()) continue;
    const auto &a = profile[part], &b = profile[part + 1];
    if (b.inward <= a.inward) continue;
    const double slope = (b.height - a.height) / (b.inward - a.inward);
    if (slope < options.min_slope || slope > options.max_slope) continue;
    const Point2 start = of.points[edge], end = of.points[(edge + 1) % of.points.size()];
    const Point2 along = geometry::normalised(end - start);
    out.push_back({f, ring, edge, start, along, geometry::left_of(along), a.height - slope * a.inward, slope});
  }
  return out;
}

/// A sample near to a dormer, in the slope's directions.
struct Sample {
  double u = 0, v = 0, z = 0;  // m; z above the base
};

struct Box {
  double left = 0, right = 0, front = 0;  // m along the edge, and inward of it
  double eaves = 0;                       // m above the base
  double pitch = 0;                       // rise per run of its own roof, towards the middle
  [[nodiscard]] auto width() const -> double { return right - left; }
  [[nodiscard]] auto back(const Slope& slope) const -> double { return (eaves - slope.gutter) / slope.slope; }
  [[nodiscard]] auto own(double u) const -> double {
    return eaves + pitch * (width() / 2 - std::abs(u - (left + right) / 2));
  }
  [[nodiscard]] auto height(const Slope& slope, double u, double v) const -> double {
    const double below = slope.at(v);
    if (u < left || u > right || v < front || v > back(slope)) return below;
    return std::max(below, own(u));
  }
};

auto error_of(const std::vector<Sample>& samples, const Slope& slope, const Box* box) -> double {
  double sum = 0;
  for (const auto& s : samples) {
    const double d = (box ? box->height(slope, s.u, s.v) : slope.at(s.v)) - s.z;
    sum += d * d;
  }
  return sum;
}

/// Its roof at the height of most of what is well inside.
void level(Box& box, const std::vector<Sample>& samples, const Slope& slope, double melt) {
  std::vector<double> heights;
  const double aside = std::min(melt, box.width() / 4);
  for (const auto& s : samples)
    if (s.u > box.left + aside && s.u < box.right - aside && s.v > box.front + aside && s.z > slope.at(s.v) + aside)
      heights.push_back(s.z - (box.own(s.u) - box.eaves));
  if (!heights.empty()) box.eaves = base::median(std::move(heights));
}

/// The walls moved until that no longer helps, by less and less.
auto fitted(Box box, const std::vector<Sample>& samples, const Slope& slope, double melt) -> Box {
  level(box, samples, slope, melt);
  double error = error_of(samples, slope, &box);
  for (const double step : {0.2, 0.1, 0.05}) {
    for (int round = 0; round < 20; ++round) {
      bool moved = false;
      for (double Box::*side : {&Box::left, &Box::right, &Box::front})
        for (const double by : {-step, step}) {
          Box other = box;
          other.*side += by;
          if (!(other.width() > 2 * step)) continue;
          level(other, samples, slope, melt);
          const double e = error_of(samples, slope, &other);
          if (e < error - same_cost) box = other, error = e, moved = true;
        }
      if (!moved) break;
    }
  }
  return box;
}

/// Connected cells of a slope that stand out of it.
auto islands(const Judged& judged, const Site& site, const Slope& slope, const Options::Dormers& options)
    -> std::vector<std::vector<std::uint32_t>> {
  const auto& grid = site.measured;
  std::vector<std::uint8_t> out_of_it(grid.z.size(), 0);
  for (const auto cell : site.cells)
    if (!std::isnan(judged.view.z[cell]) && judged.view.face[cell] == slope.face &&
        grid.z[cell] - judged.view.z[cell] > options.min_rise / 2)
      out_of_it[cell] = 1;
  std::vector<std::vector<std::uint32_t>> found;
  for (const auto cell : site.cells) {
    if (!out_of_it[cell]) continue;
    std::vector<std::uint32_t> island{cell};
    out_of_it[cell] = 0;
    for (std::size_t i = 0; i < island.size(); ++i) {
      const auto at = island[i];
      const auto column = at % grid.columns;
      const auto visit = [&](bool there, std::size_t next) {
        if (!there || !out_of_it[next]) return;
        out_of_it[next] = 0;
        island.push_back(static_cast<std::uint32_t>(next));
      };
      visit(column > 0, at - 1);
      visit(column + 1 < grid.columns, at + 1);
      visit(at >= grid.columns, at - grid.columns);
      visit(at + grid.columns < grid.z.size(), at + grid.columns);
    }
    found.push_back(std::move(island));
  }
  return found;
}

/// Whether the box lies on the slope with all of its plan.
auto on_slope(const Box& box, const Slope& slope, const Judged& judged, const Site& site) -> bool {
  const auto& grid = site.measured;
  const double step = grid.spacing, aside = step;
  for (double u = box.left - aside; u <= box.right + aside + step / 2; u += step)
    for (double v = box.front - aside; v <= box.back(slope) + aside + step / 2; v += step) {
      const Point2 p = slope.place(u, v);
      const double column = std::round((p.x - grid.origin.x) / step), row = std::round((p.y - grid.origin.y) / step);
      if (column < 0 || row < 0 || column >= static_cast<double>(grid.columns) || row >= static_cast<double>(grid.rows))
        return false;
      const auto cell = static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column);
      if (std::isnan(judged.view.z[cell]) || judged.view.face[cell] != slope.face) return false;
    }
  return true;
}

auto built(const Box& box, const Slope& slope, double base, double gain, const Options& options) -> Dormer {
  // Error bound, m: the slope reaches the hole's back a millimetre before its wall ends, so that rounding does not
  // decide which of the two goes on.
  constexpr double before = 1e-3;
  const double back = box.back(slope);
  Dormer out;
  out.ring = slope.ring;
  out.edge = slope.edge;
  out.gain = gain;
  out.back = pitched(slope.at(back) + before, slope.slope);
  out.plan.outer.points = {slope.place(box.left, box.front), slope.place(box.right, box.front),
                           slope.place(box.right, back), slope.place(box.left, back)};
  out.plan.base = base;
  const double top = box.own((box.left + box.right) / 2);
  if (box.pitch > 0) {
    out.plan.outer.profile_of_edge = {0, 1, 2, 3};
    out.plan.profiles = {wall(box.eaves, options.forms), pitched(box.eaves, box.pitch), wall(box.eaves, options.forms),
                         pitched(box.eaves, box.pitch)};
    out.plan.cap = top + 1;
  } else {
    out.plan.outer.profile_of_edge = {0, 0, 0, 0};
    out.plan.profiles = {wall(box.eaves, options.forms)};
    out.plan.cap = box.eaves;
  }
  return out;
}

auto best_box(const std::vector<std::uint32_t>& island, const Slope& slope, const Judged& judged, const Site& site,
              const Options& options) -> std::optional<Dormer> {
  const auto& o = options.dormers;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box start{infinity, -infinity, infinity, 0, 0};
  double last = -infinity;
  for (const auto cell : island) {
    const Point2 p = site.measured.centre(cell);
    start.left = std::min(start.left, slope.u_of(p)), start.right = std::max(start.right, slope.u_of(p));
    start.front = std::min(start.front, slope.v_of(p)), last = std::max(last, slope.v_of(p));
  }
  if (start.width() > o.max_width || last - start.front > o.max_width) return std::nullopt;
  const double reach = 2 * options.samples.melt;
  std::vector<std::uint32_t> own(island);
  std::ranges::sort(own);
  std::vector<Sample> samples;
  for (const auto cell : site.cells) {
    if (std::isnan(judged.view.z[cell]) || judged.view.face[cell] != slope.face) continue;
    const bool other = site.measured.z[cell] - judged.view.z[cell] > o.min_rise / 2;  // of another dormer
    if (other && !std::ranges::binary_search(own, cell)) continue;
    const Point2 p = site.measured.centre(cell);
    const Sample s{slope.u_of(p), slope.v_of(p), site.measured.z[cell]};
    if (s.u > start.left - reach && s.u < start.right + reach && s.v > start.front - reach && s.v < last + reach)
      samples.push_back(s);
  }
  const double before = error_of(samples, slope, nullptr);
  std::optional<Box> best;
  double least = infinity;
  for (const double pitch : {0.0, 0.7}) {  // level; a gable, whose pitch a scan of this size does not show
    Box box = start;
    box.pitch = pitch;
    box = fitted(box, samples, slope, options.samples.melt);
    const double error = error_of(samples, slope, &box);
    if (error < o.gable_gain * least) best = box, least = error;
  }
  const double gain = (before - least) * site.cell_area, rise = best->eaves - slope.at(best->front);
  if (best->width() < o.min_width || rise < o.min_rise || rise > o.max_rise || least > o.max_rest * before ||
      gain < o.price || !on_slope(*best, slope, judged, site))
    return std::nullopt;
  return built(*best, slope, judged.plan.base, gain, options);
}

/// Whether a line along a side of the first leaves the other beyond it, and farther than `by`.
auto apart(const Dormer& a, const Dormer& b, double by) -> bool {
  const auto& p = a.plan.outer.points;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point2 outward = -1 * geometry::left_of(geometry::normalised(p[(i + 1) % p.size()] - p[i]));
    if (std::ranges::all_of(b.plan.outer.points, [&](Point2 q) { return dot(q - p[i], outward) > by; })) return true;
  }
  return false;
}

}  // namespace

auto dormers_on(const Judged& judged, const Site& site, const Options& options) -> std::vector<Dormer> {
  const auto& o = options.dormers;
  std::vector<Dormer> found;
  for (const auto& slope : slopes_of(judged, o))
    for (const auto& island : islands(judged, site, slope, o)) {
      if (static_cast<double>(island.size()) * site.cell_area < o.min_width * o.min_width / 2) continue;
      if (auto dormer = best_box(island, slope, judged, site, options)) found.push_back(std::move(*dormer));
    }
  rank(found, [](const Dormer& dormer) { return -dormer.gain; });
  std::vector<Dormer> out;
  for (auto& dormer : found) {
    if (std::ranges::all_of(out, [&](const Dormer& other) { return apart(dormer, other, site.measured.spacing); }))
      out.push_back(std::move(dormer));
  }
  return out;
}

auto with_hole(const Plan& host, const Dormer& dormer) -> Plan {
  Plan out = host;
  const auto& p = dormer.plan.outer.points;
  const auto upright = static_cast<std::uint32_t>(out.profiles.size()), back = upright + 1;
  out.profiles.push_back({{0, 0}, {0, dormer.plan.cap + 1}});
  out.profiles.push_back(dormer.back);
  out.holes.push_back({{p[0], p[3], p[2], p[1]}, {upright, back, upright, upright}});
  return out;
}

auto without_dormers(const Site& site, const std::vector<Dormer>& dormers, double aside, const Options& options)
    -> Site {
  Site out = site;
  for (const auto& dormer : dormers) {
    const geometry::Polygon polygon = model::polygon_of(dormer.plan);
    for (const auto cell : site.cells) {
      const Point2 at = site.measured.centre(cell);
      if (geometry::contains(polygon, at) || geometry::boundary_distance(polygon, at) < aside)
        out.measured.z[cell] = unseen;
    }
  }
  return crop(out, site.polygon, options);
}

}  // namespace mansard::refine::detail
