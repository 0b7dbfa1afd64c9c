// The numbers that derive decides by; what each means and where it comes from is told in options.cpp.
#pragma once

#include <cstddef>

#include "mansard/base/options.hpp"

namespace mansard::derive {

struct Options {
  double cell = 0.5;        ///< m; of the grid of heights
  double above_ground = 2;  ///< m; what stands less high is no building
  double least_area = 25;   ///< m²; of a building, and of a courtyard
  double widest = 100;      ///< m; a square so wide holds some ground
  double smooth = 0.25;     ///< 0 … 1; the least share of a roof that lies in planes
  double step = 8;          ///< m; what stands so much above what it touches is a building of its own; 0: never
  double tolerance = 1;     ///< m; what is nearer to a wall's line is that wall
  double shortest = 1.5;    ///< m; of the sides that are drawn
  /// Maximum number of cells of the grid of heights. A few gigabytes of memory.
  double maximum_cells = 4e8;

  // The ground.
  /// Maximum slope of the ground between neighbouring cells. Chosen by hand; not measured.
  double ground_slope = 0.6;
  double ground_noise = 0.05;  ///< m; what a scan of level ground is off by
  double ground_seed = 0.5;    ///< m above the lowest surface around, where there may still be ground to begin from
  double ground_width =
      1.5;                 ///< m; ground is joined to ground over places at least this wide: no plank leads onto a roof
  double pit_width = 4.0;  ///< m; narrower pits are holes of the scan

  // Planes, and which cells are buildings.
  double plane_distance = 0.25;  ///< m; off a plane by more is not in it
  /// Cosine of the maximum angle between a cell's surface and its plane. Chosen by hand; not measured.
  double plane_cosine = 0.94;
  /// Maximum slope of a plane of a roof. Chosen by hand; not measured.
  double plane_slope = 1.75;
  double plane_area = 6.0;      ///< m²; the crowns of trees have no planes so large
  double smooth_radius = 2.0;   ///< m; half the width of the squares over which smoothness is averaged
  double piece_step = 2.0;      ///< m; cells side by side that differ by more are of two pieces
  double clutter_radius = 3.0;  ///< m; half the width of a cluttered place on a roof
  double narrow_rim = 1.0;      ///< m; of a piece, which is cornice, parapet or melted wall
  double wide_rim = 3.0;        ///< m; the same of a piece that is mostly smooth
  /// Smoothness from which a piece is mostly smooth, as a multiple of derive.smooth. Chosen by hand; not measured.
  double wide_rim_smooth = 1.5;
  double judged_area = 8.0;  ///< m²; smaller pieces (chimneys, cells of walls) are what they stand on
  /// Number of rounds in which small pieces are assigned by their neighbours. Chosen by hand; not measured.
  std::size_t judged_rounds = 3;
  double minimum_width = 2.0;  ///< m; what is narrower is no building

  // Outlines.
  double underlap = 2.0;    ///< m; the outline of a lower building is drawn as if it went on so far under a higher one,
                            ///< which draws the wall between them
  double slip_width = 0.8;  ///< m; narrower slips where two footprints were parted are left out
  double corner_turn = 0.26;  ///< rad, 15°; consecutive sides that turn by less are one
  double snap_turn = 0.7;     ///< rad, 40°; no side is turned by more to be parallel to others
  /// Maximum movement of a side's ends when it is turned, as a multiple of derive.tolerance. Chosen by hand; not
  /// measured.
  double snap_moved = 1.25;
  double parallel_turn = 0.05;  ///< rad, 3°; lines that differ by less have no corner
  /// Minimum overlap of an outline and its straight version, as the ratio of intersection to union. Chosen by hand; not
  /// measured.
  double minimum_overlap = 0.85;
  /// Length at both ends of a side that is not fitted, as a multiple of derive.tolerance. Chosen by hand; not measured.
  double corner_trim = 1.5;
  /// Maximum distance of a corner from its outline, as a multiple of derive.tolerance. Chosen by hand; not measured.
  double corner_reach = 3.0;
  /// Maximum length of a bevel that becomes a corner, as a multiple of derive.tolerance. Chosen by hand; not measured.
  double bevel_length = 4.0;
  /// Maximum distance of the corner that replaces a short side, as a multiple of derive.tolerance. Chosen by hand; not
  /// measured.
  double drop_reach = 4.0;
  /// Maximum number of wall directions of a building. Chosen by hand; not measured.
  std::size_t directions = 3;
  /// Minimum share of the perimeter in an additional wall direction. Chosen by hand; not measured.
  double direction_share = 0.2;
  double direction_width = 0.05;  ///< rad; within which sides agree on a direction
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::derive
