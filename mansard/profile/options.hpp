// The numbers that profile decides by; what each means and where it comes from is told in options.cpp. Those that
// are no options stand for what scans round off and for their noise: profiles are where the search of refine begins,
// which decides by the scan that was measured, and models are as good with other values (docs/decisions/0122).
#pragma once

#include <cstddef>
#include <cstdint>

#include "mansard/base/options.hpp"

namespace mansard::profile {

/// One vertical line; at most one pitch; all that is supported.
enum class Quality : std::uint8_t { simple, moderate, high };

/// Overhanging eaves: not looked for; measured and told; measured and made.
enum class Overhangs : std::uint8_t { off, measured, soffits };

struct Options {
  Quality quality = Quality::high;
  double spacing = 0.2;         ///< m between perpendicular slices along an edge
  double jump = 3.0;            ///< m; failing that, over a hole or parapet this wide
  double support = 0.2;         ///< share of an edge's slices that must support a line
  double vertical_angle = 0.1;  ///< rad; lines this near to vertical become vertical
  double run_angle = 0.1;       ///< rad; edges turning less than this share a profile

  Overhangs overhangs = Overhangs::off;
  double overhang_min = 0.15;     ///< m
  double overhang_max = 1.5;      ///< m
  double overhang_support = 0.4;  ///< share of an edge's slices that show the wall and the edge of the roof above it

  // Overhanging eaves.
  double overhang_wall = 0.8;   ///< m of wall below the eaves, at least
  double overhang_clear = 0.3;  ///< m below the deepest edge of the roof where no wall is read
  /// Minimum share of the height of the wall below the eaves that a slice shows. Chosen by hand; not measured.
  double overhang_shadow = 0.5;
  double overhang_near = 0.5;    ///< m between the plan's edge and the wall, at most
  double overhang_agree = 0.15;  ///< m; slices whose wall is farther from the median do not count
  double overhang_level = 0.05;  ///< m between heights of the scan that are read
  double overhang_melt = 0.3;    ///< m; a scan rounds edges off over about so much; no option
  double overhang_hidden = 0.5;  ///< m; of the edge of a roof, a sharp wedge, more than that

  // Slices.
  double slice_outward = 2.0;  ///< m outside the edge where a slice begins
  double slice_inward = 40.0;  ///< m inside the edge where a slice ends at the latest
  double slice_margin = 0.3;   ///< m; corners are rounded in scans; no option
  /// Maximum number of slices of an edge. Keeps the time of long edges in bounds; 100 slices were enough for every edge
  /// looked at.
  double slices_per_edge = 100;

  // The climb.
  double climb_near = 1.5;        ///< m; the climb starts this near to the foot
  double climb_clear = 1.0;       ///< m above ground; lower pieces are terrain
  double climb_roof_first = 0.6;  ///< m inward of the edge where, without a wall, a roof is looked for first
  double climb_roof_next = 0.3;   ///< m between that and the next places
  /// Maximum lean of a piece of wall, as a multiple of the tangent of profile.vertical_angle. Chosen by hand; not
  /// measured.
  double wall_lean =
      3.0;  ///< times the tangent of vertical_angle; single noisy triangles lean more than the wall they make
  double wall_minimum = 1.0;  ///< m; less is no wall

  // Columns of heights, and where they rise.
  double column_width = 0.2;  ///< m
  double wall_deepest = 1.5;  ///< m inward of the edge; a wall farther in does not move the start of the roof any more
  double corner = 0.3;        ///< m; scans round off gutters and ridges; no option
  /// Minimum slope of a roof that rises. Chosen by hand; not measured.
  double rising_slope = 0.1;
  /// Maximum slope of a roof along its edge, as a share of the slope across. Chosen by hand; not measured.
  double rising_oblique = 0.6;
  double rising_start = 1.6;     ///< m; parapets and gutters may lie before the roof
  double rising_shortest = 0.8;  ///< m; a rise over less is a rounded corner
  /// Number of columns in the plane whose slope is fitted. Chosen by hand; not measured.
  std::size_t rising_tile = 5;
  /// Number of columns between planes whose slopes are fitted. Chosen by hand; not measured.
  std::size_t rising_tile_step = 2;
  /// Number of consecutive planes without rise over which a roof continues. Chosen by hand; not measured.
  std::size_t rising_misses = 2;
  double rising_beside = 0.5;  ///< m; slices this near help to tell the slope
  /// Minimum share of rising slices that must reach a column for it to count. Chosen by hand; not measured.
  double pool_share = 0.25;

  // Setbacks.
  double setback_step = 1.5;  ///< m from the lower roof up
  /// Number of columns to either side of a setback's wall that a scan smears; no option.
  std::size_t setback_blur = 2;
  /// Minimum number of columns before a setback's wall. Chosen by hand; not measured.
  std::size_t setback_depth = 4;
  double setback_level = 1.0;  ///< m between the heights of the part before it
  /// Slope below which a pitch is level. Chosen by hand; not measured.
  double level_slope = 0.05;

  // Pitches.
  /// Minimum number of columns of a pitch. Chosen by hand; not measured.
  std::size_t pitch_columns = 4;
  double pitch_price = 0.15;  ///< m² · columns: what another pitch must save, 0.1 m over about fifteen columns (3 m of
                              ///< roof), or more over fewer; no option
  double pitch_gain = 0.6;  ///< m; scans round off the edges of flat roofs too: what rises less is no pitch; no option
  double pitch_tolerance =
      0.3;  ///< m; a slice within it, over half of what it shows of a pitch, supports the pitch; no option
  double single_pitch_tolerance = 1.0;  ///< m; the same for a single pitch, which stands for all that a roof does
  /// Minimum share of an edge's slices that must rise for it to have a pitched roof. Chosen by hand; not measured.
  double pitched_share = 0.4;
  double short_run = 1.0;  ///< m; shorter runs follow a neighbour or stand as walls
  /// Tangent of the maximum angle between a short edge and the neighbour whose profile it takes. Chosen by hand; not
  /// measured.
  double gentle_turn = 0.5463;

  // Heights and caps.
  double assumed_height = 3.0;  ///< m; where nothing was seen at all; no option: pipeline.assumed_height
  double minimum_height = 0.5;  ///< m; of ground-level "buildings", so that there is a solid at all
  double cap_distinct = 0.1;    ///< m between candidate caps
  double cap_clear = 0.5;       ///< m above the profiles' tops, so that roofs can close
  double cap_level = 0.5;       ///< m of height that are one level of a flat roof, whatever stands on it
  double cap_ridge = 0.99;      ///< percentile of the heights that counts as the ridge

  // Choice between profiles.
  /// Maximum number of height samples per part when profiles are chosen. Chosen by hand; not measured.
  double choice_samples = 3000;
  double choice_grid = 0.25;    ///< m between samples, at least
  double choice_outlier = 3.0;  ///< m; larger differences (trees, steps) count as this
  /// Share of the error below which another profile replaces the first choice. Chosen by hand; not measured.
  double choice_gain = 0.97;
  /// Maximum number of rounds in which profiles are chosen. Chosen by hand; not measured.
  std::size_t choice_rounds = 3;
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::profile
