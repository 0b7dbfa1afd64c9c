#include "mansard/ingest/detail/clean.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mansard::ingest::detail {
namespace {

using geometry::Point3;
using geometry::Triangle;

/// More than twice round the earth: a coordinate beyond is as good as infinite.
constexpr double farthest = 1e8;

auto usable(Point3 p) -> bool {
  return std::abs(p.x) < farthest && std::abs(p.y) < farthest && std::abs(p.z) < farthest;  // false for NaN
}

auto in_range(const Triangle& t, std::size_t count) -> bool { return t[0] < count && t[1] < count && t[2] < count; }

auto moved(Point3 p, const std::array<double, 3>& shift) -> Point3 {
  return {p.x + shift[0], p.y + shift[1], p.z + shift[2]};
}

/// For each vertex the first one at the same place, found by an open hash table.
class Welder {
 public:
  explicit Welder(const std::vector<Point3>& points) : points_(points) {
    slots_.assign(std::bit_ceil(2 * points.size() + 2), no_vertex);
  }
  auto first_at(std::uint32_t v) -> std::uint32_t {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t at = hash(points_[v]) & mask;; at = (at + 1) & mask) {
      if (slots_[at] == no_vertex) return slots_[at] = v;
      if (points_[slots_[at]] == points_[v]) return slots_[at];
    }
  }

 private:
  static auto hash(Point3 p) -> std::size_t {
    std::uint64_t h = 0;
    for (const double c : {p.x, p.y, p.z}) {
      h = (h ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9e3779b97f4a7c15ULL;  // + 0.0: −0 and 0 are one place
      h ^= h >> 29;
    }
    return h;
  }
  const std::vector<Point3>& points_;
  std::vector<std::uint32_t> slots_;
};

/// A needle whose height is below a ten-thousand-millionth of its longest side has no normal worth the name.
auto has_area(Point3 a, Point3 b, Point3 c) -> bool {
  const Point3 u = b - a, v = c - a, w = c - b;
  const double longest = std::max({dot(u, u), dot(v, v), dot(w, w)});
  return length(cross(u, v)) > 1e-10 * longest;
}

/// Items put together by a key below `count`, in their order: the items of key k are items[start[k] … start[k + 1]).
template <class Item>
struct Buckets {
  std::vector<std::size_t> start;
  std::vector<Item> items;

  /// `each` calls its argument with (key, item), for the same pairs in both of its calls.
  template <class Each>
  Buckets(std::size_t count, Each each) : start(count + 1, 0) {
    each([this](std::uint32_t key, const Item&) { ++start[key + 1]; });
    for (std::size_t k = 0; k < count; ++k) start[k + 1] += start[k];
    items.resize(start.back());
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    each([this, &next](std::uint32_t key, const Item& item) { items[next[key]++] = item; });
  }
};

/// Takes out triangles that have the corners of an earlier one, whichever way round.
auto drop_repeated(std::vector<Triangle>& triangles, std::vector<std::uint8_t>& classes, std::size_t vertices)
    -> std::uint64_t {
  struct Item {
    std::uint32_t middle = 0, last = 0;
    std::size_t triangle = 0;
    auto operator<=>(const Item&) const = default;
  };
  Buckets<Item> by_least(vertices, [&](auto put) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      Triangle t = triangles[i];
      std::ranges::sort(t);
      put(t[0], {t[1], t[2], i});
    }
  });
  std::vector<char> repeated(triangles.size(), 0);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto own = std::span(by_least.items).subspan(by_least.start[v], by_least.start[v + 1] - by_least.start[v]);
    std::ranges::sort(own);
    for (std::size_t i = 1; i < own.size(); ++i)
      repeated[own[i].triangle] = own[i].middle == own[i - 1].middle && own[i].last == own[i - 1].last ? 1 : 0;
  }
  const std::size_t before = triangles.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < before; ++i)
    if (repeated[i] == 0) {
      if (!classes.empty()) classes[kept] = classes[i];
      triangles[kept++] = triangles[i];
    }
  triangles.resize(kept);
  if (!classes.empty()) classes.resize(kept);
  return before - kept;
}

void count_edges(const std::vector<Triangle>& triangles, std::size_t vertices, MeshCounts& counts) {
  // The other end of each edge, doubled, plus one when the triangle runs along it downwards.
  Buckets<std::uint64_t> by_least(vertices, [&](auto put) {
    for (const auto& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        put(std::min(a, b), 2 * std::uint64_t{std::max(a, b)} + (a > b ? 1U : 0U));
      }
  });
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto own = std::span(by_least.items).subspan(by_least.start[v], by_least.start[v + 1] - by_least.start[v]);
    std::ranges::sort(own);
    for (std::size_t i = 0, j = 0; i < own.size(); i = j) {
      while (j < own.size() && own[j] / 2 == own[i] / 2) ++j;
      if (j - i == 1) ++counts.boundary_edges;
      if (j - i == 2 && own[i] == own[i + 1]) ++counts.flipped_edges;
      if (j - i > 2) ++counts.non_manifold_edges;
    }
  }
}

