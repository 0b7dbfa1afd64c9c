// Names, options, presets and codes of the module.
#include <algorithm>
#include <array>

#include "lab/simulate/simulate.hpp"

namespace mansard::simulate {
namespace {

constexpr std::array kinds{std::pair{Kind::terrace, "terrace"}, std::pair{Kind::perimeter, "perimeter"},
                           std::pair{Kind::courtyard, "courtyard"}, std::pair{Kind::towers, "towers"},
                           std::pair{Kind::detached, "detached"}};

}  // namespace

auto to_string(Kind kind) -> std::string_view { return kinds[static_cast<std::size_t>(kind)].second; }

auto kind_of(std::string_view name) -> std::optional<Kind> {
  const auto at = std::ranges::find(kinds, name, &std::pair<Kind, const char*>::second);
  return at == kinds.end() ? std::nullopt : std::optional(at->first);
}

auto to_string(Class kind) -> std::string_view {
  static constexpr std::array names{"wall", "roof", "ground", "other"};
  return names[static_cast<std::size_t>(kind)];
}

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("simulate");
  auto& block = o.block;
  auto& survey = o.survey;
  auto& scan = o.scan;
  list.integer("seed", o.seed, "", {0, 1e15},
               "Seed of everything that is generated; the same seed gives the same bytes.")
      .alias("seed");
  list.number("size", block.size, "m", {20, 400}, "About the length of the block's street front.")
      .number("turn", block.turn, "rad", {-7, 7}, "Turns the street off the x axis; drawn where it is not given.")
      .number("slope", block.slope, "", {-0.3, 0.3}, "Metres that the street falls per metre.")
      .number("equal_heights", block.equal_heights, "", {0, 1}, "Share of neighbours with eaves at one height.")
      .number("annexes", block.annexes, "", {0, 1}, "Share of houses with something lower at the back.")
      .number("alike", block.alike, "", {0, 1}, "Share of rows in which all houses are alike.")
      .number("dormers", block.dormers, "", {0, 1}, "Share of the slopes of gabled houses with a row of dormers.")
      .number("plant_rooms", block.plant_rooms, "", {0, 1}, "Share of flat roofs with a plant room.")
      .number("bays", block.bays, "", {0, 1}, "Share of houses with a bay window.")
      .number("extensions", block.extensions, "", {0, 1},
              "Share of houses without annex that have a rear extension, 0.8 to 2.4 m deep.")
      .number("overhang", block.overhang, "m", {0, 2}, "How far the eaves of pitched roofs overhang.");
  list.number("displacement", survey.displacement, "m", {0, 20}, "All outlines are moved by this in one direction.")
      .number("direction", survey.direction, "rad", {-7, 7},
              "Direction of that displacement, from the x axis; drawn where it is not given.")
      .number("jitter", survey.jitter, "m", {0, 5}, "Every corner of an outline is moved by up to this.")
      .number("generalise", survey.generalise, "m", {0, 5}, "Corners of outlines flatter than this are left out.")
      .number("eaves", survey.eaves, "m", {0, 3}, "Outlines are drawn so much larger, but for party walls.")
      .number("merged", survey.merged, "", {0, 1}, "Share of party walls across which two houses are one feature.");
  list.flag("heights", survey.heights, "Outlines have the height of the building as an attribute, to 0.1 m.");
  list.number("resolution", scan.resolution, "m", {0.05, 5}, "Edge length of the mesh.")
      .alias("resolution")
      .number("melt", scan.melt, "m", {0, 3}, "Standard deviation of the smoothing that rounds corners and edges.")
      .number("noise", scan.noise, "m", {0, 2}, "Root mean square of the noise along the normal.")
      .number("noise_length", scan.noise_length, "m", {0, 100},
              "Wavelength of the noise; 0 is noise that is independent from vertex to vertex.")
      .number(
          "noise_hidden", scan.noise_hidden, "", {0, 10},
          "How much stronger noise and bulge are where no camera sees: 1 doubles them, 0 makes them equal everywhere.")
      .number("bulge", scan.bulge, "m", {0, 2}, "Root mean square of a longer wave of walls.")
      .number("bulge_length", scan.bulge_length, "m", {0.1, 100}, "Wavelength of that.")
      .number("holes", scan.holes, "", {0, 1}, "Share of the walls' area lost where few cameras see.")
      .number("camera_tilt", scan.camera_tilt, "rad", {0, 1.5}, "Tilt of the cameras from straight down.")
      .number("missing_walls", scan.missing_walls, "", {0, 1}, "Probability that a wall was not matched.")
      .number("missing_share", scan.missing_share, "", {0, 1}, "How much of its height such a wall lacks, from below.")
      .number("trees", scan.trees, "", {0, 100}, "Per 1000 m² of open ground.")
      .number("cars", scan.cars, "", {0, 100}, "Per 1000 m² of open ground.")
      .number("chimneys", scan.chimneys, "", {0, 1}, "Probability per building.")
      .number("crowns", scan.crowns, "", {0, 1},
              "Probability per building of a tree beside it with its crown over the roof.")
      .number(
          "roof_trees", scan.roof_trees, "", {0, 1},
          "Probability per building of a tree within its outline, as in a yard that the survey takes for a building.")
      .number("ground_waves", scan.ground_waves, "m", {0, 5}, "Root mean square of the ground's bumps.")
      .number("ground_length", scan.ground_length, "m", {1, 1000}, "Wavelength of the ground's bumps.")
      .number("seam", scan.seam, "m", {0, 5}, "Largest step, in each direction, between tiles of the mesh.")
      .number("tile", scan.tile, "m", {5, 10000}, "Side of a tile.")
      .number("margin", scan.margin, "m", {1, 100}, "Ground around the buildings.")
      .flag("height_field", scan.height_field, "2.5-D: one height per place, as laser scans from above give.")
      .flag("exact", scan.exact,
            "The scan has the faces of the buildings themselves, unless noise, losses or objects are set.")
      .number("points_noise", scan.points_noise, "m", {0, 5},
              "Standard deviation of the height of each point of --points, independent of the others.")
      .number("points_noise_plan", scan.points_noise_plan, "m", {0, 5},
              "Standard deviation of the x and the y of each point of --points, independent of the others.")
      .number("faults", scan.faults, "", {0, 1},
              "Share of buildings of which scan or footprint have a fault each, as surveys have them; truth.json lists "
              "them.");
  return list;
}

