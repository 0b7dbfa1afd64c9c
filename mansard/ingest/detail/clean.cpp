#include "mansard/ingest/detail/clean.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <span>

#include "mansard/base/run.hpp"

namespace mansard::ingest::detail {
namespace {

using geometry::Point3;
using geometry::Triangle;

/// More than twice round the earth: a coordinate beyond is as good as infinite.
constexpr double farthest = 1e8;

auto in_range(const Triangle& t, std::size_t count) -> bool { return t[0] < count && t[1] < count && t[2] < count; }

auto moved(Point3 p, const std::array<double, 3>& shift) -> Point3 {
  return {p.x + shift[0], p.y + shift[1], p.z + shift[2]};
}

/// Work on `count` items in blocks that never depend on the number of threads.
constexpr std::size_t block_size = std::size_t{1} << 16;
auto blocks_of(std::size_t count) -> std::size_t { return (count + block_size - 1) / block_size; }
template <class Work>
void each_block(std::size_t count, const Work& work) {
  if (count == 0) return;
  if (count <= block_size) return work(0, 0, count);
  base::parallel_for(blocks_of(count),
                     [&](std::size_t b) { work(b, b * block_size, std::min(count, (b + 1) * block_size)); });
}

/// For each usable vertex the first one at the same place; no_vertex for the others. The places are in an open hash
/// table that all threads fill at once: a slot belongs to a place for good, and in the end holds the least of its
/// vertices, whoever came first.
class Welder {
 public:
  static auto weld(const std::vector<Point3>& points) -> std::vector<std::uint32_t> {
    const Welder welder(points);
    std::vector<std::uint32_t> place(points.size());
    each_block(points.size(), [&](std::size_t, std::size_t first, std::size_t end) {
      // Slots lie anywhere in memory: those of the next few vertices are on their way while one is looked at.
      constexpr std::size_t ahead = 16;
      std::array<std::size_t, ahead> start{};
      for (std::size_t v = first; v < end + ahead; ++v) {
        if (v >= first + ahead) {
          const auto now = static_cast<std::uint32_t>(v - ahead);
          place[now] = usable(points[now]) ? welder.slot_of(now, start[now % ahead]) : formats::no_vertex;
        }
        if (v >= end) continue;
        start[v % ahead] = hash(points[v]) & welder.mask_;
        __builtin_prefetch(&welder.slots_[start[v % ahead]], 1);
      }
    });
    each_block(points.size(), [&](std::size_t, std::size_t first, std::size_t end) {
      for (std::size_t v = first; v < end; ++v)
        if (place[v] != formats::no_vertex) place[v] = welder.slots_[place[v]];
    });
    return place;
  }

 private:
  explicit Welder(const std::vector<Point3>& points)
      : points_(points),
        mask_(std::min(std::bit_ceil(points.size() + points.size() / 2 + 2), std::size_t{formats::no_vertex} + 1) - 1),
        slots_(mask_ + 1, formats::no_vertex) {}

  auto slot_of(std::uint32_t v, std::size_t start) const -> std::uint32_t {
    for (std::size_t at = start;; at = (at + 1) & mask_) {
      if (at == formats::no_vertex) continue;  // stands for a vertex that cannot be used
      const std::atomic_ref slot(slots_[at]);
      std::uint32_t there = slot.load(std::memory_order_relaxed);
      while (there == formats::no_vertex || points_[there] == points_[v]) {
        if (there <= v && there != formats::no_vertex) return static_cast<std::uint32_t>(at);
        if (slot.compare_exchange_weak(there, v, std::memory_order_relaxed)) return static_cast<std::uint32_t>(at);
      }
    }
  }
  static auto hash(Point3 p) -> std::size_t {
    std::uint64_t h = 0;
    for (const double c : {p.x, p.y, p.z}) {
      h = (h ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9e3779b97f4a7c15ULL;  // + 0.0: −0 and 0 are one place
      h ^= h >> 29;
    }
    return h;
  }
  const std::vector<Point3>& points_;
  std::size_t mask_;
  mutable std::vector<std::uint32_t> slots_;
};

/// A needle whose height is below a ten-thousand-millionth of its longest side has no normal worth the name.
auto has_area(Point3 a, Point3 b, Point3 c) -> bool {
  const Point3 u = b - a, v = c - a, w = c - b;
  const double longest = std::max({dot(u, u), dot(v, v), dot(w, w)});
  return length(cross(u, v)) > 1e-10 * longest;
}

/// The corners in order of their numbers.
auto sorted(Triangle t) -> Triangle {
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  if (t[1] > t[2]) std::swap(t[1], t[2]);
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  return t;
}

/// For each vertex the triangles of which it is the least or the middle corner, in no particular order. Every triangle
/// is with its least corner once, and every edge of it with the lesser of the edge's ends.
/// Index is as wide as twice the number of triangles needs: half the memory for all but the largest meshes.
template <class Index>
struct Around {
  std::vector<Index> start;  ///< of vertex v: triangles[start[v] … start[v + 1])
  std::vector<Index> triangles;

