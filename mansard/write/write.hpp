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
#include "mansard/geometry/plan.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/label/label.hpp"

namespace mansard::write {

/// One footprint of the segmentation, raised.
struct Part {
  std::string id;
  geometry::Plan plan;
  label::LabelledSolid model;
  ingest::Attributes attributes;  ///< with prefix ms_
};

/// One GIS feature with the parts that overlap it most.
struct Building {
  std::string id;
  ingest::Attributes attributes;             ///< the source's own, then those with prefix ms_
  std::vector<geometry::Polygon> footprint;  ///< the GIS polygons, for LoD 0
  double ground = 0;                         ///< z, metres
  std::vector<Part> parts;
};

/// How the city was made, repeated in every file.
struct MadeBy {
  std::string version;
  std::vector<std::pair<std::string, std::string>> options;  ///< room.name → value, as text
  std::vector<ingest::InputFile> inputs;
};

struct City {
  ingest::Frame frame;
  MadeBy made_by;
  std::vector<Building> buildings;
};

/// CityJSON 2.0 text. Vertices at 0.1 mm; polygons, not triangles; "1.2" (flat) and "2.2" solids per part.
[[nodiscard]] auto cityjson(const City& city) -> base::Result<std::string>;

/// OBJ text and its material library; `mtl_name` is the library's file name, coordinates are the file frame's in full.
struct ObjFiles {
  std::string obj, mtl;
};
[[nodiscard]] auto obj(const City& city, const std::string& mtl_name) -> base::Result<ObjFiles>;

/// Binary glTF 2.0, y up, single precision around the origin (kept in asset.extras), a node per part, colour by class.
[[nodiscard]] auto glb(const City& city) -> base::Result<std::string>;

/// Plan + profiles: a small JSON of its own, documented in docs/write.md; the source of truth of every part.
[[nodiscard]] auto plans(const City& city) -> std::string;

/// Reads plan + profiles back: buildings and parts with plans but without models; from a file of plans, or from the
/// plans that travel in our CityJSON. Gives up with "write-plan-…".
[[nodiscard]] auto read_plans(const std::filesystem::path& path) -> base::Result<City>;

/// One plan on one line, as the member "plan" of a plans.json has it: numbers read back as the very same doubles.
[[nodiscard]] auto plan_json(const geometry::Plan& plan) -> std::string;
/// Reads one plan back, as strictly as a file of them; `name` is what messages call its place. Gives up with
/// "write-plan-…".
[[nodiscard]] auto read_plan(std::string_view json, const std::string& name) -> base::Result<geometry::Plan>;

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
  std::vector<ingest::Value> values;                 ///< one per field, of its type or absent
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
[[nodiscard]] auto geopackage(const std::vector<Layer>& layers, const ingest::Frame& frame)
    -> base::Result<std::string>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::write
