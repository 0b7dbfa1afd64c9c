// Every module's options in one place, and the presets.
#include <algorithm>
#include <array>

#include "mansard/base/files.hpp"
#include "mansard/formats/codes.hpp"
#include "mansard/picture/picture.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/pipeline/scan_checks.hpp"
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
      .number("assumed_height", options.assumed_height, "m", {0, 100},
              "Height of the prism of a footprint that the scan does not cover; 0 for none: the footprint is then "
              "written without a model.")
      .number("partly_seen", options.partly_seen, "", {0, 1},
              "Minimum share of a footprint without scan for the building to be reported as partly "
              "seen.")
      .choice("scan_checks", options.scan_checks,
              {{"stop", ScanChecks::stop}, {"warn", ScanChecks::warn}, {"off", ScanChecks::off}},
              "Whether the scan is checked against its footprints before the work begins: stop ends the run where "
              "nothing sensible can come out, warn never does.")
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
    Removed{"cloud.roughness", ""},
    Removed{"extrude.eaves_min_soffit", ""},
    Removed{"extrude.eaves_mitre", ""},
    Removed{"extrude.lines_min_stretch", ""},
    Removed{"fracture.settle_steps", ""},
    Removed{"fracture.settle_steps_per_crossing", ""},
    Removed{"label.party_strip", ""},
    Removed{"profile.assumed_storey", "pipeline.assumed_height"},
    Removed{"profile.cap_high", ""},
    Removed{"profile.cap_top_share", ""},
    Removed{"profile.climb_above_low", ""},
    Removed{"profile.corner", ""},
    Removed{"profile.far_wall", ""},
    Removed{"profile.far_wall_from", ""},
    Removed{"profile.hip_corner", ""},
    Removed{"profile.hip_corner_from", ""},
    Removed{"profile.low_height", ""},
    Removed{"profile.low_tolerance", ""},
    Removed{"profile.minimum_gutter", "profile.minimum_height"},
    Removed{"profile.overhang_melt", ""},
    Removed{"profile.pitch_gain", ""},
    Removed{"profile.pitch_price", ""},
    Removed{"profile.pitch_tolerance", ""},
    Removed{"profile.setback_blur", ""},
    Removed{"profile.setback_height", ""},
    Removed{"profile.sky_margin", ""},
    Removed{"profile.slice_margin", ""},
    Removed{"profile.step", ""},
    Removed{"profile.wall_low_weight", ""},
    Removed{"refine.alike_most_ground", "accuracy.blur"},
    Removed{"refine.bare_noise", "accuracy.noise"},
    Removed{"refine.cuts_askew_price", ""},
    Removed{"refine.cuts_crisp_rms", "refine.detail"},
    Removed{"refine.cuts_fair_area", "refine.detail"},
    Removed{"refine.cuts_fair_rms", "refine.detail"},
    Removed{"refine.cuts_hipped_min_area", "refine.detail"},
    Removed{"refine.cuts_large_area", ""},
    Removed{"refine.cuts_large_gain", ""},
    Removed{"refine.cuts_line_min_width", "accuracy.blur"},
    Removed{"refine.cuts_max_count", ""},
    Removed{"refine.cuts_max_directions", ""},
    Removed{"refine.cuts_min_rise", ""},
    Removed{"refine.cuts_min_step", "refine.detail"},
    Removed{"refine.cuts_min_width", "accuracy.blur"},
    Removed{"refine.cuts_new_direction", ""},
    Removed{"refine.cuts_plane_share", ""},
    Removed{"refine.cuts_rise_reach", ""},
    Removed{"refine.cuts_shape_price", ""},
    Removed{"refine.cuts_sliver_area", ""},
    Removed{"refine.cuts_sliver_width", ""},
    Removed{"refine.cuts_smooth_by_height", ""},
    Removed{"refine.cuts_smooth_rms", "refine.detail"},
    Removed{"refine.directions_other", ""},
    Removed{"refine.directions_second_share", ""},
    Removed{"refine.dormers_price", "refine.dormers"},
    Removed{"refine.face_price", "refine.significance"},
    Removed{"refine.forms_cap_clearance", "profile.cap_clear"},
    Removed{"refine.forms_cap_distinct", ""},
    Removed{"refine.forms_cap_percentile", "profile.cap_ridge"},
    Removed{"refine.joins_max_pieces", ""},
    Removed{"refine.joins_recut_step", "refine.detail"},
    Removed{"refine.joins_round_gain", ""},
    Removed{"refine.joins_rounds", ""},
    Removed{"refine.joins_shared_faces", ""},
    Removed{"refine.joins_touching", ""},
    Removed{"refine.lines_robust", "accuracy.noise"},
    Removed{"refine.mansard_min_depth", "accuracy.blur"},
    Removed{"refine.mansard_min_split", "accuracy.blur"},
    Removed{"refine.margin", "accuracy.blur"},
    Removed{"refine.moderate_factor", "refine.detail"},
    Removed{"refine.outlines_max_move", ""},
    Removed{"refine.outlines_max_rectangles", ""},
    Removed{"refine.outlines_max_slope", "refine.surfaces_max_slope"},
    Removed{"refine.outlines_min_addition", ""},
    Removed{"refine.outlines_min_contrast", ""},
    Removed{"refine.outlines_reach", "accuracy.blur"},
    Removed{"refine.outlines_row_share", ""},
    Removed{"refine.outlines_settle_rounds", ""},
    Removed{"refine.outlines_step_rounds", ""},
    Removed{"refine.outlines_trim_length", "accuracy.blur"},
    Removed{"refine.part_price", "refine.significance"},
    Removed{"refine.pieces_aside", "refine.pieces_slit"},
    Removed{"refine.refit_max_knot_move", ""},
    Removed{"refine.refit_max_slope", "refine.forms_max_slope"},
    Removed{"refine.refit_min_slope", ""},
    Removed{"refine.regions_agreement", ""},
    Removed{"refine.regions_bin", ""},
    Removed{"refine.regions_gap_cells", ""},
    Removed{"refine.regions_level_clearance", ""},
    Removed{"refine.regions_max_levels", ""},
    Removed{"refine.regions_max_residual", ""},
    Removed{"refine.regions_peak_share", ""},
    Removed{"refine.regions_rim_cells", ""},
    Removed{"refine.regions_valley", ""},
    Removed{"refine.samples_level_band", "profile.cap_level"},
    Removed{"refine.samples_margin_weight", "accuracy.blur"},
    Removed{"refine.samples_max_cells", ""},
    Removed{"refine.samples_melt", "accuracy.blur"},
    Removed{"refine.search_hopeless", ""},
    Removed{"refine.search_min_difference", ""},
    Removed{"refine.setback_min_depth", "accuracy.blur"},
    Removed{"refine.setback_tower_reach", ""},
    Removed{"refine.setback_tower_share", ""},
    Removed{"refine.sharpen_flat_slope", ""},
    Removed{"refine.splits_max_count", ""},
    Removed{"refine.splits_min_valley", ""},
    Removed{"refine.splits_rows_per_bin", ""},
    Removed{"refine.splits_step_share", "accuracy.noise"},
    Removed{"refine.surfaces_bin", ""},
    Removed{"refine.surfaces_plane_rounds", ""},
    Removed{"refine.surfaces_ridge_min_area", ""},
    Removed{"refine.tall_spacing", ""},
    Removed{"refine.value_price", "refine.significance"},
    Removed{"refine.wings_min_length", ""},
    Removed{"segment.edge_cover", ""},
    Removed{"segment.height_spacing", ""},
    Removed{"segment.minimum_inside_samples", ""},
    Removed{"segment.opening", ""},
    Removed{"segment.same_height", ""},
    Removed{"segment.search_passes", ""},
    Removed{"segment.search_piece", ""},
    Removed{"segment.search_sequence", ""},
    Removed{"segment.step_full", ""},
    Removed{"segment.strip_level", ""},
    Removed{"segment.strip_share", ""},
    Removed{"segment.thin_overlap", ""},
    Removed{"slice.maximum_height", ""},
    Removed{"sweep.gutter_rise", ""},
    Removed{"sweep.height_percentile", ""},
    Removed{"sweep.line_maximum_segment", ""},
    Removed{"sweep.low_height", ""},
    Removed{"sweep.low_margin", ""},
    Removed{"sweep.low_share", ""},
    Removed{"sweep.low_weight", ""},
    Removed{"sweep.maximum_scatter", ""},
    Removed{"sweep.roof_cosine", ""},
    Removed{"sweep.roof_look_down", ""},
    Removed{"sweep.roof_look_sideways", ""},
    Removed{"sweep.roof_share", ""},
    Removed{"sweep.setback_gap", "sweep.column_gap"},
    Removed{"sweep.step_alone", ""},
    Removed{"sweep.step_band", ""},
    Removed{"sweep.step_bend", ""},
    Removed{"sweep.step_cell", ""},
    Removed{"sweep.step_cover", ""},
    Removed{"sweep.step_full_jump", ""},
    Removed{"sweep.step_gap", ""},
    Removed{"sweep.step_grain_edge", ""},
    Removed{"sweep.step_grain_length", ""},
    Removed{"sweep.step_grain_share", ""},
    Removed{"sweep.step_grain_turn", ""},
    Removed{"sweep.step_ground", ""},
    Removed{"sweep.step_height", ""},
    Removed{"sweep.step_length", ""},
    Removed{"sweep.step_minimum_rows", ""},
    Removed{"sweep.step_near", ""},
    Removed{"sweep.step_noise", ""},
    Removed{"sweep.step_own_share", ""},
    Removed{"sweep.step_part", ""},
    Removed{"sweep.step_reach", ""},
    Removed{"sweep.step_rest", ""},
    Removed{"sweep.step_roughness", ""},
    Removed{"sweep.step_rows", ""},
    Removed{"sweep.step_same_line", ""},
    Removed{"sweep.step_same_sine", ""},
    Removed{"sweep.step_side", ""},
    Removed{"sweep.step_turn", ""},
    Removed{"sweep.step_wide_gap", ""},
    Removed{"sweep.twin_distance", ""},
    Removed{"sweep.twin_share", ""},
    Removed{"vegetation.overhang_within", "vegetation.overhang"},
};

