#include "mansard/formats/codes.hpp"

namespace mansard::formats {

auto codes() -> std::vector<base::Code> {
  return {
      {"write-duplicate-id", "Two buildings have the same id, so a city model cannot distinguish them.",
       "Name an attribute that is unique with --ingest-id-attribute.", 3},
      {"write-columns", "There are more attributes than a table can have columns.",
       "Nothing to do: the others are in one column, as JSON. --attributes chooses those that are written.", 0},
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
      {"write-geopackage-footprint", "The polygons of a footprint touch each other and could not be united.",
       "The GeoPackage has them as an invalid MultiPolygon; repair the footprint in the source.", 0},
      {"write-geopackage", "GDAL could not make a GeoPackage.",
       "The message has GDAL's words; its GPKG driver and PROJ's data must be installed, and there must be memory.", 3},
      {"write-foreign", "Something in a city model of another producer has no place in what is written.",
       "The message says what and how many; the original file still has it.", 0},
      {"write-flatgeobuf", "GDAL could not make a FlatGeobuf.",
       "The message has GDAL's words; its FlatGeobuf driver and PROJ's data must be installed, and there must be "
       "memory.",
       3},
      {"write-attribute-missing",
       "A name in the list of --attributes is that of no attribute of the buildings written.",
       "Compare the name with those of 'mansard options --attributes'. Some attributes need a scan or points, and "
       "models "
       "of other producers have none.",
       0},
      {"write-postgis", "A PostGIS database could not be written; nothing in it has changed.",
       "The message has GDAL's words. The address is that of GDAL (PG:dbname=NAME host=HOST user=USER), PostGIS must "
       "be "
       "enabled in the database, and a table mansard_buildings of others must have another name or schema.",
       3},
      {"write-tiles-height",
       "The heights of a 3D Tiles tileset are not above the ellipsoid, so that it is too high or too low on a globe.",
       "Give the height of the geoid there with --tiles-height-offset (about 43 m in the Netherlands), or a CRS with "
       "heights, with PROJ's grids installed.",
       0},
      {"write-stl-size", "There are more triangles than the 4,294,967,295 that an STL can count.",
       "Run smaller areas (--bbox).", 2},
      {"write-geojson", "Footprints cannot be brought to longitude and latitude, which GeoJSON is in.",
       "Give the CRS that the coordinates are in with --ingest-crs; PROJ's data must be installed.", 3},
      {"write-las", "A point that was to be written has a coordinate that is not finite or too large.",
       "This is a bug: please report it with the input.", 70},
      {"write-geotiff", "GDAL could not make a GeoTIFF, or there is nothing to put into it.",
       "The message has GDAL's words; its GTiff driver and PROJ's data must be installed, and there must be memory.",
       3},
  };
}

}  // namespace mansard::formats
