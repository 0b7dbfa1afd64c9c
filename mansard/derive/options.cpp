#include "mansard/derive/options.hpp"

namespace mansard::derive {

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("derive");
  list.number("cell", o.cell, "m", {0.1, 5}, "Cell size of the grid of heights that footprints are drawn from.")
      .source("docs/decisions/0022");
  list.number("above_ground", o.above_ground, "m", {0.5, 100}, "Minimum height of a building above the ground.")
      .source("docs/decisions/0022");
  list.number("least_area", o.least_area, "m²", {1, 1e5},
              "Buildings with less area are left out, and courtyards with less area are closed.")
      .source("docs/decisions/0022");
  list.number("widest", o.widest, "m", {10, 2000},
              "Width of the squares whose lowest surface is ground: wider than any roof, and than any built-up area.")
      .source("docs/decisions/0022");
  list.number("smooth", o.smooth, "", {0, 1},
              "Minimum share of a roof, around each place, that lies in planes; trees have next to none.")
      .source("docs/decisions/0022");
  list.number("step", o.step, "m", {0, 500},
              "Height above a touching roof from which a roof is a building of its own; 0 for never.")
      .source("docs/decisions/0022");
  list.number("tolerance", o.tolerance, "m", {0.1, 20},
              "Maximum distance of an outline from the line of a wall that it follows.")
      .source("docs/decisions/0022");
  list.number("shortest", o.shortest, "m", {0, 50}, "Minimum length of a side that is drawn.")
      .source("docs/decisions/0022");
  list.number("ground_noise", o.ground_noise, "m", {0, 5},
              "Height difference between neighbouring cells that is noise.")
      .advanced("chosen by hand; not measured");
  list.number("ground_seed", o.ground_seed, "m", {0, 50},
              "Height above the lowest surface around up to which the ground begins.")
      .advanced("chosen by hand; not measured");
  list.number("ground_width", o.ground_width, "m", {0.1, 100},
              "Minimum width of the places over which ground is joined to ground.")
      .advanced("chosen by hand; not measured");
  list.number("pit_width", o.pit_width, "m", {0.1, 100}, "Pits narrower than this are holes in the mesh.")
      .advanced("chosen by hand; not measured");
  list.number("plane_distance", o.plane_distance, "m", {0.001, 10}, "Maximum distance of a cell from its plane.")
      .advanced("chosen by hand; not measured");
  list.number("plane_area", o.plane_area, "m²", {0.1, 1000}, "Minimum area of a plane of a roof.")
      .advanced("chosen by hand; not measured");
  list.number("smooth_radius", o.smooth_radius, "m", {0.1, 50},
              "Half width of the squares over which the share of planes is averaged.")
      .advanced("chosen by hand; not measured");
  list.number("piece_step", o.piece_step, "m", {0.05, 50},
              "Height difference of neighbouring cells from which they belong to two pieces.")
      .advanced("chosen by hand; not measured");
  list.number("clutter_radius", o.clutter_radius, "m", {0, 50},
              "Half width of the cluttered places on a roof that are closed.")
      .advanced("chosen by hand; not measured");
  list.number("narrow_rim", o.narrow_rim, "m", {0, 50}, "Width of the rim of a piece that belongs to its building.")
      .advanced("chosen by hand; not measured");
  list.number("wide_rim", o.wide_rim, "m", {0, 50},
              "Width of the rim of a mostly smooth piece that belongs to its building.")
      .advanced("chosen by hand; not measured");
  list.number("judged_area", o.judged_area, "m²", {0, 1000},
              "Pieces smaller than this belong to the piece that they are on.")
      .advanced("chosen by hand; not measured");
  list.number("minimum_width", o.minimum_width, "m", {0, 50}, "Minimum width of a building.")
      .advanced("chosen by hand; not measured");
  list.number("underlap", o.underlap, "m", {0, 50},
              "Distance by which the outline of a building continues under a higher one before the two are parted.")
      .advanced("chosen by hand; not measured");
  list.number("slip_width", o.slip_width, "m", {0.01, 20},
              "Pieces narrower than this, where two footprints were parted, are left out.")
      .advanced("chosen by hand; not measured");
  list.number("corner_turn", o.corner_turn, "rad", {0.01, 1.5}, "Minimum turn between consecutive sides.")
      .advanced("chosen by hand; not measured");
  list.number("snap_turn", o.snap_turn, "rad", {0, 1.5},
              "Maximum angle by which a side is turned to be parallel to others.")
      .advanced("chosen by hand; not measured");
  list.number("parallel_turn", o.parallel_turn, "rad", {0.001, 0.5},
              "Lines that differ by less than this angle have no corner.")
      .advanced("chosen by hand; not measured");
  list.number("direction_width", o.direction_width, "rad", {0.001, 0.5},
              "Angle within which sides agree on a direction.")
      .advanced("chosen by hand; not measured");
  return list;
}

}  // namespace mansard::derive