/// Numbers without a unit that are part of the method: shares, counts, cosines. The headers of the options of their
/// modules say what each means (docs/decisions/0120).
constexpr std::array fixed{
    std::string_view("derive.bevel_length"),
    std::string_view("derive.corner_reach"),
    std::string_view("derive.corner_trim"),
    std::string_view("derive.direction_share"),
    std::string_view("derive.directions"),
    std::string_view("derive.drop_reach"),
    std::string_view("derive.ground_slope"),
    std::string_view("derive.judged_rounds"),
    std::string_view("derive.maximum_cells"),
    std::string_view("derive.minimum_overlap"),
    std::string_view("derive.plane_cosine"),
    std::string_view("derive.plane_slope"),
    std::string_view("derive.snap_moved"),
    std::string_view("derive.wide_rim_smooth"),
    std::string_view("profile.choice_gain"),
    std::string_view("profile.choice_rounds"),
    std::string_view("profile.choice_samples"),
    std::string_view("profile.gentle_turn"),
    std::string_view("profile.level_slope"),
    std::string_view("profile.overhang_shadow"),
    std::string_view("profile.pitch_columns"),
    std::string_view("profile.pitched_share"),
    std::string_view("profile.pool_share"),
    std::string_view("profile.rising_misses"),
    std::string_view("profile.rising_oblique"),
    std::string_view("profile.rising_slope"),
    std::string_view("profile.rising_tile"),
    std::string_view("profile.rising_tile_step"),
    std::string_view("profile.setback_depth"),
    std::string_view("profile.slices_per_edge"),
    std::string_view("profile.wall_lean"),
    std::string_view("refine.cuts_fullness"),
    std::string_view("refine.cuts_fullness_part"),
    std::string_view("refine.cuts_line_gain"),
    std::string_view("refine.cuts_max_cells"),
    std::string_view("refine.cuts_same_share"),
    std::string_view("refine.directions_min_weight"),
    std::string_view("refine.dormers_gable_gain"),
    std::string_view("refine.dormers_max_rest"),
    std::string_view("refine.dormers_max_slope"),
    std::string_view("refine.forms_across_cosine"),
    std::string_view("refine.forms_axis_cosine"),
    std::string_view("refine.forms_gable_length"),
    std::string_view("refine.forms_gable_turn"),
    std::string_view("refine.forms_max_axes"),
    std::string_view("refine.forms_min_slope"),
    std::string_view("refine.forms_samples"),
    std::string_view("refine.joins_quick_excess"),
    std::string_view("refine.lines_min_samples"),
    std::string_view("refine.lines_rounds"),
    std::string_view("refine.mansard_min_slope"),
    std::string_view("refine.mansard_upper_share"),
    std::string_view("refine.outlines_cells"),
    std::string_view("refine.outlines_max_slant"),
    std::string_view("refine.outlines_min_area_share"),
    std::string_view("refine.outlines_min_width_share"),
    std::string_view("refine.outlines_outside_price"),
    std::string_view("refine.outlines_push_share"),
    std::string_view("refine.pieces_profile_share"),
    std::string_view("refine.pieces_seen_share"),
    std::string_view("refine.refit_min_cap_samples"),
    std::string_view("refine.refit_min_samples"),
    std::string_view("refine.regions_hollow_share"),
    std::string_view("refine.regions_min_area_share"),
    std::string_view("refine.regions_seen_share"),
    std::string_view("refine.search_cap_gain"),
    std::string_view("refine.search_max_sides"),
    std::string_view("refine.search_opposite_cosine"),
    std::string_view("refine.search_quick_starts"),
    std::string_view("refine.search_round_gain"),
    std::string_view("refine.search_rounds"),
    std::string_view("refine.search_settle_rounds"),
    std::string_view("refine.search_starts"),
    std::string_view("refine.setback_max_rest"),
    std::string_view("refine.sharpen_level_gain"),
    std::string_view("refine.sharpen_rounds"),
    std::string_view("refine.splits_row_share"),
    std::string_view("refine.surfaces_model_share"),
    std::string_view("refine.tall_walls"),
    std::string_view("refine.wings_reflex_sine"),
    std::string_view("roof.corner_cut_share"),
    std::string_view("roof.direction_cosine"),
    std::string_view("roof.gambrel_rise"),
    std::string_view("roof.gambrel_run"),
    std::string_view("roof.level_cosine"),
    std::string_view("roof.mansard_rise"),
    std::string_view("roof.mansard_run"),
    std::string_view("roof.mansard_slope"),
    std::string_view("roof.rectangle_fill"),
    std::string_view("roof.wing_clearance"),
    std::string_view("roof.wing_depth"),
    std::string_view("segment.gis_parallel_sine"),
    std::string_view("segment.low_share"),
    std::string_view("segment.minimum_samples"),
    std::string_view("segment.surely_inside"),
    std::string_view("segment.thin_run_turn"),
    std::string_view("sweep.cluster_lines"),
    std::string_view("sweep.cluster_overlap"),
    std::string_view("sweep.cluster_overlap_parallel"),
    std::string_view("sweep.cluster_reach"),
    std::string_view("sweep.column_support"),
    std::string_view("sweep.footprint_cosine"),
    std::string_view("sweep.gis_square_score"),
    std::string_view("sweep.line_merge_cosine"),
    std::string_view("sweep.line_straightness"),
    std::string_view("sweep.line_trim_nodes"),
    std::string_view("sweep.registration_cosine"),
    std::string_view("sweep.registration_determined"),
    std::string_view("sweep.registration_explains"),
    std::string_view("sweep.registration_explains_astray"),
    std::string_view("sweep.registration_rounds"),
    std::string_view("sweep.registration_significance"),
    std::string_view("sweep.registration_stands_out"),
    std::string_view("sweep.thin_share"),
    std::string_view("sweep.wall_gap_slices"),
    std::string_view("sweep.wall_lower_share"),
    std::string_view("sweep.wall_share"),
    std::string_view("sweep.wall_slope"),
    std::string_view("vegetation.beyond"),
    std::string_view("vegetation.local_squareness"),
    std::string_view("vegetation.squareness"),
};

}  // namespace

