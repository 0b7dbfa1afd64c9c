// The room's options and codes.
#include <algorithm>

#include "mansard/roof/detail/tags.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof {

auto to_string(Shape shape) -> std::string_view {
  switch (shape) {
    case Shape::flat: return "flat";
    case Shape::skillion: return "skillion";
    case Shape::gabled: return "gabled";
    case Shape::half_hipped: return "half-hipped";
    case Shape::hipped: return "hipped";
    case Shape::pyramidal: return "pyramidal";
    case Shape::gambrel: return "gambrel";
    case Shape::mansard: return "mansard";
  }
  return "";
}

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
  for (const auto shape : {Shape::flat, Shape::skillion, Shape::gabled, Shape::half_hipped, Shape::hipped,
                           Shape::pyramidal, Shape::gambrel, Shape::mansard})
    shapes.emplace_back(to_string(shape), shape);
  base::OptionList list("roof");
  list.string("profile", o.profile,
              "One profile for every edge, \"0,0 0,6 4,9\" (inward,height); empty: by attributes.")
      .alias("profile")
      .number("cap", o.cap, "m", {0.01, 2000}, "Height above the base at which a roof of roof.profile is cut off flat.")
      .choice("shape", o.shape, std::move(shapes), "Roof where there is no roof:shape.")
      .number("default_height", o.default_height, "m", {0.1, 1500},
              "Height, roof included, of a building with neither height nor levels.")
      .alias("default_height")
      .number("level_height", o.level_height, "m", {1, 20}, "Height of a storey.")
      .alias("level_height")
      .number("pitch", o.pitch, "rad", {0.01, 1.48}, "Of roofs with neither roof:height nor roof:angle.")
      .alias("pitch")
      .number("most_share", o.most_share, "", {0.01, 0.99}, "Such roofs take no more than this share of the height.")
      .number("half_hip", o.half_hip, "", {0.05, 0.95}, "Upright share of a half-hipped end.")
      .number("ground", o.ground, "m", {-12000, 9000}, "z of the ground where no attribute says it.")
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
       "Nothing to do, or choose one of flat, skillion, gabled, half-hipped, hipped, pyramidal, gambrel, mansard.", 0},
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
      {"roof-missed", "A roof was extruded, but its ridge is not at the requested height.",
       "Look for very small edges in the outline.", 1},
  };
}

}  // namespace mansard::roof
