// A mesh as a file has it: any index, any number.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mansard/geometry/mesh.hpp"

namespace mansard::formats {

/// Stands for an index that names no vertex.
inline constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

struct RawMesh {
  std::vector<geometry::Point3> vertices;     ///< file coordinates, may hold NaN
  std::vector<geometry::Triangle> triangles;  ///< may name vertices that do not exist
  std::uint64_t short_faces = 0;              ///< faces of fewer than three corners, left out
  std::vector<std::uint8_t> classes;          ///< per triangle, where the file has them; else empty
  std::vector<geometry::Point3> points;       ///< of which a surface was made; of files of meshes none
};

/// Index of a face's corner as 32 bits.
[[nodiscard]] inline auto to_index(std::int64_t index) -> std::uint32_t {
  return index >= 0 && index < static_cast<std::int64_t>(no_vertex) ? static_cast<std::uint32_t>(index) : no_vertex;
}

/// Adds a polygon as a fan around its first corner.
inline void add_face(RawMesh& mesh, std::span<const std::uint32_t> corners) {
  if (corners.size() < 3) ++mesh.short_faces;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    mesh.triangles.push_back({corners[0], corners[i], corners[i + 1]});
}

/// Adds a triangle strip; every second triangle is turned over.
inline void add_strip(RawMesh& mesh, std::span<const std::uint32_t> corners) {
  for (std::size_t i = 0; i + 2 < corners.size(); ++i)
    mesh.triangles.push_back({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
}

}  // namespace mansard::formats
