// What the oracle's edges sweep, strip by strip, and the faces that neighbouring strips of one plane make.
#pragma once

#include <vector>

#include "wave.hpp"

namespace oracle {

/// What two strips must have in common to be of one face, and the edge that this one comes from.
struct Plane {
  FaceKind kind = FaceKind::side;
  Direction direction;
  Rational offset;  ///< of the line, or the height of a level plane
  std::size_t track = 0, part = 0;
  Provenance provenance;

  [[nodiscard]] auto same_as(const Plane& o) const -> bool {
    return kind == o.kind && direction == o.direction && offset == o.offset && track == o.track && part == o.part;
  }
};

/// The faces in normal form: corners left out where nothing turns and nothing meets, edges and faces sorted.
[[nodiscard]] auto tidied(std::vector<Face> faces) -> std::vector<Face>;

class Strips {
 public:
  /// The strip that an edge sweeps between two heights, equal ones for a terrace.
  void add(const Plane& plane, const Slab::Edge& swept, const Rational& from, const Rational& to);
  /// One boundary edge of a level face. All level faces of one plane count as one.
  void border(const Plane& plane, const Point& start, const Point& end, const Rational& z);
  [[nodiscard]] auto faces() const -> std::vector<Face>;

 private:
  struct Edge {
    std::array<Point3, 2> ends;
    std::size_t strip;
  };
  void draw(const Point3& from, const Point3& to);

  std::vector<Plane> planes_;  ///< of every strip
  std::vector<Edge> edges_;
};

}  // namespace oracle
