// The numbers that sweep decides by; what each means and where it comes from is told in options.cpp.
#pragma once

#include <cstddef>
#include <numbers>

#include "mansard/base/options.hpp"

namespace mansard::sweep {

struct Options {
  double gamma = 10.0;         ///< m²; clusters with less mesh area are dropped
  double line_distance = 0.3;  ///< m; segments this near a line belong to it
  double line_gap = 0.6;       ///< m; gaps up to this are closed along a line
  double gis_angle = 0.39;     ///< rad; lines turn to a GIS edge within this angle; 0 leaves them alone
  double gis_distance = 3.0;   ///< m; … when the GIS edge is this near
  double gis_offset = 0.75;    ///< m; edges seen up to this far outside a footprint's stand on it; 0: where seen
  double gis_inward = 0.25;    ///< m; … and up to this far inside: a scan sees eaves, but nothing through a wall
  double cluster_step = 0.8;   ///< m; greatest lateral step between neighbouring slices
  double low_height = 4.0;     ///< m above ground; lines below weigh a tenth (cars, hedges)
  double thin_distance = 4.0;  ///< m; lines lose weight for anti-parallel lines this near (buses, fences)
  double setback = 1.0;        ///< m; wall feet this far off the median become sweep-edges of their own
  double step_height = 0.35;   ///< m; roofs that jump by this along a straight line make sweep-edges; 0: none do
  double step_length = 2.5;    ///< m; … of this length

  // Lines in a slice.
  double line_node_spacing = 0.3;  ///< m; chains may be cut at nodes this far apart
  std::size_t line_trim_nodes =
      6;  ///< a piece of so many node distances leaves out its first and last one: the corner may be in it
  double line_piece_price = 1.0;     ///< m of chain that lie line_distance off: what another piece must save
  double line_straightness = 0.6;    ///< chord of a piece over its own length; a piece that winds more is vegetation
  double line_merge_cosine = 0.9;    ///< within 26° pieces may share a line; their ends decide
  double line_minimum_length = 0.5;  ///< m; shorter lines are noise
  /// m across one triangle: it belongs to a stray vertex, not to a wall; no building's wall is as long
  static constexpr double line_maximum_segment = 500;

  // Lines turned to the footprints' edges.
  double gis_straight_turn =
      0.05;  ///< rad; consecutive edges that bend less count as one: vertices of party walls must not shorten a facade
  double gis_minimum_edge = 0.5;   ///< m; a shorter GIS edge has no direction to speak of
  double gis_square_score = 0.2;   ///< of a parallel edge's
  double gis_maximum_swing = 1.0;  ///< m; an end that would move farther was measured better than that

  // Clusters of lines.
  double thin_turn = 0.7 * std::numbers::pi;  ///< rad; lines turned by more are opposite to each other
  double low_weight = 0.1;                    ///< of what is lower than low_height
  std::size_t cluster_reach = 2;              ///< slices up and down
  std::size_t cluster_lines = 4;              ///< a metre of height, a slice missed; the reference asks for 3 m
  double cluster_overlap = 0.8;               ///< of a line's length beside the cluster, for up to cluster_turn
  double cluster_turn = 0.3;                  ///< rad
  double cluster_overlap_parallel = 0.5;  ///< of a line's length beside the cluster, for up to cluster_turn_parallel
  double cluster_turn_parallel = 0.1;     ///< rad

  // Wall feet of a cluster.
  double column_width = 0.2;         ///< m
  double column_gap = 3.0;           ///< m without columns part an edge in two
  double column_support = 0.25;      ///< of the median column's lines: less is the ragged end of an edge
  double wall_minimum_height = 1.0;  ///< m of height; less is a step in a roof
  double wall_slope = 0.546;         ///< m sideways per m upwards: the tangent of 0.5 rad
  double wall_window = 1.0;          ///< m of height a slope is taken over: single slices are too noisy
  double wall_gap = 0.65;            ///< m of height without samples that a wall continues over, if not 3.1 slices
  double wall_gap_slices = 3.1;      ///< the same, in slices
  double wall_spread = 0.5;          ///< m; a wall leaves its own mean by less
  double wall_lower_share = 0.3;     ///< of the tallest wall of the column: what a lower one must have to be the foot
  double wall_share = 0.25;          ///< of the columns must have a wall; else the side stands at its gutter
  double untidy_height = 2.5;        ///< m above ground where cars and hedges hide the wall
  std::size_t setback_columns = 10;  ///< columns of a setback, at least
  double gutter_rise = 1.0;          ///< m above the median gutter: the column is the end of a hip, not eaves
  double gutter_band = 0.5;          ///< m above the lowest sample: the gutter
  /// of the columns' lower ends, and 1 minus it of their upper ends, are a side's low and high; only told, in the layer
  /// of the sweep-edges
  static constexpr double height_percentile = 0.1;
  double minimum_length = 1.0;  ///< m; shorter sweep-edges are left out

