// A building footprint: one feature of a GIS source.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/attributes.hpp"

namespace mansard::model {

/// One GIS feature. A feature that cannot be used keeps its place, with `defect` set and no polygons.
struct Footprint {
  std::string id;                           ///< the id attribute, else the feature id of the source; unique in a scene
  std::vector<geometry::Polygon> polygons;  ///< local frame, simple, oriented, one per part of a MultiPolygon
  Attributes attributes;
  std::optional<base::Diagnostic> defect;
  bool derived = false;  ///< drawn from the mesh, by no surveyor
};

}  // namespace mansard::model
