// Other readers of the same files, as references. They are linked nowhere else.
#pragma once

#include <cstddef>
#include <string>

namespace mansard::bench {

/// Triangles read; 0 when it failed.
auto read_by_tinyobjloader(const std::string& path) -> std::size_t;
auto read_by_assimp(const std::string& path) -> std::size_t;

}  // namespace mansard::bench
