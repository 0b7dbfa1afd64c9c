// Finds sweep-edges: the approximate plan positions of vertical walls, with their evidence in height.
#pragma once

#include <cstddef>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/slice/slice.hpp"

namespace mansard::sweep {

/// A straight line fitted to one slice.
struct Line {
  geometry::Segment2 segment;  ///< outside on the left
  std::size_t slice = 0;       ///< index into SliceStack::slices
};

/// Lines of neighbouring slices that follow one side of a building upwards.
struct Cluster {
  std::vector<Line> lines;  ///< from below upwards
  double area = 0;          ///< m²: sum of lengths × slice interval
};

struct SweepEdge {
  geometry::Segment2 segment;  ///< plan position of the wall foot; outside on the left
  double area = 0;             ///< m² of mesh behind it
  double low = 0, high = 0;    ///< z between which the wall was seen, metres
  std::size_t cluster = 0;     ///< index into SweepEdges::clusters
};

struct SweepEdges {
  std::vector<SweepEdge> edges;    ///< longest first; ties by coordinates
  std::vector<Cluster> clusters;
};

struct Options {
  double gamma = 10.0;            ///< m²; clusters with less mesh area are dropped
  double line_distance = 0.3;     ///< m; segments this near a line belong to it
  double line_gap = 0.6;          ///< m; gaps up to this are closed along a line
  double gis_angle = 0.39;        ///< rad; lines turn to a GIS edge within this angle; 0 leaves them alone
  double gis_distance = 3.0;      ///< m; … when the GIS edge is this near
  double cluster_step = 0.8;      ///< m; greatest lateral step between neighbouring slices
  double low_height = 4.0;        ///< m above ground; lines below weigh a tenth (cars, hedges)
  double thin_distance = 4.0;     ///< m; lines lose weight for anti-parallel lines this near (buses, fences)
  double setback = 1.0;           ///< m; wall feet this far off the median become sweep-edges of their own
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// Guarantees: 1 every edge's cluster has area ≥ gamma · 2 the result does not depend on the order of segments within
/// a slice (beyond rounding) nor on the thread count · 3 edges are sorted longest first.
[[nodiscard]] auto find_edges(const slice::SliceStack& stack, const block::Block& block, const Options& options,
                              const base::Run& run = {}) -> SweepEdges;

}  // namespace mansard::sweep
