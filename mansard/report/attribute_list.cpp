#include "mansard/report/attributes.hpp"
#include "mansard/report/measures.hpp"

namespace mansard::report {

auto attributes() -> std::vector<formats::Attribute> {
  using Objects = std::vector<std::string>;
  const Objects both{"Building", "BuildingPart"}, building{"Building"}, part{"BuildingPart"};
  auto all = formats::attributes();
  const auto add = [&all](const char* name, const Objects& of, const char* type, const char* unit,
                          const std::string& meaning) {
    all.push_back({name, "pipeline", of, type, unit, meaning});
  };
  add("ms_outcome", building, "string", "",
      "full: every part was extruded along its full profiles; fallback: some part is simpler; covered: its ground is "
      "part of its neighbours' models; refused: the footprint cannot be used, or the scan does not cover it.");
  add("ms_kept_from", building, "string", "",
      "The earlier run whose model it is, since nothing has changed there; only with --since.");
  add("ms_success", building, "boolean", "", "Whether the building has a model.");
  add("ms_quality", building, "string", "",
      "How likely the model is right: high (ms_confidence of 0.85 or more, and no check failed), medium (0.5 or more), "
      "low; unknown: it was made without a scan, or edited since; none: it has no model.");
  add("ms_checks", building, "string", "",
      "no check failed, or those that did: outcome (some part is simpler than its profiles), validity (of a level of "
      "detail), coverage (the scan covers less than half of the footprint), ground (nothing shows it).");
  add("ms_confidence", building, "number", "",
      "Probability that the model is right, 0 to 1: a mean squared vertical error of 0.5 m² or less, 0.3 m inside the "
      "outline, against what is really there; only with a scan.");
  add("ms_error", building, "number", "m",
      "Root mean square vertical error to expect against what is really there, 0.3 m inside the outline; only with a "
      "scan.");
  add("ms_reasons", building, "string", "",
      "Why the building has no model, a simpler one, or one that is less sure, the main reason first; absent where "
      "there "
      "is nothing to say.");
  add("ms_source", building, "string", "", "The scan, as pipeline.survey_source names it; absent where that is empty.");
  add("ms_source_date", building, "string", "",
      "The date of the scan, as pipeline.survey_date gives it; absent where that is empty.");
  add("ms_nodata_share", building, "number", "",
      "Share of the footprint without a surface of the mesh or below the crown of a tree, 0 to 1; only with a mesh.");
  add("ms_nodata_radius", building, "number", "m",
      "Radius of the largest circle in the footprint without such a surface; only with a mesh.");
  add("ms_point_density", building, "number", "1/m²",
      "Points of the point clouds over the footprint per square metre of it, without noise and points that are "
      "withheld; "
      "counted in cells of 1 m; only with point clouds and footprints that were given.");
  add("ms_h_ground", both, "number", "m",
      "z of the base: the lowest of the terrain at the walls, where terrain or scan shows it; of a building where it "
      "has "
      "parts.");
  const char* at_walls = "only where ms_ground_source is terrain or scan and the terrain at the walls can be seen.";
  add("ms_h_ground_mean", building, "number", "m",
      std::string("z of the terrain at the walls, mean by length; ") + at_walls);
  add("ms_h_ground_max", building, "number", "m", std::string("z of the highest terrain at the walls; ") + at_walls);
  add("ms_ground_source", building, "string", "",
      "What the height of the ground comes from: attribute, terrain (a terrain model or ground points), scan (level "
      "surface around the building), neighbours (around its block), option, outline (z of the footprint), lowest (the "
      "lowest surface beside it, which may be too high) or assumed (a storey below the lowest roof).");
  const Objects with_roof{"Building", "BuildingPart", "RoofSurface"};
  add("ms_h_roof_min", with_roof, "number", "m",
      "z of the lowest corner of the roof; of a part made with a mesh, of its lowest sample on a grid of "
      "pipeline.roof_grid.");
  add("ms_h_roof_50p", with_roof, "number", "m",
      "z below which half of the roof's area lies; of a part, of its samples, only with a mesh.");
  add("ms_h_roof_70p", with_roof, "number", "m",
      "z below which 70 % of the roof's area lies; of a part, of its samples, only with a mesh.");
  add("ms_h_roof_max", with_roof, "number", "m", "z of the roof's highest corner; of a building where it has parts.");
  add("ms_h_eave", building, "number", "m",
      "z below which half of the length of the eaves and of the edges of flat roofs lies; absent where there are "
      "none.");
  add("ms_h_ridge", both, "number", "m", "z of the highest corner of a pitched face; absent where there is none.");
  add("ms_roof_type", both, "string", "",
      "slanted: more than 5 % of the roof's area is steeper than 5°; multiple horizontal: levels more than 0.5 m "
      "apart; "
      "horizontal.");
  add("ms_source_id", part, "string", "",
      "The id of the source's building:part that it is; only of models without a mesh.");
  add("ms_area_uncovered", building, "number", "m²",
      "Area of the outline that its building:parts leave without a model; only where it has such, of models without a "
      "mesh.");
  add("ms_wall_colour", part, "string", "", "Colour of the walls as #rrggbb, by building:colour or building:material.");
  add("ms_roof_colour", part, "string", "", "Colour of the roof as #rrggbb, by roof:colour or roof:material.");
  add("ms_wall_material", part, "string", "", "What the walls are made of, as building:material says it.");
  add("ms_roof_material", part, "string", "", "What the roof is made of, as roof:material says it.");
  add("ms_roof_shape", part, "string", "", "The shape that was made; only of models without a mesh.");
  add("ms_height_from", part, "string", "",
      "What gave the height: height, levels, assumed or profile; only of models without a mesh.");
  add("ms_roof_planes", building, "number", "", "Number of roof surfaces of LoD 2.2.");
  add("ms_ridges", building, "number", "",
      "Number of ridges of LoD 2.2, inclined by up to 5°; those that go straight on are one.");
  add("ms_parts", building, "number", "", "Number of parts.");
  add("ms_storeys", building, "number", "",
      "Estimate of the storeys above ground: the height of the roof that 70 % of it is below, in storeys of "
      "roof.level_height.");
  add("measuredHeight", building, "number", "m",
      "As in CityGML: from the ground to the highest corner; the source's own where it has one.");
  add("roofType", building, "string", "",
      "As in CityGML, by the code list of the SIG 3D: 1000 flat, 1010 monopitch, 1030 gabled, 1040 hipped, 1130 a "
      "combination; the source's own where it has one.");
  add("storeysAboveGround", building, "number", "",
      "As in CityGML: ms_storeys, an estimate; the source's own where it has one.");
  for (const auto lod : {formats::Lod::lod12, formats::Lod::lod13, formats::Lod::lod20}) {
    const std::string level(formats::name_of(lod));
    add(level_names(lod).volume, building, "number", "m³",
        "Volume of LoD " + level + "; absent where it has no valid solid.");
    add(level_names(lod).rmse, building, "number", "m",
        "Root mean square of the vertical distance of LoD " + level +
            " to the mesh, measured as ms_rmse_lod22; absent without mesh coverage.");
  }
  for (const auto& names : level_names()) {
    const std::string level(formats::name_of(names.lod));
    add(names.surface, building, "number", "m²", "Area of all surfaces of LoD " + level + ".");
    add(names.val3dity, building, "string", "",
        "The codes of val3dity that the check of LoD " + level + " found; [] is valid.");
  }
  add("ms_volume_lod22", both, "number", "m³",
      "Volume of the LoD 2.2 solid; of a building over its parts, where it has some.");
  add("ms_rmse_lod22", both, "number", "m",
      "Root mean square of the vertical distance to the mesh over the roof, without what is within evaluate.inset of a "
      "wall; absent without mesh coverage.");
  add("ms_area_left_out", building, "number", "m²",
      "Area of the footprint that is high enough for a building and has no model; absent up to 1 m².");
  all.push_back(
      {"ms_texture_known", "texture", building, "number", "",
       "Share of the area of roofs and outer walls whose colour the scan shows, 0 to 1; only with textures."});
  const auto error = [&](const char* name, const char* unit, const std::string& of) {
    add(name, building, "number", unit,
        "Standard error of " + of + "; absent where the scan does not show what it rests on, and of edited models.");
  };
  error("ms_h_ground_se", "m", "ms_h_ground");
  error("ms_h_roof_min_se", "m", "ms_h_roof_min");
  error("ms_h_roof_50p_se", "m", "ms_h_roof_50p");
  error("ms_h_roof_70p_se", "m", "ms_h_roof_70p");
  error("ms_h_roof_max_se", "m", "ms_h_roof_max");
  error("ms_h_eave_se", "m", "ms_h_eave");
  error("ms_h_ridge_se", "m", "ms_h_ridge");
  error("ms_volume_lod22_se", "m³", "ms_volume_lod22");
  error("ms_area_ground_se", "m²", "ms_area_ground");
  error("ms_area_wall_se", "m²", "ms_area_wall");
  error("ms_area_party_wall_se", "m²", "ms_area_party_wall");
  add("ms_area_footprint", building, "number", "m²", "Area of the footprint as it was read.");
  add("ms_area_ground", building, "number", "m²", "Area of the ground of the model.");
  add("ms_area_roof_flat", both, "number", "m²", "Area of roof that is level within 5°.");
  add("ms_area_roof_sloped", both, "number", "m²", "Area of the other roof.");
  add("ms_area_wall", both, "number", "m²",
      "Area of walls in the open; of a building, without the walls between its parts.");
  add("ms_area_party_wall", both, "number", "m²",
      "Area of walls against another solid; of a building, against other buildings.");
  add("ms_fallback", part, "string?", "",
      "The code of the first reason why the part is simpler than its profiles; null where it is not.");
  add("ms_refined", part, "string", "",
      "What measured error changed of the part's plan, in words, with sizes, errors and costs; absent where nothing "
      "was.");
  add("ms_overhang", both, "number", "m",
      "Mean overhang of the eaves that overhang, by length; only with profile.overhangs, absent where none were seen.");
  add("ms_overhang_share", both, "number", "",
      "Share of the length of the eaves that overhangs, 0 to 1; only with ms_overhang.");
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
