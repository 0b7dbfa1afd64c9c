// Some of the triangles of a mesh: as a mesh of their own, left out, or found by where they are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::geometry {

/// These triangles, in their order, with the vertices that they use, in the mesh's order; without points. Cost: O(n log
/// n) of the triangles asked for.
[[nodiscard]] auto part_of(const Mesh& mesh, std::span<const std::uint32_t> triangles) -> Mesh;

/// The mesh without these triangles, which are ascending and each there once; vertices and points stay.
[[nodiscard]] auto without(const Mesh& mesh, std::span<const std::uint32_t> triangles) -> Mesh;

/// For each box, the triangles whose boxes in plan overlap or touch it, ascending: candidates for a closer look.
/// Nothing is near an empty box. Cost: O(n + k) for k results where boxes are of about one size. Memory: the results.
[[nodiscard]] auto triangles_near(const Mesh& mesh, const std::vector<Box2>& boxes)
    -> std::vector<std::vector<std::uint32_t>>;
/// The same of points.
[[nodiscard]] auto points_near(std::span<const Point3> points, const std::vector<Box2>& boxes)
    -> std::vector<std::vector<std::uint32_t>>;

}  // namespace mansard::geometry
