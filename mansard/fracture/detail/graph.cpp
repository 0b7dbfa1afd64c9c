#include "mansard/fracture/detail/graph.hpp"

#include <algorithm>

#include "mansard/geometry/predicates.hpp"

namespace mansard::fracture::detail {
namespace {

constexpr double cell_side = 3.0;  // metres: a few edges to a cell in a block of houses

void sort_out(std::vector<std::uint32_t>& numbers) {
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

Graph::Graph(const Box2& rectangle, double reach)
    : reach_(reach * 1.001), vertex_cells_(rectangle, cell_side), edge_cells_(rectangle, cell_side) {
  const Point2 low = rectangle.least, high = rectangle.most;
  for (const Point2 corner : {low, Point2{high.x, low.y}, high, Point2{low.x, high.y}}) add_vertex(corner);
  for (std::uint32_t i = 0; i < 4; ++i) add_edge({i, (i + 1) % 4, true, {}, true});
}

auto Graph::find(std::uint32_t a, std::uint32_t b) const -> std::optional<std::uint32_t> {
  for (const std::uint32_t e : vertices_[a].edges)
    if (edges_[e].a == b || edges_[e].b == b) return e;
  return std::nullopt;
}

auto Graph::vertices_near(const Segment2& segment, double distance, const Segment2& part) const
    -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> found;
  vertex_cells_.near(part, 1.001 * distance, [&](std::uint32_t v) {
    if (vertices_[v].alive && squared_distance(segment, vertices_[v].at) < square(distance)) found.push_back(v);
  });
  sort_out(found);
  return found;
}

auto Graph::edges_near(Point2 p, double distance) const -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> found;
  edge_cells_.near({p, p}, 0, [&](std::uint32_t e) {
    if (edges_[e].alive && squared_distance(this->segment(e), p) < square(distance)) found.push_back(e);
  });
  sort_out(found);
  return found;
}

auto Graph::edges_across(const Segment2& segment, const Segment2& part) const -> std::vector<std::uint32_t> {
  using geometry::orientation;
  const Point2 a = segment.start, b = segment.end;
  const Box2 box = Box2::of(segment);
  std::vector<std::uint32_t> found;
  edge_cells_.near(part, 0, [&](std::uint32_t e) {
    if (!edges_[e].alive) return;
    const Point2 c = place(edges_[e].a), d = place(edges_[e].b);
    if (std::max(c.x, d.x) < box.least.x || std::min(c.x, d.x) > box.most.x || std::max(c.y, d.y) < box.least.y ||
        std::min(c.y, d.y) > box.most.y)
      return;
    if (a == c || a == d || b == c || b == d) return;  // not a question for exact arithmetic
    if (orientation(a, b, c) * orientation(a, b, d) < 0 && orientation(c, d, a) * orientation(c, d, b) < 0)
      found.push_back(e);
  });
  sort_out(found);
  return found;
}

auto Graph::add_vertex(Point2 p) -> std::uint32_t {
  const auto number = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back({p, true, {}});
  vertex_cells_.put(number, {p, p}, 0);
  return number;
}

void Graph::drop_vertex(std::uint32_t vertex) {
  vertices_[vertex].alive = false;
  dropped_vertices_.push_back(vertex);
}

auto Graph::add_edge(Edge edge) -> std::uint32_t {
  const auto number = static_cast<std::uint32_t>(edges_.size());
  edges_.push_back(std::move(edge));
  attach(number);
  edge_cells_.put(number, segment(number), reach_);
  return number;
}

void Graph::drop_edge(std::uint32_t edge) {
  detach(edge);
  dropped_edges_.push_back(edge);
}

void Graph::attach(std::uint32_t edge) {
  edges_[edge].alive = true;
  vertices_[edges_[edge].a].edges.push_back(edge);
  vertices_[edges_[edge].b].edges.push_back(edge);
}

void Graph::detach(std::uint32_t edge) {
  edges_[edge].alive = false;
  std::erase(vertices_[edges_[edge].a].edges, edge);
  std::erase(vertices_[edges_[edge].b].edges, edge);
}

void Graph::back_to(const Mark& mark) {
  while (edges_.size() > mark.edges) {
    const auto last = static_cast<std::uint32_t>(edges_.size() - 1);
    edge_cells_.take_back(segment(last), reach_);
    if (edges_[last].alive) detach(last);
    edges_.pop_back();
  }
  for (; dropped_edges_.size() > mark.dropped_edges; dropped_edges_.pop_back())
    if (dropped_edges_.back() < mark.edges) attach(dropped_edges_.back());
  for (; dropped_vertices_.size() > mark.dropped_vertices; dropped_vertices_.pop_back())
    vertices_[dropped_vertices_.back()].alive = true;
  while (vertices_.size() > mark.vertices) {
    vertex_cells_.take_back({vertices_.back().at, vertices_.back().at}, 0);
    vertices_.pop_back();
  }
}

}  // namespace mansard::fracture::detail
