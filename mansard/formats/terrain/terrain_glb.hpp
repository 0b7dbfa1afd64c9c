// Triangles of the ground as binary glTF 2.0.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::formats::detail {

/// One mesh with the material "ground", y up. `extras` is a JSON object for the asset, or nothing. Fails with
/// "write-glb-size".
[[nodiscard]] auto terrain_glb(const geometry::Mesh& mesh, const std::string& version, std::string_view extras)
    -> base::Result<std::string>;

template <class T>
void append_little_endian(std::string& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
}
inline void append_float(std::string& bytes, float value) {
  append_little_endian(bytes, std::bit_cast<std::uint32_t>(value));
}

}  // namespace mansard::formats::detail
