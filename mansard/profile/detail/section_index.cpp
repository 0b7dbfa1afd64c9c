#include "mansard/profile/detail/section_index.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace mansard::profile::detail {
namespace {

using geometry::Box2;
using geometry::Mesh;
using geometry::Point2;
using geometry::Point3;

auto box_of(const Mesh& mesh, const geometry::Triangle& triangle) -> Box2 {
  return Box2::of(std::array{mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]});
}

/// Keeps the part of the piece between two inward distances.
auto clipped(SectionPoint a, SectionPoint b, double from, double to)
    -> std::optional<std::pair<SectionPoint, SectionPoint>> {
  if (a.inward > b.inward) std::swap(a, b);
  if (b.inward < from || a.inward > to) return std::nullopt;
  const auto at = [&, p = a, q = b](double inward) -> SectionPoint {
    return {inward, p.height + (inward - p.inward) / (q.inward - p.inward) * (q.height - p.height)};
  };
  if (a.inward < from) a = at(from);
  if (b.inward > to) b = at(to);
  return std::pair{a, b};
}

}  // namespace

SectionIndex::SectionIndex(const Mesh& mesh) : mesh_(&mesh), box_(Box2::of(mesh.vertices)) {
  if (mesh.triangles.empty() || box_.empty()) return;
  // Metre cells suit scans of a few triangles per square metre; at most some four million of them.
  const double width = box_.most.x - box_.least.x, depth = box_.most.y - box_.least.y;
  cell_ = std::max(1.0, std::sqrt(width * depth / 4e6));
  columns_ = static_cast<std::int64_t>(width / cell_) + 1;
  rows_ = static_cast<std::int64_t>(depth / cell_) + 1;

  const auto cells_of = [&](const geometry::Triangle& triangle, auto&& visit) {
    const Box2 b = box_of(mesh, triangle);
    const auto x0 = static_cast<std::int64_t>((b.least.x - box_.least.x) / cell_);
    const auto x1 = static_cast<std::int64_t>((b.most.x - box_.least.x) / cell_);
    const auto y0 = static_cast<std::int64_t>((b.least.y - box_.least.y) / cell_);
    const auto y1 = static_cast<std::int64_t>((b.most.y - box_.least.y) / cell_);
    for (auto y = y0; y <= y1; ++y)
      for (auto x = x0; x <= x1; ++x) visit(static_cast<std::size_t>(y * columns_ + x));
  };
  first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const auto& triangle : mesh.triangles) cells_of(triangle, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  triangles_.resize(first_.back());
  auto next = first_;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    cells_of(mesh.triangles[t], [&](std::size_t cell) { triangles_[next[cell]++] = t; });
}

auto SectionIndex::cut(const SectionPlane& plane) const -> std::vector<Piece> {
  if (triangles_.empty()) return {};
  const Point2 across = geometry::left_of(plane.direction);
  const auto off = [&](std::uint32_t vertex) {
    return dot(geometry::xy(mesh_->vertices[vertex]) - plane.foot, across);
  };

  std::vector<std::uint32_t> found;
  const auto look = [&](std::int64_t column, std::int64_t row) {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return;
    const auto cell = static_cast<std::size_t>(row * columns_ + column);
    for (auto i = first_[cell]; i < first_[cell + 1]; ++i) {
      const auto& t = mesh_->triangles[triangles_[i]];
      const bool a = off(t[0]) >= 0;
      if ((off(t[1]) >= 0) != a || (off(t[2]) >= 0) != a) found.push_back(triangles_[i]);
    }
  };

  // The cells under the window, row by row or column by column, whichever the line crosses more of. A cell's breadth to
  // both sides costs little and leaves no corner out.
  const Point2 a = plane.foot + plane.from * plane.direction, b = plane.foot + plane.to * plane.direction;
  const bool along_x = std::abs(plane.direction.x) >= std::abs(plane.direction.y);
  const auto main = [&](Point2 p) { return along_x ? p.x - box_.least.x : p.y - box_.least.y; };
  const auto other = [&](Point2 p) { return along_x ? p.y - box_.least.y : p.x - box_.least.x; };
  const double low = std::min(main(a), main(b)), high = std::max(main(a), main(b));
  const double slope = (other(b) - other(a)) / (main(b) - main(a));
  const auto lanes = along_x ? columns_ : rows_;
  const auto begin = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(low / cell_)));
  const auto end = std::min<std::int64_t>(lanes - 1, static_cast<std::int64_t>(std::floor(high / cell_)));
  for (auto lane = begin; lane <= end; ++lane) {
    const double m0 = std::max(low, static_cast<double>(lane) * cell_);
    const double m1 = std::min(high, static_cast<double>(lane + 1) * cell_);
    const double o0 = other(a) + slope * (m0 - main(a)), o1 = other(a) + slope * (m1 - main(a));
    // m; coordinates of up to 10⁷ m carry a rounding of 2⁻³⁰ m, and a slope of at most 1 over a lane adds a few of
    // them: a thousand times that.
    constexpr double breadth = 1e-6;
    const auto from = static_cast<std::int64_t>(std::floor((std::min(o0, o1) - breadth) / cell_));
    const auto to = static_cast<std::int64_t>(std::floor((std::max(o0, o1) + breadth) / cell_));
    for (auto cross_lane = from; cross_lane <= to; ++cross_lane)
      along_x ? look(lane, cross_lane) : look(cross_lane, lane);
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());

  std::vector<Piece> pieces;
  pieces.reserve(found.size());
  for (const auto triangle : found) {
    // Vertices on the plane count as left of it, so that every triangle is crossed on two edges or none.
    const auto& t = mesh_->triangles[triangle];
    std::array<SectionPoint, 2> ends;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3 && count < 2; ++i) {
      // Both triangles at an edge compute its crossing from the same end: bit-identical, so pieces join.
      const auto v = std::min(t[i], t[(i + 1) % 3]), w = std::max(t[i], t[(i + 1) % 3]);
      const double dv = off(v), dw = off(w);
      if ((dv >= 0) == (dw >= 0)) continue;
      const Point3 p = mesh_->vertices[v] + (dv / (dv - dw)) * (mesh_->vertices[w] - mesh_->vertices[v]);
      ends[count++] = {dot(geometry::xy(p) - plane.foot, plane.direction), p.z};
    }
    auto piece = clipped(ends[0], ends[1], plane.from, plane.to);
    if (!piece) continue;
    if (piece->first.height > piece->second.height) std::swap(piece->first, piece->second);
    pieces.push_back({piece->first, piece->second});
  }
  return pieces;
}

}  // namespace mansard::profile::detail
