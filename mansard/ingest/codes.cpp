#include "mansard/formats/drivers.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/ingest/join.hpp"

namespace mansard::ingest {

namespace {

auto own_codes() -> std::vector<base::Code> {
  return {
      {"ingest-mesh-empty", "A mesh file is empty, or a folder holds no meshes.",
       "Check the path. A mesh is a tileset.json, or a file with the extension " +
           formats::extensions_in_words(&formats::Reads::mesh) + ".",
       3},
      {"ingest-outside",
       "An input refers to a file outside its folder, or from a disk to a server. A file that somebody sent could so "
       "show other files of this machine, or make the program call out.",
       "Copy what it refers to into the folder, give that itself as the input, or set the environment variable "
       "MANSARD_OUTSIDE=yes if the file is to be trusted.",
       3},
      {"ingest-mesh-format", "A mesh file is not in its format, or uses a part of it that is not read.",
       "Export it again as one of " + formats::titles(&formats::Reads::mesh) + ".", 3},
      {"ingest-mesh-metadata", "The metadata.xml beside a mesh does not say clearly where it is.",
       "Correct its SRS and SRSOrigin; --crs local or --mesh-offset take the mesh without it.", 3},
      {"ingest-tile-skipped", "Tiles of a tileset hold points, instances or vectors, of which no surface is read.",
       "Nothing to do, unless the mesh lacks something.", 0},
      {"ingest-mesh-truncated", "A mesh file ends before what its header promises.", "Copy or export it again.", 3},
      {"ingest-mesh-unusable", "A mesh has no triangle that can be used.",
       "Give a surface rather than points; look for NaN coordinates.", 3},
      {"ingest-points-format", "A point cloud is damaged, or is not in its format.",
       "Copy or export it again; the message says what is wrong.", 3},
      {"ingest-points-truncated", "A point cloud ends before the points that its header counts.",
       "Copy or export it again.", 3},
      {"ingest-points-unsupported", "A point cloud uses a version or a part of its format that is not read.",
       "Convert it to LAS 1.4 or LAZ with point formats 0 to 3 or 6 to 10.", 3},
      {"ingest-points-empty", "Point clouds have no points that can be used, or none in the box asked for.",
       "Check --bbox, --crs and the classes of the points.", 3},
      {"ingest-points-records", "Records in the header of a point cloud are damaged and were left out.",
       "Nothing to do, unless the cloud is in the wrong place: --crs and --mesh-offset.", 0},
      {"ingest-points-index", "The octree of a COPC file is damaged; its points were read without it.",
       "Write the file again if only parts of it are to be read.", 0},
      {"ingest-points-crs", "The record of a point cloud's CRS is not valid, and is not used.",
       "Say --crs EPSG:n for the working CRS, and give points that are in it.", 0},
      {"ingest-points-classes", "A point cloud has classes that the LAS specification reserves or leaves to users.",
       "Ask the cloud's producer what they mean, and name them with --cloud-building-classes, --cloud-ground-classes "
       "or --cloud-left-out-classes.",
       0},
      {"scan-classes",
       "Points of a class that is not used for buildings are most of what is over footprints, above the ground.",
       "Give the --cloud-building-classes of the message, if the class has roofs.", 0},
      {"ingest-points-twice",
       "Points are repeated in the point clouds: the same tile was given twice, deliveries overlap, or a file has "
       "points "
       "twice. A point that was measured once counts once.",
       "Nothing to do; leaving the repetitions out saves time.", 0},
      {"ingest-points-strips", "Flight strips of a point cloud differ in height where they overlap.",
       "Ask the cloud's producer for a strip adjustment if the difference matters; nothing is corrected.", 0},
      {"ingest-points-surface", "How a surface was made of point clouds.",
       "Nothing to do; the options of the group cloud change it.", 0},
      {"ingest-raster", "A raster has no heights that can be used, has no georeference, or is in another place.",
       "Give a surface or terrain model in metres or feet; 'gdalinfo FILE' shows what GDAL says.", 3},
      {"ingest-ground-tiles",
       "The tiles of a basemap cannot be used: what was given is not the address or folder of tiles, the server does "
       "not "
       "answer or refuses, there are none at the place of the models, or what was sent is not a picture.",
       "Open the address of a tile in a browser; check {z}, {x} and {y}, the key, the network and the proxy "
       "(GDAL_HTTP_PROXY).",
       3},
      {"ingest-memory", "A mesh does not fit into memory.", "Cut it into tiles, or use --bbox and a smaller one.", 3},
      {"ingest-footprints-format", "The footprints are not a vector file that GDAL reads, or it is damaged.",
       "Check the path, which comes last; 'ogrinfo FILE' shows what GDAL says.", 3},
      {"ingest-footprints-none", "The vector file has no features, or the filters leave none.",
       "Check the layer, --ingest-where and --bbox.", 3},
      {"ingest-footprints-geometry", "No feature of the layer is a polygon.",
       "Give footprints as polygons, or choose another layer.", 3},
      {"ingest-crs-unknown",
       "The CRS of the footprints or of the mesh is unknown, or there is no transformation from it to metres.",
       "Reproject them, or say --crs.", 3},
      {"ingest-crs-unit", "The CRS of the footprints is projected, but not in metres.",
       "Say --crs EPSG:n with a metric CRS, and bring the mesh there.", 3},
      {"ingest-no-overlap", "Mesh and footprints are in different places.",
       "Check --mesh-offset, --crs and the up axis; the message gives the extent of each.", 3},
      {"ingest-crs-option", "The CRS asked for is not known, or not a projected one in metres.",
       "Write EPSG:n with a projected CRS in metres, or local.", 4},
      {"ingest-layer", "The layer asked for does not exist.", "The message lists those that do.", 4},
      {"ingest-where", "The attribute filter is not understood.", "Write it as in SQL after WHERE: \"height > 3\".", 4},
      {"ingest-id-attribute", "The attribute asked for as id does not exist.", "The message lists those that do.", 4},
      {"ingest-bbox", "The box is upside down: its first corner is not the lower left one.",
       "Write xmin ymin xmax ymax.", 4},
      {"ingest-footprint-crossing", "A footprint's outline crosses itself, so its inside is not known.",
       "Correct it in the source; this building is left out.", 1},
      {"ingest-footprint-holes", "A footprint's holes cross, overlap or lie outside it.",
       "Correct it in the source; this building is left out.", 1},
      {"ingest-footprint-area", "A footprint has no area.", "Remove or redraw it; this building is left out.", 1},
      {"ingest-footprint-empty", "A feature has no geometry.", "Remove or draw it; this building is left out.", 1},
      {"ingest-footprint-unreadable", "A feature is damaged in its file.",
       "Correct it in the source; this building is left out.", 1},
      {"ingest-footprint-type", "A feature is a point, a line or a solid rather than a polygon.",
       "Convert it to a polygon; this building is left out.", 1},
      {"ingest-footprint-coordinates", "A footprint has a coordinate that is not a number, or cannot be projected.",
       "Correct it in the source; this building is left out.", 1},
      {"ingest-footprint-size", "A footprint is kilometres long, as a wrong CRS or a district's outline makes it.",
       "Check its coordinates and the CRS; this building is left out.", 1},
      {"ingest-footprint-outside", "A footprint is in an area without mesh coverage.",
       "Give the mesh there, or cut the footprints with --bbox; this building is left out.", 1},
      {"ingest-footprint-repaired", "A footprint had a small fault that was repaired.",
       "Nothing to do; the message says what was changed.", 0},
      {"ingest-mesh-not-finite", "Triangles had NaN, infinite or absurdly far corners and were left out.",
       "Nothing to do, unless there are many.", 0},
      {"ingest-mesh-level", "A file of a finer level of detail of the mesh is missing.",
       "Copy the whole folder of the mesh; until then, the coarser level is used there.", 0},
      {"ingest-mesh-precision", "A mesh is far from its origin, and its format or reader has single precision.",
       "Export it with an origin near the mesh, and give that as --mesh-offset.", 0},
      {"ingest-mesh-index", "Triangles named vertices that do not exist and were left out.",
       "Export the mesh again if there are many.", 0},
      {"ingest-mesh-degenerate", "Triangles without area were left out.", "Nothing to do.", 0},
      {"ingest-mesh-duplicate", "Triangles that repeat another one were left out.", "Nothing to do.", 0},
      {"ingest-mesh-non-manifold", "Edges have more than two triangles.", "Nothing to do.", 0},
      {"ingest-mesh-flipped", "Neighbouring triangles disagree about the outside.",
       "Orient the mesh if walls come out wrong.", 0},
      {"ingest-mesh-no-faces", "One of several mesh files has no faces.", "Check whether it should.", 0},
      {"ingest-crs-local", "The footprints have no CRS, so none is written.",
       "Say --crs EPSG:n if it is known; --crs local if there is none.", 0},
      {"ingest-crs-scale", "Lengths in the working CRS are not those on the ground, as in the Mercator of web maps.",
       "Say --crs EPSG:n with a system made for the place: the UTM zone, or the country's own.", 0},
      {"ingest-layers", "The vector file has several layers, of which one was read.", "--ingest-layer chooses.", 0},
      {"ingest-model-format", "A building model is neither CityJSON nor OBJ, or it is damaged.",
       "Give CityJSON 1.0 to 2.0, CityJSONSeq, or OBJ; export the model again.", 3},
      {"ingest-model-empty", "A model has no building with a surface.",
       "Check what is in it: buildings and their parts with surfaces or solids are read.", 3},
      {"ingest-model-crs", "The CRS of a model is not known, not in metres, or another one than the rest is in.",
       "Convert the model; --crs local takes all coordinates as they are.", 3},
      {"ingest-model-overlap", "A model and what it is compared with do not overlap.",
       "Check --mesh-offset, the CRS and the heights; the message gives the extent of each.", 3},
      {"ingest-model-lod", "No building of the model has the LoD asked for.", "The message lists those there are.", 4},
      {"ingest-model-lods", "The highest LoD differs between the objects of a model.", "--lod reads one of them.", 0},
      {"ingest-model-left-out", "Something in a model is no surface of a building, and was not read.",
       "Nothing to do; the message says what it was.", 0},
      {"ingest-model-face", "Faces of a model had no area, or could not be cut into triangles, and were left out.",
       "Nothing to do, unless there are many.", 0},
      {"ingest-model-semantics", "Surfaces of a model do not say what they are; their direction told.",
       "Nothing to do; add semantics if classes come out wrong.", 0},
      {"ingest-raster-bands", "A raster has several bands, of which the first was read.",
       "Nothing to do, unless the heights are in another one; gdal_translate -b chooses.", 0},
      {"ingest-attribute-range", "Integer attributes are at the limit of 64 bits, where GDAL puts larger ones.",
       "Write integers beyond 2^63 as strings in the source.", 0},
      {"ingest-id-duplicate",
       "Features lack an id, or share one. Ids stay as given: a feature with the id of an earlier one gets ~2, ~3 … "
       "appended.",
       "Choose another attribute with --ingest-id-attribute.", 0},
  };
}

}  // namespace

auto codes() -> std::vector<base::Code> {
  auto all = own_codes();
  for (auto& code : join_codes()) all.push_back(std::move(code));
  return all;
}

}  // namespace mansard::ingest
