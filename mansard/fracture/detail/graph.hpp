// The planar graph that grows: vertices, undirected edges with what lies on them, and a way back.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/fracture/detail/cells.hpp"
#include "mansard/fracture/fracture.hpp"

namespace mansard::fracture::detail {

/// That a cut runs along an edge.
struct Trace {
  std::uint32_t cut = 0;  ///< index into the cuts
  Kind kind = Kind::hard;
  bool along = true;  ///< from the edge's `a` to its `b`
};

struct Edge {
  std::uint32_t a = 0, b = 0;
  bool border = false;        ///< on the rectangle, counter-clockwise; never bent
  std::vector<Trace> traces;  ///< by cut, at most one each
  bool alive = true;
};

struct Vertex {
  Point2 at;
  bool alive = true;
  std::vector<std::uint32_t> edges;  ///< alive ones, in no order
};

class Graph {
 public:
  /// Starts with the rectangle. `reach`: the largest distance, metres, that `edges_near` will be asked for.
  Graph(const Box2& rectangle, double reach);

  [[nodiscard]] auto vertices() const -> const std::vector<Vertex>& { return vertices_; }
  [[nodiscard]] auto edges() const -> const std::vector<Edge>& { return edges_; }
  [[nodiscard]] auto place(std::uint32_t vertex) const -> Point2 { return vertices_[vertex].at; }
  [[nodiscard]] auto segment(std::uint32_t edge) const -> Segment2 {
    return {place(edges_[edge].a), place(edges_[edge].b)};
  }
  [[nodiscard]] auto find(std::uint32_t a, std::uint32_t b) const -> std::optional<std::uint32_t>;

  /// All nearer than `distance`, metres, by number.
  [[nodiscard]] auto vertices_near(const Segment2& segment, double distance) const -> std::vector<std::uint32_t> {
    return vertices_near(segment, distance, segment);
  }
  [[nodiscard]] auto edges_near(Point2 p, double distance) const -> std::vector<std::uint32_t>;
  /// All edges that the segment crosses, by number: properly, so that no end of either lies on the other. Exact.
  [[nodiscard]] auto edges_across(const Segment2& segment) const -> std::vector<std::uint32_t> {
    return edges_across(segment, segment);
  }
  /// Of these, at least all that are near, or cross, `part` of the segment; only what is about there is looked at.
  [[nodiscard]] auto vertices_near(const Segment2& segment, double distance, const Segment2& part) const
      -> std::vector<std::uint32_t>;
  [[nodiscard]] auto edges_across(const Segment2& segment, const Segment2& part) const -> std::vector<std::uint32_t>;

  auto add_vertex(Point2 p) -> std::uint32_t;
  void drop_vertex(std::uint32_t vertex);
  auto add_edge(Edge edge) -> std::uint32_t;
  void drop_edge(std::uint32_t edge);

  struct Mark {
    std::size_t vertices = 0, edges = 0, dropped_vertices = 0, dropped_edges = 0;
  };
  [[nodiscard]] auto mark() const -> Mark {
    return {vertices_.size(), edges_.size(), dropped_vertices_.size(), dropped_edges_.size()};
  }
  /// Everything as it was at the mark.
  void back_to(const Mark& mark);

 private:
  void attach(std::uint32_t edge);
  void detach(std::uint32_t edge);

  double reach_;
  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> dropped_vertices_, dropped_edges_;
  Cells vertex_cells_, edge_cells_;
};

}  // namespace mansard::fracture::detail
