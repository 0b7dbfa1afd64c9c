#include "mansard/roof/detail/shape_list.hpp"

#include <algorithm>
#include <array>

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

// OpenStreetMap's values that are not among the eight are taken for what they look like from afar.
constexpr std::array<std::string_view, 3> like_flat{"sawtooth", "butterfly", "terrace"};
constexpr std::array<std::string_view, 3> is_skillion{"lean_to", "shed", "monopitched"};
constexpr std::array<std::string_view, 1> like_skillion{"skillion_with_setback"};
constexpr std::array<std::string_view, 1> is_gabled{"gable"};
constexpr std::array<std::string_view, 6> like_gabled{"gabled_row",   "pitched",      "saltbox",
                                                      "cross_gabled", "crosspitched", "crossgabled"};
constexpr std::array<std::string_view, 2> is_half_hipped{"half_hipped", "halfhipped"};
constexpr std::array<std::string_view, 3> like_half_hipped{"side_half_hipped", "hipped_and_gabled",
                                                           "gabled_and_hipped"};
constexpr std::array<std::string_view, 1> is_hipped{"hip"};
constexpr std::array<std::string_view, 1> like_hipped{"side_hipped"};
constexpr std::array<std::string_view, 1> is_pyramidal{"pyramid"};
constexpr std::array<std::string_view, 8> like_pyramidal{"dome", "onion",     "cone",   "conical",
                                                         "bulb", "spherical", "tented", "helm"};
constexpr std::array<std::string_view, 3> like_gambrel{"round", "barrel", "double_saltbox"};
constexpr std::array<std::string_view, 1> like_mansard{"quadruple_saltbox"};

constexpr std::array all{
    ShapeInfo{Shape::flat, "flat", {}, like_flat, Ends::own, Shape::flat, nullptr},
    ShapeInfo{Shape::skillion, "skillion", is_skillion, like_skillion, Ends::own, Shape::skillion, nullptr},
    ShapeInfo{Shape::gabled, "gabled", is_gabled, like_gabled, Ends::upright, Shape::hipped, one_pitch},
    ShapeInfo{Shape::half_hipped, "half-hipped", is_half_hipped, like_half_hipped, Ends::half_upright, Shape::hipped,
              one_pitch},
    ShapeInfo{Shape::hipped, "hipped", is_hipped, like_hipped, Ends::move, Shape::hipped, one_pitch},
    ShapeInfo{Shape::pyramidal, "pyramidal", is_pyramidal, like_pyramidal, Ends::own, Shape::hipped, nullptr},
    ShapeInfo{Shape::gambrel, "gambrel", {}, like_gambrel, Ends::upright, Shape::mansard, gambrel},
    ShapeInfo{Shape::mansard, "mansard", {}, like_mansard, Ends::move, Shape::mansard, mansard},
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
