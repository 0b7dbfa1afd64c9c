// A glTF file with its buffers, unpacked.
#pragma once

#include <tiny_gltf.h>
#include <filesystem>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

struct GltfInput {
  tinygltf::Model model;  ///< without images; buffer views compressed with meshoptimizer are unpacked in place
  std::vector<model::InputFile> buffers;  ///< the files beside it that were read
};

/// `path` leads to the buffers beside it. With `images`, those written into the JSON itself (data URIs) are kept in
/// their encoded form; others stay where they are. Fails with "ingest-mesh-format", "ingest-mesh-truncated",
/// "file-missing", "file-read".
[[nodiscard]] auto load_gltf(std::string_view bytes, const std::filesystem::path& path, bool images = false)
    -> base::Result<GltfInput>;

}  // namespace mansard::formats
