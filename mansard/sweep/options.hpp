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
  double thin_distance = 4.0;  ///< m; lines lose weight for anti-parallel lines this near (buses, fences)
  double setback = 1.0;        ///< m; wall feet this far off the median become sweep-edges of their own

  // Lines in a slice.
  double line_node_spacing = 0.3;  ///< m; chains may be cut at nodes this far apart
  /// Pieces of at least this number of node spacings are fitted without their first and last spacing, which may reach
  /// around a corner. Chosen by hand; not measured.
  std::size_t line_trim_nodes =
      6;  ///< a piece of so many node distances leaves out its first and last one: the corner may be in it
  double line_piece_price = 1.0;  ///< m of chain that lie line_distance off: what another piece must save
  /// Minimum ratio of a piece's chord to its length along the chain; pieces that wind more are vegetation. Chosen by
  /// hand; not measured.
  double line_straightness = 0.6;
  /// Cosine of the maximum angle between two pieces that may be joined to one line. Chosen by hand; not measured.
  double line_merge_cosine = 0.9;
  double line_minimum_length = 0.5;  ///< m; shorter lines are noise
  /// m across one triangle: it belongs to a stray vertex, not to a wall; no building's wall is as long
  static constexpr double line_maximum_segment = 500;

  // Lines turned to the footprints' edges.
  double gis_straight_turn =
      0.05;  ///< rad; consecutive edges that bend less count as one: vertices of party walls must not shorten a facade
  double gis_minimum_edge = 0.5;  ///< m; a shorter GIS edge has no direction to speak of
  /// Score of an edge at right angles to a line, as a share of the score of a parallel edge. Reference implementation
  /// chordatlas: 0.2, with its sign corrected.
  double gis_square_score = 0.2;
  double gis_maximum_swing = 1.0;  ///< m; an end that would move farther was measured better than that

  // Clusters of lines.
  double thin_turn = 0.7 * std::numbers::pi;  ///< rad; lines turned by more are opposite to each other
  /// Number of slices up and down within which a cluster of lines continues. Reference implementation chordatlas: 2.
  std::size_t cluster_reach = 2;
  /// Minimum number of lines in a cluster. A metre of height at 0.2 m, with one slice missed; the reference
  /// implementation asks for 6 lines at 0.5 m.
  std::size_t cluster_lines = 4;
  /// Minimum share of a line beside its cluster's first line when it is turned by up to sweep.cluster_turn. Reference
  /// implementation chordatlas: 0.8.
  double cluster_overlap = 0.8;
  double cluster_turn = 0.3;  ///< rad
  /// Minimum share of a line beside its cluster's first line when it is turned by up to sweep.cluster_turn_parallel.
  /// Reference implementation chordatlas: 0.5.
  double cluster_overlap_parallel = 0.5;
  double cluster_turn_parallel = 0.1;  ///< rad

  // Wall feet of a cluster.
  double column_width = 0.2;  ///< m
  double column_gap = 3.0;    ///< m without columns part an edge in two
  /// Columns with less than this share of the median column's lines are left out, as the ragged end of a sweep-edge.
  /// Chosen by hand; not measured.
  double column_support = 0.25;
  double wall_minimum_height = 1.0;  ///< m of height; less is a step in a roof
  /// Maximum lateral movement of a wall per metre of height. Reference implementation chordatlas: 0.5 rad from the
  /// vertical, here as a tangent.
  double wall_slope = 0.546;
  double wall_window = 1.0;  ///< m of height a slope is taken over: single slices are too noisy
  double wall_gap = 0.65;    ///< m of height without samples that a wall continues over, if not 3.1 slices
  /// Number of slice intervals without samples over which a wall continues. Three slices, and a margin for rounding.
  double wall_gap_slices = 3.1;
  double wall_spread = 0.5;  ///< m; a wall leaves its own mean by less
  /// Minimum height of the lowest wall in a column, as a share of the tallest one's. Chosen by hand; not measured.
  double wall_lower_share = 0.3;
  /// Minimum share of a side's columns with a wall; below it, the side is placed at its gutter. Chosen by hand; not
  /// measured.
  double wall_share = 0.25;
  double untidy_height = 2.5;        ///< m above ground where cars and hedges hide the wall
  std::size_t setback_columns = 10;  ///< columns of a setback, at least
  double gutter_band = 0.5;          ///< m above the lowest sample: the gutter
  /// of the columns' lower ends, and 1 minus it of their upper ends, are a side's low and high; only told, in the layer
  /// of the sweep-edges
  static constexpr double height_percentile = 0.1;
  double minimum_length = 1.0;  ///< m; shorter sweep-edges are left out

  // Selection of sides.
  double same_line = 0.4;          ///< m; sides whose feet are this near stand on one line
  double same_line_gap = 2.0;      ///< m along it: a balcony, a bay, a tree before the wall
  double same_line_cosine = 0.98;  ///< cosine of 0.2 rad
  double outline_margin = 2.0;     ///< m outside the footprints; farther off stand trees and neighbours
  double outline_spacing = 0.25;   ///< m between the points of an edge that are tested
  /// Sides that keep less than this share of their length next to opposite lines count with that share alone. Chosen by
  /// hand; not measured.
  double thin_share = 0.4;

  // Registration of the footprints.
  /// Cosine of the maximum angle between a wall and the outline's edge it is compared with. Docs/decisions/0015.
  double registration_cosine = 0.995;
  double registration_shared = 1.0;           ///< m of two edges beside each other before their distance says anything
  double registration_distance = 1.0;         ///< m; walls farther off their footprint are another thing
  double registration_distance_astray = 1.5;  ///< m; unless all of them are
  double registration_noise = 0.02;           ///< m; distances under it are all alike
  /// Minimum share of the walls' length that must face across every direction for a displacement to be determined.
  /// Chosen by hand; not measured.
  double registration_determined = 0.02;
  /// A displacement counts when it is this many times the median distance that it leaves. Docs/decisions/0015.
  double registration_stands_out = 2.0;
  /// A displacement also counts when it is this many times its standard error. 95 % of a normal distribution in the
  /// plane; docs/decisions/0018.
  double registration_significance = 2.45;
  /// Share of the mean distance that a displacement must explain when its standard error decides. Docs/decisions/0018.
  double registration_explains = 0.15;
  /// Share of the mean distance that a displacement larger than sweep.gis_offset must explain. Docs/decisions/0018.
  double registration_explains_astray = 0.5;
  double registration_minimum_shift = 0.12;  ///< m; less is as likely the scan's own displacement as the footprints'
  /// Number of rounds of the reweighted least squares that fit the displacement. Far more than the fit takes to
  /// converge; not measured.
  std::size_t registration_rounds = 30;

  // Walls put on footprints.
  /// Cosine of the maximum angle between a wall and the footprint's edge it is moved onto. Chosen by hand; not
  /// measured.
  double footprint_cosine = 0.7;
  double footprint_piece = 0.1;      ///< m
  double footprint_straight = 0.03;  ///< m; corners this near to the line without them do not bend it
  double footprint_rest = 1.0;       ///< m of a sweep-edge beside which there is no footprint edge

  // Walls under eaves.
  double eaves_reach = 1.5;   ///< m inside of a footprint's edge: as far as footprints may be astray
  double eaves_spread = 0.3;  ///< m; median distance of the eaves' columns from their median
  double roof_height = 2.0;   ///< m above ground; lower is no roof; no option: segment.min_height
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::sweep
