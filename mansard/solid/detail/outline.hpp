// Boundaries put together from directed edges.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mansard/solid/detail/sheets.hpp"

namespace mansard::solid::detail {

using Edge = std::pair<Node, Node>;
using Flat = std::function<geometry::Point2(const Node&)>;

/// Faces, outer loop first, of what polygons that lie in one plane cover together: edges that two of them walk both
/// ways go. `flat` shows them from outside. None where polygons overlap.
[[nodiscard]] auto united_faces(const std::vector<Path>& polygons, const Flat& flat)
    -> std::optional<std::vector<std::vector<Path>>>;

/// A path that comes to a node again, taken apart into loops that do not, without those of fewer than three corners.
[[nodiscard]] auto simple_loops(const Path& path) -> std::vector<Path>;

}  // namespace mansard::solid::detail
