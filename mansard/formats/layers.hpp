// Layers of plan geometry: tables of features, and a GeoPackage of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/attributes.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// What the features of a layer are: a table without geometry, one line, several lines, …
enum class Shape : std::uint8_t { none, line, lines, polygon, polygons };
enum class FieldType : std::uint8_t { integer, real, string, boolean };

struct Field {
  std::string name;
  FieldType type = FieldType::string;
};

/// A row of a layer. Without lines and polygons it has no geometry, which every shape allows.
struct Feature {
  std::vector<std::vector<geometry::Point2>> lines;  ///< local frame, two points or more each
  std::vector<geometry::Polygon> polygons;           ///< local frame
  std::vector<model::Value> values;                  ///< one per field, of its type or absent
};

struct Layer {
  std::string name, meaning;
  Shape shape = Shape::none;
  std::vector<Field> fields;
  std::vector<Feature> features;
};

/// The bytes of a GeoPackage (OGC 12-128) with these layers in this order, in the frame's file coordinates and CRS,
/// each with a spatial index. A field whose name is taken already ("fid", "geom", or an earlier one in any case) gets
/// "_2" or the next number free. The same layers give the same bytes at any time: the date of change is 1970-01-01.
/// Fails with "write-layer" (the layers are inconsistent), "write-geopackage" (the library's words).
[[nodiscard]] auto geopackage(const std::vector<Layer>& layers, const model::Frame& frame) -> base::Result<std::string>;

}  // namespace mansard::formats
