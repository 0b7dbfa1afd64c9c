#include "bench/extrude/cgal_reference.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/create_straight_skeleton_2.h>

#include <exception>

namespace mansard::bench {

auto nodes_of_cgal_skeleton(const geometry::Ring& ring) -> std::size_t {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::Polygon_2<Kernel> polygon;
  for (const geometry::Point2 p : ring) polygon.push_back({p.x, p.y});
  std::size_t nodes = 0;
  try {
    const auto skeleton = CGAL::create_interior_straight_skeleton_2(polygon, Kernel());
    if (!skeleton) return 0;
    for (auto v = skeleton->vertices_begin(); v != skeleton->vertices_end(); ++v) nodes += v->is_skeleton() ? 1 : 0;
  } catch (const std::exception&) {
    return 0;
  }
  return nodes;
}

}  // namespace mansard::bench
