// The steps of a roof: what its sides do, how high that comes at unit slope, and the profiles that bring it to its
// height.
#include "mansard/roof/roof.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/roof/detail/shape_list.hpp"
#include "mansard/roof/detail/shapes.hpp"

namespace mansard::roof {
namespace {

using detail::on_wall;
using detail::Side;
using geometry::Point2;
using model::Profile;

/// A plan whose edges all have the first profile, until they are given others. Equal profiles are one.
class Draft {
 public:
  Draft(const geometry::Polygon& polygon, double base, Profile first) {
    plan_.base = base;
    plan_.profiles.push_back(std::move(first));
    plan_.outer = ring(polygon.outer);
    for (const auto& hole : polygon.holes) plan_.holes.push_back(ring(hole));
  }
  void give(const Side& side, const Profile& profile) {
    auto at = std::ranges::find(plan_.profiles, profile);
    if (at == plan_.profiles.end()) at = plan_.profiles.insert(at, profile);
    auto& of = side.ring == 0 ? plan_.outer : plan_.holes[side.ring - 1];
    for (std::size_t k = 0; k < side.count; ++k)
      of.profile_of_edge[(side.first + k) % of.points.size()] = static_cast<std::uint32_t>(at - plan_.profiles.begin());
  }
  [[nodiscard]] auto plan(double cap) && -> model::Plan {
    plan_.cap = cap;
    return std::move(plan_);
  }

 private:
  static auto ring(const geometry::Ring& points) -> model::PlanRing {
    return {points, std::vector<std::uint32_t>(points.size(), 0)};
  }
  model::Plan plan_;
};

auto upright(double height) -> Profile { return {{0, 0}, {0, height}}; }

/// What is wall and what is roof, in metres.
struct Heights {
  double wall = 0, rise = 0;
};

/// `run` is the horizontal distance over which the roof rises.
auto heights_of(const Form& form, double run, const Options& o, Planned& out) -> Heights {
  const double room = form.height - form.base;
  const bool given = form.rise || form.angle;
  const double usual = detail::info_of(form.shape).rise_of_run;
  double rise = form.rise                  ? *form.rise
                : form.angle || usual == 0 ? run * geometry::tangent(form.angle ? *form.angle : form.pitch)
                                           : run * usual;
  if (!form.roof_included) {
    if (!given && room > 0) rise = std::min(rise, room * form.most_share / (1 - form.most_share));
    return {room, rise};
  }
  if (!given) rise = std::min(rise, room * form.most_share);
  if (rise > room + o.minimum_rise) {
    const double lower = room * form.most_share;
    out.as_asked = false;
    out.warnings.push_back(base::warning("roof-height", "a roof of this pitch would be " + base::to_text(rise, 1) +
                                                            " m high, more than the building's " +
                                                            base::to_text(room, 1) + " m; it was made " +
                                                            base::to_text(lower, 1) + " m high"));
    rise = lower;
  }
  if (room - rise < o.minimum_rise) rise = room;  // no wall a centimetre high
  return {room - rise, rise};
}

void make_flat(const geometry::Polygon& polygon, double top, Planned& out) {
  out.shape = Shape::flat;
  out.top = out.flat_top = top;
  out.plan = Draft(polygon, out.plan.base, upright(top)).plan(top);
}

/// A plane that is `wall` high where uphill · p is `low`, and `rise` higher after `run`.
struct Plane {
  double low = 0, run = 0, wall = 0, rise = 0;
};

void make_plane(const detail::Slope& slope, const Plane& plane, const Options& o, Planned& out) {
  if (slope.cut > 0)
    out.warnings.push_back(
        base::warning("roof-corner-cut",
                      std::to_string(slope.cut) + " low corners were cut off by 8 cm, for the plane to start from"));
  const auto& [low, run, wall, rise] = plane;
  const double steep = rise / run, top = wall + steep * (slope.low + slope.run - low);
  Draft draft(slope.polygon, out.plan.base, upright(top));
  const auto sides = detail::sides_of(slope.polygon, o.side_turn);
  const auto level = detail::level_sides(sides, slope.uphill, o);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!level[i]) continue;
    // Edges that start higher in the same plane stand on a wall up to there.
    const double above = steep * (dot(0.5 * (sides[i].start + sides[i].end), slope.uphill) - low);
    const double foot = wall + above < o.minimum_rise / 10 ? 0 : wall + above;
    if (foot < top - o.minimum_rise) draft.give(sides[i], on_wall(foot, {{run, rise}}));
  }
  out.plan = std::move(draft).plan(top + o.cap_clearance);
}