/// Keeps the vertices that triangles name, in their order.
void compact(geometry::Mesh& mesh) {
  std::vector<std::uint32_t> place(mesh.vertices.size(), no_vertex);
  for (const auto& t : mesh.triangles)
    for (const auto v : t) place[v] = 0;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == no_vertex) continue;
    mesh.vertices[kept] = mesh.vertices[v];
    place[v] = kept++;
  }
  mesh.vertices.resize(kept);
  mesh.vertices.shrink_to_fit();
  for (auto& t : mesh.triangles)
    for (auto& v : t) v = place[v];
}

}  // namespace

auto bounds(const RawMesh& raw, const std::array<double, 3>& offset) -> Box3 {
  Box3 box;
  for (const auto& t : raw.triangles) {
    if (!in_range(t, raw.vertices.size())) continue;
    const std::array<Point3, 3> p{moved(raw.vertices[t[0]], offset), moved(raw.vertices[t[1]], offset),
                                  moved(raw.vertices[t[2]], offset)};
    if (!usable(p[0]) || !usable(p[1]) || !usable(p[2])) continue;
    if (box.plan.empty()) box.low = box.high = p[0].z;
    for (const auto& corner : p) {
      box.plan.add(xy(corner));
      box.low = std::min(box.low, corner.z);
      box.high = std::max(box.high, corner.z);
    }
  }
  return box;
}

auto clean(RawMesh raw, const std::array<double, 3>& shift, const std::optional<geometry::Box2>& within) -> CleanMesh {
  CleanMesh out;
  auto& counts = out.counts;
  counts.vertices_read = raw.vertices.size();
  counts.triangles_read = raw.triangles.size() + raw.short_faces;
  counts.degenerate = raw.short_faces;
  for (auto& v : raw.vertices) v = moved(v, shift);

  Welder welder(raw.vertices);
  auto& triangles = out.mesh.triangles;
  triangles.reserve(raw.triangles.size());
  std::vector<std::uint32_t> place(raw.vertices.size(), no_vertex);
  for (std::uint32_t v = 0; v < raw.vertices.size(); ++v)
    if (usable(raw.vertices[v])) place[v] = welder.first_at(v);
  for (std::size_t i = 0; i < raw.triangles.size(); ++i) {
    const Triangle& t = raw.triangles[i];
    if (!in_range(t, raw.vertices.size())) {
      ++counts.out_of_range;
      continue;
    }
    const Triangle welded{place[t[0]], place[t[1]], place[t[2]]};
    if (std::ranges::find(welded, no_vertex) != welded.end()) {
      ++counts.not_finite;
      continue;
    }
    const Point3 a = raw.vertices[welded[0]], b = raw.vertices[welded[1]], c = raw.vertices[welded[2]];
    if (within) {
      geometry::Box2 box;
      for (const Point3 p : {a, b, c}) box.add(xy(p));
      if (!box.overlaps(*within)) continue;
    }
    if (!has_area(a, b, c)) {
      ++counts.degenerate;
      continue;
    }
    triangles.push_back(welded);
    if (!raw.classes.empty()) out.classes.push_back(raw.classes[i]);
  }
  counts.duplicate = drop_repeated(triangles, out.classes, raw.vertices.size());
  out.mesh.vertices = std::move(raw.vertices);
  compact(out.mesh);
  triangles.shrink_to_fit();
  count_edges(triangles, out.mesh.vertices.size(), counts);
  counts.vertices = out.mesh.vertices.size();
  counts.triangles = triangles.size();
  return out;
}

auto warnings_of(const MeshCounts& counts, const std::string& subject) -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> out;
  const auto tell = [&](std::uint64_t count, const char* code, const char* what) {
    if (count > 0) out.push_back(base::warning(code, std::to_string(count) + " " + what, subject));
  };
  tell(counts.not_finite, "ingest-mesh-not-finite",
       "triangles with NaN, infinite or absurdly far corners were left out");
  tell(counts.out_of_range, "ingest-mesh-index", "triangles that name missing vertices were left out");
  tell(counts.degenerate, "ingest-mesh-degenerate", "triangles without area were left out");
  tell(counts.duplicate, "ingest-mesh-duplicate", "triangles that repeat another one were left out");
  tell(counts.non_manifold_edges, "ingest-mesh-non-manifold", "edges have more than two triangles; they were kept");
  tell(counts.flipped_edges, "ingest-mesh-flipped", "edges have triangles that face opposite ways; they were kept");
  return out;
}

}  // namespace mansard::ingest::detail