auto why_removed(std::string_view key) -> std::string {
  if (std::ranges::find(fixed, key) != fixed.end())
    return "this option was removed: it is a fixed number of the method now; leave it out";
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
  add(confidence::codes());
  add(vegetation::codes());
  add(derive::codes());
  add(fracture::codes());
  add(segment::codes());
  add(refine::codes());
  add(extrude::codes());
  add(solid::codes());
  add(roof::codes());
  add(formats::codes());
  add(texture::codes());
  add(terrain::codes());
  add(picture::codes());
  add(scan_codes());
  add({
      {"pipeline-nothing", "No footprint of the input could be used.",
       "The report lists the reason of each; repair the footprints.", 5},
      {"pipeline-footprints", "Footprints are missing, or both given and to be derived.",
       "Give footprints after the meshes, or --derive-footprints and meshes alone.", 2},
      {"pipeline-no-ground",
       "There is no mesh within block.ground_reach of the footprint's block, so its ground is unknown.",
       "Give the mesh there, or the ground's heights with --dtm.", 1},
      {"pipeline-ground-attribute", "No footprint has the attribute that is to say the height of the ground.",
       "Check the name of --ground-attribute; 'mansard info FOOTPRINTS' lists the attributes.", 3},
      {"pipeline-no-mesh",
       "The scan shows no surface over this footprint. It is written without a model (LoD 0), or as a prism of "
       "pipeline.assumed_height where that is set. Where the scan shows another part of the building, the part is as "
       "high as that.",
       "Use a scan that covers the footprint, or set pipeline.assumed_height.", 1},
      {"pipeline-partly-seen",
       "The scan does not cover a part of the footprint. The roof there continues what is seen beside it.",
       "Look at the building, or use a scan that covers it. ms_nodata_share is the share without data.", 0},
      {"pipeline-low", "The mesh over this footprint is lower than segment.min_height above the ground.",
       "Lower segment.min_height if low buildings matter; the building is a prism of its median height.", 1},
      {"pipeline-outside", "No face of the fractured ground was given to this footprint.",
       "The footprint may be displaced against the mesh; it is written as a prism of its median height.", 1},
      {"pipeline-covered", "The ground of this footprint went to the models of its neighbours.",
       "Check whether the input repeats a building; segment.gis_edges = hard keeps features apart.", 1},
      {"pipeline-left-out", "Some of a footprint is high enough for a building and has no model.",
       "The message lists area and height of every piece. If a piece is a building, lower "
       "segment.narrow.",
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
      {"compare-state", "There are no models of buildings in what is to be compared.",
       "Give a folder of 'mansard reconstruct', a file of models, or footprints with heights.", 3},
      {"compare-crs", "The states to compare are in different coordinate reference systems.",
       "Transform one of them. Footprints with heights are transformed with --crs.", 3},
      {"compare-overlap", "The states to compare are of different places.",
       "Check the files and their coordinate reference systems.", 3},
      {"compare-scan-gone", "The scan of a run cannot be used any more, so models alone are compared.",
       "Put the files back where the run found them, or name them with --old-scan or --new-scan. With models alone, "
       "fewer changes are significant.",
       0},
      {"compare-outline", "A model has no outline seen from above, and is not compared.",
       "Look at the model in a viewer; export it with its roof or its ground.", 0},
      {"since-models", "The models of the earlier run have no plans, so that they cannot be taken over.",
       "Give --since a folder of 'mansard reconstruct', or a file that it wrote.", 3},
      {"report-run", "The run.json in a folder of results cannot be read.",
       "Run 'mansard reconstruct' again, or give the models themselves instead of the folder.", 3},
      {"report-models", "A folder of results has no models of which a report can be made.",
       "Give the output folder of a run whose --formats have cityjson, geopackage, plans, glb or obj.", 3},
      {"report-changes", "What has changed cannot be read: the file is not the report of 'mansard compare'.",
       "Give changes.json, or the folder that 'mansard compare' wrote.", 3},
      {"report-scan", "The scan of a run cannot be used any more, so the pictures of its report show the models alone.",
       "Put the files back where the run found them, or name them with --scan.", 0},
      {"review-file", "The decisions of a review cannot be read: the file is damaged, or of another kind.",
       "Give review.json of a project, or the folder of the project. Restore a damaged file from a backup, or move it "
       "away: without the file, no building is decided.",
       3},
      {"pipeline-block-unknown", "A run of some blocks names an unknown block.",
       "Take a name from the report of a whole run, or of 'mansard segment'.", 4},
  });
  return all;
}

}  // namespace mansard::pipeline
