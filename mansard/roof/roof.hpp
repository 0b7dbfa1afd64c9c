// Roofs without a mesh: from a footprint's attributes to plan + profiles that can be extruded.
// References: OpenStreetMap wiki, "Simple 3D Buildings" (the tags and what they mean); T. Kelly, P. Wonka, Interactive
// Architectural Modeling with Procedural Extrusions, ACM TOG 30(2), 2011 (roofs as profiles of edges).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/attributes.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::roof {

enum class Shape : std::uint8_t { flat, skillion, gabled, half_hipped, hipped, pyramidal, gambrel, mansard };
/// As OpenStreetMap writes it: "half-hipped".
[[nodiscard]] auto to_string(Shape shape) -> std::string_view;

enum class Orientation : std::uint8_t { along, across };  ///< of the ridge: along the longer side, or across it

/// Where a height comes from.
enum class Source : std::uint8_t { height, levels, assumed };
[[nodiscard]] auto to_string(Source source) -> std::string_view;

/// What is known of a building and its roof. Metres above the ground, radians.
struct Form {
  Shape shape = Shape::flat;
  double ground = 0;          ///< z of the ground, file frame
  double base = 0;            ///< where the building starts, ≥ 0
  double height = 6;          ///< of the top, or of the eaves where the roof comes on top of it
  bool roof_included = true;  ///< whether `height` is that of the top
  Source source = Source::assumed;
  std::optional<double> rise;   ///< of the roof alone, from eaves to ridge
  std::optional<double> angle;  ///< pitch; counts where there is no rise
  double pitch = 0.5236;        ///< where there is neither: this pitch …
  double most_share = 0.5;      ///< … but no more than this share of base to top
  std::optional<Orientation> orientation;
  std::optional<double> direction;  ///< clockwise from north: where the roof looks, which is down its slope
};

struct Options {
  std::string profile;        ///< "inward,height inward,height …" in metres for every edge; empty: by attributes
  std::optional<double> cap;  ///< m above the base; where a roof from `profile` is cut off flat
  Shape shape = Shape::flat;  ///< where there is no roof:shape
  double default_height = 6;  ///< m, roof included; where neither height nor levels are given
  double level_height = 3;    ///< m
  double pitch = 0.5236;      ///< rad; where neither roof:height nor roof:angle is given (30°)
  double most_share = 0.5;    ///< of the height; a roof without roof:height or roof:angle is no higher
  double half_hip = 0.5;      ///< of a half-hipped end's height; upright below it
  double ground = 0;          ///< m; z of the ground where no attribute says it

  /// Attributes to take instead of the well-known names.
  std::string building_height_attribute, building_levels_attribute, min_height_attribute, min_level_attribute,
      shape_attribute, height_attribute, levels_attribute, angle_attribute, orientation_attribute, direction_attribute,
      ground_attribute;

  // How outlines are read, and what the shapes look like.
  double side_turn = 0.026;     ///< rad, 1.5°; turns under this are none
  double minimum_rise = 0.01;   ///< m; a roof or a wall less high than this is none
  double cap_clearance = 0.01;  ///< m; the cap stands so much over the ridge, so as not to cut it
  /// Minimum share of its smallest box that an outline with a single ridge fills. Chosen by hand; not measured.
  double rectangle_fill = 0.9;
  double wing_corner = 0.35;  ///< rad; 90° ± 20°
  /// Minimum depth of a wing, as a share of its width. Chosen by hand; not measured.
  double wing_depth = 0.3;
  /// Minimum distance from the outline to the top of the triangle over a wing's end, as a share of the triangle's
  /// height. Chosen by hand; not measured.
  double wing_clearance = 0.95;
  /// Share of a gambrel roof's run that is its steep part. Chosen by hand so that roofs look drawn; not measured.
  double gambrel_run = 0.35;
  /// Share of a gambrel roof's height that is its steep part. Chosen by hand so that roofs look drawn; not measured.
  double gambrel_rise = 0.65;
  /// Share of a mansard roof's height that is its steep part. Chosen by hand so that roofs look drawn; not measured.
  double mansard_rise = 0.7;
  /// Maximum share of a mansard roof's run that is its steep part. Chosen by hand so that roofs look drawn; not
  /// measured.
  double mansard_run = 0.35;
  /// Slope of the steep part of a mansard roof. Chosen by hand so that roofs look drawn; not measured.
  double mansard_slope = 2.747;
  /// Cosine of the maximum angle between a side that is level in a skillion roof and the direction across its slope.
  /// Chosen by hand; not measured.
  double level_cosine = 0.99966;
  /// Cosine of the maximum angle between roof:direction and the edge that it is taken for. Chosen by hand; not
  /// measured.
  double direction_cosine = 0.966;
  double corner_cut = 0.08;  ///< m; width of the cut at a skillion's lowest corner
  /// Maximum share of the sides beside a skillion roof's lowest corner that is cut off. Chosen by hand; not measured.
  double corner_cut_share = 1.0 / 3;
  double apex_distance = 0.2;  ///< m; nearer to a side than this, its roof would be a wall
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// The form, and a warning for every value that could not be used, which names tag and value.
struct Read {
  Form form;
  std::vector<base::Diagnostic> warnings;
};

/// From a feature's attributes: OpenStreetMap's tags under their own names ("building:levels"), as OGR's drivers write
/// them ("building_levels", "building:l"), or inside hstore text ("other_tags"); or the attributes that options name.
/// Never fails: what cannot be used is left out with "roof-value", "roof-shape-unknown", "roof-conflict".
[[nodiscard]] auto form_of(const model::Attributes& attributes, const Options& options) -> Read;

/// A plan whose extrusion has the form's roof.
struct Planned {
  model::Plan plan;
  double top = 0;             ///< m above plan.base: where the highest ridge will be
  double flat_top = 0;        ///< m above plan.base: of the prism, where nothing else can be extruded
  bool as_asked = true;       ///< false where the outline or the height does not take the form; a warning says why
  Shape shape = Shape::flat;  ///< what it became
  std::vector<base::Diagnostic> warnings;
};

/// Guarantees: 1 the plan's polygon is the given one, but for corners cut off under a skillion (8 cm) · 2 where it is
/// raised in full, its highest point is at `top`: within a millimetre over square outlines, 5 mm over others, 5 cm for
/// pyramids over outlines with short edges · 3 speeds are never negative · 4 the same input
/// gives the same plan. Warns "roof-shape-here", "roof-height", "roof-orientation", "roof-corner-cut".
/// Fails with "roof-form" (not finite, or nothing between base and top).
/// Cost: outlines that are not convex are raised once with unit slopes to learn how high their ridge comes.
[[nodiscard]] auto plan_of(const geometry::Polygon& polygon, const Form& form, const Options& options = {},
                           const base::Run& run = {}) -> base::Result<Planned>;

/// "0,0 0,6 4,9" as a profile. Fails with "roof-profile".
[[nodiscard]] auto profile_of(std::string_view text) -> base::Result<model::Profile>;

/// The same profile for every edge, until the roofs meet, or up to `cap` metres above the base. A last part that is
/// upright or level ends where it ends.
[[nodiscard]] auto plan_along(const geometry::Polygon& polygon, const model::Profile& profile, const Form& form,
                              const Options& options) -> Planned;

/// Whether a layer with these attributes has all that options name. Fails with "roof-attribute".
[[nodiscard]] auto check_attributes(const model::Attributes& attributes, const Options& options) -> base::Result<void>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::roof