auto presets() -> const std::vector<Preset>& {
  static const std::vector<Preset> all{
      {"clean",
       "a perfect scan: the faces of the buildings themselves, with level ground around and nothing else",
       {{"simulate.exact", "true"},
        {"simulate.melt", "0"},
        {"simulate.noise", "0"},
        {"simulate.bulge", "0"},
        {"simulate.holes", "0"},
        {"simulate.missing_walls", "0"},
        {"simulate.trees", "0"},
        {"simulate.cars", "0"},
        {"simulate.chimneys", "0"},
        {"simulate.ground_waves", "0"},
        {"simulate.seam", "0"}}},
      {"nadir-drone",
       "a drone with vertical cameras: sharp roofs, rounded walls with many holes",
       {{"simulate.resolution", "0.2"},
        {"simulate.melt", "0.2"},
        {"simulate.noise", "0.03"},
        {"simulate.noise_length", "0.8"},
        {"simulate.bulge", "0.08"},
        {"simulate.bulge_length", "4"},
        {"simulate.holes", "0.2"},
        {"simulate.camera_tilt", "0.35"},
        {"simulate.missing_walls", "0.15"},
        {"simulate.missing_share", "0.6"}}},
      {"oblique-aerial",
       "an aeroplane with oblique cameras: all sides seen, coarser and softer",
       {{"simulate.resolution", "0.4"},
        {"simulate.melt", "0.35"},
        {"simulate.noise", "0.06"},
        {"simulate.noise_length", "2"},
        {"simulate.bulge", "0.06"},
        {"simulate.holes", "0.07"},
        {"simulate.camera_tilt", "0.8"},
        {"simulate.missing_walls", "0.03"}}},
      {"lidar-2.5d",
       "a laser scan from above as a height field: no walls but steep triangles",
       {{"simulate.height_field", "true"},
        {"simulate.resolution", "0.35"},
        {"simulate.noise", "0.02"},
        {"simulate.noise_length", "0.6"},
        {"simulate.bulge", "0"},
        {"simulate.holes", "0"},
        {"simulate.missing_walls", "0"},
        {"simulate.seam", "0.02"}}},
  };
  return all;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"simulate-solid", "A generated building could not be extruded.",
       "This is a fault of the program: please report it with kind, options and seed. Another --seed gets around it.",
       70},
      {"simulate-nothing", "There is nothing to simulate: no usable footprint, or a model without solids.",
       "Give footprints with area, or a plans.json or model.city.json with parts.", 5},
      {"simulate-model-ground", "Buildings of a model have no ground faces.",
       "Their outlines are what is seen of them from above, and their base is at their lowest corner. Label the ground "
       "faces in the model if that is not right, as where roofs overhang walls.",
       0},
      {"simulate-model-open", "Buildings of a model are not closed when seen from above and from below.",
       "They are taken as solid from their highest surface down to the ground; an overhang becomes a wall. Close the "
       "model if that is not right.",
       0},
      {"simulate-model-outline", "A building of a model has no outline: no area when seen from above.",
       "It is left out. Give it ground faces or a roof, or do without it.", 0},
      {"simulate-size", "A scan would have more cells or points than can be numbered.",
       "Keep a part of it with --bbox, or take a coarser --resolution; the message says how coarse.", 4},
      {"simulate-flat", "No pitched roof could be extruded over a footprint; it has a flat one instead.",
       "Nothing need be done; the truth says so.", 0},
      {"simulate-left-out", "Nothing could be extruded over a footprint; it is left out of the truth.",
       "Repair the footprint, or do without it.", 0},
  };
}

}  // namespace mansard::simulate