void make_skillion(const geometry::Polygon& polygon, const Form& form, const Options& o, Planned& out) {
  const auto slope = detail::slope_of(polygon, form, o);
  const auto [wall, rise] = heights_of(form, slope.run, o, out);
  if (rise < o.minimum_rise) return make_flat(polygon, wall + rise, out);
  make_plane(slope, {slope.low, slope.run, wall, rise}, o, out);
}

void make_around_apex(const geometry::Polygon& polygon, Point2 apex, const std::vector<Side>& sides, const Form& form,
                      const Options& o, Planned& out) {
  const auto distance = [&](const Side& side) {
    // The line through the middle of the side: its ends may bulge a little.
    return std::round(dot(apex - 0.5 * (side.start + side.end), side.inward) * 1e4) / 1e4;
  };
  double nearest = distance(sides.front()), farthest = nearest;
  for (const Side& side : sides) {
    nearest = std::min(nearest, distance(side));
    farthest = std::max(farthest, distance(side));
  }
  const auto [wall, rise] = heights_of(form, nearest, o, out);
  if (rise < o.minimum_rise) return make_flat(polygon, wall + rise, out);
  const auto profile = [&, wall = wall, rise = rise](const Side& side) {
    return detail::info_of(form.shape).profile({wall, distance(side), rise, farthest}, o);
  };
  Draft draft(polygon, out.plan.base, profile(sides.front()));
  for (const Side& side : sides) draft.give(side, profile(side));
  out.plan = std::move(draft).plan(wall + rise + o.cap_clearance);
}

void make_swept(const geometry::Polygon& polygon, const std::vector<Side>& sides, const Form& form, const Options& o,
                const base::Run& run, Planned& out) {
  auto design = detail::design_of(polygon, sides, form, o);
  out.shape = design.shape;
  out.as_asked = out.as_asked && design.as_asked;
  out.warnings.insert(out.warnings.end(), design.warnings.begin(), design.warnings.end());
  auto crest = detail::crest_of(polygon, sides, design.sweeps, run);
  if (!crest || *crest < o.minimum_rise) {
    out.as_asked = false;
    out.warnings.push_back(base::warning("roof-shape-here", "no roof could be raised over this outline; made flat"));
    const double top = form.height - form.base + (form.roof_included ? 0 : form.rise.value_or(0));
    return make_flat(polygon, top, out);
  }
  const auto [wall, rise] = heights_of(form, *crest, o, out);
  if (rise < o.minimum_rise) return make_flat(polygon, wall + rise, out);
  const auto plan_with = [&, wall = wall, top = wall + rise](double height) {
    const double steep = height / *crest, share = o.half_hip;
    Draft draft(polygon, out.plan.base, detail::info_of(design.shape).profile({wall, *crest, height}, o));
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const auto& sweep = design.sweeps[i];
      if (design.half_move[i])
        draft.give(sides[i], on_wall(wall, {{share * *crest, share * height}, {share * *crest, height}}));
      else if (!sweep.moves) draft.give(sides[i], upright(wall + height));
      else if (design.half_way[i]) draft.give(sides[i], on_wall(wall + height / 2, {{*crest, height / 2}}));
      else if (sweep.lag > 0) draft.give(sides[i], on_wall(wall + steep * sweep.lag, {{*crest, height}}));
    }
    return std::move(draft).plan(top + o.cap_clearance);
  };
  out.plan = plan_with(rise);
  if (std::ranges::find(design.half_move, true) == design.half_move.end()) return;
  // Ends that move a little can take away where the ridge would be highest; all heights of the roof scale alike.
  const auto made = extrude::crest(out.plan, {}, run);
  if (made && *made - wall > o.minimum_rise && *made < wall + rise - o.minimum_rise)
    out.plan = plan_with(rise * rise / (*made - wall));
}

auto sound(const geometry::Polygon& polygon, const Form& form) -> bool {
  const double room = form.height - form.base;
  const bool finite = std::isfinite(form.height) && std::isfinite(form.base) && std::isfinite(form.ground) &&
                      std::isfinite(form.rise.value_or(0)) && std::isfinite(form.angle.value_or(0));
  const bool filled = room > 0 || (room == 0 && !form.roof_included && form.shape != Shape::flat);
  return finite && filled && polygon.outer.size() >= 3;
}

}  // namespace

