#include "mansard/report/attributes.hpp"

namespace mansard::report {

auto attributes() -> std::vector<formats::Attribute> {
  using Objects = std::vector<std::string>;
  const Objects both{"Building", "BuildingPart"}, building{"Building"}, part{"BuildingPart"};
  auto all = formats::attributes();
  const auto add = [&all](const char* name, const Objects& of, const char* type, const char* unit,
                          const char* meaning) {
    all.push_back({name, "pipeline", of, type, unit, meaning});
  };
  add("ms_outcome", building, "string", "",
      "full: every part was extruded along its full profiles; fallback: some part is simpler; covered: its ground is "
      "part of its neighbours' models; refused: the footprint cannot be used.");
  add("ms_h_ground", both, "number", "m", "z of the ground; of a building where it has parts.");
  add("ms_h_roof_min", part, "number", "m",
      "z of the roof's lowest sample on a grid of pipeline.roof_grid; without a mesh, of its lowest corner.");
  add("ms_h_roof_50p", part, "number", "m", "z below which half of the roof's samples lie; only with a mesh.");
  add("ms_h_roof_70p", part, "number", "m", "z below which 70 % of the roof's samples lie; only with a mesh.");
  add("ms_h_roof_max", both, "number", "m", "z of the roof's highest corner; of a building where it has parts.");
  add("ms_h_ridge", part, "number", "m", "z of the highest corner of a pitched face; absent where there is none.");
  add("ms_roof_type", part, "string", "",
      "slanted: more than 5 % of the roof's area is steeper than 5°; multiple horizontal: levels more than 0.5 m "
      "apart; "
      "horizontal.");
  add("ms_roof_shape", part, "string", "", "The shape that was made; only of models without a mesh.");
  add("ms_height_from", part, "string", "",
      "What gave the height: height, levels, assumed or profile; only of models without a mesh.");
  add("ms_volume_lod22", both, "number", "m³",
      "Volume of the LoD 2.2 solid; of a building over its parts, where it has some.");
  add("ms_rmse_lod22", both, "number", "m",
      "Root mean square of the vertical distance to the mesh; absent without mesh coverage.");
  add("ms_area_left_out", building, "number", "m²",
      "Area of the footprint that is high enough for a building and has no model; absent up to 1 m².");
  all.push_back(
      {"ms_texture_known", "texture", building, "number", "",
       "Share of the area of roofs and outer walls whose colour the scan shows, 0 to 1; only with textures."});
  add("ms_area_roof_flat", part, "number", "m²", "Area of roof that is level within 5°.");
  add("ms_area_roof_sloped", part, "number", "m²", "Area of the other roof.");
  add("ms_area_wall", part, "number", "m²", "Area of walls in the open.");
  add("ms_area_party_wall", part, "number", "m²", "Area of walls against another solid.");
  add("ms_fallback", part, "string?", "",
      "The code of the first reason why the part is simpler than its profiles; null where it is not.");
  add("ms_refined", part, "string", "",
      "What measured error changed of the part's plan, in words; absent where nothing was.");
  add("ms_block", part, "string", "", "The block; only with a mesh.");
  add("ms_opt_status", part, "string", "",
      "How the block's integer program ended: optimal, stopped, empty or failed; only with a mesh.");
  add("ms_opt_gap", part, "number", "", "What of the block's objective is not proven, in its units; only with a mesh.");
  const auto derived = [&all](const char* name, const char* type, const char* unit, const char* meaning) {
    all.push_back({name, "derive", {"Building"}, type, unit, meaning});
  };
  derived("ms_derived", "boolean", "",
          "true: the footprint was drawn from the mesh, by no surveyor; absent from buildings with a footprint that "
          "was given.");
  derived("ms_derived_height", "number", "m", "Median height of the mesh above the ground over a derived footprint.");
  derived("ms_derived_planes", "number", "",
          "Share of a derived footprint's roof that lies in planes, 0 to 1: below 0.4 look whether it is a building.");
  return all;
}

}  // namespace mansard::report
