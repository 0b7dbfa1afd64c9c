// What the sweep leaves behind: exact points, faces as they grow, and the arcs between them.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/extrude/detail/plane.hpp"
#include "mansard/extrude/extrude.hpp"

namespace mansard::extrude::detail {

/// One face in the making. Faces that turn out to be one plane's neighbouring pieces are united.
struct FaceNode {
  model::FaceKind kind = model::FaceKind::side;
  model::Provenance provenance;
  Direction direction;  ///< of the edge that sweeps it; for side and connector
  Rational slope;       ///< run over rise; for side
};

struct ExactPlace {
  Rational x, y, z;  ///< metres, from the footprint's origin
};

/// Where a point of the surface is: three planes, and the level when their t is a terrace's time.
struct TracePoint {
  Triple planes;
  bool on_level = false;
  std::int64_t level = 0;  ///< quanta
};

/// A closed surface with exact points.
struct ExactSurface {
  struct ExactFace {
    std::vector<std::vector<std::uint32_t>> loops;  ///< outer first
    FaceNode node;
  };
  std::vector<geometry::Point3> places;  ///< the doubles nearest to the points, metres, from the footprint's origin
  std::vector<ExactFace> faces;
  std::vector<TracePoint> points;
  Planes planes;
  std::uint64_t moments = 0;  ///< critical heights and terrace times passed

  [[nodiscard]] auto exact(std::uint32_t point) const -> ExactPlace;
};

/// Gathers the sweep's products; assembled into faces when the sweep has ended.
class Trace {
 public:
  struct Arc {
    std::uint32_t from, to;
    std::uint32_t left, right;  ///< nodes: `left` walks from → to in its boundary, `right` walks to → from
  };

  Planes planes;

  auto point(TracePoint point) -> std::uint32_t;
  [[nodiscard]] auto place(std::uint32_t point) const -> geometry::Point3 { return places_[point]; }
  auto node(FaceNode node) -> std::uint32_t;
  [[nodiscard]] auto node_at(std::uint32_t node) const -> const FaceNode& { return nodes_[node]; }
  void unite(std::uint32_t a, std::uint32_t b);
  void arc(std::uint32_t from, std::uint32_t to, std::uint32_t left, std::uint32_t right);

  /// Says that edges have moved along themselves at this height, as they do beside a terrace: arcs there can overlap in
  /// part and are cut at each other's ends.
  void cut_at(std::int64_t level);
  /// Forgets everything drawn so far; points keep their numbers.
  void forget_arcs() { arcs_.clear(); }

  /// Joins the arcs into faces: loops with holes, terraces merged, points that only pass through taken out. The trace
  /// is used up.
  [[nodiscard]] auto assemble() -> ExactSurface;

 private:
  [[nodiscard]] auto root(std::uint32_t node) const -> std::uint32_t;
  void merge_points();
  void rename(std::uint32_t root_node, std::span<ExactSurface::ExactFace> faces) const;
  void cut_arcs();

  std::vector<TracePoint> points_;
  std::vector<geometry::Point3> places_;
  std::vector<FaceNode> nodes_;
  std::vector<model::Provenance> own_names_;  ///< of the nodes, before any were united
  mutable base::DisjointSets sets_;           ///< of nodes; looking one up shortens paths
  std::vector<Arc> arcs_;
  std::vector<std::int64_t> cuts_;
};

}  // namespace mansard::extrude::detail