  Around(const std::vector<Triangle>& all, std::size_t vertices) : start(vertices + 1, 0), triangles(2 * all.size()) {
    each_block(all.size(), [&](std::size_t, std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) {
        const Triangle t = sorted(all[i]);
        for (const auto v : {t[0], t[1]}) std::atomic_ref(start[v]).fetch_add(1, std::memory_order_relaxed);
      }
    });
    Index sum = 0;
    for (auto& own : start) own = sum += own;  // now where the next vertex starts; counted down while filling
    each_block(all.size(), [&](std::size_t, std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) {
        const Triangle t = sorted(all[i]);
        for (const auto v : {t[0], t[1]})
          triangles[std::atomic_ref(start[v]).fetch_sub(1, std::memory_order_relaxed) - 1] = static_cast<Index>(i);
      }
    });
  }
  [[nodiscard]] auto of(std::size_t v) const -> std::span<const Index> {
    return std::span(triangles).subspan(start[v], start[v + 1] - start[v]);
  }
};

/// Marks triangles that have the corners of another one, whichever way round. Which is kept depends on where the
/// corners are, not on the order of the triangles or vertices.
template <class Index>
auto find_repeated(const std::vector<Triangle>& triangles, const Around<Index>& around,
                   const std::vector<Point3>& points) -> std::vector<char> {
  const auto ascends = [&](const Triangle& t) {
    return (points[t[0]] < points[t[1]]) + (points[t[1]] < points[t[2]]) + (points[t[2]] < points[t[0]]) == 2;
  };
  struct Item {
    std::uint32_t middle = 0, last = 0;
    Index triangle = 0;
    auto operator<=>(const Item&) const = default;
  };
  std::vector<char> repeated(triangles.size(), 0);
  each_block(points.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    std::vector<Item> own;
    for (std::size_t v = first; v < last; ++v) {
      own.clear();
      for (const Index i : around.of(v))
        if (const Triangle t = sorted(triangles[i]); t[0] == v) own.push_back({t[1], t[2], i});
      std::ranges::sort(own);
      for (std::size_t i = 0, end = 0; i < own.size(); i = end) {
        // Of triangles over the same corners one is kept: the first of those that most agree with.
        std::size_t up = 0;
        for (end = i; end < own.size() && own[end].middle == own[i].middle && own[end].last == own[i].last; ++end)
          up += ascends(triangles[own[end].triangle]) ? 1 : 0;
        std::size_t kept = i;
        while (ascends(triangles[own[kept].triangle]) != (2 * up >= end - i)) ++kept;
        for (std::size_t k = i; k < end; ++k)
          if (k != kept) repeated[own[k].triangle] = 1;
      }
    }
  });
  return repeated;
}

/// Of the triangles that are not repeated.
template <class Index>
void count_edges(const std::vector<Triangle>& triangles, const std::vector<char>& repeated, const Around<Index>& around,
                 const std::vector<Point3>& points, const std::optional<Home>& home, model::MeshCounts& counts) {
  const std::size_t vertices = points.size();
  struct Found {
    std::uint64_t boundary = 0, flipped = 0, non_manifold = 0;
  };
  std::vector<Found> found(blocks_of(vertices));
  each_block(vertices, [&](std::size_t block, std::size_t first, std::size_t end) {
    // The other end of each edge, doubled, plus one when the triangle runs along it downwards.
    std::vector<std::uint64_t> own;
    Found sum;
    for (std::size_t v = first; v < end; ++v) {
      own.clear();
      for (const Index i : around.of(v)) {
        if (repeated[i] != 0) continue;
        const Triangle& t = triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = t[k], b = t[(k + 1) % 3];
          if (std::min(a, b) == v) own.push_back(2 * std::uint64_t{std::max(a, b)} + (a > b ? 1U : 0U));
        }
      }
      std::ranges::sort(own);
      for (std::size_t i = 0, j = 0; i < own.size(); i = j) {
        while (j < own.size() && own[j] / 2 == own[i] / 2) ++j;
        if (home && !home->has(std::min(points[v], points[own[i] / 2]))) continue;
        if (j - i == 1) ++sum.boundary;
        if (j - i == 2 && own[i] == own[i + 1]) ++sum.flipped;
        if (j - i > 2) ++sum.non_manifold;
      }
    }
    found[block] = sum;
  });
  for (const Found& one : found) {
    counts.boundary_edges += one.boundary;
    counts.flipped_edges += one.flipped;
    counts.non_manifold_edges += one.non_manifold;
  }
}

