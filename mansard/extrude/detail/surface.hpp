// What the sweep leaves behind: exact points, faces as they grow, and the arcs between them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "mansard/extrude/detail/direction.hpp"
#include "mansard/extrude/detail/numbers.hpp"
#include "mansard/extrude/extrude.hpp"

namespace mansard::extrude::detail {

/// One face in the making. Faces that turn out to be one plane's neighbouring pieces are united.
struct FaceNode {
  FaceKind kind = FaceKind::side;
  Provenance provenance;
  Direction direction;  ///< of the edge that sweeps it; for side and connector
  Rational slope;       ///< run over rise; for side
};

/// Gathers the sweep's products; assembled into faces when the sweep has ended.
class Trace {
 public:
  struct Arc {
    std::uint32_t from, to;
    std::uint32_t left, right;  ///< nodes: `left` walks from → to in its boundary, `right` walks to → from
  };

  /// The index of an exact point, the same for equal points.
  auto point(const ExactPoint& p, const Rational& z) -> std::uint32_t;
  auto node(FaceNode node) -> std::uint32_t;
  void unite(std::uint32_t a, std::uint32_t b);
  void arc(std::uint32_t from, std::uint32_t to, std::uint32_t left, std::uint32_t right);

  /// Says that edges have moved along themselves at this height, as they do beside a terrace: arcs there can overlap in
  /// part and are cut at each other's ends.
  void cut_at(const Rational& z);
  void cut_arcs();

  struct Point {
    Rational x, y, z;
  };
  [[nodiscard]] auto root(std::uint32_t node) const -> std::uint32_t;
  [[nodiscard]] auto points() const -> const std::vector<Point>& { return points_; }
  [[nodiscard]] auto nodes() const -> const std::vector<FaceNode>& { return nodes_; }
  [[nodiscard]] auto arcs() const -> const std::vector<Arc>& { return arcs_; }
  /// Forgets everything drawn so far; points keep their numbers.
  void forget_arcs() { arcs_.clear(); }

 private:
  std::vector<Point> points_;
  std::map<std::array<double, 3>, std::vector<std::uint32_t>> found_;  ///< by rounded place: equal points round equally
  std::vector<FaceNode> nodes_;
  mutable std::vector<std::uint32_t> parent_;
  std::vector<Arc> arcs_;
  std::vector<Rational> cuts_;
};

/// A closed surface with exact points.
struct ExactSurface {
  std::vector<Trace::Point> points;
  struct ExactFace {
    std::vector<std::vector<std::uint32_t>> loops;  ///< outer first
    FaceNode node;
  };
  std::vector<ExactFace> faces;
};

/// Joins the arcs into faces: loops with holes, terraces merged, points that only pass through taken out.
[[nodiscard]] auto assemble(Trace& trace) -> ExactSurface;

}  // namespace mansard::extrude::detail
