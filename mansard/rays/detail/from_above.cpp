#include "mansard/rays/detail/from_above.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mansard/geometry/predicates.hpp"

namespace mansard::rays::detail {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Point3;

/// Whether p is in the triangle, which has an area, or on its boundary: it is not on both sides of its edges' lines.
auto holds(const std::array<Point2, 3>& t, Point2 p) -> bool {
  int side = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int turn = geometry::orientation(t[k], t[(k + 1) % 3], p);
    if (turn * side < 0) return false;
    if (turn != 0) side = turn;
  }
  return true;
}

/// The nearest float that is not above, or not below.
auto floor_of(double value) -> float {
  const auto near = static_cast<float>(value);
  return near <= value ? near : std::nextafter(near, -std::numeric_limits<float>::infinity());
}
auto ceiling_of(double value) -> float { return -floor_of(-value); }

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
    const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    if (geometry::orientation(xy(a), xy(b), xy(c)) == 0) continue;
    Box2 box;
    for (const Point3 p : {a, b, c}) box.add(xy(p));
    flat_.push_back({floor_of(box.least.x), floor_of(box.least.y), ceiling_of(box.most.x), ceiling_of(box.most.y),
                     ceiling_of(std::max({a.z, b.z, c.z})), i});
    box_.include(box);
  }
  if (flat_.empty()) return;
  choose_cells(box_);
  order_by_cell();
  fill();
}

/// So that what is looked at for one point lies together in memory.
void FromAbove::order_by_cell() {
  std::vector<std::uint32_t> start(x_.count * y_.count + 1, 0);
  const auto cell = [this](const Flat& one) { return cell_of({one.west, one.south}); };
  for (const Flat& one : flat_) ++start[cell(one) + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<Flat> ordered(flat_.size());
  for (const Flat& one : flat_) ordered[start[cell(one)]++] = one;
  flat_ = std::move(ordered);
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
  for (const Flat& one : flat_)
    sum += (x_.cell(one.east) - x_.cell(one.west) + 1) * (y_.cell(one.north) - y_.cell(one.south) + 1);
  return sum;
}

template <class Visit>
void FromAbove::each_cell(const Flat& one, Visit visit) const {
  for (std::size_t row = y_.cell(one.south), last = y_.cell(one.north); row <= last; ++row)
    for (std::size_t column = x_.cell(one.west), end = x_.cell(one.east); column <= end; ++column)
      visit(row * x_.count + column);
}

void FromAbove::fill() {
  start_.assign(x_.count * y_.count + 1, 0);
  for (const Flat& one : flat_) each_cell(one, [&](std::size_t cell) { ++start_[cell + 1]; });
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  inside_.resize(start_.back());
  auto next = start_;
  for (std::uint32_t i = 0; i < flat_.size(); ++i)
    each_cell(flat_[i], [&](std::size_t cell) { inside_[next[cell]++] = i; });
}

template <class Wanted, class Visit>
void FromAbove::each_over(Point2 at, Wanted wanted, Visit visit) const {
  if (flat_.empty() || !box_.contains(at)) return;
  const std::size_t cell = cell_of(at);
  for (std::size_t k = start_[cell]; k < start_[cell + 1]; ++k) {
    const Flat& one = flat_[inside_[k]];
    if (at.x < one.west || at.x > one.east || at.y < one.south || at.y > one.north || !wanted(one)) continue;
    const auto& t = mesh_->triangles[one.triangle];
    const Point3 a = mesh_->vertices[t[0]], b = mesh_->vertices[t[1]], c = mesh_->vertices[t[2]];
    const std::array corners{xy(a), xy(b), xy(c)};
    if (holds(corners, at)) visit(one, corners, height(a, b, c, at));
  }
}

auto FromAbove::operator()(Point2 at) const -> std::optional<Seen> {
  std::optional<Seen> best;
  each_over(
      at, [&](const Flat& one) { return !best || one.top >= best->z; },
      [&](const Flat& one, const auto&, double z) {
        // Of several at one height the first of the mesh.
        if (!best || z > best->z || (z == best->z && one.triangle < best->triangle)) best = Seen{z, one.triangle};
      });
  return best;
}

void FromAbove::crossings(Point2 at, std::vector<Crossing>& out) const {
  out.clear();
  each_over(
      at, [](const Flat&) { return true; },
      [&](const Flat& one, const auto& corners, double z) {
        out.push_back({z, geometry::orientation(corners[0], corners[1], corners[2]) > 0, one.triangle});
      });
  std::ranges::sort(out, [](const Crossing& a, const Crossing& b) {
    return a.z != b.z ? a.z > b.z : a.upward != b.upward ? a.upward : a.triangle < b.triangle;
  });
  const auto again =
      std::ranges::unique(out, [](const Crossing& a, const Crossing& b) { return a.z == b.z && a.upward == b.upward; });
  out.erase(again.begin(), again.end());
}

}  // namespace mansard::rays::detail
