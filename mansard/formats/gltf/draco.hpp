// Meshes compressed with Draco, as KHR_draco_mesh_compression has them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::formats {

/// A further attribute that is wanted, by its unique id in the bitstream.
struct DracoExtra {
  std::uint32_t attribute = 0;
  bool normalised = false;
  std::size_t components = 0;   ///< of each vertex; set when it was there
  std::vector<float> values{};  ///< vertex by vertex
};

/// `position` is the attribute's unique id in the bitstream; with `normalised`, integers stand for fractions of their
/// type's greatest value. Fails with "ingest-mesh-format".
[[nodiscard]] auto unpack_draco(std::span<const unsigned char> bytes, std::uint32_t position, bool normalised,
                                const std::string& name, std::span<DracoExtra> more = {})
    -> base::Result<geometry::Mesh>;

}  // namespace mansard::formats
