// mansard-reader: the program that reads the formats of libraries that damaged files can bring down (decision 52).
#pragma once

#include <filesystem>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/formats/outside/scene.hpp"

namespace mansard::formats {

/// The bytes of a file in the format with this extension ("osgb", "fbx"), read by another process, which is kept for
/// the next file. From any thread. Fails with "ingest-mesh-format" where they are not in the format, where reading ends
/// the other process, or where that cannot be found; "ingest-mesh-truncated".
[[nodiscard]] auto read_outside(std::string_view extension, std::string_view bytes, const std::filesystem::path& path)
    -> base::Result<outside::Scene>;

}  // namespace mansard::formats