/// Keeps triangles (and their classes, where there are any) that `wanted(i)` wants, in their order. Every block moves
/// its own to its front, then the blocks close up: no second copy.
template <class Wanted>
void keep(std::vector<Triangle>& triangles, std::vector<std::uint8_t>& classes, const Wanted& wanted) {
  std::vector<std::size_t> kept(blocks_of(triangles.size()), 0);
  each_block(triangles.size(), [&](std::size_t block, std::size_t first, std::size_t end) {
    std::size_t to = first;
    for (std::size_t i = first; i < end; ++i) {
      if (!wanted(block, i)) continue;
      if (!classes.empty()) classes[to] = classes[i];
      triangles[to++] = triangles[i];
    }
    kept[block] = to - first;
  });
  std::size_t to = 0;
  for (std::size_t block = 0; block < kept.size(); ++block) {
    const std::size_t first = block * block_size;
    if (to != first) {
      std::copy_n(triangles.begin() + static_cast<std::ptrdiff_t>(first), kept[block],
                  triangles.begin() + static_cast<std::ptrdiff_t>(to));
      if (!classes.empty())
        std::copy_n(classes.begin() + static_cast<std::ptrdiff_t>(first), kept[block],
                    classes.begin() + static_cast<std::ptrdiff_t>(to));
    }
    to += kept[block];
  }
  triangles.resize(to);
  if (!classes.empty()) classes.resize(to);
}

auto at_home(const Triangle& t, const std::vector<Point3>& points, const std::optional<Home>& home) -> bool {
  return !home || home->has(std::min({points[t[0]], points[t[1]], points[t[2]]}));
}

/// Takes out triangles that are there twice, and counts what is odd about the edges of the others.
template <class Index>
void look_at_neighbours(CleanMesh& mesh, const std::vector<Point3>& points, const std::optional<Home>& home,
                        const base::Run& run) {
  auto& triangles = mesh.mesh.triangles;
  std::vector<char> repeated;
  {
    const Around<Index> around(triangles, points.size());
    if (run.cancelled()) return;
    repeated = find_repeated(triangles, around, points);
    if (run.cancelled()) return;
    count_edges(triangles, repeated, around, points, home, mesh.counts);
  }
  if (run.cancelled()) return;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (repeated[i] != 0 && at_home(triangles[i], points, home)) ++mesh.counts.duplicate;
  keep(triangles, mesh.classes, [&](std::size_t, std::size_t i) { return repeated[i] == 0; });
}

/// Keeps the vertices that triangles name, in their order.
void compact(geometry::Mesh& mesh) {
  std::vector<std::uint32_t> place(mesh.vertices.size(), formats::no_vertex);
  each_block(mesh.triangles.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      for (const auto v : mesh.triangles[i]) std::atomic_ref(place[v]).store(0, std::memory_order_relaxed);
  });
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == formats::no_vertex) continue;
    mesh.vertices[kept] = mesh.vertices[v];
    place[v] = kept++;
  }
  if (kept == mesh.vertices.size()) return;
  mesh.vertices.resize(kept);
  mesh.vertices.shrink_to_fit();
  each_block(mesh.triangles.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      for (auto& v : mesh.triangles[i]) v = place[v];
  });
}

}  // namespace

auto usable(Point3 p) -> bool {
  return std::abs(p.x) < farthest && std::abs(p.y) < farthest && std::abs(p.z) < farthest;  // false for NaN
}

auto bounds(const formats::RawMesh& raw, const std::array<double, 3>& offset) -> geometry::Box3 {
  std::vector<geometry::Box3> boxes(blocks_of(raw.triangles.size()));
  each_block(raw.triangles.size(), [&](std::size_t block, std::size_t first, std::size_t end) {
    geometry::Box3 box;
    for (std::size_t i = first; i < end; ++i) {
      const Triangle& t = raw.triangles[i];
      if (!in_range(t, raw.vertices.size())) continue;
      const std::array<Point3, 3> p{moved(raw.vertices[t[0]], offset), moved(raw.vertices[t[1]], offset),
                                    moved(raw.vertices[t[2]], offset)};
      if (!usable(p[0]) || !usable(p[1]) || !usable(p[2])) continue;
      for (const auto& corner : p) box.add(corner);
    }
    boxes[block] = box;
  });
  geometry::Box3 all;
  for (const auto& box : boxes) all.include(box);
  return all;
}

