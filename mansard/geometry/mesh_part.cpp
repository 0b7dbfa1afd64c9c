#include "mansard/geometry/mesh_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mansard/base/run.hpp"

namespace mansard::geometry {

auto part_of(const Mesh& mesh, std::span<const std::uint32_t> triangles) -> Mesh {
  std::vector<std::uint32_t> used;
  used.reserve(3 * triangles.size());
  for (const auto t : triangles) used.insert(used.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  Mesh out;
  out.vertices.reserve(used.size());
  for (const auto v : used) out.vertices.push_back(mesh.vertices[v]);
  out.triangles.reserve(triangles.size());
  for (const auto t : triangles) {
    auto triangle = mesh.triangles[t];
    for (auto& v : triangle) v = static_cast<std::uint32_t>(std::ranges::lower_bound(used, v) - used.begin());
    out.triangles.push_back(triangle);
  }
  return out;
}

auto without(const Mesh& mesh, std::span<const std::uint32_t> triangles) -> Mesh {
  Mesh out{mesh.vertices, {}, mesh.points};
  out.triangles.reserve(mesh.triangles.size() - triangles.size());
  std::size_t next = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (next < triangles.size() && triangles[next] == t) ++next;
    else out.triangles.push_back(mesh.triangles[t]);
  }
  return out;
}

namespace {

/// For each box, those of so many things whose boxes overlap or touch it.
template <class BoxOf>
auto near_boxes(std::size_t things, BoxOf box_of, const std::vector<Box2>& boxes)
    -> std::vector<std::vector<std::uint32_t>> {
  std::vector<std::vector<std::uint32_t>> out(boxes.size());
  Box2 all;
  double sides = 0;
  for (const auto& one : boxes) {
    if (one.empty()) continue;
    all.add(one.least);
    all.add(one.most);
    sides += std::max(one.most.x - one.least.x, one.most.y - one.least.y);
  }
  if (all.empty()) return out;

  // A grid over the boxes with cells about their size; everything looks into the cells under its box.
  const Point2 extent = all.most - all.least;
  const double size = std::max({sides / static_cast<double>(boxes.size()), extent.x / 512, extent.y / 512, 1.0});
  const auto columns = static_cast<std::size_t>(extent.x / size) + 1,
             rows = static_cast<std::size_t>(extent.y / size) + 1;
  const auto range = [&](const Box2& box) {
    const auto place = [size](double along, double least, std::size_t count) {
      const double cell = std::floor((along - least) / size);
      return cell <= 0 ? std::size_t{0} : std::min(static_cast<std::size_t>(cell), count - 1);
    };
    return std::array<std::size_t, 4>{place(box.least.x, all.least.x, columns), place(box.most.x, all.least.x, columns),
                                      place(box.least.y, all.least.y, rows), place(box.most.y, all.least.y, rows)};
  };
  std::vector<std::vector<std::uint32_t>> cells(columns * rows);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].empty()) continue;
    const auto [c0, c1, r0, r1] = range(boxes[i]);
    for (std::size_t r = r0; r <= r1; ++r)
      for (std::size_t c = c0; c <= c1; ++c) cells[r * columns + c].push_back(static_cast<std::uint32_t>(i));
  }

  // In pieces, each with its own lists, put together in the order of the pieces; some at a time, since all lists of a
  // city would take as much memory as its mesh.
  constexpr std::size_t piece = 1 << 14, at_a_time = 32;
  const std::size_t pieces = (things + piece - 1) / piece;
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> found(std::min(pieces, at_a_time));
  for (std::size_t first = 0; first < pieces; first += at_a_time) {
    base::parallel_for(std::min(at_a_time, pieces - first), [&](std::size_t k) {
      std::vector<std::uint32_t> near;
      found[k].clear();
      const std::size_t begin = (first + k) * piece;
      for (std::size_t t = begin; t < std::min(things, begin + piece); ++t) {
        const Box2 box = box_of(t);
        if (!box.overlaps(all)) continue;
        near.clear();
        const auto [c0, c1, r0, r1] = range(box);
        for (std::size_t r = r0; r <= r1; ++r)
          for (std::size_t c = c0; c <= c1; ++c)
            for (const std::uint32_t i : cells[r * columns + c])
              if (boxes[i].overlaps(box)) near.push_back(i);
        std::ranges::sort(near);
        near.erase(std::unique(near.begin(), near.end()), near.end());
        for (const std::uint32_t i : near) found[k].emplace_back(i, static_cast<std::uint32_t>(t));
      }
    });
    for (std::size_t k = 0; k < std::min(at_a_time, pieces - first); ++k)
      for (const auto& [near_box, triangle] : found[k]) out[near_box].push_back(triangle);
  }
  for (auto& triangles : out) triangles.shrink_to_fit();
  return out;
}

}  // namespace

auto triangles_near(const Mesh& mesh, const std::vector<Box2>& boxes) -> std::vector<std::vector<std::uint32_t>> {
  const auto box_of = [&mesh](std::size_t t) {
    Box2 box;
    for (const auto v : mesh.triangles[t]) box.add(xy(mesh.vertices[v]));
    return box;
  };
  return near_boxes(mesh.triangles.size(), box_of, boxes);
}

auto points_near(std::span<const Point3> points, const std::vector<Box2>& boxes)
    -> std::vector<std::vector<std::uint32_t>> {
  const auto box_of = [points](std::size_t i) { return Box2{xy(points[i]), xy(points[i])}; };
  return near_boxes(points.size(), box_of, boxes);
}

}  // namespace mansard::geometry
