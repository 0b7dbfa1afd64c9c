// Point clouds as text: a point a line.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/formats/points.hpp"

namespace mansard::formats {

/// Whether a text begins as a cloud does: with a header that names x, y and z, or with three numbers a line.
[[nodiscard]] auto is_point_text(std::string_view beginning) -> bool;

/// The columns of a header are found by their names, in any order: x, y, z; class, return, returns, intensity, red,
/// green and blue are optional, others are passed over. Without a header they are x, y, z; of six columns the last
/// three are red, green, blue; of seven, the fourth is the intensity and the last three are red, green, blue; more of
/// them are passed over. The separator is that of the first line: semicolons, tabs, commas, else blanks; where
/// it is not a comma, decimal commas are numbers, too. Empty lines, comments (# and //) and a first line with the
/// number of points (PTS) are passed over. Fails as open_points does, with the number of the line.
[[nodiscard]] auto open_point_text(const std::filesystem::path& path) -> base::Result<std::unique_ptr<PointCloud>>;

}  // namespace mansard::formats
