// The options and codes of the module.
#include <algorithm>

#include "mansard/roof/detail/shape_list.hpp"
#include "mansard/roof/detail/tags.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof {

auto to_string(Shape shape) -> std::string_view { return detail::info_of(shape).name; }

auto to_string(Source source) -> std::string_view {
  switch (source) {
    case Source::height: return "height";
    case Source::levels: return "levels";
    case Source::assumed: return "assumed";
  }
  return "";
}

auto option_list(Options& o) -> base::OptionList {
  std::vector<std::pair<std::string, Shape>> shapes;
  for (const auto& info : detail::shapes()) shapes.emplace_back(info.name, info.shape);
  base::OptionList list("roof");
  list.string("profile", o.profile,
              "One profile for every edge, \"0,0 0,6 4,9\" (inward,height); empty: by attributes.")
      .alias("profile")
      .source("none by default")
      .number("cap", o.cap, "m", {0.01, 2000}, "Height above the base at which a roof of roof.profile is cut off flat.")
      .choice("shape", o.shape, std::move(shapes), "Shape of roofs without roof:shape.")
      .source("OpenStreetMap wiki, Simple 3D Buildings: a building without roof:shape has a flat one")
      .number("default_height", o.default_height, "m", {0.1, 1500},
              "Height, roof included, of a building with neither height nor levels.")
      .alias("default_height")
      .source("two storeys")
      .number("level_height", o.level_height, "m", {1, 20}, "Height of a storey.")
      .alias("level_height")
      .source("OpenStreetMap wiki, Simple 3D Buildings: 3 m a level")
      .number("pitch", o.pitch, "rad", {0.01, 1.48}, "Pitch of roofs with neither roof:height nor roof:angle.")
      .alias("pitch")
      .source("30°, common in Europe; not measured")
      .number("most_share", o.most_share, "", {0.01, 0.99},
              "Maximum share of a building's height that a roof with neither roof:height nor roof:angle takes.")
      .source("chosen by hand; not measured")
      .number("half_hip", o.half_hip, "", {0.05, 0.95}, "Upright share of a half-hipped end.")
      .source("chosen by hand so that roofs look drawn; not measured")
      .number("detail", o.detail, "m", {0.001, 5},
              "Maximum distance between a curved roof (dome, onion, round) and its planes, unless it has 12 pitches.")
      .source("a tenth of a metre, what a survey of roofs resolves; chosen by hand")
      .number("outline_cover", o.outline_cover, "", {0, 1},
              "Share of an outline from which on its building:parts replace it; below, it is extruded beside them.")
      .source("OpenStreetMap wiki, Simple 3D Buildings: an outline with parts is not extruded")
      .number("ground", o.ground, "m", {-12000, 9000}, "z of the ground where no attribute gives it.")
      .source("zero of the vertical datum")
      .string("building_height_attribute", o.building_height_attribute, "Attribute to take as height.")
      .alias("height_attribute")
      .string("building_levels_attribute", o.building_levels_attribute, "Attribute to take as building:levels.")
      .alias("levels_attribute")
      .string("min_height_attribute", o.min_height_attribute, "Attribute to take as min_height.")
      .alias("min_height_attribute")
      .string("min_level_attribute", o.min_level_attribute, "Attribute to take as building:min_level.")
      .string("ground_attribute", o.ground_attribute, "Attribute with the z of the ground.")
      .alias("ground_attribute")
      .string("shape_attribute", o.shape_attribute, "Attribute to take as roof:shape.")
      .string("height_attribute", o.height_attribute, "Attribute to take as roof:height.")
      .string("levels_attribute", o.levels_attribute, "Attribute to take as roof:levels.")
      .string("angle_attribute", o.angle_attribute, "Attribute to take as roof:angle.")
      .string("orientation_attribute", o.orientation_attribute, "Attribute to take as roof:orientation.")
      .string("direction_attribute", o.direction_attribute, "Attribute to take as roof:direction.");
  list.number("side_turn", o.side_turn, "rad", {0, 0.5}, "Consecutive edges that turn by less than this are one side.")
      .advanced("chosen by hand; not measured");
  list.number("minimum_rise", o.minimum_rise, "m", {0.0001, 1}, "Minimum height of a roof, and of the wall under it.")
      .advanced("a centimetre: what surveys resolve");
  list.number("cap_clearance", o.cap_clearance, "m", {0.0001, 1}, "Height of the cap above the ridge.")
      .advanced("a centimetre, which no file shows: the roof closes below");
  list.number("wing_corner", o.wing_corner, "rad", {0, 1.5},
              "Maximum deviation from a right angle at the corners of a wing's end.")
      .advanced("chosen by hand; not measured");
  list.number("corner_cut", o.corner_cut, "m", {0.001, 5},
              "Width of the cut at a skillion roof's lowest corner, which makes an edge for the plane to start from.")
      .advanced("wider than extrude's tolerances; not measured");
  list.number("saltbox_shift", o.saltbox_shift, "", {0.05, 0.9},
              "Share of a saltbox roof's width by which one of its eaves is farther from the ridge than the other.")
      .advanced("chosen by hand so that roofs look drawn; not measured");
  list.number("tooth", o.tooth, "m", {1, 100}, "Length of a tooth of a sawtooth roof without roof:height.")
      .advanced("chosen by hand; not measured");
  list.number("apex_distance", o.apex_distance, "m", {0.001, 20},
              "Minimum distance between a pyramid's apex and the sides of its outline.")
      .advanced("chosen by hand; not measured");
  return list;
}

