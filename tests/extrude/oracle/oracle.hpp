// The extrusion once more, slow and plain, to judge the kernel by: exact rationals throughout, every vertex against
// every edge at every event, nothing filtered, nothing remembered. It shares the kernel's input and no other code, and
// its surface is made another way: out of the strips that edges sweep between one critical height and the next.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "mansard/extrude/detail/footprint.hpp"

namespace oracle {

using Rational = mpq_class;
using mansard::extrude::detail::Footprint;
using mansard::model::FaceKind;
using mansard::model::Provenance;

struct Point {
  Rational x, y;
  friend auto operator==(const Point&, const Point&) -> bool = default;
  friend auto operator<(const Point& p, const Point& q) -> bool { return p.x != q.x ? p.x < q.x : p.y < q.y; }
};

struct Point3 {
  Rational x, y, z;
  friend auto operator==(const Point3&, const Point3&) -> bool = default;
  friend auto operator<(const Point3& p, const Point3& q) -> bool {
    return p.z != q.z ? p.z < q.z : p.x != q.x ? p.x < q.x : p.y < q.y;
  }
};

/// A face as the set of its directed boundary edges, interior on the left seen from outside: the same for whatever way
/// its loops are listed. Corners where nothing turns and nothing meets are left out.
struct Face {
  FaceKind kind = FaceKind::side;
  std::optional<Provenance> provenance;         ///< for side and terrace
  std::vector<std::array<Point3, 2>> boundary;  ///< sorted
  friend auto operator==(const Face&, const Face&) -> bool = default;
  friend auto operator<(const Face& p, const Face& q) -> bool {
    return p.kind != q.kind ? p.kind < q.kind : p.boundary < q.boundary;
  }
};

/// The wavefront between two critical heights: every edge with its ends at both.
struct Slab {
  Rational from, to;  ///< heights, from < to
  struct Edge {
    Point start, end, start_above, end_above;
  };
  std::vector<Edge> edges;

  /// The ends of every edge at a height within the slab.
  [[nodiscard]] auto at(const Rational& z) const -> std::vector<std::array<Point, 2>>;
  /// m², exact.
  [[nodiscard]] auto area(const Rational& z) const -> Rational;
};

struct Solid {
  std::vector<Face> faces;  ///< sorted
  std::vector<Slab> slabs;  ///< from the ground up, without gaps
  std::vector<Rational>
      events;       ///< heights at which an edge vanished or a vertex met an edge, rising; terraces' included
  Rational volume;  ///< m³: the integral of the wavefront's area over the height
};

/// Raises the footprint to the cap, metres above its base. Throws std::logic_error when an invariant does not hold.
[[nodiscard]] auto raise(const Footprint& footprint, const Rational& cap) -> Solid;

}  // namespace oracle
