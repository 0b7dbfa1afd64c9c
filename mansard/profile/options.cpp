#include "mansard/profile/options.hpp"

namespace mansard::profile {

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("profile");
  list.choice("quality", o.quality,
              {{"simple", Quality::simple}, {"moderate", Quality::moderate}, {"high", Quality::high}},
              "Detail of the profiles: walls only, one roof pitch an edge, or up to three.")
      .source("paper, Figure 7");
  list.number("spacing", o.spacing, "m", {0.05, 5}, "Distance between perpendicular slices along an edge.")
      .source("paper: 0.2 m");
  list.number("jump", o.jump, "m", {0.05, 20}, "Width of a hole or parapet over which a slice is followed.")
      .source("reference implementation chordatlas: 3 m");
  list.number("support", o.support, "", {0, 1}, "Share of an edge's slices that must agree with a pitch.")
      .source("reference implementation chordatlas: 0.2");
  list.number("vertical_angle", o.vertical_angle, "rad", {0.001, 0.5},
              "Parts of a profile within this angle of vertical become wall.")
      .source("reference implementation chordatlas: 0.1 rad");
  list.number("run_angle", o.run_angle, "rad", {0, 0.7},
              "Consecutive edges that turn by less than this share a profile.")
      .source("reference implementation chordatlas: 0.1 rad");
  list.choice("overhangs", o.overhangs,
              {{"off", Overhangs::off}, {"measured", Overhangs::measured}, {"soffits", Overhangs::soffits}},
              "Overhanging eaves of a scan that shows the walls below them: not looked for, measured as attributes, or "
              "also made, with soffits.")
      .source("docs/decisions/0088-measured-overhangs.md");
  list.number("overhang_min", o.overhang_min, "m", {0.01, 3}, "Minimum overhang of eaves that counts.")
      .source("docs/decisions/0088-measured-overhangs.md");
  list.number("overhang_max", o.overhang_max, "m", {0.01, 3}, "Maximum overhang of eaves; more is taken for a canopy.")
      .source("chosen by hand; not measured");
  list.number("overhang_support", o.overhang_support, "", {0, 1},
              "Minimum share of an edge's slices that show the wall and an edge of the roof outside of it.")
      .source("docs/decisions/0088-measured-overhangs.md");
  list.number("overhang_wall", o.overhang_wall, "m", {0.1, 50}, "Minimum height of wall below overhanging eaves.")
      .advanced("chosen by hand; not measured");
  list.number("overhang_clear", o.overhang_clear, "m", {0, 5},
              "Distance below the lowest possible soffit within which no wall is read.")
      .advanced("chosen by hand; not measured");
  list.number("overhang_near", o.overhang_near, "m", {0.05, 5},
              "Maximum distance between an edge and the wall that is seen below its eaves.")
      .advanced("chosen by hand; not measured");
  list.number("overhang_agree", o.overhang_agree, "m", {0.01, 5},
              "Slices whose wall is farther than this from the median of their edge do not count.")
      .advanced("chosen by hand; not measured");
  list.number("overhang_level", o.overhang_level, "m", {0.01, 1},
              "Distance between the heights at which a slice is read at the edge of a roof.")
      .advanced("a tenth of a usual overhang; not measured");
  list.number("overhang_hidden", o.overhang_hidden, "m", {0, 2},
              "Maximum distance between the outermost point that a scan shows of eaves and the edge of their roof.")
      .advanced("docs/decisions/0088-measured-overhangs.md");
  list.number("slice_outward", o.slice_outward, "m", {0, 50}, "Distance outside an edge at which its slices begin.")
      .advanced("chosen by hand; not measured");
  list.number("slice_inward", o.slice_inward, "m", {1, 1000}, "Maximum length of a slice inside an edge.")
      .advanced("chosen by hand; not measured");
  list.number("climb_near", o.climb_near, "m", {0.05, 20}, "Distance from an edge within which its wall is looked for.")
      .advanced("chosen by hand; not measured");
  list.number("climb_clear", o.climb_clear, "m", {0, 20}, "Height above ground below which mesh is terrain.")
      .advanced("chosen by hand; not measured");
  list.number("climb_roof_first", o.climb_roof_first, "m", {0, 20},
              "Distance inside an edge at which a roof without a wall is looked for first.")
      .advanced("chosen by hand; not measured");
  list.number("climb_roof_next", o.climb_roof_next, "m", {0.01, 20},
              "Spacing of the places at which a roof without a wall is looked for.")
      .advanced("chosen by hand; not measured");
  list.number("wall_minimum", o.wall_minimum, "m", {0, 50}, "Minimum height of wall that has a position.")
      .advanced("reference implementation chordatlas: 1 m");
  list.number("column_width", o.column_width, "m", {0.02, 5},
              "Width of the columns in which the heights of a slice are kept.")
      .advanced("as wide as slices are apart; not measured");
  list.number("wall_deepest", o.wall_deepest, "m", {0, 20},
              "Maximum distance inside an edge by which a wall moves the start of its roof.")
      .advanced("chosen by hand; not measured");
  list.number("rising_start", o.rising_start, "m", {0, 20},
              "Maximum distance from the wall to the start of a rising roof.")
      .advanced("chosen by hand; not measured");
  list.number("rising_shortest", o.rising_shortest, "m", {0, 20}, "Minimum length of a rising roof.")
      .advanced("chosen by hand; not measured");
  list.number("rising_beside", o.rising_beside, "m", {0, 20},
              "Distance along an edge within which slices contribute to a fitted slope.")
      .advanced("chosen by hand; not measured");
  list.number("setback_step", o.setback_step, "m", {0.1, 50}, "Minimum step of the wall behind a setback.")
      .advanced("docs/decisions/0017; not measured");
  list.number("setback_level", o.setback_level, "m", {0, 20},
              "Maximum height difference within the part before a setback.")
      .advanced("chosen by hand; not measured");
  list.number("single_pitch_tolerance", o.single_pitch_tolerance, "m", {0.001, 20},
              "Distance within which a slice agrees with a single pitch, which represents all of a roof.")
      .advanced("chosen by hand; not measured");
  list.number("short_run", o.short_run, "m", {0, 50},
              "Edges shorter than this take the profile of a neighbour, or are walls.")
      .advanced("chosen by hand; not measured");
  list.number("minimum_height", o.minimum_height, "m", {0.01, 50}, "Minimum height of a building.")
      .advanced("chosen by hand; not measured");
  list.number("cap_distinct", o.cap_distinct, "m", {0, 20}, "Minimum difference between two candidate cap heights.")
      .advanced("chosen by hand; not measured");
  list.number("cap_clear", o.cap_clear, "m", {0, 20},
              "Height of a cap above the tops of the profiles, so that roofs can close.")
      .advanced("reference implementation chordatlas: 0.5 m");
  list.number("cap_level", o.cap_level, "m", {0.01, 20}, "Height range that is one level of a flat roof.")
      .advanced("chosen by hand; not measured");
  list.number("cap_ridge", o.cap_ridge, "", {0, 1}, "Percentile of the mesh's heights that is the ridge height.")
      .advanced("chosen by hand; not measured");
  list.number("choice_grid", o.choice_grid, "m", {0.02, 10},
              "Minimum spacing of the height samples when profiles are chosen.")
      .advanced("the cell of the paper's error measure");
  list.number("choice_outlier", o.choice_outlier, "m", {0.1, 100},
              "Differences between roof and mesh larger than this count as this, because of trees and steps.")
      .advanced("chosen by hand; not measured");
  return list;
}

}  // namespace mansard::profile
