// A building footprint: one feature of a GIS source.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/attributes.hpp"

namespace mansard::model {

/// A part of a building that its source draws by itself: OpenStreetMap's building:part.
struct FootprintPart {
  std::string id;                           ///< as that of a footprint, and unique among both
  std::vector<geometry::Polygon> polygons;  ///< as those of a footprint
  Attributes attributes;
};

/// One GIS feature. A feature that cannot be used keeps its place, with `defect` set; it has polygons only where
/// nothing is wrong with these, so that they can be written as LoD 0.
struct Footprint {
  std::string id;                           ///< the id attribute, else the feature id of the source; unique in a scene
  std::vector<geometry::Polygon> polygons;  ///< local frame, simple, oriented, one per part of a MultiPolygon
  Attributes attributes;
  std::optional<base::Diagnostic> defect;
  bool derived = false;  ///< drawn from the mesh, by no surveyor
  /// z of the ground around it, m, in the heights of the files: what an attribute says.
  std::optional<double> ground = std::nullopt;
  /// Minimum z of its outline, m, in the same; none where it is drawn in two dimensions. That may be the ground or a
  /// roof.
  std::optional<double> outline_z = std::nullopt;
  /// What the names of its parts begin with, where "id-" would make one that another footprint has; else empty.
  std::string part_prefix = {};
  /// Where there are any, they are the building where no scan shows it, and the polygons are the land that it covers.
  std::vector<FootprintPart> parts = {};

  /// The name of its part `number`, from 1.
  [[nodiscard]] auto part_id(std::size_t number) const -> std::string {
    return (part_prefix.empty() ? id + "-" : part_prefix) + std::to_string(number);
  }
};

}  // namespace mansard::model
