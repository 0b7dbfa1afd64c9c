// Roofs without a mesh: from a footprint's attributes to plan + profiles that can be extruded.
// References: OpenStreetMap wiki, "Simple 3D Buildings" (the tags and what they mean); T. Kelly, P. Wonka, Interactive
// Architectural Modeling with Procedural Extrusions, ACM TOG 30(2), 2011 (roofs as profiles of edges).
#pragma once

#include <array>
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

enum class Shape : std::uint8_t {
  flat,
  skillion,
  gabled,
  half_hipped,
  hipped,
  pyramidal,
  gambrel,
  mansard,
  saltbox,
  gabled_height_moved,
  bellcast_gable,
  side_hipped,
  side_half_hipped,
  hipped_and_gabled,
  round,
  cone,
  dome,
  onion,
  butterfly,
  sawtooth,
};
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
  double detail = 0.1;        ///< m; curved roofs are this near to their planes, or have 12 pitches
  double outline_cover = 0;   ///< share of an outline that its parts cover; less, and it is extruded beside them
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
  /// Share of a saltbox roof's width by which its lower eaves are farther from the ridge than its higher ones.
  double saltbox_shift = 0.4;
  double tooth = 6;  ///< m; length of a tooth of a sawtooth roof without roof:height
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// sRGB
using Colour = std::array<std::uint8_t, 3>;

/// The colours of a building's surfaces, and what these are made of in OpenStreetMap's words.
struct Paint {
  std::optional<Colour> wall, roof;
  std::string wall_material, roof_material;
  [[nodiscard]] auto empty() const -> bool { return !wall && !roof && wall_material.empty() && roof_material.empty(); }
};

/// The paint, and a warning for every value that could not be used, which names tag and value.
struct ReadPaint {
  Paint paint;
  std::vector<base::Diagnostic> warnings;
};

/// From building:colour, building:material, roof:colour and roof:material. A material gives the colour where no colour
/// is given. Never fails: what cannot be used is left out with "roof-value".
[[nodiscard]] auto paint_of(const model::Attributes& attributes, const Options& options) -> ReadPaint;

/// The attributes of a part with those of its outline that count for it: colours and materials that it lacks, and where
/// it has neither height nor levels all of the outline's that say a shape or a height.
[[nodiscard]] auto inherited(const model::Attributes& part, const model::Attributes& outline, const Options& options)
    -> model::Attributes;

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

/// The plans of a roof, side by side: one of most shapes, of a sawtooth one for each tooth, of a butterfly two.
/// Guarantees, warnings and errors of plan_of for each; a shape of several plans comes out of plan_of as the nearest
/// one of a single plan.
[[nodiscard]] auto plans_of(const geometry::Polygon& polygon, const Form& form, const Options& options = {},
                            const base::Run& run = {}) -> base::Result<std::vector<Planned>>;

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
