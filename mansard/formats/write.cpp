#include "mansard/formats/write.hpp"

#include "mansard/base/files.hpp"
#include "mansard/formats/cityjson/cityjson.hpp"
#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/gltf/glb_bytes.hpp"
#include "mansard/formats/obj/obj_text.hpp"
#include "mansard/formats/plans/plan_text.hpp"

namespace mansard::formats {
namespace {

/// What every format with geometry asks of a city first.
auto checked_keys(const model::City& city) -> base::Result<detail::Keys> {
  if (const auto sound = detail::check_models(city); !sound) return sound.error();
  return detail::keys_of(city);
}

}  // namespace

auto cityjson(const model::City& city) -> base::Result<std::string> {
  const auto keys = checked_keys(city);
  if (!keys) return keys.error();
  const Header header{city.frame, city.made_by};
  base::TextSink vertices;
  detail::CityObjects text(header, vertices, 0);
  for (std::size_t b = 0; b < city.buildings.size(); ++b)
    text.add(city.buildings[b], {keys->buildings[b], keys->parts[b]});
  std::string out = detail::cityjson_head(header, text.extent(), 0) + text.end();
  return out.append(detail::cityjson_waist).append(vertices.text).append(detail::cityjson_foot);
}

auto obj(const model::City& city, const std::string& mtl_name) -> base::Result<ObjFiles> {
  const auto keys = checked_keys(city);
  if (!keys) return keys.error();
  const Header header{city.frame, city.made_by};
  detail::ObjText text(header);
  ObjFiles files{detail::ObjText::head(header, mtl_name), detail::mtl_text()};
  for (std::size_t b = 0; b < city.buildings.size(); ++b) {
    const auto more = text.of(city.buildings[b], {keys->buildings[b], keys->parts[b]});
    if (!more) return more.error();
    files.obj += *more;
  }
  return files;
}

auto glb(const model::City& city) -> base::Result<std::string> {
  const auto keys = checked_keys(city);
  if (!keys) return keys.error();
  return detail::glb_bytes(city, *keys);
}

auto plans(const model::City& city) -> std::string {
  base::TextSink sink;
  detail::PlansText text({city.frame, city.made_by}, sink);
  for (const model::Building& building : city.buildings) text.add(building);
  text.end();
  return std::move(sink.text);
}

auto read_plans(const std::filesystem::path& path) -> base::Result<model::City> {
  const auto text = base::read_file(path);
  if (!text) return text.error();
  return detail::parse_plans(*text, path.string());
}

auto plan_json(const model::Plan& plan) -> std::string {
  detail::JsonText json;
  detail::append_plan(json.begin_object(), plan);
  return std::move(json.end_object()).str();
}

auto read_plan(std::string_view json, const std::string& name) -> base::Result<model::Plan> {
  return detail::parse_plan(json, name);
}

auto codes() -> std::vector<base::Code> {
  return {
      {"write-duplicate-id", "Two buildings have the same id, so a city model cannot tell them apart.",
       "Name an attribute that is unique with --ingest-id-attribute.", 3},
      {"write-model", "A model that was to be written is broken: a coordinate that is not finite, a missing vertex.",
       "This is a bug: please report it with the input.", 70},
      {"write-triangulate", "A face of a model could not be cut into triangles for OBJ or GLB.",
       "This is a bug: please report it with the input; CityJSON keeps whole polygons and is not affected.", 70},
      {"write-glb-size", "The model is larger than the 4 GB, or the 16 million surfaces, that a GLB can hold.",
       "Write 3D Tiles, or run smaller areas (--bbox).", 2},
      {"write-tiles-crs",
       "PROJ has no transformation from the coordinate reference system to WGS 84, which 3D Tiles use.",
       "Work in a projected coordinate system of EPSG (--ingest-crs), or in none (local): tiles are not placed on "
       "Earth then.",
       3},
      {"write-tiles-grid",
       "PROJ lacks a geoid or a grid on the way to WGS 84, so a tileset stands less exactly than it could.",
       "Install PROJ's grids for the region (https://cdn.proj.org), or set PROJ_NETWORK=ON so that it fetches them.",
       0},
      {"write-read-format", "A file is in no format that buildings can be read back from.",
       "Give CityJSON, CityJSONSeq, OBJ, GLB, 3D Tiles, a GeoPackage, GeoJSON or plans that mansard wrote.", 3},
      {"write-read-plans", "A file of buildings carries none of the plans that mansard's own files do.",
       "Give a file that mansard wrote and no other program has stripped.", 3},
      {"write-plan-json", "A plan file is not JSON, or is cut short, or has a number no double can hold.",
       "Look at the byte that is named, or write the file again.", 3},
      {"write-plan-type",
       "A JSON file is neither plan + profiles (\"type\": \"mansard-plan\") nor CityJSON that carries plans.",
       "Give the plan file or the CityJSON that reconstruct wrote.", 3},
      {"write-plan-version", "A plan file is of a version of the format that is not known here.",
       "Use the mansard that wrote it, or a newer one.", 3},
      {"write-plan-missing", "A plan file lacks a member that is required.",
       "Add it; docs/plan.schema.json lists all members.", 3},
      {"write-plan-key", "A plan file has a member that the format does not know, often a misspelt one.",
       "Correct its name or take it out; docs/plan.schema.json lists all members.", 3},
      {"write-plan-value", "A member of a plan file has a value of the wrong type, length or range.",
       "Correct it; the message names the place and what it should be.", 3},
      {"write-plan-profile",
       "A profile does not start at [0, 0], goes outward or down, repeats a point, or an edge names one that is "
       "missing.",
       "Correct the profile or the edge's number; profiles are numbered from 0.", 3},
      {"write-layer",
       "A layer that was to be written is broken: values that do not fit its fields, or coordinates that "
       "are not finite.",
       "This is a bug: please report it with the input.", 70},
      {"write-layer-left", "A layer of a GeoPackage beside the buildings cannot be taken into another file.",
       "Nothing, or copy it with ogr2ogr; the original file still has it. A GeoPackage as the result takes all layers "
       "of "
       "mansard's.",
       0},
      {"write-geopackage", "GDAL could not make a GeoPackage.",
       "The message has GDAL's words; its GPKG driver and PROJ's data must be installed, and there must be memory.", 3},
      {"write-stl-shell",
       "Parts that touch cannot be one closed shell of an STL: where towers meet at a corner, or outlines "
       "overlap. They are several sound shells with walls between them.",
       "Change the plans at the place that is named, or take the shells as they are.", 0},
      {"write-stl-size", "There are more triangles than the 4,294,967,295 that an STL can count.",
       "Run smaller areas (--bbox).", 2},
      {"write-geojson", "Footprints cannot be brought to longitude and latitude, which GeoJSON is in.",
       "Give the CRS that the coordinates are in with --ingest-crs; PROJ's data must be installed.", 3},
      {"write-geotiff", "GDAL could not make a GeoTIFF, or there is nothing to put into it.",
       "The message has GDAL's words; its GTiff driver and PROJ's data must be installed, and there must be memory.",
       3},
  };
}

}  // namespace mansard::formats
