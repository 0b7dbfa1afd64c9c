// The numbers that segment decides by; what each means and where it comes from is told in options.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "mansard/base/options.hpp"

namespace mansard::segment {

enum class GisEdges : std::uint8_t {
  ignore,     ///< as in the paper: GIS edges are not inserted
  candidate,  ///< edges between two features are inserted, and those no sweep-edge follows; the optimum decides
  hard,       ///< the same, and no part spans two features
};
enum class Continuations : std::uint8_t { sweep, plain };  ///< do continuations count as sweep-edges in O1?
enum class ThinRule : std::uint8_t {
  any,          ///< O7 over any two edges that do not meet and are nearer than the limit, whichever way they face
  all,          ///< over those that face each other
  unsupported,  ///< the same, but not where both sides are walls
};
enum class ThinReach : std::uint8_t { face, block };  ///< O7 between edges of one face, or across several faces too
enum class HeightMeasure : std::uint8_t {
  along,   ///< mean difference of the mesh's heights on the two sides of the edge, sampled along it
  median,  ///< difference of the two faces' median heights, as in the reference implementation
};

/// Of the heuristics that find a first grouping.
struct SearchLimits {
  /// nodes; sequences between larger pieces cost more than they find; a limit on the work
  static constexpr std::size_t piece = 400;
  static constexpr std::size_t sequence = 60;  ///< nodes moved one after the other, at most; a limit on the work
  static constexpr std::size_t passes = 20;    ///< rounds of moving and joining, at most; a limit on the work
};

struct Options {
  double alpha = 40.0;                     ///< per metre of sweep-edge left unused
  double beta = 60.0;                      ///< per metre of footprint edge without a sweep-edge
  double height_weight = 16.0;             ///< of O2, per metre and metre of height difference
  double phi = 0.5;                        ///< of O7, times the total edge length
  double thin_distance = 2.0;              ///< m; O7: opposite edges nearer than this
  double thin_angle = 0.5235987755982988;  ///< rad; O7: adjacent edges under this angle
  Continuations continuations = Continuations::plain;
  ThinRule thin_rule = ThinRule::unsupported;
  ThinReach thin_reach = ThinReach::face;
  HeightMeasure height_measure = HeightMeasure::median;
  double height_offset = 0.6;  ///< m; how far to both sides of an edge heights are sampled along it
  GisEdges gis_edges = GisEdges::hard;
  double gis_alpha = 10.0;        ///< per metre of GIS edge left unused, with gis_edges = candidate
  double gis_ratio = 0.44;        ///< a face is inside when at least this part of it is inside the footprints …
  double min_height = 2.0;        ///< m; … and its median height above ground at least this
  double exposed = 0.4;           ///< faces with more wall-less boundary than this share of the rest are peeled off
  double narrow = 1.0;            ///< m; parts of less mean width go to their neighbour, or out; 0 keeps them
  std::int64_t samples = 64;      ///< height samples per face, at most
  std::optional<double> seconds;  ///< time limit per block; none: until proven optimal or the node limit
  std::int64_t nodes = 100000;    ///< branch-and-bound nodes per solve
  bool cliques = false;           ///< give the solver a row for every clique of conflicts as well

  // Slivers and needles (O7).
  /// Tangent of the maximum turn between edges that count as one when slivers and needles are looked for. Reference
  /// implementation chordatlas: 0.05 rad; not measured.
  double thin_run_turn = 0.1;
  double thin_shortest = 0.2;  ///< m; runs shorter than that have no direction to speak of
  double thin_parallel = 0.3;  ///< rad; opposite runs are parallel within this

  // What is measured of a face, and along an edge.
  double samples_per_area = 2.0;  ///< height samples per m² of a face
  /// Minimum number of height samples per face. Chosen by hand; not measured.
  std::size_t minimum_samples = 9;
  bool by_points = false;  ///< points are the samples of a face, where it has enough; no option: of the scan
  double rim = 0;  ///< m along a face's boundary where samples may be of either side; no option: of the scan's edges
  /// Share of a face within the footprints above which the face is inside even without mesh, and is not peeled off.
  /// Chosen by hand; not measured.
  double surely_inside = 0.8;
  /// m between samples along an edge, with height_measure = along; of the grid of places
  static constexpr double height_spacing = 0.5;

  // GIS edges.
  double gis_near = 0.2;       ///< m; as far as the other member's boundary, or a wall, may be off a GIS edge
  double gis_shortest = 0.05;  ///< m; of a stretch of GIS edge, and of a gap between stretches
  /// Sine of the maximum angle between an edge of a footprint and a line that runs along it. Chosen by hand; not
  /// measured.
  double gis_parallel_sine = 0.1;

  // From faces to parts.
  double smallest_part = 1.0;  ///< m²; smaller parts go to their neighbour, or out
  /// Narrow parts of at least this share of their neighbour's height are part of its roof. Docs/decisions/0013.
  double low_share = 0.5;
  double collinear = 0.01;  ///< m; corners this near to the edge without them are dropped
  /// m; how far a part that touches itself draws back; a tenth of what surveys resolve
  static constexpr double opening = 0.01;

  SearchLimits search;
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::segment