auto clean(formats::RawMesh raw, const std::array<double, 3>& shift, const std::optional<geometry::Box2>& within,
           const std::optional<Home>& home, const base::Run& run) -> CleanMesh {
  CleanMesh out;
  auto& counts = out.counts;
  counts.vertices_read = raw.vertices.size();
  counts.triangles_read = raw.triangles.size() + raw.short_faces;
  counts.degenerate = raw.short_faces;
  each_block(raw.vertices.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) raw.vertices[v] = moved(raw.vertices[v], shift);
  });

  out.mesh.points = std::move(raw.points);
  for (Point3& p : out.mesh.points) p = moved(p, shift);
  std::erase_if(out.mesh.points, [&](Point3 p) { return !usable(p) || (within && !within->contains(xy(p))); });

  auto& triangles = out.mesh.triangles;
  triangles = std::move(raw.triangles);
  out.classes = std::move(raw.classes);
  struct Found {
    std::uint64_t out_of_range = 0, not_finite = 0, degenerate = 0;
  };
  std::vector<Found> found(blocks_of(triangles.size()));
  {
    if (run.cancelled()) return {};
    const auto place = Welder::weld(raw.vertices);
    if (run.cancelled()) return {};
    keep(triangles, out.classes, [&](std::size_t block, std::size_t i) {
      Triangle& t = triangles[i];
      if (!in_range(t, raw.vertices.size())) return ++found[block].out_of_range, false;
      t = {place[t[0]], place[t[1]], place[t[2]]};
      if (std::ranges::find(t, formats::no_vertex) != t.end()) return ++found[block].not_finite, false;
      const Point3 a = raw.vertices[t[0]], b = raw.vertices[t[1]], c = raw.vertices[t[2]];
      if (within && !geometry::Box2::of(std::array{a, b, c}).overlaps(*within)) return false;
      return has_area(a, b, c) || (found[block].degenerate += at_home(t, raw.vertices, home) ? 1 : 0, false);
    });
  }
  if (run.cancelled()) return {};
  for (const Found& one : found) {
    counts.out_of_range += one.out_of_range;
    counts.not_finite += one.not_finite;
    counts.degenerate += one.degenerate;
  }
  if (2 * triangles.size() < formats::no_vertex) look_at_neighbours<std::uint32_t>(out, raw.vertices, home, run);
  else look_at_neighbours<std::uint64_t>(out, raw.vertices, home, run);
  if (run.cancelled()) return {};
  out.mesh.vertices = std::move(raw.vertices);
  compact(out.mesh);
  triangles.shrink_to_fit();
  counts.vertices = out.mesh.vertices.size();
  counts.triangles = triangles.size();
  if (home) {
    counts.vertices =
        static_cast<std::uint64_t>(std::ranges::count_if(out.mesh.vertices, [&](Point3 p) { return home->has(p); }));
    counts.triangles = static_cast<std::uint64_t>(
        std::ranges::count_if(triangles, [&](const Triangle& t) { return at_home(t, out.mesh.vertices, home); }));
  }
  return out;
}

auto warnings_of(const model::MeshCounts& counts, const std::string& subject) -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> out;
  const auto tell = [&](std::uint64_t count, const char* code, const char* one, const char* several) {
    if (count > 0)
      out.push_back(base::warning(code, std::to_string(count) + " " + (count == 1 ? one : several), subject));
  };
  tell(counts.not_finite, "ingest-mesh-not-finite", "triangle with NaN, infinite or absurdly far corners was left out",
       "triangles with NaN, infinite or absurdly far corners were left out");
  tell(counts.out_of_range, "ingest-mesh-index", "triangle that names missing vertices was left out",
       "triangles that name missing vertices were left out");
  tell(counts.degenerate, "ingest-mesh-degenerate", "triangle without area was left out",
       "triangles without area were left out");
  tell(counts.duplicate, "ingest-mesh-duplicate", "triangle that repeats another one was left out",
       "triangles that repeat another one were left out");
  tell(counts.non_manifold_edges, "ingest-mesh-non-manifold", "edge has more than two triangles, which were kept",
       "edges have more than two triangles, which were kept");
  tell(counts.flipped_edges, "ingest-mesh-flipped", "edge has triangles that face opposite ways; they were kept",
       "edges have triangles that face opposite ways; they were kept");
  return out;
}

}  // namespace mansard::ingest::detail
