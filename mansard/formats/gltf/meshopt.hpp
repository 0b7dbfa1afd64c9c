// Buffers compressed with meshoptimizer, as EXT_meshopt_compression has them.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace mansard::formats {

struct MeshoptLayout {
  std::string mode;    ///< "ATTRIBUTES", "TRIANGLES", "INDICES"
  std::string filter;  ///< "NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"
  std::size_t count = 0, stride = 0;
};

/// Unpacks into `out`, which has count × stride bytes. False where the layout is none, or the bytes are damaged.
[[nodiscard]] auto unpack_meshopt(std::span<const unsigned char> bytes, const MeshoptLayout& layout,
                                  std::span<unsigned char> out) -> bool;

}  // namespace mansard::formats
