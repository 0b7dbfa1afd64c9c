#include "mansard/roof/detail/shapes.hpp"
#include "mansard/geometry/angles.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/roof/detail/shape_list.hpp"

namespace mansard::roof::detail {
namespace {

using geometry::Point2;

/// A direction towards which one side, or one end, is special: as asked for, else that of the longest of those that are
/// marked, of equal ones the first.
auto facing(const std::vector<Side>& sides, const std::vector<bool>& marked, const Form& form) -> Point2 {
  const Side* best = nullptr;
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (marked[i] && sides[i].ring == 0 && (best == nullptr || sides[i].length > best->length + 1e-6)) best = &sides[i];
  if (form.direction || best == nullptr) return pointing(form.direction.value_or(0));
  return -1.0 * best->inward;
}

/// Of those that are marked, the ones that look that way.
auto looking(const std::vector<Side>& sides, const std::vector<bool>& marked, Point2 where) -> std::vector<bool> {
  std::vector<bool> out(sides.size(), false);
  for (std::size_t i = 0; i < sides.size(); ++i) out[i] = marked[i] && dot(sides[i].inward, where) < 0;
  return out;
}

/// Only the first of several: of wings without a direction, the end of one.
void keep_first(std::vector<bool>& marked) {
  const auto first = std::ranges::find(marked, true);
  if (first != marked.end()) std::fill(first + 1, marked.end(), false);
}

void fall_back(Design& out, Shape to, const std::string& why) {
  out.warnings.push_back(base::warning("roof-shape-here", why + "; made " + std::string(to_string(to)) +
                                                              " instead of " + std::string(to_string(out.shape))));
  out.shape = to;
  out.as_asked = false;
}

}  // namespace

auto pointing(double bearing) -> Point2 { return {geometry::sine(bearing), geometry::cosine(bearing)}; }

auto ridge_axis(const Extent& extent, const Form& form, bool to_end) -> Point2 {
  const Point2 across = left_of(extent.axis);
  if (form.direction) {  // a gabled roof looks at right angles to its ridge
    const Point2 d = pointing(*form.direction);
    return (std::abs(dot(d, extent.axis)) > std::abs(dot(d, across))) == to_end ? extent.axis : across;
  }
  return form.orientation == Orientation::across ? across : extent.axis;
}

auto design_of(const geometry::Polygon& polygon, const std::vector<Side>& sides, const Form& form, const Options& o)
    -> Design {
  Design out{form.shape,
             std::vector<Sweep>(sides.size()),
             std::vector<bool>(sides.size()),
             std::vector<bool>(sides.size()),
             true,
             {}};
  if (info_of(out.shape).ends == Ends::move) return out;
  if (info_of(out.shape).ends == Ends::apex) {
    const Shape to = info_of(out.shape).without_ends;
    const std::string same = "no apex sees every side of this outline";
    if (to != out.shape) {
      fall_back(out, to, same);
    } else {
      out.as_asked = false;
      out.warnings.push_back(base::warning("roof-shape-here", same + "; every side rises along the shape's curve"));
    }
    return out;
  }

  const Extent extent = extent_of(sides);
  const bool single = nearly_rectangle(polygon, extent, o);
  if (!single && info_of(out.shape).opposite != Opposite::same)
    fall_back(out, info_of(out.shape).without_ends, "wings of this outline have ridges of their own");
  const bool to_end = info_of(out.shape).ends == Ends::one_move || info_of(out.shape).ends == Ends::one_half_upright;
  std::vector<bool> ends;
  double span = 0;  // of the whole roof, where it has one
  if (single) {
    const Point2 axis = ridge_axis(extent, form, to_end);
    ends = ends_by_axis(sides, axis);
    span = std::abs(dot(axis, extent.axis)) > 0.5 ? extent.width : extent.length;
  } else {
    ends = ends_of_wings(polygon, sides, o);
    if (form.orientation == Orientation::across || (form.direction && !to_end))
      out.warnings.push_back(base::warning("roof-orientation", "every wing of this outline has a ridge of its own"));
  }
  const bool any = std::ranges::find(ends, true) != ends.end(), all = std::ranges::find(ends, false) == ends.end();
  if (!any || all) {
    const Shape to = info_of(out.shape).without_ends;
    fall_back(out, info_of(to).ends == Ends::move ? to : info_of(to).without_ends,
              "no side of this outline is fit for a gable");
    return out;
  }
  const ShapeInfo& info = info_of(out.shape);
  std::vector<bool> other(sides.size(), false);  // ends that are not upright
  if (to_end) {
    other = looking(sides, ends, facing(sides, ends, form));
    if (!form.direction && !single) keep_first(other);
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!ends[i] || (info.ends == Ends::one_move && other[i])) continue;
    if (info.ends == Ends::half_upright || (info.ends == Ends::one_half_upright && other[i])) {
      out.sweeps[i].lag = o.half_hip * (span > 0 ? span : sides[i].length) / 2;
    } else {
      out.sweeps[i].moves = false;
      out.half_move[i] = info.ends == Ends::half_move;
    }
  }
  if (info.opposite == Opposite::same) return out;
  std::vector<bool> long_sides = ends;
  long_sides.flip();
  const auto low = looking(sides, long_sides, facing(sides, long_sides, form));
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (ends[i] || low[i]) continue;
    if (info.opposite == Opposite::higher) out.sweeps[i].lag = o.saltbox_shift * span;
    else out.half_way[i] = true;
  }
  return out;
}

