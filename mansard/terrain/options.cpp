#include "mansard/terrain/terrain.hpp"

namespace mansard::terrain {

auto option_list(Options& o) -> base::OptionList {
  const std::string filter = "K. Zhang et al. (2003); the default of PDAL 2.5's filters.pmf";
  base::OptionList list("terrain");
  list.number("tolerance", o.tolerance, "m", {0.001, 100},
              "Maximum vertical distance of the terrain from the heights that it is made from.")
      .source("half of the vertical accuracy of common national terrain models from airborne lidar, 0.15 to 0.2 m")
      .number("margin", o.margin, "m", {0, 10000}, "Width of the terrain around the buildings.")
      .number("cell", o.cell, "m", {0.1, 100}, "Distance between the heights that the terrain is made from.")
      .number("depth", o.depth, "m", {0.1, 10000},
              "Depth of the bottom of a closed surface (STL) below its lowest point.")
      .number("object_width", o.object_width, "m", {1, 1000},
              "Maximum width of objects without footprint that are removed from the ground of a mesh.")
      .advanced(filter)
      .number("object_slope", o.object_slope, "", {0.01, 10},
              "Tangent of the slope above which the ground of a mesh is taken for the side of an object.")
      .advanced("removes parked cars, 1.5 m high and 2 m wide; even slopes of any steepness are kept by the filter")
      .number("object_height", o.object_height, "m", {0, 10},
              "Minimum height of objects that are removed from the ground of a mesh.")
      .advanced(filter)
      .number("object_step", o.object_step, "m", {0.1, 100},
              "Height above which everything that rises from the ground of a mesh is removed.")
      .advanced(filter)
      .number("beside", o.beside, "m", {0, 20}, "Distance around footprints within which a mesh shows no ground.")
      .advanced("walls of photogrammetric meshes are inclined by about that much at their foot");
  return list;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"terrain-no-ground", "No height of the ground is known around the buildings.",
       "Give a terrain model that covers the buildings with --dtm, or a mesh that shows the ground.", 3},
      {"terrain-filled", "Part of the terrain has no heights and is continued from around.",
       "Use a terrain model that covers the buildings and terrain.margin around them, or lower terrain.margin.", 0},
      {"terrain-overlap",
       "The ground of a building overlaps that of another one, so that the terrain does not meet it.",
       "Repair the footprints; the building is above the terrain that the others have.", 0},
      {"terrain-extent", "The terrain would be wider than 53 km.", "Run smaller areas with --bbox.", 4},
      {"terrain-join", "The terrain does not have the outlines of all buildings as edges.",
       "This is a bug; please report it with the data.", 70},
      {"terrain-simplified", "Some buildings have flat roofs in the closed surface, or are one prism.",
       "Nothing, where that is detailed enough; the message says what was wrong with its union.", 0},
      {"terrain-closed", "The closed surface of terrain and buildings has open edges or intersects itself.",
       "Raise terrain.tolerance, or leave out the STL; the message says where.", 1},
      {"terrain-format", "The terrain cannot be written in a format.",
       "Use .city.json, .city.jsonl, .glb, .obj, .3dtiles or .stl.", 2},
  };
}

}  // namespace mansard::terrain