auto check_attributes(const model::Attributes& attributes, const Options& given) -> base::Result<void> {
  std::vector<std::string> known;
  for (const auto& [name, value] : attributes) {
    const auto word = detail::plain(name);
    if (word == "other_tags" || word == "all_tags" || word == "tags") return {};  // it may be in there
    known.push_back(name);
  }
  Options options = given;
  const auto list = option_list(options);
  for (const auto& option : list.options()) {
    const std::string wanted = option.name.ends_with("_attribute") ? option.get() : std::string();
    const auto named = [&](const std::string& name) { return detail::plain(name) == detail::plain(wanted); };
    if (wanted.empty() || std::ranges::any_of(known, named)) continue;
    std::string all;
    for (const auto& name : known) all += (all.empty() ? "" : ", ") + name;
    return base::error("roof-attribute",
                       "there is no attribute '" + wanted + "'" +
                           base::did_you_mean(base::nearest_word(wanted, known)) + "; the layer has: " + all,
                       "roof." + option.name);
  }
  return {};
}

auto codes() -> std::vector<base::Code> {
  std::string names;
  for (const auto& info : detail::shapes()) names += (names.empty() ? "" : ", ") + std::string(info.name);
  return {
      {"roof-profile", "The profile cannot be read, leans outwards or goes down.",
       "Write pairs inward,height in metres that never decrease, from 0,0: \"0,0 0,6 4,9\".", 4},
      {"roof-attribute", "An attribute that an option names is not in the layer.", "The message lists those that are.",
       4},
      {"roof-form", "A building has nothing between its base and its top, or a value that is not finite.",
       "Correct its height.", 1},
      {"roof-value", "A tag's value is no height, number, angle or word that it may have; it was left out.",
       "Correct the value in the source; the message names tag and value.", 0},
      {"roof-conflict", "Two tags of a building contradict each other; the one named was left out.",
       "Correct one of them in the source.", 0},
      {"roof-shape-unknown", "roof:shape has a value that is not made here; the nearest shape was taken.",
       "Nothing to do, or choose one of " + names + ".", 0},
      {"roof-assumed", "Buildings have neither height nor levels; their height was assumed.",
       "Say --default-height, or name the attribute with --height-attribute or --levels-attribute.", 0},
      {"roof-orientation", "The ridge cannot follow roof:orientation or roof:direction on this outline.",
       "Nothing to do: wings of such an outline have ridges of their own.", 0},
      {"roof-corner-cut", "Corners of an outline lie lowest under a skillion; 8 cm were cut off them.",
       "Give roof:direction at right angles to an edge to avoid it.", 0},
      {"roof-shape-here", "The outline does not take the roof's shape: no gable, or no apex that sees every edge.",
       "Split the building, or choose another shape; the message says what was made instead.", 1},
      {"roof-height", "A roof of this pitch would be higher than the building, so it was made lower.",
       "Correct roof:angle or height.", 1},
      {"roof-uncovered",
       "The building:parts of a building leave some of its outline without a model, or reach beyond it.",
       "Nothing to do where the source means that; else draw the missing part, or give --roof-outline-cover 0.9.", 0},
      {"roof-missed", "A roof was extruded, but its ridge is not at the requested height.",
       "Look for very small edges in the outline.", 1},
  };
}

}  // namespace mansard::roof
