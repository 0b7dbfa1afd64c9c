// A city of models as text in memory: CityJSON 2.0, OBJ + MTL, GLB.
#pragma once

#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats {

/// CityJSON 2.0 text. Vertices at 0.1 mm; polygons, not triangles; "1.2" (flat) and "2.2" solids. `warnings` gets what
/// is simpler in it than in the city, or left out: "solid-simplified", "solid-left-out", "solid-not-united".
[[nodiscard]] auto cityjson(const model::City& city, Solids solids = Solids::building,
                            std::vector<base::Diagnostic>* warnings = nullptr) -> base::Result<std::string>;

/// OBJ text and its material library; `mtl_name` is the library's file name, coordinates are the file frame's in full.
struct ObjFiles {
  std::string obj, mtl;
};
[[nodiscard]] auto obj(const model::City& city, const std::string& mtl_name, Solids solids = Solids::building)
    -> base::Result<ObjFiles>;

/// Binary glTF 2.0, y up, single precision around the origin (kept in asset.extras), a node per solid, colour by class.
[[nodiscard]] auto glb(const model::City& city, Solids solids = Solids::building) -> base::Result<std::string>;

}  // namespace mansard::formats
