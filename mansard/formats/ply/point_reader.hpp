// PLY without faces: a point cloud.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "mansard/formats/points.hpp"

namespace mansard::formats {

/// Whether the header that the bytes begin with has vertices with x, y and z, and no face and no triangle strip; false
/// where it is no header.
[[nodiscard]] auto is_point_ply(std::string_view bytes) -> bool;

/// Beside x, y and z of any type it takes the properties classification (or class, label), return_number,
/// number_of_returns, intensity, and red, green and blue. Fails as open_points does.
[[nodiscard]] auto open_point_ply(const std::filesystem::path& path) -> base::Result<std::unique_ptr<PointCloud>>;

}  // namespace mansard::formats
