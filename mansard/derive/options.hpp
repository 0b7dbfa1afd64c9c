// The numbers that derive decides by; what each means and where it comes from is told in options.cpp.
#pragma once

#include <cstddef>

#include "mansard/base/options.hpp"

namespace mansard::derive {

struct Options {
  double cell = 0.5;           ///< m; of the grid of heights
  double above_ground = 2;     ///< m; what stands less high is no building
  double least_area = 25;      ///< m²; of a building, and of a courtyard
  double widest = 100;         ///< m; a square so wide holds some ground
  double smooth = 0.25;        ///< 0 … 1; the least share of a roof that lies in planes
  double step = 8;             ///< m; what stands so much above what it touches is a building of its own; 0: never
  double tolerance = 1;        ///< m; what is nearer to a wall's line is that wall
  double shortest = 1.5;       ///< m; of the sides that are drawn
  double maximum_cells = 4e8;  ///< cells of the grid; more are refused

  // The ground.
  double ground_slope = 0.6;   ///< rise for 1 (31°); what rises more between neighbouring cells is a step
  double ground_noise = 0.05;  ///< m; what a scan of level ground is off by
  double ground_seed = 0.5;    ///< m above the lowest surface around, where there may still be ground to begin from
  double ground_width =
      1.5;                 ///< m; ground is joined to ground over places at least this wide: no plank leads onto a roof
  double pit_width = 4.0;  ///< m; narrower pits are holes of the scan

  // Planes, and which cells are buildings.
  double plane_distance = 0.25;   ///< m; off a plane by more is not in it
  double plane_cosine = 0.94;     ///< cosine of 20°: what looks elsewhere is not in it either
  double plane_slope = 1.75;      ///< rise for 1: what is steeper (60°) is no roof
  double plane_area = 6.0;        ///< m²; the crowns of trees have no planes so large
  double smooth_radius = 2.0;     ///< m; half the width of the squares over which smoothness is averaged
  double piece_step = 2.0;        ///< m; cells side by side that differ by more are of two pieces
  double clutter_radius = 3.0;    ///< m; half the width of a cluttered place on a roof
  double narrow_rim = 1.0;        ///< m; of a piece, which is cornice, parapet or melted wall
  double wide_rim = 3.0;          ///< m; the same of a piece that is mostly smooth
  double wide_rim_smooth = 1.5;   ///< times `smooth`: a piece that is mostly smooth
  double judged_area = 8.0;       ///< m²; smaller pieces (chimneys, cells of walls) are what they stand on
  std::size_t judged_rounds = 3;  ///< in which small pieces are judged by their neighbours
  double minimum_width = 2.0;     ///< m; what is narrower is no building

  // Outlines.
  double underlap = 2.0;    ///< m; the outline of a lower building is drawn as if it went on so far under a higher one,
                            ///< which draws the wall between them
  double slip_width = 0.8;  ///< m; narrower slips where two footprints were parted are left out
  double corner_turn = 0.26;      ///< rad, 15°; consecutive sides that turn by less are one
  double snap_turn = 0.7;         ///< rad, 40°; no side is turned by more to be parallel to others
  double snap_moved = 1.25;       ///< tolerances; no side is turned so that its ends move by more
  double parallel_turn = 0.05;    ///< rad, 3°; lines that differ by less have no corner
  double minimum_overlap = 0.85;  ///< area of intersection over that of union; below, the outline stays as it is
  double corner_trim = 1.5;       ///< tolerances at both ends of a side that are not fitted: openings round corners off
  double corner_reach = 3.0;      ///< tolerances; lines that meet farther off get a step between them
  double bevel_length = 4.0;      ///< tolerances; shorter bevels become corners
  double drop_reach = 4.0;        ///< tolerances; a short side stays where its neighbours would meet farther off
  std::size_t directions = 3;     ///< of walls a building has, at most
  double direction_share = 0.2;   ///< of the perimeter that another direction's sides must make
  double direction_width = 0.05;  ///< rad; within which sides agree on a direction
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::derive
