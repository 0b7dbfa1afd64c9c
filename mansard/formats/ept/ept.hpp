// Entwine Point Tiles: a folder with ept.json, a hierarchy in JSON and one LAZ file a node.
#pragma once

#include <filesystem>
#include <memory>

#include "mansard/formats/points.hpp"

namespace mansard::formats {

/// `path` is that of ept.json. Data type "laszip" is read; "binary" and "zstandard" are refused by name. Fails as
/// open_points does. Reference: the EPT specification (entwine.io).
[[nodiscard]] auto open_ept(const std::filesystem::path& path) -> base::Result<std::unique_ptr<PointCloud>>;

}  // namespace mansard::formats
