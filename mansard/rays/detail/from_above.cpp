#include "mansard/rays/detail/from_above.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mansard/geometry/predicates.hpp"

namespace mansard::rays::detail {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Point3;

/// Whether p is in the triangle or on its boundary; `turn` is the triangle's own orientation.
auto holds(const std::array<Point2, 3>& t, int turn, Point2 p) -> bool {
  for (std::size_t k = 0; k < 3; ++k)
    if (geometry::orientation(t[k], t[(k + 1) % 3], p) == -turn) return false;
  return true;
}

/// z of the triangle's plane at p, which is over the triangle. The bounds matter to needles, whose plane is ill
/// conditioned.
auto height(Point3 a, Point3 b, Point3 c, Point2 p) -> double {
  const Point2 u = xy(b) - xy(a), v = xy(c) - xy(a), w = p - xy(a);
  const double area = cross(u, v);
  const double z =
      area == 0 ? std::max({a.z, b.z, c.z}) : a.z + ((b.z - a.z) * cross(w, v) + (c.z - a.z) * cross(u, w)) / area;
  return std::clamp(z, std::min({a.z, b.z, c.z}), std::max({a.z, b.z, c.z}));
}

/// Memory for the grid, in entries per triangle: long triangles across many cells make the cells larger.
constexpr std::size_t entries_per_triangle = 12;

}  // namespace

auto FromAbove::Axis::cell(double along) const -> std::size_t {
  const double at = std::floor((along - least) / size);
  return at <= 0 ? 0 : std::min(static_cast<std::size_t>(at), count - 1);
}

FromAbove::FromAbove(const geometry::Mesh& mesh) : mesh_(&mesh) {
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Point2 a = xy(mesh.vertices[t[0]]), b = xy(mesh.vertices[t[1]]), c = xy(mesh.vertices[t[2]]);
    const int turn = geometry::orientation(a, b, c);
    if (turn == 0) continue;
    Box2 box;
    for (const Point2 p : {a, b, c}) box.add(p);
    flat_.push_back(i);
    turns_.push_back(static_cast<std::int8_t>(turn));
    boxes_.push_back(box);
    box_.add(box.least);
    box_.add(box.most);
  }
  if (flat_.empty()) return;
  choose_cells(box_);
  fill();
}

/// About two triangles a cell, and fewer cells while triangles reach over too many of them.
void FromAbove::choose_cells(const Box2& box) {
  const Point2 extent = box.most - box.least;
  double size = std::sqrt(extent.x * extent.y * 2 / static_cast<double>(flat_.size()));
  const std::size_t allowed = entries_per_triangle * flat_.size() + 64;
  const auto cells = [&](double length) { return static_cast<std::size_t>(length / size) + 1; };
  size = std::max(size, std::max(extent.x, extent.y) / static_cast<double>(allowed));
  for (;; size *= 2) {
    x_ = {box.least.x, size, cells(extent.x)};
    y_ = {box.least.y, size, cells(extent.y)};
    if (x_.count * y_.count <= allowed && entries() <= allowed) return;
    if (x_.count * y_.count == 1) return;
  }
}

auto FromAbove::entries() const -> std::size_t {
  std::size_t sum = 0;
  for (const Box2& b : boxes_)
    sum += (x_.cell(b.most.x) - x_.cell(b.least.x) + 1) * (y_.cell(b.most.y) - y_.cell(b.least.y) + 1);
  return sum;
}

void FromAbove::fill() {
  const auto each_cell = [&](const Box2& b, const auto& visit) {
    for (std::size_t row = y_.cell(b.least.y), last = y_.cell(b.most.y); row <= last; ++row)
      for (std::size_t column = x_.cell(b.least.x), end = x_.cell(b.most.x); column <= end; ++column)
        visit(row * x_.count + column);
  };
  start_.assign(x_.count * y_.count + 1, 0);
  for (const Box2& b : boxes_) each_cell(b, [&](std::size_t cell) { ++start_[cell + 1]; });
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  inside_.resize(start_.back());
  auto next = start_;
  for (std::uint32_t i = 0; i < boxes_.size(); ++i)
    each_cell(boxes_[i], [&](std::size_t cell) { inside_[next[cell]++] = i; });
}

auto FromAbove::operator()(Point2 at) const -> std::optional<Seen> {
  if (flat_.empty() || !box_.contains(at)) return std::nullopt;
  const std::size_t cell = y_.cell(at.y) * x_.count + x_.cell(at.x);
  std::optional<Seen> best;
  for (std::size_t k = start_[cell]; k < start_[cell + 1]; ++k) {
    const std::uint32_t i = inside_[k];
    if (!boxes_[i].contains(at)) continue;
    const auto& t = mesh_->triangles[flat_[i]];
    const Point3 a = mesh_->vertices[t[0]], b = mesh_->vertices[t[1]], c = mesh_->vertices[t[2]];
    if (best && std::max({a.z, b.z, c.z}) <= best->z) continue;
    if (!holds({xy(a), xy(b), xy(c)}, turns_[i], at)) continue;
    if (const double z = height(a, b, c, at); !best || z > best->z) best = Seen{z, flat_[i]};
  }
  return best;
}

}  // namespace mansard::rays::detail