  // Selection of sides.
  double same_line = 0.4;           ///< m; sides whose feet are this near stand on one line
  double same_line_gap = 2.0;       ///< m along it: a balcony, a bay, a tree before the wall
  double same_line_cosine = 0.98;   ///< cosine of 0.2 rad
  double outline_margin = 2.0;      ///< m outside the footprints; farther off stand trees and neighbours
  double outline_spacing = 0.25;    ///< m between the points of an edge that are tested
  double low_margin = 0.75;         ///< m; a low thing farther outside is a hedge or a car
  double low_share = 0.8;           ///< of a low side's area in the zone of cars and hedges
  double thin_share = 0.4;          ///< of a side's length left by the bus filter: less is a fence
  double maximum_scatter = 0.35;    ///< m of scatter: foliage
  double roof_look_down = 1.0;      ///< m below a roof's lower end
  double roof_look_sideways = 1.2;  ///< m
  double roof_cosine = 0.9;         ///< cosine of 26°
  double roof_share = 0.5;          ///< of a line's length beside its continuation
  double twin_distance = 0.5;       ///< m between edges that run along each other
  double twin_share = 0.8;          ///< of the smaller one's length

  // Registration of the footprints.
  double registration_cosine = 0.995;         ///< 0.1 rad: edges that are compared by their distance
  double registration_shared = 1.0;           ///< m of two edges beside each other before their distance says anything
  double registration_distance = 1.0;         ///< m; walls farther off their footprint are another thing
  double registration_distance_astray = 1.5;  ///< m; unless all of them are
  double registration_noise = 0.02;           ///< m; distances under it are all alike
  double registration_determined = 0.02;      ///< of the length: what must face across every direction to fix the shift
  double registration_stands_out = 2.0;       ///< a shift is this many times what it leaves unexplained …
  double registration_significance = 2.45;    ///< … or its standard error
  double registration_explains = 0.15;        ///< and then also takes this share off what was left over
  double registration_explains_astray = 0.5;  ///< and this share where footprints would be astray
  double registration_minimum_shift = 0.12;   ///< m; less is as likely the scan's own displacement as the footprints'
  std::size_t registration_rounds = 30;       ///< of reweighted least squares

  // Walls put on footprints.
  double footprint_cosine = 0.7;     ///< a wall follows edges turned from it by up to 45°: a bay, an apse
  double footprint_piece = 0.1;      ///< m
  double footprint_straight = 0.03;  ///< m; corners this near to the line without them do not bend it
  double footprint_rest = 1.0;       ///< m of a sweep-edge beside which there is no footprint edge

  // Walls under eaves.
  double eaves_reach = 1.5;   ///< m inside of a footprint's edge: as far as footprints may be astray
  double eaves_spread = 0.3;  ///< m; median distance of the eaves' columns from their median

  // Roof steps.
  double step_cell = 0.25;          ///< m
  std::size_t step_near = 2;        ///< cells: half the width of a step's melted flank
  std::size_t step_side = 3;        ///< cells beyond the flank from which the slope beside it is taken, less one
  std::size_t step_alone = 3;       ///< cells; of two jumps nearer than this the higher one stands
  std::size_t step_rows = 3;        ///< rows to both sides that a jump is averaged over, against noise …
  double step_minimum_rows = 4;     ///< … of which so many must be known
  double step_own_share = 1.0 / 3;  ///< of that mean which the row itself must have
  double step_noise = 0.2;          ///< m; a lower jump is noise
  double step_roughness = 0.2;      ///< m; root mean square off the slope: foliage, chimneys
  double step_ground = 2.0;         ///< m above ground; lower is no roof; no option: segment.min_height
  double step_grain_turn = 0.06;    ///< rad; edges that differ by less, or by that from a right angle, run alike
  double step_grain_edge = 1.0;     ///< m; shorter edges of a footprint tell no direction
  double step_grain_length = 8.0;   ///< m of edge that make a direction
  double step_band = 0.4;           ///< m; jumps this near a line are of one step
  double step_gap = 1.25;           ///< m along it without a jump: noise, a chimney
  double step_wide_gap = 4.0;       ///< m where two roofs cross each other: the step changes its sign there
  double step_cover = 0.7;          ///< of a line's length that must jump
  double step_full_jump = 1.0;      ///< m; higher ones say no more
  double step_bend = 0.2;           ///< m across, from end to end, from which a step may be turned from the grain …
  double step_turn = 0.05;          ///< … by this tangent
  double step_part = 1.5;           ///< m; of a line that jumps one way, to be believed
  double step_reach = 1.5;          ///< m beyond its ends to the wall or outline it runs up to
  double step_same_line = 0.75;     ///< m; a wall or a footprint's edge this near is the same line
  double step_same_sine = 0.2;      ///< … if it is turned by less
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::sweep
