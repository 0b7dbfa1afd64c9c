#include "mansard/solid/detail/shell_surface.hpp"

#include <map>

#include "mansard/base/disjoint_sets.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point3;
using Ends = std::pair<std::uint32_t, std::uint32_t>;  // of an edge, the lower number first

struct Cut {
  double at = 0;  ///< 0 … 1 from the lower end
  std::uint32_t point = 0;
  friend auto operator<=>(const Cut&, const Cut&) = default;
};
using Cuts = std::map<Ends, std::vector<Cut>>;

auto ends_of(std::uint32_t a, std::uint32_t b) -> Ends { return {std::min(a, b), std::max(a, b)}; }

/// For every point the first one within the tolerance, on from there.
auto welded(const std::vector<Point3>& points, double tolerance) -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> order(points.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(points[i], i); });
  base::DisjointSets sets(points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t k = i; k-- > 0 && points[order[i]].x - points[order[k]].x <= tolerance;)
      if (length(points[order[i]] - points[order[k]]) <= tolerance) sets.join(order[i], order[k]);
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = sets.of(i);
  return order;
}

/// Without repeated corners, and without lines that are walked there and back.
auto tidied(Loop loop) -> Loop {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; loop.size() > 2 && i < loop.size();) {
      const std::size_t n = loop.size();
      const bool repeats = loop[i] == loop[(i + 1) % n];
      const bool turns_back = loop[(i + n - 1) % n] == loop[(i + 1) % n];
      if (!repeats && !turns_back) {
        ++i;
        continue;
      }
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
    }
  }
  return loop.size() > 2 ? loop : Loop();
}

void tidy(Surface& surface) {
  for (auto& face : surface.faces) {
    for (auto& loop : face.loops) loop = tidied(std::move(loop));
    // A hole that closes goes by itself; an outer boundary takes what is left of the face along.
    const bool gone = face.loops.front().empty();
    std::erase_if(face.loops, [&](const Loop& loop) { return gone || loop.empty(); });
  }
  std::erase_if(surface.faces, [](const SurfaceFace& face) { return face.loops.empty(); });
}

void weld(Surface& surface, double tolerance) {
  const auto first = welded(surface.points, tolerance);
  for (auto& face : surface.faces)
    for (auto& loop : face.loops)
      for (auto& point : loop) point = first[point];
  tidy(surface);
}

class Breaker {
 public:
  Breaker(Surface& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {
    std::vector<std::uint8_t> used(surface.points.size(), 0);
    for (const auto& face : surface.faces)
      for (const auto& loop : face.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          edges_.push_back(ends_of(loop[i], loop[(i + 1) % loop.size()]));
          used[loop[i]] = 1;
        }
    std::ranges::sort(edges_);
    edges_.erase(std::ranges::unique(edges_).begin(), edges_.end());
    for (std::uint32_t p = 0; p < used.size(); ++p)
      if (used[p] != 0) points_.push_back(p);
    std::ranges::sort(points_, {}, [&](std::uint32_t p) { return std::pair(at(p), p); });
  }

  /// Edges broken at points that lie on them. False where there are none.
  auto at_points() -> bool {
    for (const Ends& edge : edges_) {
      const Point3 a = at(edge.first), along = at(edge.second) - a;
      const double length2 = dot(along, along);
      const double least = std::min(a.x, a.x + along.x) - tolerance_, most = std::max(a.x, a.x + along.x) + tolerance_;
      auto p = std::ranges::lower_bound(points_, least, {}, [&](std::uint32_t i) { return at(i).x; });
      for (; p != points_.end() && at(*p).x <= most; ++p) {
        if (*p == edge.first || *p == edge.second || !is_near(edge, at(*p))) continue;
        const double t = dot(at(*p) - a, along) / length2;
        if (t > 0 && t < 1 && length(a + t * along - at(*p)) <= tolerance_) cuts_[edge].push_back({t, *p});
      }
    }
    return apply();
  }

  /// Edges broken where they cross. False where none do.
  auto at_crossings() -> bool {
    std::ranges::sort(edges_, {}, [&](const Ends& e) { return std::pair(least_x(e), e); });
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const double most = std::max(at(edges_[i].first).x, at(edges_[i].second).x) + tolerance_;
      for (std::size_t k = i + 1; k < edges_.size() && least_x(edges_[k]) <= most; ++k) cross_at(edges_[i], edges_[k]);
    }
    return apply();
  }

