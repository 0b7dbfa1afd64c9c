#include "mansard/formats/detail/triangles.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::formats::detail {

auto triangles_of(const model::Solid& solid, const std::string& part) -> base::Result<solid::Triangulated> {
  auto triangulated = solid::triangulate(solid);
  if (!triangulated)
    return base::error("write-triangulate",
                       "the model cannot be cut into triangles (" + triangulated.error().message +
                           "); this is a bug, please report it",
                       part);
  return triangulated;
}

}  // namespace mansard::formats::detail
