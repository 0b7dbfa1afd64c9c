// Chooses which faces of the fractured ground belong together: the integer program O1 + O2 + O7, as a multicut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/fracture/fracture.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/segment/options.hpp"
#include "mansard/segment/terms.hpp"
#include "mansard/solver/solver.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::segment {

/// Numbers for fracture::Cut::source: sweep-edge i is cut i, GIS edge j is cut gis_source + j.
inline constexpr std::uint32_t gis_source = 0x80000000U;

/// The lines to fracture a block by: its walls longest first, then, unless ignored, the GIS edges between features and
/// those of torn walls, then its roof steps, longest first: these go on to the next of all those lines and no farther.
[[nodiscard]] auto cuts_of(const sweep::SweepEdges& edges, const block::Block& block, const Options& options)
    -> std::vector<fracture::Cut>;

/// What was measured of a face.
struct FaceEvidence {
  bool inside = false;
  double height = 0;  ///< median z of the mesh's top surface, metres; meaningful when `seen`
  bool seen = false;
  double gis_share = 0;                ///< of its area inside the footprints
  std::optional<std::size_t> feature;  ///< index into Scene::footprints of the feature with the largest share
};

/// One interior edge of the program: a run of half-edges between two faces.
struct Candidate {
  std::uint32_t left = 0, right = 0;      ///< faces
  std::vector<std::uint32_t> half_edges;  ///< those with `left` on their left
  double length = 0;                      ///< m
  /// What each term is paid for: m of the edge (of a low roof step its share); for `height` the difference, m.
  Terms amounts;
  bool sweep = false;   ///< isSweepEdge, most of it
  bool forced = false;  ///< between two features, with gis_edges = hard
  bool solved = false;  ///< cut by the program's answer
  bool chosen = false;  ///< between two parts, after small and narrow parts were joined
  Terms costs;          ///< in the objective's units; for `thin` φ for each conflict with the outline
};

/// A bad pair of O7: two candidates; a candidate and the outline, or itself, where `second` is absent.
struct Conflict {
  std::uint32_t first = 0;
  std::optional<std::uint32_t> second;
  friend auto operator<=>(const Conflict&, const Conflict&) = default;
};

/// Whoever walks from one side of the edge around to the other along the path crosses another wall, if the edge is one:
/// s_edge ≤ Σ s_path. By candidates.
struct CycleRow {
  std::uint32_t edge = 0;
  std::vector<std::uint32_t> path;  ///< ascending
};

/// One output footprint.
struct Part {
  geometry::Polygon polygon;  ///< simple, no vertex visited twice, collinear points removed
  std::vector<std::uint32_t> faces;
  std::optional<std::size_t> feature;  ///< index into Scene::footprints it overlaps most
  double height = 0;                   ///< z, median of the mesh's top surface, metres
};

/// Ground of a feature that the mesh shows as high enough for a building, and that no part has.
struct LeftOut {
  std::optional<std::size_t> feature;  ///< index into Scene::footprints
  double area = 0;                     ///< m² within the footprint
  double height = 0;                   ///< m above the ground, median of the mesh's top surface
  std::string why;                     ///< the end of a sentence: "a blurred wall: …"
};

struct Segmentation {
  std::vector<FaceEvidence> faces;
  std::vector<Candidate> candidates;
  std::vector<Conflict> conflicts;  ///< ascending
  double phi = 0;                   ///< what a conflict costs when both are cut
  std::vector<CycleRow> rows;       ///< those of the start (stars), then those that the rounds added
  std::vector<std::optional<std::uint32_t>> part_of_face;
  std::vector<Part> parts;        ///< ordered by feature, then by lowest face
  std::vector<LeftOut> left_out;  ///< in the order in which they were taken out

  Terms terms;           ///< re-evaluated from the labels
  double objective = 0;  ///< terms.sum()
  double bound = 0;      ///< proven: no segmentation is cheaper
  std::string status;    ///< "optimal", "empty" (no face inside), "stopped" (a limit reached, the run cancelled, or the
                         ///< solver gave up; labels are the best found, and the gap is true)
  std::int64_t rounds = 0, nodes = 0;
  std::size_t variables = 0;
  double solve_cpu_seconds = 0;  ///< from the candidates and conflicts to the labels
  std::vector<base::Diagnostic> warnings;
};

/// Guarantees: 1 no chosen edge has the same part on both sides, no unchosen one different parts · 2 bound ≤ objective,
/// equal when "optimal" · 3 parts are simple polygons with holes, disjoint · 4 the same input gives the same answer.
/// Fails with: "segment-failed".
[[nodiscard]] auto choose(const fracture::Arrangement& arrangement, const sweep::SweepEdges& edges,
                          const block::Block& block, const rays::Scene& mesh, const Options& options,
                          const base::Run& run = {}) -> base::Result<Segmentation>;

/// The integer program that was solved, whole and with every row it took but those of cliques, which only say again
/// what is known of whole points: variable i is s of candidate i, then comes a y
/// for every conflict of two candidates. Costs and constant are whole, in thousandths of the objective. Every cut of
/// the plane into parts satisfies the rows, so whatever any solver proves of it bounds the segmentation; when the
/// status is "optimal", its optimum is 1000 × objective but for one unit of rounding a candidate.
[[nodiscard]] auto program_of(const Segmentation& segmentation) -> solver::Program;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::segment