auto plan_of(const geometry::Polygon& polygon, const Form& given, const Options& o, const base::Run& run)
    -> base::Result<Planned> {
  if (!sound(polygon, given))
    return base::error("roof-form", "there is nothing between base (" + base::to_text(given.base, 2) + " m) and top (" +
                                        base::to_text(given.height, 2) + " m)");
  Planned out;
  Form form = given;
  const auto make_instead = [&](Shape shape, const std::string& why) {
    out.as_asked = false;
    out.warnings.push_back(base::warning("roof-shape-here", why + "; made " + std::string(to_string(shape)) +
                                                                " instead of " + std::string(to_string(form.shape))));
    form.shape = shape;
  };
  if (detail::is_of_several(form.shape) && form.rise.value_or(1) >= o.minimum_rise)
    make_instead(detail::info_of(form.shape).without_ends, "this roof takes several plans");
  out.shape = form.shape;
  out.plan.base = form.ground + form.base;
  const auto sides = detail::sides_of(polygon, o.side_turn);
  const auto apex = [&] {
    return detail::info_of(form.shape).ends == detail::Ends::apex ? detail::apex_of(polygon, sides, o) : std::nullopt;
  };
  if (form.shape == Shape::flat || form.rise.value_or(1) < o.minimum_rise) {
    make_flat(polygon, form.height - form.base, out);
  } else if (form.shape == Shape::skillion) {
    make_skillion(polygon, form, o, out);
  } else if (const auto at = apex()) {
    make_around_apex(polygon, *at, sides, form, o, out);
  } else {
    make_swept(polygon, sides, form, o, run, out);
  }
  if (form.shape == Shape::onion && out.shape == Shape::onion) {
    out.as_asked = false;
    out.warnings.push_back(base::warning(
        "roof-shape-here", "the foot of an onion would overhang; made an onion from its largest ring up"));
  }
  if (out.shape != Shape::flat) out.top = out.flat_top = out.plan.cap - o.cap_clearance;
  if (out.top <= 0) return base::error("roof-form", "neither walls nor roof have a height");
  return out;
}

namespace {

/// A strip of an outline between two lines across `up`.
auto strip_of(const geometry::Polygon& polygon, Point2 up, double from, double to)
    -> base::Result<std::vector<geometry::Polygon>> {
  const Point2 along = left_of(up);
  double least = 1e300, most = -1e300;
  for (const Point2 p : polygon.outer) {
    least = std::min(least, dot(p, along) - 1);
    most = std::max(most, dot(p, along) + 1);
  }
  const auto at = [&](double u, double v) { return u * up + v * along; };
  return geometry::intersect(polygon,
                             geometry::Polygon{{at(from, least), at(to, least), at(to, most), at(from, most)}, {}});
}

/// One strip with the direction in which its plane rises.
struct Strip {
  Point2 uphill;
  double from = 0, to = 0;  ///< m; along uphill
};

/// Planes side by side, each over a strip of the outline. None where the outline cannot be cut.
auto in_strips(const geometry::Polygon& polygon, const Form& form, const std::vector<Strip>& strips, const Options& o)
    -> base::Result<std::vector<Planned>> {
  std::vector<Planned> all;
  const double run = strips.front().to - strips.front().from;
  for (const auto& [uphill, from, to] : strips) {
    const auto pieces = strip_of(polygon, uphill, from, to);
    if (!pieces) return pieces.failure();
    for (const auto& piece : *pieces) {
      constexpr double least = 0.01;  // m²; what is less is rounding
      if (geometry::area(piece) < least) continue;
      Planned out;
      out.shape = form.shape;
      out.plan.base = form.ground + form.base;
      const auto [wall, rise] = heights_of(form, run, o, out);
      if (rise < o.minimum_rise) make_flat(piece, wall + rise, out);
      else make_plane(detail::slope_along(piece, uphill, o), {from, run, wall, rise}, o, out);
      if (out.shape != Shape::flat) out.top = out.flat_top = out.plan.cap - o.cap_clearance;
      if (out.top <= 0) return base::error("roof-form", "neither walls nor roof have a height");
      all.push_back(std::move(out));
    }
  }
  return all;
}

/// Where the planes of a butterfly or of the teeth of a sawtooth are.
auto strips_of(const geometry::Polygon& polygon, const Form& form, const Options& o) -> std::vector<Strip> {
  const auto extent = detail::extent_of(detail::sides_of(polygon, o.side_turn));
  const Point2 axis = detail::ridge_axis(extent, form);
  Point2 up = left_of(axis);
  if (form.direction && dot(up, detail::pointing(*form.direction)) > 0) up = -1.0 * up;
  double least = 1e300, most = -1e300;
  for (const Point2 p : polygon.outer) {
    least = std::min(least, dot(p, up));
    most = std::max(most, dot(p, up));
  }
  if (form.shape == Shape::butterfly) {
    const double middle = (least + most) / 2;
    return {{up, middle, most}, {-1.0 * up, -middle, -least}};
  }
  constexpr double narrowest = 1, most_teeth = 12;  // m, and as many as a curve has pitches
  const double usual = form.rise ? *form.rise / geometry::tangent(form.angle ? *form.angle : form.pitch) : o.tooth;
  const double length = std::max(usual, narrowest);
  const auto teeth = static_cast<int>(
      std::clamp(std::round((most - least) / length), 1.0, std::min(most_teeth, std::max(1.0, most - least))));
  std::vector<Strip> out;
  const auto at = [&](int i) { return least + (most - least) * i / teeth; };
  for (int i = 0; i < teeth; ++i) out.push_back({up, at(i), at(i + 1)});
  return out;
}

}  // namespace

