#include "mansard/solid/detail/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace mansard::solid::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using VertexPair = std::pair<std::uint32_t, std::uint32_t>;

class Flipping {
 public:
  Flipping(const model::Solid& solid, Point3 normal, std::vector<Corners>& triangles)
      : solid_(solid), triangles_(triangles), origin_(solid.vertices[triangles[0][0]]) {
    const Point3 n = geometry::normalised(normal);
    const Point3 aside = std::abs(n.x) < 0.6 ? Point3{1, 0, 0} : Point3{0, 1, 0};
    u_ = geometry::normalised(cross(aside, n));
    v_ = cross(n, u_);
  }

  void run() {
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) at_[{triangles_[t][i], triangles_[t][(i + 1) % 3]}] = t;
    std::vector<VertexPair> open;
    for (const auto& [edge, t] : at_)
      if (edge.first < edge.second && at_.contains({edge.second, edge.first})) open.push_back(edge);
    // Each flip makes the triangulation a better one; rounding may not, so that there is an end to them.
    std::size_t left = 16 + 4 * triangles_.size() * triangles_.size();
    while (!open.empty() && left > 0) {
      const auto [a, b] = open.back();
      open.pop_back();
      const auto there = at_.find({a, b}), back = at_.find({b, a});
      if (there == at_.end() || back == at_.end()) continue;
      const std::uint32_t c = third(there->second, a, b), d = third(back->second, b, a);
      if (!is_better(a, b, c, d)) continue;
      flip(there->second, back->second, a, b, c, d);
      --left;
      for (const VertexPair& edge : {VertexPair{b, c}, {c, a}, {a, d}, {d, b}}) open.push_back(edge);
    }
  }

 private:
  [[nodiscard]] auto seen(std::uint32_t v) const -> Point2 {
    const Point3 p = solid_.vertices[v] - origin_;
    return {dot(p, u_), dot(p, v_)};
  }

  [[nodiscard]] auto third(std::size_t t, std::uint32_t a, std::uint32_t b) const -> std::uint32_t {
    for (const auto v : triangles_[t])
      if (v != a && v != b) return v;
    return a;
  }

  /// Whether d is inside the circumcircle of a, b, c, and the other diagonal runs inside of both triangles.
  [[nodiscard]] auto is_better(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const -> bool {
    const Point2 o = seen(d), p = seen(a) - o, q = seen(b) - o, r = seen(c) - o;
    if (!(cross(p, r) < 0 && cross(q, r) > 0)) return false;  // a is left of d to c, and b right of it
    const double inside = dot(p, p) * cross(q, r) + dot(q, q) * cross(r, p) + dot(r, r) * cross(p, q);
    const double size = std::max({dot(p, p), dot(q, q), dot(r, r)});
    return inside > 1e-13 * size * size;
  }

  void flip(std::size_t s, std::size_t t, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    at_.erase({a, b});
    at_.erase({b, a});
    triangles_[s] = {c, a, d};
    triangles_[t] = {d, b, c};
    at_[{c, a}] = at_[{a, d}] = at_[{d, c}] = s;
    at_[{d, b}] = at_[{b, c}] = at_[{c, d}] = t;
  }

  const model::Solid& solid_;
  std::vector<Corners>& triangles_;
  Point3 origin_, u_, v_;
  std::map<VertexPair, std::size_t> at_;  ///< the triangle on the left of an edge
};

}  // namespace

void make_delaunay(const model::Solid& solid, Point3 normal, std::vector<Corners>& triangles) {
  if (triangles.size() > 1) Flipping(solid, normal, triangles).run();
}

}  // namespace mansard::solid::detail
