#include "mansard/sweep/options.hpp"

namespace mansard::sweep {

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("sweep");
  list.number("gamma", o.gamma, "m²", {0, 1e6}, "Sides of buildings with less mesh area than this are dropped.")
      .alias("gamma")
      .source("paper, section on computing the optimization inputs: 10 m²");
  list.number("line_distance", o.line_distance, "m", {0.01, 5},
              "Mesh at most this far from a line belongs to the line.")
      .source("docs/sweep.md: precision and recall move by less than 0.03 between 0.2 and 0.45 m");
  list.number("line_gap", o.line_gap, "m", {0, 20}, "Gaps along a line up to this length are closed.")
      .source("reference implementation chordatlas: 0.56 m");
  list.number("gis_angle", o.gis_angle, "rad", {0, 0.7},
              "Lines turn to the direction of a footprint's edge within this angle; 0 leaves them unchanged.")
      .source("reference implementation chordatlas: π/8");
  list.number("gis_distance", o.gis_distance, "m", {0, 50},
              "Maximum distance from a line to the footprint's edge that it turns to.")
      .source("chosen by hand; not measured");
  list.number("gis_offset", o.gis_offset, "m", {0, 5},
              "Walls seen up to this far outside a footprint's edge are moved onto it; 0 leaves all walls where they "
              "were seen.")
      .source("docs/decisions/0015");
  list.number("gis_inward", o.gis_inward, "m", {0, 5},
              "Walls seen up to this far inside a footprint's edge are moved onto it.")
      .source("docs/decisions/0015");
  list.number("cluster_step", o.cluster_step, "m", {0.05, 10},
              "Maximum lateral step of a side between neighbouring slices.")
      .source("docs/sweep.md: recall of true walls 0.89, against 0.87 with the reference's 1.5 m");
  list.number("thin_distance", o.thin_distance, "m", {0, 20},
              "Lines backed by an opposite line within this distance lose weight, as buses and fences do.")
      .source("reference implementation chordatlas: 4 m");
  list.number("setback", o.setback, "m", {0.3, 20},
              "Wall feet at least this far from their side's median become sweep-edges of their own.")
      .source("reference implementation chordatlas: 1 m");
  list.number("line_node_spacing", o.line_node_spacing, "m", {0.02, 10},
              "Spacing of the points at which a chain of segments may be cut into straight pieces.")
      .advanced("chosen by hand; not measured");
  list.number("line_piece_price", o.line_piece_price, "m", {0, 1000},
              "Length of chain at sweep.line_distance from its line that an additional straight piece must save.")
      .advanced("chosen by hand; not measured");
  list.number("line_minimum_length", o.line_minimum_length, "m", {0, 50}, "Minimum length of a line in a slice.")
      .advanced("chosen by hand; not measured");
  list.number("gis_straight_turn", o.gis_straight_turn, "rad", {0, 0.7},
              "Consecutive edges of a footprint that turn by less than this count as one edge when lines are turned to "
              "them.")
      .advanced("reference implementation chordatlas: 0.05 rad");
  list.number("gis_minimum_edge", o.gis_minimum_edge, "m", {0, 50},
              "Minimum length of a footprint's edge that lines turn to.")
      .advanced("chosen by hand; not measured");
  list.number("gis_maximum_swing", o.gis_maximum_swing, "m", {0, 100},
              "Maximum movement of a line's ends when the line turns to a footprint's edge.")
      .advanced("chosen by hand; not measured");
  list.number("thin_turn", o.thin_turn, "rad", {1.6, 3.1},
              "Minimum angle between the directions of two lines that are opposite sides of a thin object.")
      .advanced("reference implementation chordatlas: 0.7 π");
  list.number("cluster_turn", o.cluster_turn, "rad", {0, 1.5},
              "Maximum angle between a line and its cluster's first line.")
      .advanced("reference implementation chordatlas: 0.3 rad");
  list.number("cluster_turn_parallel", o.cluster_turn_parallel, "rad", {0, 1.5},
              "Maximum angle between a line and its cluster's first line when they overlap little.")
      .advanced("reference implementation chordatlas: 0.1 rad");
  list.number("column_width", o.column_width, "m", {0.02, 5},
              "Width of the columns in which the foot of a wall is measured.")
      .advanced("paper: profiles every 0.2 m");
  list.number("column_gap", o.column_gap, "m", {0, 100},
              "Gaps without wall feet longer than this divide a sweep-edge in two.")
      .advanced("chosen by hand; not measured");
  list.number("wall_minimum_height", o.wall_minimum_height, "m", {0, 50},
              "Minimum height of a wall in a column; less is a step in a roof.")
      .advanced("reference implementation chordatlas: 1 m of vertical profile");
  list.number("wall_window", o.wall_window, "m", {0, 20}, "Height over which the slope of a wall is fitted.")
      .advanced("chosen by hand; not measured");
  list.number("wall_gap", o.wall_gap, "m", {0, 20}, "Height without samples over which a wall continues.")
      .advanced("three slices of 0.2 m and a margin for rounding");
  list.number("wall_spread", o.wall_spread, "m", {0, 20},
              "Maximum distance of a wall's samples from the wall's mean position.")
      .advanced("chosen by hand; not measured");
  list.number("untidy_height", o.untidy_height, "m", {0, 100},
              "Height above ground up to which cars and hedges hide the foot of a wall.")
      .advanced("chosen by hand; not measured");
  list.integer("setback_columns", o.setback_columns, "", {1, 1000}, "Minimum number of columns in a setback.")
      .advanced("reference implementation chordatlas: 2 m in columns of 0.2 m");
  list.number("gutter_band", o.gutter_band, "m", {0, 20},
              "Height above a roof's lowest sample within which its gutter is measured.")
      .advanced("chosen by hand; not measured");
  list.number("minimum_length", o.minimum_length, "m", {0, 100}, "Minimum length of a sweep-edge.")
      .advanced("chosen by hand; not measured");
  list.number("same_line", o.same_line, "m", {0, 20},
              "Maximum distance between the wall feet of sides that are put together.")
      .advanced("chosen by hand; not measured");
  list.number("same_line_gap", o.same_line_gap, "m", {0, 50},
              "Maximum gap between sides on one line that are put together.")
      .advanced("chosen by hand; not measured");
  list.number("same_line_cosine", o.same_line_cosine, "", {0, 1},
              "Cosine of the maximum angle between sides on one line.")
      .advanced("chosen by hand; not measured");
  list.number("outline_margin", o.outline_margin, "m", {0, 100},
              "Sweep-edges are cut off at this distance outside the footprints.")
      .advanced("reference implementation chordatlas: 2 m, written but not used");
  list.number("outline_spacing", o.outline_spacing, "m", {0.01, 10},
              "Spacing of the points at which a sweep-edge's distance to the footprints is tested.")
      .advanced("the cell of the evaluation grid; not measured");
  list.number("registration_shared", o.registration_shared, "m", {0.01, 100},
              "Minimum length along which a wall and an outline's edge are compared.")
      .advanced("chosen by hand; not measured");
  list.number("registration_distance", o.registration_distance, "m", {0.01, 20},
              "Maximum distance between a wall and an outline's edge that are compared.")
      .advanced("docs/decisions/0015");
  list.number("registration_distance_astray", o.registration_distance_astray, "m", {0.01, 20},
              "The same distance for footprints that are displaced by more than sweep.gis_offset.")
      .advanced("docs/decisions/0018");
  list.number("registration_noise", o.registration_noise, "m", {1e-6, 5},
              "Distances below this weigh the same in the fit of the displacement.")
      .advanced("chosen by hand; not measured");
  list.number("registration_minimum_shift", o.registration_minimum_shift, "m", {0, 20},
              "Displacements of the footprints smaller than this are ignored.")
      .advanced("docs/decisions/0015");
  list.number("footprint_piece", o.footprint_piece, "m", {0.001, 50},
              "Minimum length of a piece of a wall that is moved onto a footprint's edge.")
      .advanced("chosen by hand; not measured");
  list.number("footprint_straight", o.footprint_straight, "m", {0, 20},
              "Corners of a footprint nearer than this to the line without them do not divide a wall.")
      .advanced("chosen by hand; not measured");
  list.number("footprint_rest", o.footprint_rest, "m", {0, 100},
              "Minimum length of the rest of a wall beside which there is no footprint's edge.")
      .advanced("chosen by hand; not measured");
  list.number(
          "eaves_reach", o.eaves_reach, "m", {0, 20},
          "Walls up to this far inside of a footprint's edge are moved outward to the end of the eaves above them; 0: "
          "none are.")
      .advanced("docs/decisions/0115");
  list.number("eaves_spread", o.eaves_spread, "m", {0, 20},
              "Maximum spread of the overhang along a wall: the median distance from its median.")
      .advanced("docs/decisions/0115");
  return list;
}

}  // namespace mansard::sweep
