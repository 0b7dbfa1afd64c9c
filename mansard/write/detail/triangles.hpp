// The faces of a model as triangles.
#pragma once

#include <string>

#include "mansard/base/result.hpp"
#include "mansard/extrude/extrude.hpp"

namespace mansard::write::detail {

/// extrude::triangulate, with the part's name in its complaint: "write-triangulate".
[[nodiscard]] auto triangles_of(const extrude::Solid& solid, const std::string& part)
    -> base::Result<extrude::Triangulated>;

}  // namespace mansard::write::detail
