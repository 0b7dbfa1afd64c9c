// Every module's options in one place, and the presets.
#include <algorithm>
#include <array>

#include "mansard/base/files.hpp"
#include "mansard/formats/codes.hpp"
#include "mansard/picture/picture.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solver/solver.hpp"
#include "mansard/texture/texture.hpp"

namespace mansard::pipeline {

auto option_lists(Options& options) -> std::vector<base::OptionList> {
  std::vector<base::OptionList> lists;
  lists.push_back(ingest::option_list(options.ingest));
  lists.push_back(cloud::option_list(options.ingest.cloud));
  lists.push_back(derive::option_list(options.derive));
  lists.push_back(block::option_list(options.block));
  lists.push_back(accuracy::option_list(options.accuracy));
  lists.push_back(vegetation::option_list(options.vegetation));
  lists.push_back(slice::option_list(options.slice));
  lists.push_back(sweep::option_list(options.sweep));
  lists.push_back(fracture::option_list(options.fracture));
  lists.push_back(segment::option_list(options.segment));
  lists.push_back(profile::option_list(options.profile));
  lists.push_back(extrude::option_list(options.extrude));
  lists.push_back(refine::option_list(options.refine));
  lists.push_back(roof::option_list(options.roof));
  lists.push_back(label::option_list(options.label));
  lists.push_back(evaluate::option_list(options.evaluate));
  lists.push_back(solid::option_list(options.write.levels));
  lists.push_back(formats::option_list(options.write));
  lists.push_back(texture::option_list(options.texture));
  lists.push_back(terrain::option_list(options.terrain));
  base::OptionList own("pipeline");
  own.integer("seed", options.seed, "", {0, 9e15}, "Seed of all sampling; the same seed gives the same bytes.")
      .alias("seed")
      .number("assumed_height", options.assumed_height, "m", {0.5, 100},
              "Height of the prism of a footprint without mesh coverage.")
      .number("roof_grid", options.roof_grid, "m", {0.05, 5},
              "Sample spacing of the roof heights among the attributes.")
      .string("survey_source", options.survey_source, "Name of the scan, for the attribute ms_source of buildings.")
      .alias("survey-source")
      .string("survey_date", options.survey_date,
              "Date of the scan as YYYY, YYYY-MM or YYYY-MM-DD, for the attribute ms_source_date of buildings.")
      .alias("survey-date");
  lists.push_back(std::move(own));
  return lists;
}

auto presets() -> const std::vector<Preset>& {
  // pipeline.md has the table. The reference's weights are per half-edge, ours per edge: twice as much. Its γ sums line
  // lengths at 0.5 m, so 30 there is 15 m² of mesh.
  static const std::vector<Preset> all{
      {"paper",
       "The numbers Kelly and Mitra publish.",
       {{"vegetation.mask", "false"},
        {"slice.interval", "0.2"},
        {"sweep.gamma", "10"},
        {"sweep.cluster_step", "1.5"},
        {"sweep.gis_offset", "0"},
        {"sweep.step_height", "0"},
        {"fracture.continuation", "2"},
        {"segment.alpha", "40"},
        {"segment.beta", "60"},
        {"segment.height_weight", "1"},
        {"segment.phi", "0.5"},
        {"segment.thin_distance", "2"},
        {"segment.thin_angle", "0.5235987755982988"},
        {"segment.continuations", "plain"},
        {"segment.thin_rule", "any"},
        {"segment.thin_reach", "block"},
        {"segment.gis_edges", "ignore"},
        {"segment.narrow", "0"},
        {"profile.quality", "high"},
        {"refine.effort", "caps"}}},
      {"chordatlas",
       "What the reference implementation runs.",
       {{"vegetation.mask", "false"},
        {"slice.interval", "0.5"},
        {"sweep.gamma", "15"},
        {"sweep.cluster_step", "1.5"},
        {"sweep.gis_offset", "0"},
        {"sweep.step_height", "0"},
        {"fracture.continuation", "2"},
        {"segment.alpha", "80"},
        {"segment.beta", "40"},
        {"segment.height_weight", "8"},
        {"segment.phi", "1"},
        {"segment.thin_distance", "0.3"},
        {"segment.thin_angle", "0.5"},
        {"segment.continuations", "plain"},
        {"segment.thin_rule", "unsupported"},
        {"segment.gis_edges", "ignore"},
        {"segment.narrow", "0"},
        {"segment.gis_ratio", "0.44"},
        {"segment.min_height", "4"},
        {"segment.exposed", "0.4"},
        {"profile.quality", "high"},
        {"refine.effort", "caps"}}},
  };
  return all;
}

namespace {

/// An option of earlier versions, and which one to use now; none for those without which models are as good.
struct Removed {
  std::string_view name, now;
};
/// docs/decisions/0104 has the measurements.
constexpr std::array removed{
    Removed{"block.gap_area", ""},
    Removed{"extrude.eaves_min_soffit", ""},
    Removed{"extrude.eaves_mitre", ""},
    Removed{"extrude.lines_min_stretch", ""},
    Removed{"fracture.settle_steps", ""},
    Removed{"fracture.settle_steps_per_crossing", ""},
    Removed{"label.party_strip", ""},
    Removed{"profile.assumed_storey", "pipeline.assumed_height"},
    Removed{"profile.cap_high", ""},
    Removed{"profile.cap_top_share", ""},
    Removed{"profile.low_tolerance", ""},
    Removed{"profile.minimum_gutter", "profile.minimum_height"},
    Removed{"profile.setback_height", ""},
    Removed{"profile.sky_margin", ""},
    Removed{"profile.step", ""},
    Removed{"refine.cuts_max_count", ""},
    Removed{"refine.cuts_max_directions", ""},
    Removed{"refine.cuts_min_rise", ""},
    Removed{"refine.cuts_plane_share", ""},
    Removed{"refine.cuts_rise_reach", ""},
    Removed{"refine.cuts_smooth_by_height", ""},
    Removed{"refine.forms_cap_clearance", "profile.cap_clear"},
    Removed{"refine.forms_cap_distinct", ""},
    Removed{"refine.forms_cap_percentile", "profile.cap_ridge"},
    Removed{"refine.joins_max_pieces", ""},
    Removed{"refine.joins_recut_step", "refine.cuts_min_step"},
    Removed{"refine.joins_round_gain", ""},
    Removed{"refine.joins_rounds", ""},
    Removed{"refine.joins_shared_faces", ""},
    Removed{"refine.joins_touching", ""},
    Removed{"refine.mansard_min_split", "refine.mansard_min_depth"},
    Removed{"refine.outlines_max_slope", "refine.surfaces_max_slope"},
    Removed{"refine.outlines_reach", "refine.samples_melt"},
    Removed{"refine.outlines_trim_length", "refine.samples_melt"},
    Removed{"refine.pieces_aside", "refine.pieces_slit"},
    Removed{"refine.refit_max_slope", "refine.forms_max_slope"},
    Removed{"refine.regions_gap_cells", ""},
    Removed{"refine.regions_max_levels", ""},
    Removed{"refine.regions_max_residual", ""},
    Removed{"refine.regions_rim_cells", ""},
    Removed{"refine.samples_level_band", "profile.cap_level"},
    Removed{"refine.samples_max_cells", ""},
    Removed{"refine.search_hopeless", ""},
    Removed{"refine.search_min_difference", ""},
    Removed{"refine.setback_min_depth", "refine.mansard_min_depth"},
    Removed{"refine.setback_tower_reach", ""},
    Removed{"refine.setback_tower_share", ""},
    Removed{"refine.sharpen_flat_slope", ""},
    Removed{"refine.splits_max_count", ""},
    Removed{"refine.splits_rows_per_bin", ""},
    Removed{"refine.surfaces_bin", ""},
    Removed{"refine.surfaces_plane_rounds", ""},
    Removed{"refine.tall_spacing", ""},
    Removed{"refine.wings_min_length", ""},
    Removed{"segment.edge_cover", ""},
    Removed{"segment.height_spacing", ""},
    Removed{"segment.minimum_inside_samples", ""},
    Removed{"segment.opening", ""},
    Removed{"segment.same_height", ""},
    Removed{"segment.search_passes", ""},
    Removed{"segment.search_piece", ""},
    Removed{"segment.search_sequence", ""},
    Removed{"segment.thin_overlap", ""},
    Removed{"slice.maximum_height", ""},
    Removed{"sweep.height_percentile", ""},
    Removed{"sweep.line_maximum_segment", ""},
    Removed{"sweep.setback_gap", "sweep.column_gap"},
    Removed{"sweep.step_grain_share", ""},
    Removed{"sweep.step_ground", "segment.min_height"},
    Removed{"sweep.step_rest", ""},
    Removed{"vegetation.overhang_within", "vegetation.overhang"},
};

}  // namespace

auto why_removed(std::string_view key) -> std::string {
  const auto found = std::ranges::find(removed, key, &Removed::name);
  if (found == removed.end()) return {};
  if (found->now.empty()) return "this option was removed, because models are as good without it; leave it out";
  return "this option was removed; use '" + std::string(found->now) + "'";
}

auto set_option(std::vector<base::OptionList>& lists, std::string_view key, std::string_view value)
    -> base::Result<void> {
  std::vector<std::string> known;
  for (const auto& list : lists)
    for (const auto& option : list.options()) {
      const std::string name = list.module() + "." + option.name;
      if (name == key) return option.set(value);
      known.push_back(name);
    }
  if (auto why = why_removed(key); !why.empty()) return base::error("option-unknown", std::move(why), std::string(key));
  const auto nearest = base::nearest_word(key, known);
  return base::error("option-unknown",
                     "there is no such option" + base::did_you_mean(nearest) + "; see 'mansard options'",
                     std::string(key));
}

auto codes() -> std::vector<base::Code> {
  std::vector<base::Code> all = base::codes();
  const auto add = [&all](std::vector<base::Code> more) { all.insert(all.end(), more.begin(), more.end()); };
  add(geometry::codes());
  add(solver::codes());
  add(ingest::codes());
  add(block::codes());
  add(vegetation::codes());
  add(derive::codes());
  add(fracture::codes());
  add(segment::codes());
  add(extrude::codes());
  add(solid::codes());
  add(roof::codes());
  add(formats::codes());
  add(texture::codes());
  add(terrain::codes());
  add(picture::codes());
  add({
      {"pipeline-nothing", "No footprint of the input could be used.",
       "The report lists the reason of each; repair the footprints.", 5},
      {"pipeline-footprints", "Footprints are missing, or both given and to be derived.",
       "Give footprints after the meshes, or --derive-footprints and meshes alone.", 2},
      {"pipeline-no-ground",
       "There is no mesh within block.ground_reach of the footprint's block, so its ground is unknown.",
       "Give the mesh there, or the ground's heights with --dtm.", 1},
      {"pipeline-no-mesh", "The mesh shows no surface over this footprint, so its height is assumed.",
       "Use a mesh that covers the footprint, or set pipeline.assumed_height.", 1},
      {"pipeline-low", "The mesh over this footprint is lower than segment.min_height above the ground.",
       "Lower segment.min_height if low buildings matter; the building is a prism of its median height.", 1},
      {"pipeline-outside", "No face of the fractured ground was given to this footprint.",
       "The footprint may be displaced against the mesh; it is written as a prism of its median height.", 1},
      {"pipeline-covered", "The ground of this footprint went to the models of its neighbours.",
       "Check whether the input repeats a building; segment.gis_edges = hard keeps features apart.", 1},
      {"pipeline-left-out", "Some of a footprint is high enough for a building and has no model.",
       "The message lists area and height of every piece. Blurred walls beside a roof are left out on purpose; if a "
       "piece is "
       "a building, lower segment.strip_share or segment.narrow.",
       0},
      {"pipeline-block", "The segmentation of a block failed, so its footprints became prisms.",
       "The message says why; please report it.", 1},
      {"pipeline-overhang", "Overhanging eaves of a plan could not be made, and the walls go up to the roof there.",
       "Look at the corner that is named: another face meets the eaves, or they would run into something. Set the "
       "edge's "
       "overhang to 0 to be rid of the message.",
       0},
      {"pipeline-overlap", "Two solids overlap.", "Look whether the input's footprints overlap, or repeat a building.",
       0},
      {"pipeline-cover-unchecked",
       "The outlines of its neighbours' parts could not be subtracted from a footprint without a part of its own.",
       "The footprint is modelled nevertheless; see whether its model overlaps another one (pipeline-overlap), and "
       "repair the footprints there.",
       0},
      {"pipeline-overlap-unchecked", "Whether two models share ground could not be computed.",
       "Look at the two models named; repair the outlines of their footprints.", 0},
      {"pipeline-evaluation-unchecked",
       "An outline of a model, the ground that two outlines share, or the union of footprints could not be computed.",
       "The scores count it as missing or not matched, or leave out more ground; repair that building or footprint.",
       0},
      {"pipeline-block-unknown", "A run of some blocks names an unknown block.",
       "Take a name from the report of a whole run, or of 'mansard segment'.", 4},
  });
  return all;
}

}  // namespace mansard::pipeline