 private:
  [[nodiscard]] auto at(std::uint32_t p) const -> const Point3& { return surface_.points[p]; }
  [[nodiscard]] auto least_x(const Ends& e) const -> double { return std::min(at(e.first).x, at(e.second).x); }
  [[nodiscard]] auto apart(double a, double b, double c, double d) const -> bool {
    return std::max(a, b) + tolerance_ < std::min(c, d) || std::max(c, d) + tolerance_ < std::min(a, b);
  }
  [[nodiscard]] auto is_near(const Ends& e, Point3 p) const -> bool {
    const Point3 &a = at(e.first), &b = at(e.second);
    return !apart(a.y, b.y, p.y, p.y) && !apart(a.z, b.z, p.z, p.z);
  }

  void cross_at(const Ends& e, const Ends& f) {
    if (e.first == f.first || e.first == f.second || e.second == f.first || e.second == f.second) return;
    const Point3 &a = at(e.first), &b = at(e.second), &c = at(f.first), &d = at(f.second);
    if (apart(a.y, b.y, c.y, d.y) || apart(a.z, b.z, c.z, d.z)) return;
    const Point3 u = b - a, v = d - c, w = a - c;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double divisor = uu * vv - uv * uv;
    if (divisor <= 1e-12 * uu * vv) return;  // parallel: their ends are on each other, or they do not meet
    const double s = (uv * vw - vv * uw) / divisor, t = (uu * vw - uv * uw) / divisor;
    if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return;
    const Point3 p = a + s * u, q = c + t * v;
    if (length(p - q) > tolerance_) return;
    surface_.points.push_back(0.5 * (p + q));
    const auto crossing = static_cast<std::uint32_t>(surface_.points.size() - 1);
    cuts_[e].push_back({s, crossing});
    cuts_[f].push_back({t, crossing});
  }

  auto apply() -> bool {
    if (cuts_.empty()) return false;
    for (auto& [edge, cuts] : cuts_) std::ranges::sort(cuts);
    for (auto& face : surface_.faces)
      for (auto& loop : face.loops) loop = broken(loop);
    return true;
  }

  [[nodiscard]] auto broken(const Loop& loop) const -> Loop {
    Loop out;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      out.push_back(loop[i]);
      const std::uint32_t next = loop[(i + 1) % loop.size()];
      const auto found = cuts_.find(ends_of(loop[i], next));
      if (found == cuts_.end()) continue;
      const auto& cuts = found->second;
      if (loop[i] < next)
        for (const Cut& cut : cuts) out.push_back(cut.point);
      else
        for (std::size_t k = cuts.size(); k-- > 0;) out.push_back(cuts[k].point);
    }
    return out;
  }

  Surface& surface_;
  const double tolerance_;
  std::vector<Ends> edges_;
  std::vector<std::uint32_t> points_;  ///< by x
  Cuts cuts_;
};

}  // namespace

auto surface_of(std::span<const model::Solid* const> solids) -> Surface {
  Surface surface;
  for (std::uint32_t s = 0; s < solids.size(); ++s) {
    const auto first = static_cast<std::uint32_t>(surface.points.size());
    surface.points.insert(surface.points.end(), solids[s]->vertices.begin(), solids[s]->vertices.end());
    for (const auto& face : solids[s]->faces) {
      surface.faces.push_back({face.loops, face.normal, s});
      for (auto& loop : surface.faces.back().loops)
        for (auto& point : loop) point += first;
    }
  }
  return surface;
}

auto conform(Surface& surface, double tolerance) -> bool {
  weld(surface, tolerance);
  // Every round breaks edges into shorter ones at points that are further apart than the tolerance.
  constexpr int most_rounds = 20;
  for (int round = 0; round < most_rounds; ++round) {
    if (Breaker(surface, tolerance).at_points()) {
      tidy(surface);
      continue;
    }
    if (!Breaker(surface, tolerance).at_crossings()) return true;
    weld(surface, tolerance);
  }
  return false;
}

}  // namespace mansard::solid::detail