auto level_sides(const std::vector<Side>& sides, Point2 uphill, const Options& o) -> std::vector<bool> {
  std::vector<bool> out;
  for (const Side& side : sides) out.push_back(dot(side.inward, uphill) > o.level_cosine);
  return out;
}

auto slope_of(const geometry::Polygon& polygon, const Form& form, const Options& o) -> Slope {
  const auto sides = sides_of(polygon, o.side_turn);
  Slope out{polygon, {}, 0, 0, 0};
  const auto longest = [&](auto&& allowed) -> const Side* {
    const Side* best = nullptr;
    for (const Side& side : sides)
      if (side.ring == 0 && allowed(side) && (best == nullptr || side.length > best->length + 1e-6)) best = &side;
    return best;
  };
  if (form.direction) {
    out.uphill = -1.0 * pointing(*form.direction);
    if (const Side* side = longest([&](const Side& s) { return dot(s.inward, out.uphill) > o.direction_cosine; }))
      out.uphill = side->inward;
  } else {
    const Point2 axis = extent_of(sides).axis;
    const bool across = form.orientation == Orientation::across;
    const Side* side = longest([&](const Side& s) { return (std::abs(dot(s.inward, axis)) > 0.7071) == across; });
    if (side == nullptr) side = longest([](const Side&) { return true; });
    out.uphill = side->inward;
  }

  return slope_along(polygon, out.uphill, o);
}

auto slope_along(const geometry::Polygon& polygon, Point2 uphill, const Options& o) -> Slope {
  const auto sides = sides_of(polygon, o.side_turn);
  Slope out{polygon, uphill, 0, 0, 0};
  // Where two vertical sides meet lowest, no edge would sweep the plane: cut the corner off, level.
  const auto level = level_sides(sides, out.uphill, o);
  std::vector<geometry::Ring> rings(polygon.holes.size() + 1);
  std::size_t first = 0;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const auto& ring = ring_of(polygon, r);
    std::vector<bool> is_level(ring.size(), false);
    for (; first < sides.size() && sides[first].ring == r; ++first)
      for (std::size_t k = 0; k < sides[first].count; ++k)
        is_level[(sides[first].first + k) % ring.size()] = level[first];
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::size_t before = (i + ring.size() - 1) % ring.size();
      const Point2 p = ring[i], in = ring[before] - p, on = ring[(i + 1) % ring.size()] - p;
      const double up_in = dot(normalised(in), out.uphill), up_on = dot(normalised(on), out.uphill);
      if (is_level[i] || is_level[before] || up_in <= 0 || up_on <= 0 || cross(in, on) >= 0) {
        rings[r].push_back(p);
        continue;
      }
      const Point2 level_in = (1 / up_in) * normalised(in), level_on = (1 / up_on) * normalised(on);
      const double wide = length(level_on - level_in);  // of a cut one metre up
      const double up = std::min(
          {o.corner_cut / wide, o.corner_cut_share * dot(in, out.uphill), o.corner_cut_share * dot(on, out.uphill)});
      rings[r].push_back(p + up * level_in);
      rings[r].push_back(p + up * level_on);
      ++out.cut;
    }
  }
  out.polygon.outer = rings[0];
  out.polygon.holes.assign(rings.begin() + 1, rings.end());
  double high = -1e300;
  out.low = 1e300;
  for (const Point2 p : out.polygon.outer) {
    out.low = std::min(out.low, dot(p, out.uphill));
    high = std::max(high, dot(p, out.uphill));
  }
  out.run = high - out.low;
  return out;
}

auto apex_of(const geometry::Polygon& polygon, const std::vector<Side>& sides, const Options& o)
    -> std::optional<Point2> {
  if (!polygon.holes.empty()) return std::nullopt;
  const auto deepest = deepest_of(sides);
  const auto sees_all = [&](Point2 p, double enough) {
    return std::ranges::all_of(sides, [&](const Side& side) { return dot(p - side.start, side.inward) >= enough; });
  };
  if (deepest.distance < o.apex_distance || !sees_all(deepest.place, o.apex_distance / 2)) return std::nullopt;
  const Point2 origin = polygon.outer.front();
  Point2 sum;
  double doubled = 0;
  for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
    const Point2 a = polygon.outer[i] - origin, b = polygon.outer[(i + 1) % polygon.outer.size()] - origin;
    sum = sum + cross(a, b) * (a + b);
    doubled += cross(a, b);
  }
  const Point2 centroid = origin + (1 / (3 * doubled)) * sum;
  return sees_all(centroid, deepest.distance / 2) ? centroid : deepest.place;
}

}  // namespace mansard::roof::detail
