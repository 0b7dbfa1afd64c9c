#include "lab/simulate/detail/nearest.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::simulate::detail {
namespace {

using geometry::Point3;

constexpr double cell = 1.0;  // m

/// The point of the triangle nearest to p, by the regions of its corners, edges and inside.
auto nearest_point(Point3 p, Point3 a, Point3 b, Point3 c) -> Point3 {
  const Point3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Point3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const Point3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  const double sum = va + vb + vc;
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

auto is_shell(Class kind) -> bool { return kind != Class::ground; }

}  // namespace

auto Nearest::column(double x) const -> std::int64_t {
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((x - origin_.x) / cell)), 0, columns_ - 1);
}
auto Nearest::row(double y) const -> std::int64_t {
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((y - origin_.y) / cell)), 0, rows_ - 1);
}

Nearest::Nearest(const Surface& surface) : surface_(&surface) {
  auto box = geometry::Box2::of(surface.mesh.vertices);
  if (box.empty()) box.add({0, 0});
  origin_ = box.least;
  columns_ = static_cast<std::int64_t>((box.most.x - box.least.x) / cell) + 1;
  rows_ = static_cast<std::int64_t>((box.most.y - box.least.y) / cell) + 1;

  const auto& mesh = surface.mesh;
  for (const auto& t : mesh.triangles)
    normals_.push_back(
        normalised(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]])));
  // Twice over the triangles: count, then fill.
  const auto each_cell = [&](auto&& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!is_shell(surface.classes[t])) continue;
      geometry::Box2 of;
      for (const auto v : mesh.triangles[t]) of.add(xy(mesh.vertices[v]));
      for (auto r = row(of.least.y); r <= row(of.most.y); ++r)
        for (auto c = column(of.least.x); c <= column(of.most.x); ++c)
          visit(static_cast<std::size_t>(r * columns_ + c), t);
    }
  };
  first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  each_cell([&](std::size_t at, std::uint32_t) { ++first_[at + 1]; });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  entries_.resize(first_.back());
  auto next = first_;
  each_cell([&](std::size_t at, std::uint32_t t) { entries_[next[at]++] = t; });
}

auto Nearest::find(Point3 p, Point3 normal, double radius) const -> std::optional<Found> {
  const auto& mesh = surface_->mesh;
  std::optional<Found> best;
  const auto c0 = column(p.x - radius), c1 = column(p.x + radius), r0 = row(p.y - radius), r1 = row(p.y + radius);
  for (auto r = r0; r <= r1; ++r)
    for (auto c = c0; c <= c1; ++c) {
      const auto at = static_cast<std::size_t>(r * columns_ + c);
      for (std::uint32_t i = first_[at]; i < first_[at + 1]; ++i) {
        const std::uint32_t t = entries_[i];
        const double extra = turned * (1 - dot(normal, normals_[t]));
        const auto& [ia, ib, ic] = mesh.triangles[t];
        const Point3 a = mesh.vertices[ia], b = mesh.vertices[ib], d = mesh.vertices[ic];
        const double off = std::abs(dot(p - a, normals_[t]));  // from its plane
        if (off > radius || (best && off + extra > best->cost)) continue;
        const double distance = length(p - nearest_point(p, a, b, d));
        const double cost = distance + extra;
        if (distance > radius || (best && (cost > best->cost || (cost == best->cost && t >= best->triangle)))) continue;
        best = Found{t, cost};
      }
    }
  return best;
}

}  // namespace mansard::simulate::detail
