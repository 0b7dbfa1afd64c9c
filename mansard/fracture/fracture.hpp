// Fractures the ground plane along lines and their continuations. A kernel: knows only geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::fracture {

enum class Kind : std::uint8_t {
  hard,          ///< on the measured part of an inserted line
  continuation,  ///< on the prolongation of one
  border,        ///< on the bounding rectangle
};

/// A line to insert. Lines are inserted in the order given (longest first is the caller's business).
struct Cut {
  geometry::Segment2 segment;
  std::uint32_t source = 0;  ///< the caller's number for it, remembered by every edge that comes of it
};

/// Why an edge is there. An edge may lie on several cuts.
struct Origin {
  Kind kind = Kind::border;
  std::uint32_t source = 0;  ///< of the cut; 0 for border
  bool along = true;         ///< the half-edge runs in the cut's direction
  friend auto operator<=>(const Origin&, const Origin&) = default;
};

struct HalfEdge {
  std::uint32_t from = 0;  ///< vertex
  std::uint32_t twin = 0, next = 0, previous = 0;
  std::optional<std::uint32_t> face;  ///< on its left; none outside the bounding rectangle
  std::vector<Origin> origins;        ///< sorted; the twin has the same with `along` reversed
};

struct Face {
  std::uint32_t edge = 0;  ///< one of its half-edges: faces are simply connected
  double area = 0;         ///< m²
};

/// A planar subdivision of a rectangle.
struct Arrangement {
  std::vector<geometry::Point2> vertices;
  std::vector<HalfEdge> half_edges;  ///< twins are 2k and 2k + 1
  std::vector<Face> faces;
  std::vector<base::Diagnostic> warnings;  ///< cuts ignored or left out; the subject is "cut <source>"

  [[nodiscard]] auto to(std::uint32_t half_edge) const -> std::uint32_t {
    return half_edges[half_edges[half_edge].twin].from;
  }
  [[nodiscard]] auto segment(std::uint32_t half_edge) const -> geometry::Segment2 {
    return {vertices[half_edges[half_edge].from], vertices[to(half_edge)]};
  }
  [[nodiscard]] auto ring(std::uint32_t face) const -> geometry::Ring;
};

struct Options {
  double continuation = 2.0;  ///< m; a line goes on for this far beyond both ends, then to the next edge
  double snap = 0.05;         ///< m; vertices and lines nearer than this become one
  double margin = 10.0;       ///< m; from the cuts to the bounding rectangle
  /// steps a cut may take to settle …; a limit on the work: lines that settle were seen to take 155 at most
  static constexpr std::size_t settle_steps = 300;
  /// … and so many more for each edge that it crosses; a limit on the work
  static constexpr std::size_t settle_steps_per_crossing = 4;
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// Guarantees: 1 faces are simple, disjoint and cover the rectangle exactly · 2 no two vertices are nearer than `snap`,
/// nor a vertex to an edge it is not on, and no point of a cut lies farther than 2·snap from the edges that come of it
/// · 3 every half-edge but the border's knows its origins · 4 the same cuts in the same order give the same
/// arrangement, and shifted by whole metres, the shifted one. A cut shorter than `snap` is ignored
/// ("fracture-cut-short"); one that cannot go in without breaking guarantee 1 or 2 is left out
/// ("fracture-cut-left-out"). A run that is cancelled leaves out the cuts not yet reached. Fails with:
/// "fracture-not-finite". Cost: O(cuts × crossed faces).
[[nodiscard]] auto arrange(const std::vector<Cut>& cuts, const geometry::Box2& region, const Options& options,
                           const base::Run& run = {}) -> base::Result<Arrangement>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::fracture
