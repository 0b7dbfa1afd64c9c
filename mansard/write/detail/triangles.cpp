#include "mansard/write/detail/triangles.hpp"

namespace mansard::write::detail {

auto triangles_of(const extrude::Solid& solid, const std::string& part) -> base::Result<extrude::Triangulated> {
  auto triangulated = extrude::triangulate(solid);
  if (!triangulated)
    return base::error("write-triangulate",
                       "the model cannot be cut into triangles (" + triangulated.error().message +
                           "); this is a bug, please report it",
                       part);
  return triangulated;
}

}  // namespace mansard::write::detail
