// Chooses which faces of the fractured ground belong together: the integer program O1 + O2 + O7, as a multicut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/fracture/fracture.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::segment {

/// Numbers for fracture::Cut::source: sweep-edge i is cut i, GIS edge j is cut gis_source + j.
inline constexpr std::uint32_t gis_source = 0x80000000U;

enum class GisEdges : std::uint8_t {
  ignore,  ///< as in the paper: GIS edges are not inserted
  hard,    ///< edges between two features are inserted, and those no sweep-edge follows; no part spans two features
};
enum class Continuations : std::uint8_t { sweep, plain };  ///< do continuations count as sweep-edges in O1?
enum class ThinRule : std::uint8_t { all, unsupported };  ///< O7 over all near pairs, or not where both sides are walls

struct Options {
  double alpha = 40.0;          ///< per metre of sweep-edge left unused
  double beta = 60.0;           ///< per metre of footprint edge without a sweep-edge
  double height_weight = 1.0;   ///< of O2, per metre and metre of height difference
  double phi = 0.5;             ///< of O7, times the total edge length
  double thin_distance = 2.0;   ///< m; O7: opposite edges nearer than this
  double thin_angle = 0.5235987755982988;  ///< rad; O7: adjacent edges under this angle
  Continuations continuations = Continuations::plain;
  ThinRule thin_rule = ThinRule::unsupported;
  GisEdges gis_edges = GisEdges::hard;
  double gis_ratio = 0.44;      ///< a face is inside when at least this part of it is inside the footprints …
  double min_height = 2.0;      ///< m; … and its median height above ground at least this
  double exposed = 0.4;         ///< faces with more wall-less boundary than this share of the rest are peeled off
  double narrow = 1.0;          ///< m; parts of less mean width go to their neighbour, or out; 0 keeps them
  std::int64_t samples = 64;    ///< height samples per face, at least 9
  std::optional<double> seconds;  ///< time limit per block; none: until proven optimal or the node limit
  std::int64_t nodes = 100000;    ///< branch-and-bound nodes per solve
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// The lines to fracture a block by: its sweep-edges longest first, then, unless ignored, the GIS edges between
/// features.
[[nodiscard]] auto cuts_of(const sweep::SweepEdges& edges, const block::Block& block, const Options& options)
    -> std::vector<fracture::Cut>;

/// What was measured of a face.
struct FaceEvidence {
  bool inside = false;
  double height = 0;    ///< median z of the mesh's top surface, metres; meaningful when `seen`
  bool seen = false;
  double gis_share = 0; ///< of its area inside the footprints
  std::optional<std::size_t> feature;  ///< index into Scene::footprints of the feature with the largest share
};

/// One interior edge of the program: a run of half-edges between two faces.
struct Candidate {
  std::uint32_t left = 0, right = 0;      ///< faces
  std::vector<std::uint32_t> half_edges;  ///< those with `left` on their left
  double length = 0, height_difference = 0;  ///< m
  bool sweep = false;   ///< isSweepEdge
  bool forced = false;  ///< between two features, with gis_edges = hard
  bool chosen = false;
};

struct Terms {
  double sweep_unused = 0;  ///< O1, α
  double unsupported = 0;   ///< O1, β
  double height = 0;        ///< O2
  double thin = 0;          ///< O7
  [[nodiscard]] auto sum() const -> double { return sweep_unused + unsupported + height + thin; }
};

/// Where a footprint's edge comes from.
struct EdgeOrigin {
  std::vector<std::uint32_t> sweep_edges;   ///< hard parts only, those that face outwards here, by number
  std::optional<std::uint32_t> neighbour;   ///< the part on the other side, if any
};

/// One output footprint.
struct Part {
  geometry::Polygon polygon;  ///< simple, no vertex visited twice, collinear points removed
  std::vector<std::vector<EdgeOrigin>> edges;  ///< per ring (outer, then holes), per edge
  std::vector<std::uint32_t> faces;
  std::optional<std::size_t> feature;  ///< index into Scene::footprints it overlaps most
  double height = 0;  ///< z, median of the mesh's top surface, metres
};

struct Segmentation {
  std::vector<FaceEvidence> faces;
  std::vector<Candidate> candidates;
  std::vector<std::optional<std::uint32_t>> part_of_face;
  std::vector<Part> parts;  ///< ordered by feature, then by lowest face

  Terms terms;           ///< re-evaluated from the labels
  double objective = 0;  ///< terms.sum()
  double bound = 0;      ///< proven: no segmentation is cheaper
  std::string status;    ///< "optimal", "stopped" (limit reached; the gap is true), "empty" (no face inside)
  std::int64_t rounds = 0, nodes = 0;
  std::size_t variables = 0, conflicts = 0;
  std::vector<base::Diagnostic> warnings;
};

/// Guarantees: 1 no chosen edge has the same part on both sides, no unchosen one different parts · 2 bound ≤ objective,
/// equal when "optimal" · 3 parts are simple polygons with holes, disjoint · 4 the same input gives the same answer.
/// Gives up with: "segment-failed".
[[nodiscard]] auto choose(const fracture::Arrangement& arrangement, const sweep::SweepEdges& edges,
                          const block::Block& block, const rays::Scene& mesh, const Options& options,
                          const base::Run& run = {}) -> base::Result<Segmentation>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::segment
