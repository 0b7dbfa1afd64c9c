// The faces of a model as triangles.
#pragma once

#include <string>

#include "mansard/base/result.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::formats::detail {

/// solid::triangulate, with the part's name in its complaint: "write-triangulate".
[[nodiscard]] auto triangles_of(const model::Solid& solid, const std::string& part)
    -> base::Result<solid::Triangulated>;

}  // namespace mansard::formats::detail
