#include "mansard/formats/cityjson/quantised.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mansard/geometry/change.hpp"

namespace mansard::formats::detail {
namespace {

using model::FaceClass;
using model::least_apart;

/// Halves go up everywhere, so that a shift by whole metres shifts the result.
auto to_quanta(double metres) -> std::int64_t {
  return static_cast<std::int64_t>(std::floor(metres * quanta_per_metre + 0.5));
}

auto to_vertex(geometry::Point3 p) -> Vertex { return {to_quanta(p.x), to_quanta(p.y), to_quanta(p.z)}; }

/// Without repeated vertices and spikes (a, b, a), across its seam too.
auto tidied(const std::vector<Vertex>& loop) -> std::vector<Vertex> {
  std::vector<Vertex> kept;
  for (const Vertex& v : loop) {
    if (!kept.empty() && kept.back() == v) continue;
    if (kept.size() >= 2 && kept[kept.size() - 2] == v) kept.pop_back();
    else kept.push_back(v);
  }
  auto first = kept.begin(), last = kept.end();
  while (last - first >= 2) {
    if (*(last - 1) == *first) --last;
    else if (last - first >= 3 && *(last - 2) == *first) last -= 2;
    else if (last - first >= 3 && *(last - 1) == *(first + 1)) ++first, --last;
    else break;
  }
  return last - first >= 3 ? std::vector<Vertex>(first, last) : std::vector<Vertex>();
}

auto tidied(const Loops& loops) -> Loops {
  Loops kept;
  for (const auto& loop : loops) {
    auto tidy = tidied(loop);
    if (!tidy.empty()) kept.push_back(std::move(tidy));
    else if (kept.empty()) return {};  // no outer loop, no surface
  }
  return kept;
}

auto are_near(const Vertex& a, const Vertex& b) -> bool {
  const std::int64_t dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
  return dx * dx + dy * dy + dz * dz < least_apart * least_apart;
}

/// Without vertices that are nearer than that to the one before them.
auto thinned(const std::vector<Vertex>& loop) -> std::vector<Vertex> {
  std::vector<Vertex> kept;
  for (const Vertex& v : loop)
    if (kept.empty() || !are_near(kept.back(), v)) kept.push_back(v);
  while (kept.size() > 1 && are_near(kept.back(), kept.front())) kept.pop_back();
  return kept;
}

}  // namespace

auto is_sound(const Loops& loops) -> bool {
  std::vector<Vertex> all;
  const auto polygon = geometry::polygon_of(loops, [&](const Vertex& v) {
    all.push_back(v);
    return geometry::Point2{static_cast<double>(v[0]), static_cast<double>(v[1])};
  });
  // Rounding may turn a ring without width over.
  if (!loops.empty() && !(geometry::signed_area(polygon.outer) > 0)) return false;
  const auto turned_over = [](const geometry::Ring& hole) { return geometry::signed_area(hole) > 0; };
  if (std::ranges::any_of(polygon.holes, turned_over)) return false;
  std::ranges::sort(all);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = i; k-- > 0 && all[i][0] - all[k][0] < least_apart;)
      if (are_near(all[i], all[k])) return false;
  return geometry::is_simple(polygon);
}

auto quantised(const model::LabelledSolid& model) -> std::vector<Surface> {
  std::vector<Surface> surfaces;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    const auto& face = model.solid.faces[f];
    Loops loops;
    for (const auto& loop : face.loops) {
      auto& rounded = loops.emplace_back();
      for (const auto v : loop) rounded.push_back(to_vertex(model.solid.vertices[v]));
    }
    if (loops = tidied(loops); !loops.empty()) surfaces.push_back({std::move(loops), model.classes[f], face.normal, f});
  }
  return surfaces;
}

auto quantised(const geometry::Polygon& polygon, double z) -> Loops {
  Loops loops;
  const auto add = [&](const geometry::Ring& ring) {
    auto& loop = loops.emplace_back();
    for (const auto& p : ring) loop.push_back(to_vertex({p.x, p.y, z}));
    loop = thinned(loop);
  };
  add(polygon.outer);
  for (const auto& hole : polygon.holes) add(hole);
  return tidied(loops);
}

auto flat_prism(const std::vector<Surface>& solid, double z) -> std::vector<Surface> {
  const std::int64_t top = std::isfinite(z) ? to_quanta(z) : 0;
  using Edge = std::pair<Vertex, Vertex>;
  std::set<Edge> ground_edges, party_edges;
  const auto each_edge = [](const std::vector<Vertex>& loop, auto&& work) {
    for (std::size_t i = 0; i < loop.size(); ++i) work(loop[i], loop[(i + 1) % loop.size()]);
  };
  for (const Surface& surface : solid)
    for (const auto& loop : surface.loops)
      each_edge(loop, [&](const Vertex& a, const Vertex& b) {
        if (surface.kind == FaceClass::ground) ground_edges.emplace(a, b);
        if (surface.kind == FaceClass::party_wall) party_edges.emplace(a, b);
      });

  std::vector<Surface> prism;
  for (const Surface& surface : solid) {
    if (surface.kind != FaceClass::ground) continue;
    Surface roof{surface.loops, FaceClass::roof, {0, 0, 1}};
    for (auto& loop : roof.loops) {
      for (Vertex& v : loop) {
        if (v[2] >= top) return {};
        v[2] = top;
      }
      std::reverse(loop.begin(), loop.end());
    }
    prism.push_back(surface);
    prism.push_back(std::move(roof));
    for (const auto& loop : surface.loops)
      each_edge(loop, [&](const Vertex& a, const Vertex& b) {
        if (ground_edges.contains({b, a})) return;  // inside, between two pieces of ground
        const FaceClass kind = party_edges.contains({b, a}) ? FaceClass::party_wall : FaceClass::wall;
        const Vertex a_top{a[0], a[1], top}, b_top{b[0], b[1], top};
        const auto dx = static_cast<double>(b[0] - a[0]), dy = static_cast<double>(b[1] - a[1]);
        // Seen from below the ground runs counter-clockwise, so outside is to the left of its edges seen from above.
        const auto n = geometry::normalised(geometry::Point2{-dy, dx});
        const geometry::Point3 normal{n.x, n.y, 0};
        const double width = std::hypot(dx, dy), height = static_cast<double>(top - a[2]);
        if (width < model::narrowest_face * height || height < model::narrowest_face * width) {
          prism.push_back({{{b, a, a_top}}, kind, normal});
          prism.push_back({{{b, a_top, b_top}}, kind, normal});
        } else {
          prism.push_back({{{b, a, a_top, b_top}}, kind, normal});
        }
      });
  }
  return prism;
}

void widen(Extent& extent, const Vertex& v) {
  if (!extent) extent = {v, v};
  auto& [least, most] = *extent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    least[axis] = std::min(least[axis], v[axis]);
    most[axis] = std::max(most[axis], v[axis]);
  }
}

auto quanta_in_file_frame(std::int64_t quanta, std::int64_t origin) -> std::string {
  constexpr auto per_metre = static_cast<std::int64_t>(quanta_per_metre);
  const std::int64_t all = quanta + origin * per_metre;
  const std::uint64_t size = all < 0 ? 0 - static_cast<std::uint64_t>(all) : static_cast<std::uint64_t>(all);
  std::string fraction = std::to_string(size % per_metre);
  fraction.insert(0, 4 - fraction.size(), '0');
  while (fraction.size() > 1 && fraction.back() == '0') fraction.pop_back();
  return (all < 0 ? "-" : "") + std::to_string(size / per_metre) + "." + fraction;
}

}  // namespace mansard::formats::detail