auto plans_of(const geometry::Polygon& polygon, const Form& form, const Options& o, const base::Run& run)
    -> base::Result<std::vector<Planned>> {
  if (detail::is_of_several(form.shape) && sound(polygon, form) && form.rise.value_or(1) >= o.minimum_rise)
    if (auto planned = in_strips(polygon, form, strips_of(polygon, form, o), o); planned && !planned->empty())
      return planned;
  auto one = plan_of(polygon, form, o, run);
  if (!one) return one.failure();
  return std::vector<Planned>{std::move(*one)};
}

auto profile_of(std::string_view text) -> base::Result<Profile> {
  const auto refuse = [&](const std::string& what) {
    return base::error("roof-profile", "\"" + base::on_one_line(std::string(text)) + "\" " + what, "roof.profile");
  };
  Profile profile;
  for (std::size_t at = 0; (at = text.find_first_not_of(" ;\t", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(" ;\t", at), text.size());
    const auto pair = text.substr(at, end - at);
    const auto comma = pair.find(',');
    const auto inward = base::to_number(pair.substr(0, comma));
    const auto height = comma == std::string_view::npos ? std::nullopt : base::to_number(pair.substr(comma + 1));
    if (!inward || !height) return refuse("has '" + std::string(pair) + "', which is no pair inward,height");
    if (std::abs(*inward) > 1e4 || std::abs(*height) > 1e4) return refuse("has a number beyond 10000 m");
    const model::ProfilePoint point{*inward, *height};
    if (profile.empty() && point != model::ProfilePoint{}) profile.push_back({});
    if (!profile.empty() && point == profile.back()) return refuse("repeats '" + std::string(pair) + "'");
    if (!profile.empty() && point.inward < profile.back().inward)
      return refuse("goes outward at '" + std::string(pair) + "'");
    if (!profile.empty() && point.height < profile.back().height)
      return refuse("goes down at '" + std::string(pair) + "'");
    profile.push_back(point);
    at = end;
  }
  if (profile.size() < 2 || profile.back().height <= 0) return refuse("has no height; write \"0,0 0,6 4,9\"");
  return profile;
}

auto plan_along(const geometry::Polygon& polygon, const Profile& profile, const Form& form, const Options& o)
    -> Planned {
  Planned out;
  const auto &last = profile.back(), &before = profile[profile.size() - 2];
  const double rise = last.height - before.height, run = last.inward - before.inward;
  out.flat_top = out.top = last.height;
  if (rise > 0 && run > 0) {
    // Every edge moves alike, so the outline is used up where the smallest box around it is.
    const auto extent = detail::extent_of(detail::sides_of(polygon, o.side_turn));
    out.top = std::max(last.height, before.height + (extent.width / 2 - before.inward) * rise / run) + o.cap_clearance;
  }
  if (o.cap) out.top = std::min(out.top, *o.cap);
  out.flat_top = std::min(out.flat_top, out.top);
  out.plan = Draft(polygon, form.ground + form.base, profile).plan(out.top);
  return out;
}

}  // namespace mansard::roof
