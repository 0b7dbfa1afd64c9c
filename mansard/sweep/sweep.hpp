// Finds sweep-edges: the approximate plan positions of vertical walls, with their evidence in height.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/slice/slice.hpp"
#include "mansard/sweep/options.hpp"

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

/// How the block's footprints lie beside the walls of the mesh.
struct Registration {
  geometry::Point2 shift;  ///< m; what to add to the footprints to bring them to the mesh
  double spread = 0;       ///< m; median distance, by length, between walls and footprints thereafter
};

struct SweepEdges {
  std::vector<SweepEdge> edges;  ///< longest first, by whole centimetres; then by coordinates
  std::vector<Cluster> clusters;
  Registration registration;
};

/// The shift of the registration is 0 unless it stands out of what it leaves unexplained.
/// Guarantees: 1 every edge's cluster has area ≥ gamma · 2 the result does not depend on the order of segments within
/// a slice (beyond rounding) nor on the thread count · 3 edges are sorted longest first.
[[nodiscard]] auto find_edges(const slice::SliceStack& stack, const block::Block& block, const Options& options,
                              const base::Run& run = {}) -> SweepEdges;

/// The same edges, where walls are inside of a footprint under eaves that end inside of it, too, moved outward to where
/// these end as seen from above (docs/decisions/0115). Guarantees: 1 edges are sorted longest first · 2 none is moved
/// by more than `eaves_reach`. Cost: O(length of such walls · log n).
[[nodiscard]] auto under_eaves(SweepEdges edges, const block::Block& block, const rays::Scene& mesh,
                               const Options& options) -> SweepEdges;

}  // namespace mansard::sweep
