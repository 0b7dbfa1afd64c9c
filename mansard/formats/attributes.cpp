#include "mansard/formats/attributes.hpp"

namespace mansard::formats {

auto attributes() -> std::vector<Attribute> {
  return {
      {"+ms_plan",
       "write",
       {"BuildingPart"},
       "object",
       "",
       "The plan of the part as in a plans.json, with the origin that its coordinates are relative to."},
      {"+ms_footprint",
       "write",
       {"Building"},
       "object",
       "",
       "The polygons of the footprint as they were read and the z of the ground, with the origin that they are "
       "relative to."},
      {"+ms_solid_of",
       "write",
       {"BuildingPart"},
       "array",
       "",
       "The parts that the solid of this object contains, where it is not this part alone."},
      {"ms_party_wall", "write", {"WallSurface"}, "boolean", "", "Whether another solid is adjacent to the wall."},
      {"ms_slope", "write", {"RoofSurface"}, "number", "°", "Angle from the horizontal."},
      {"ms_azimuth",
       "write",
       {"RoofSurface"},
       "number",
       "°",
       "Where the surface looks, clockwise from north; absent below a slope of 0.5°."},
  };
}

}  // namespace mansard::formats
