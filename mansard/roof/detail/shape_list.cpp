#include "mansard/roof/detail/shape_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mansard/geometry/angles.hpp"

namespace mansard::roof::detail {

auto on_wall(double wall, std::initializer_list<model::ProfilePoint> above) -> model::Profile {
  model::Profile profile{{0, 0}};
  if (wall > 0) profile.push_back({0, wall});
  for (const auto& point : above) profile.push_back({point.inward, wall + point.height});
  return profile;
}

namespace {

using Names = std::span<const std::string_view>;

auto one_pitch(const Pitch& p, const Options&) -> model::Profile { return on_wall(p.wall, {{p.run, p.rise}}); }

auto gambrel(const Pitch& p, const Options& o) -> model::Profile {
  return on_wall(p.wall, {{o.gambrel_run * p.run, o.gambrel_rise * p.rise}, {p.run, p.rise}});
}

auto mansard(const Pitch& p, const Options& o) -> model::Profile {
  const double lower = o.mansard_rise * p.rise;
  return on_wall(p.wall, {{std::min(lower / o.mansard_slope, o.mansard_run * p.run), lower}, {p.run, p.rise}});
}

constexpr double quarter = std::numbers::pi / 2;

/// How many chords an arc takes so that none is farther from it than `detail`; an ellipse as a circle of its longer
/// half axis.
auto chords_of(double radius, double arc, const Options& o) -> int {
  constexpr int least = 2, most = 12;
  radius = std::max(radius, o.detail);
  return std::clamp(static_cast<int>(std::ceil(arc / (2 * geometry::arc_cosine(1 - o.detail / radius)) - 1e-9)), least,
                    most);
}

/// A profile along a curve: `at` gives the shares of run and rise from 0 to 1.
template <class At>
auto along(const Pitch& p, int pitches, At at) -> model::Profile {
  model::Profile profile = on_wall(p.wall, {});
  for (int i = 1; i < pitches; ++i) {
    const model::ProfilePoint share = at(static_cast<double>(i) / pitches);
    profile.push_back({p.run * share.inward, p.wall + p.rise * share.height});
  }
  profile.push_back({p.run, p.wall + p.rise});
  return profile;
}

/// A quarter of an ellipse, upright at the eaves and level at the top.
auto dome(const Pitch& p, const Options& o) -> model::Profile {
  return along(p, chords_of(std::max({p.run, p.longest, p.rise}), quarter, o), [](double t) {
    return model::ProfilePoint{1 - geometry::cosine(quarter * t), geometry::sine(quarter * t)};
  });
}

/// The arc of a circle from the eaves to the level at the ridge; where the roof is higher than half of its width a
/// quarter of an ellipse.
auto round(const Pitch& p, const Options& o) -> model::Profile {
  if (p.rise >= p.run) return dome(p, o);
  const double radius = (p.run * p.run + p.rise * p.rise) / (2 * p.rise);
  const double arc = geometry::arc_tangent(p.run, radius - p.rise);
  return along(p, chords_of(radius, arc, o), [&](double t) {
    const double left = arc * (1 - t);
    return model::ProfilePoint{1 - radius * geometry::sine(left) / p.run,
                               1 - radius * (1 - geometry::cosine(left)) / p.rise};
  });
}

/// An onion from its largest ring on, as the foot below it would overhang: a quarter of an ellipse up to 60 % of the
/// height, then a spire that is hollow.
auto onion(const Pitch& p, const Options& o) -> model::Profile {
  constexpr double neck = 0.25, shoulder = 0.6;  // shares of run and rise where the bulb ends and the spire begins
  const int bulb = std::max(2, chords_of(std::max({p.run, p.longest, p.rise}), quarter, o) * 2 / 3),
            spire = std::max(2, bulb / 2);
  return along(p, bulb + spire, [&](double t) {
    const double at = t * (bulb + spire);
    if (at <= bulb) {
      const double turned = quarter * at / bulb;
      return model::ProfilePoint{(1 - neck) * (1 - geometry::cosine(turned)), shoulder * geometry::sine(turned)};
    }
    const double left = 1 - (at - bulb) / spire;
    return model::ProfilePoint{1 - neck * left * left, 1 - (1 - shoulder) * left};
  });
}

/// Shallow at the eaves, then steep.
auto bellcast(const Pitch& p, const Options&) -> model::Profile {
  constexpr double run = 0.3, rise = 0.15;  // shares of the flared part; chosen by hand so that roofs look drawn
  return on_wall(p.wall, {{run * p.run, rise * p.rise}, {p.run, p.rise}});
}

// Other names of the shapes; and OpenStreetMap's values that are not among them, taken for what they look like from
// afar.
constexpr std::array<std::string_view, 3> like_flat{"terrace", "many", "complex"};
constexpr std::array<std::string_view, 4> is_skillion{"lean_to", "shed", "monopitched", "mono_pitched"};
constexpr std::array<std::string_view, 1> like_skillion{"skillion_with_setback"};
constexpr std::array<std::string_view, 2> is_gabled{"gable", "pitched"};
constexpr std::array<std::string_view, 5> like_gabled{"gabled_row", "cross_gabled", "crosspitched", "cross_pitched",
                                                      "crossgabled"};
constexpr std::array<std::string_view, 2> is_half_hipped{"half_hipped", "halfhipped"};
constexpr std::array<std::string_view, 1> is_hipped{"hip"};
constexpr std::array<std::string_view, 2> is_pyramidal{"pyramid", "tented"};
constexpr std::array<std::string_view, 1> like_pyramidal{"helm"};
constexpr std::array<std::string_view, 1> like_gambrel{"double_saltbox"};
constexpr std::array<std::string_view, 1> like_mansard{"quadruple_saltbox"};
constexpr std::array<std::string_view, 1> is_bellcast{"bellcast"};
constexpr std::array<std::string_view, 1> is_side_half_hipped{"side_half_hipped"};
constexpr std::array<std::string_view, 4> is_hipped_and_gabled{"hipped_and_gabled", "gabled_and_hipped", "dutch_gable",
                                                               "gablet"};
constexpr std::array<std::string_view, 1> is_round{"barrel"};
constexpr std::array<std::string_view, 1> is_cone{"conical"};
constexpr std::array<std::string_view, 1> is_dome{"spherical"};
constexpr std::array<std::string_view, 1> like_onion{"bulb"};

constexpr std::array all{
    ShapeInfo{Shape::flat, "flat", {}, like_flat, Ends::own, Shape::flat, nullptr},
    ShapeInfo{Shape::skillion, "skillion", is_skillion, like_skillion, Ends::own, Shape::skillion, nullptr},
    ShapeInfo{Shape::gabled, "gabled", is_gabled, like_gabled, Ends::upright, Shape::hipped, one_pitch},
    ShapeInfo{Shape::half_hipped, "half-hipped", is_half_hipped, {}, Ends::half_upright, Shape::hipped, one_pitch},
    ShapeInfo{Shape::hipped, "hipped", is_hipped, {}, Ends::move, Shape::hipped, one_pitch},
    ShapeInfo{Shape::pyramidal, "pyramidal", is_pyramidal, like_pyramidal, Ends::apex, Shape::hipped, one_pitch},
    ShapeInfo{Shape::gambrel, "gambrel", {}, like_gambrel, Ends::upright, Shape::mansard, gambrel},
    ShapeInfo{Shape::mansard, "mansard", {}, like_mansard, Ends::move, Shape::mansard, mansard},
    ShapeInfo{Shape::saltbox, "saltbox", {}, {}, Ends::upright, Shape::gabled, one_pitch, Opposite::higher},
    ShapeInfo{Shape::gabled_height_moved,
              "gabled_height_moved",
              {},
              {},
              Ends::upright,
              Shape::gabled,
              one_pitch,
              Opposite::half_way},
    ShapeInfo{Shape::bellcast_gable, "bellcast_gable", is_bellcast, {}, Ends::upright, Shape::hipped, bellcast},
    ShapeInfo{Shape::side_hipped, "side_hipped", {}, {}, Ends::one_move, Shape::hipped, one_pitch},
    ShapeInfo{Shape::side_half_hipped,
              "side_half-hipped",
              is_side_half_hipped,
              {},
              Ends::one_half_upright,
              Shape::hipped,
              one_pitch},
    ShapeInfo{Shape::hipped_and_gabled,
              "hipped-and-gabled",
              is_hipped_and_gabled,
              {},
              Ends::half_move,
              Shape::hipped,
              one_pitch},
    ShapeInfo{Shape::round, "round", is_round, {}, Ends::upright, Shape::hipped, round},
    ShapeInfo{Shape::cone, "cone", is_cone, {}, Ends::apex, Shape::hipped, one_pitch},
    ShapeInfo{Shape::dome, "dome", is_dome, {}, Ends::apex, Shape::dome, dome, Opposite::same, 1},
    ShapeInfo{Shape::onion, "onion", {}, like_onion, Ends::apex, Shape::onion, onion, Opposite::same, 1.5},
    ShapeInfo{Shape::butterfly, "butterfly", {}, {}, Ends::own, Shape::flat, nullptr},
    ShapeInfo{Shape::sawtooth, "sawtooth", {}, {}, Ends::own, Shape::skillion, nullptr},
};

constexpr auto in_order() -> bool {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].shape != static_cast<Shape>(i)) return false;
  return true;
}
static_assert(in_order(), "every shape has a row, in the order of Shape");

}  // namespace

auto shapes() -> std::span<const ShapeInfo> { return all; }

auto info_of(Shape shape) -> const ShapeInfo& { return all[static_cast<std::size_t>(shape)]; }

}  // namespace mansard::roof::detail
