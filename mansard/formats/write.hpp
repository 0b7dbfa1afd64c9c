// Writes a city of models: CityJSON 2.0, OBJ + MTL, GLB, plan + profiles; and layers of plan geometry: GeoPackage.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/attributes.hpp"
#include "mansard/model/city.hpp"
#include "mansard/model/frame.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::formats {

/// CityJSON 2.0 text. Vertices at 0.1 mm; polygons, not triangles; "1.2" (flat) and "2.2" solids per part.
[[nodiscard]] auto cityjson(const model::City& city) -> base::Result<std::string>;

/// OBJ text and its material library; `mtl_name` is the library's file name, coordinates are the file frame's in full.
struct ObjFiles {
  std::string obj, mtl;
};
[[nodiscard]] auto obj(const model::City& city, const std::string& mtl_name) -> base::Result<ObjFiles>;

/// Binary glTF 2.0, y up, single precision around the origin (kept in asset.extras), a node per part, colour by class.
[[nodiscard]] auto glb(const model::City& city) -> base::Result<std::string>;

/// Plan + profiles: a small JSON of its own, documented in docs/formats.md; the source of truth of every part.
[[nodiscard]] auto plans(const model::City& city) -> std::string;

/// Reads plan + profiles back: buildings and parts with plans but without models; from a file of plans, or from the
/// plans that travel in our CityJSON. Gives up with "write-plan-…".
[[nodiscard]] auto read_plans(const std::filesystem::path& path) -> base::Result<model::City>;

/// One plan on one line, as the member "plan" of a plans.json has it: numbers read back as the very same doubles.
[[nodiscard]] auto plan_json(const model::Plan& plan) -> std::string;
/// Reads one plan back, as strictly as a file of them; `name` is what messages call its place. Gives up with
/// "write-plan-…".
[[nodiscard]] auto read_plan(std::string_view json, const std::string& name) -> base::Result<model::Plan>;

/// What the features of a layer are: a table without geometry, one line, several lines, …
enum class Shape : std::uint8_t { none, line, lines, polygon, polygons };
enum class FieldType : std::uint8_t { whole, real, text, flag };

struct Field {
  std::string name;
  FieldType type = FieldType::text;
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
/// Gives up with "write-layer" (the layers are inconsistent), "write-geopackage" (the library's words).
[[nodiscard]] auto geopackage(const std::vector<Layer>& layers, const model::Frame& frame) -> base::Result<std::string>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::formats
