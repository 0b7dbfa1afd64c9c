#include "mansard/refine/options.hpp"

namespace mansard::refine {
namespace {

using base::OptionList;
using base::Range;

constexpr const char* by_hand = "chosen by hand; not measured";
constexpr const char* decision_8 = "docs/decisions/0008-cap-by-measured-error.md";
constexpr const char* decision_14 = "docs/decisions/0014-refined-by-measured-error.md";
constexpr const char* decision_16 = "docs/decisions/0016-roof-steps.md";
constexpr const char* decision_17 = "docs/decisions/0017-setbacks-by-measured-error.md";
constexpr const char* decision_39 = "docs/decisions/0039-alike-what-is-alike.md";
constexpr const char* decision_41 = "docs/decisions/0041-faces-want-evidence.md";
constexpr const char* decision_87 = "docs/decisions/0087-dormers-by-default.md";
constexpr const char* decision_47 = "docs/decisions/0047-moderate-detail.md";
constexpr const char* decision_86 = "docs/decisions/0086-tall-parts-and-crowns.md";

constexpr Range share{0, 1};                 // of a whole, or a cosine
constexpr Range count{0, 1000};              // things; none switches the step off
constexpr Range some{1, 1000};               // things, of which there must be one
constexpr Range length{0, 100};              // m
constexpr Range positive_length{0.01, 100};  // m
constexpr Range height{0, 1000};             // m
constexpr Range slope{0, 100};               // rise per run
constexpr Range area{0, 10'000};             // m²
constexpr Range positive_area{0.01, 1e9};    // m²
constexpr Range angle{0, 1.6};               // rad; directions repeat after a quarter turn

void add_objective(OptionList& list, Options& o) {
  list.choice("effort", o.effort, {{"caps", Effort::caps}, {"planes", Effort::planes}, {"parts", Effort::parts}},
              "What may be changed by measured error: the height caps; the profiles too; or the plan as well.")
      .source(decision_14)
      .number("detail", o.detail, "m", {0.001, 10},
              "The smallest detail of interest: a step in height of this size over refine.least_area. What the scan shows "
              "more finely is left out.")
      .source("half of the smallest step that LoD 2.2 models of agencies show; docs/accuracy.md")
      .number("significance", o.significance, "", {0.01, 100},
              "How many times the description length of a number, in the measured noise of the scan, the number must "
              "explain to be modelled.")
      .source("1: description length (Rissanen 1978); docs/accuracy.md")
      .number("grid", o.grid, "m", {0.05, 5}, "Distance between the samples of mesh and roof, seen from above.")
      .source("a quarter of a metre is what photogrammetry resolves; not measured")
      .number("robust", o.robust, "m", {0.05, 100},
              "Differences from the mesh greater than this count linearly, not squared: trees, debris.")
      .source(decision_14)
      .number("least_area", o.least_area, "m²", {0.5, 1000},
              "A structure with a smaller ground area stays with the roof around it.")
      .source(by_hand);
}

void add_lines(OptionList& list, Options::Lines& o) {
  list.integer("lines_rounds", o.rounds, "", count, "Number of times that the samples of a line are weighted again.")
      .advanced("reweighing converges well before; not measured")
      .integer("lines_min_samples", o.min_samples, "", {2, 10'000},
               "A line is fitted to at least this many samples; each side of a split has as many.")
      .advanced(by_hand)
      .number("lines_min_spread", o.min_spread, "m", length,
              "A slope is fitted only where the samples' standard deviation along the slope is at least this.")
      .advanced(by_hand);
}

void add_forms(OptionList& list, Options::Forms& o) {
  list.integer("forms_samples", o.samples, "", {1, 1'000'000},
               "Of the samples over a part, every so many are used for a form's pitch that about this many remain.")
      .advanced("more would not move a line; not measured")
      .number("forms_min_height", o.min_height, "m", {0.01, 100},
              "Minimum height of a proposed wall or cap above the base.")
      .advanced("any positive height gives a solid; chosen by hand")
      .number("forms_min_slope", o.min_slope, "", slope, "A form with a smaller slope (rise per run) is not proposed.")
      .advanced(by_hand)
      .number("forms_max_slope", o.max_slope, "", slope,
              "A form with a greater slope (rise per run) is not proposed, and no refitted plane is steeper.")
      .advanced("a steeper one is a scan's rounding of a wall (79°); decision 113")
      .integer("forms_max_axes", o.max_axes, "", count,
               "Number of directions of a part along which gables and single pitches are tried.")
      .advanced(by_hand)
      .number("forms_axis_cosine", o.axis_cosine, "", share,
              "Two directions whose cosine is greater than this are one direction.")
      .advanced("0.9 is an angle of about 26°; chosen by hand, not measured")
      .number("forms_across_cosine", o.across_cosine, "", share,
              "A side carries the roof of a direction where the cosine between the two is greater than this.")
      .advanced("0.8 is an angle of about 37°; chosen by hand, not measured")
      .number("forms_gable_turn", o.gable_turn, "", share,
              "A side may be a gable end where the sine of the turn at both of its corners is greater than this.")
      .advanced("0.5 is an angle of 30°; chosen by hand, not measured")
      .number("forms_gable_length", o.gable_length, "", {0, 100},
              "A side may be a gable end where its length is less than this multiple of its shorter neighbour's.")
      .advanced(by_hand);
}

void add_mansard(OptionList& list, Options::Mansard& o) {
  list.number("mansard_min_depth", o.min_depth, "m", length, "Minimum run of the steep part of a mansard roof.")
      .advanced("a melted corner is smaller; docs/refine.md, not measured")
      .number("mansard_max_depth", o.max_depth, "m", length, "Maximum run of the steep part of a mansard roof.")
      .advanced(by_hand)
      .number("mansard_min_rise", o.min_rise, "m", height, "Minimum rise of the steep part of a mansard roof.")
      .advanced("a melted corner is smaller; docs/refine.md, not measured")
      .number("mansard_min_slope", o.min_slope, "", slope,
              "Minimum slope (rise per run) of the steep part of a mansard roof.")
      .advanced(by_hand)
      .number("mansard_upper_share", o.upper_share, "", share,
              "The slope of the upper part of a mansard roof is at most this share of the steep part's.")
      .advanced(by_hand);
}

void add_setback(OptionList& list, Options::Setback& o) {
  list.number("setback_max_depth", o.max_depth, "m", length, "Maximum depth of a level strip along a side.")
      .advanced(decision_17)
      .number("setback_behind", o.behind, "m", length,
              "Behind the deepest strip, samples are read up to this distance.")
      .advanced(by_hand)
      .number("setback_min_rise", o.min_rise, "m", height,
              "What is located behind a strip rises above it by at least this.")
      .advanced(decision_17)
      .number("setback_max_rest", o.max_rest, "", share,
              "A step is proposed where a level and a line leave less than this share of the squares that one line "
              "leaves.")
      .advanced(decision_17);
}

void add_refit(OptionList& list, Options::Refit& o) {
  list.number("refit_min_slope", o.min_slope, "", slope, "Minimum slope (rise per run) that a refitted plane takes.")
      .advanced("a flatter roof is the cap's; not measured")
      .integer("refit_min_samples", o.min_samples, "", {1, 10'000},
               "A plane with fewer samples on its faces stays as it is.")
      .advanced(by_hand)
      .integer("refit_min_cap_samples", o.min_cap_samples, "", {1, 10'000},
               "A cap with fewer samples on its faces stays as it is.")
      .advanced(by_hand)
      .number("refit_max_knot_move", o.max_knot_move, "m", length,
              "A profile whose knot would move farther than this stays as it is.")
      .advanced(by_hand);
}

void add_search(OptionList& list, Options::Search& o) {
  list.number("search_cap_gain", o.cap_gain, "", share,
              "A later cap replaces an earlier one where its error is less than this share of the earlier one's.")
      .advanced(decision_8)
      .integer("search_settle_rounds", o.settle_rounds, "", count,
               "Maximum number of times that a roof's planes are refitted in a row.")
      .advanced(by_hand)
      .integer("search_starts", o.starts, "", some, "Number of forms that a thorough search follows.")
      .advanced(by_hand)
      .integer("search_quick_starts", o.quick_starts, "", some, "Number of forms that a quick search follows.")
      .advanced(by_hand)
      .integer("search_rounds", o.rounds, "", count, "Number of times that all sides of a part are tried in turn.")
      .advanced(by_hand)
      .number("search_round_gain", o.round_gain, "", share,
              "All sides are tried again where the last round reduced the cost to at most this share.")
      .advanced(by_hand)
      .integer("search_max_sides", o.max_sides, "", count,
               "Of a part with more sides, this many, the longest, are tried.")
      .advanced(by_hand)
      .number("search_opposite_cosine", o.opposite_cosine, "", share,
              "Two sides are opposite where the negative cosine of their directions is greater than this.")
      .advanced("0.95 is an angle of about 18°; chosen by hand, not measured");
}

void add_sharpen(OptionList& list, Options::Sharpen& o) {
  list.integer("sharpen_rounds", o.rounds, "", count,
               "Maximum number of times that planes are refitted to the middle of their faces.")
      .advanced(by_hand)
      .number(
          "sharpen_level_slope", o.level_slope, "", slope,
          "A roof with no greater slope (rise per run) becomes a flat one where its pitches explain little of what a "
          "flat one leaves.")
      .advanced("0.6 is 31°; docs/decisions/0102-pitches-that-explain-little.md")
      .number("sharpen_level_gain", o.level_gain, "", share,
              "Pitches explain little where they leave at least this share of the squared differences of a flat roof, "
              "explain at most this share of those away from the outline, and save less than a part costs.")
      .advanced("docs/decisions/0102-pitches-that-explain-little.md");
}

void add_alike(OptionList& list, Options::Alike& o) {
  list.number(
          "alike_most_ground", o.most_ground, "m²", positive_area,
          "A roof plane over more ground than this counts as over this much where heights and pitches are made equal: "
          "what is wrong with a scan over several metres does not become less with more samples.")
      .advanced(decision_39);
}

void add_pieces(OptionList& list, Options::Pieces& o) {
  list.number("pieces_profile_share", o.profile_share, "", share,
              "An edge takes a profile where at least this share of its length runs along edges with it.")
      .advanced(by_hand)
      .number(
          "pieces_seen_share", o.seen_share, "", share,
          "No piece is cut out of which less than this share is known: crowns hide the rest, or the scan has holes.")
      .advanced(by_hand)
      .number("pieces_min_width", o.min_width, "m", length,
              "A piece with a smaller mean width is a strip along an edge, and the cut is not made.")
      .advanced(by_hand)
      .number("pieces_slit", o.slit, "m", length, "Joining two parts closes gaps up to this width between them.")
      .advanced("straightening opens up to 0.01 m between neighbours; twice that")
      .number("pieces_straight", o.straight, "m", length,
              "A corner of a joined part that is nearer to its neighbours' line than this is removed.")
      .advanced(by_hand);
}

void add_bare(OptionList& list, Options::Bare& o) {
  list.integer("bare_cells", o.cells, "", count,
               "A roof face narrower than this many samples pays part_price: no sample shows it alone.")
      .advanced(decision_41)
      .number("bare_steep", o.steep, "rad", angle,
              "A steeper roof face is a wall in truth, and pays part_price unless the scan shows it.")
      .advanced("65°, as mansard evaluate counts them")
      .number("bare_noise", o.noise, "m", length, "Samples within this distance of a steep face lie on it.")
      .advanced("a scan's noise, as mansard evaluate takes it")
      .number("bare_area", o.area, "m²", area, "A steep face with samples over this area is shown by the scan.")
      .advanced("as mansard evaluate counts them");
}

void add_tall(OptionList& list, Options::Tall& o) {
  list.number("tall_ratio", o.ratio, "", {0, 1000},
              "No part is cut out that is taller than this many times the root of its area, unless the scan shows its "
              "walls; 0: without limit.")
      .advanced("as mansard evaluate counts them")
      .number("tall_walls", o.walls, "", share,
              "Walls are seen where the scan is near to this share of the places that are looked at on them.")
      .advanced(decision_86)
      .number("tall_clear", o.clear, "m", length,
              "These places are so far below the upper and above the lower end of a wall.")
      .advanced("more than tall_reach, so that no roof is near")
      .number("tall_reach", o.reach, "m", length, "A surface this near to such a place is the wall.")
      .advanced("half of the spacing of the points of 2.5D meshes, and some noise")
      .number("tall_inside", o.inside, "m", length, "Where the height of the part is taken, inward from its wall.")
      .advanced(by_hand)
      .number("tall_beside", o.beside, "m", length, "Where the height beside the part is taken, outward from its wall.")
      .advanced("past what a scan melts; by hand");
}

void add_joins(OptionList& list, Options::Joins& o) {
  list.number("joins_quick_excess", o.quick_excess, "", {1, 1000},
              "Two parts are searched as one where a quick roof costs less than this multiple of both.")
      .advanced("searching edge by edge seldom takes more off; no record of the measurement")
      .number(
          "joins_recut_reach", o.recut_reach, "m", length,
          "Only differences nearer than this to the other part are evidence that two parts meet in the wrong place.")
      .advanced(by_hand);
}

void add_wings(OptionList& list, Options::Wings& o) {
  list.number("wings_reflex_sine", o.reflex_sine, "", share,
              "A corner is reflex where the sine of its turn outwards is greater than this.")
      .advanced("0.35 is an angle of 20°; chosen by hand, not measured")
      .integer("wings_max_cuts", o.max_cuts, "", count,
               "Of all cuts between wings, this many are tried, those with "
               "the most error around them.")
      .advanced(by_hand);
}

void add_roughness(OptionList& list, Options::Cuts& o) {
  list.number("cuts_crisp_rms", o.crisp_rms, "m", height,
              "A structure is a roof where a simple surface leaves no greater root mean square than this.")
      .advanced("the crown of a tree 3 m high has more; not measured")
      .number("cuts_smooth_rms", o.smooth_rms, "m", height,
              "A structure that fills its box is a roof where a simple surface leaves no greater root mean square.")
      .advanced("a roof with its clutter; not measured")
      .number("cuts_fullness", o.fullness, "", share,
              "A structure fills its box where its mean height is at least this share of its maximum height.")
      .advanced(by_hand)
      .integer("cuts_fullness_part", o.fullness_part, "", {2, 1'000'000},
               "The maximum height of a structure is exceeded by one sample in this many.")
      .advanced(by_hand)
      .number("cuts_hipped_min_area", o.hipped_min_area, "m²", area,
              "A structure of at least this area is also compared with a roof of four hips.")
      .advanced("a smaller crown passes for one; not measured")
      .number("cuts_fair_area", o.fair_area, "m²", area,
              "A structure of at least this area may have hips and smaller structures on it.")
      .advanced(by_hand)
      .number("cuts_fair_rms", o.fair_rms, "m", height,
              "A structure of at least refine.cuts_fair_area is a roof where a simple surface leaves no greater root "
              "mean square than this.")
      .advanced(by_hand)
      .number("cuts_large_area", o.large_area, "m²", area, "A structure of at least this area is not a tree.")
      .advanced(by_hand)
      .number("cuts_large_gain", o.large_gain, "", share,
              "A structure of at least refine.cuts_large_area is cut out where it explains this share of the part's "
              "error.")
      .advanced(by_hand);
}

void add_cuts(OptionList& list, Options::Cuts& o) {
  list.number("cuts_min_step", o.min_step, "m", height,
              "A structure differs in height from the roof around it by at least "
              "this.")
      .advanced(by_hand)
      .number("cuts_min_width", o.min_width, "m", length,
              "A structure with a smaller mean width is a chimney or a rounded edge.")
      .advanced(by_hand);
  add_roughness(list, o);
  list.number("cuts_line_gain", o.line_gain, "", share,
              "A line across a part is proposed where it explains at least this share of the part's error.")
      .advanced(by_hand)
      .number("cuts_line_min_width", o.line_min_width, "m", length,
              "A line across a part leaves at least this mean width on either side.")
      .advanced(by_hand)
      .number("cuts_same_share", o.same_share, "", share,
              "Two cuts are one where at most this share of their cells is on different sides.")
      .advanced(by_hand)
      .number("cuts_shape_price", o.shape_price, "", share,
              "An outline is ranked lower by this share of its gain for each of its rectangles.")
      .advanced(by_hand)
      .number("cuts_askew_price", o.askew_price, "", share,
              "An outline along no edge of the part is ranked lower by this share of its gain.")
      .advanced(by_hand)
      .number("cuts_new_direction", o.new_direction, "rad", angle,
              "The walls of a structure are a direction of their own where they differ from all others by more than "
              "this.")
      .advanced("8°; chosen by hand, not measured")
      .number("cuts_max_cells", o.max_cells, "", {1, 1e9},
              "Cuts are compared with at most about this many samples; of more, every second or third is used.")
      .advanced(by_hand)
      .number("cuts_sliver_area", o.sliver_area, "m²", area,
              "A piece smaller than this that a cut would leave goes with the structure.")
      .advanced(by_hand)
      .number("cuts_sliver_width", o.sliver_width, "m", length,
              "A piece of a smaller mean width that a cut would leave goes with the structure.")
      .advanced(by_hand);
}

void add_dormers(OptionList& list, Options::Dormers& o) {
  list.flag("dormers", o.wanted, "Whether dormers are looked for on the slopes of roofs.")
      .source(decision_87)
      .number("dormers_min_width", o.min_width, "m", positive_length, "The minimum width of a dormer.")
      .advanced("dormers of 1.2 m and more, less half a sample")
      .number("dormers_max_width", o.max_width, "m", positive_length,
              "The maximum width and depth of a dormer; what is larger may become a part by a cut.")
      .advanced(by_hand)
      .number("dormers_min_rise", o.min_rise, "m", positive_length, "The minimum height of a dormer's front.")
      .advanced(by_hand)
      .number("dormers_max_rise", o.max_rise, "m", positive_length, "The maximum height of a dormer's front.")
      .advanced(by_hand)
      .number("dormers_min_slope", o.min_slope, "", slope, "Dormers are on slopes at least as steep as this.")
      .advanced(by_hand)
      .number("dormers_max_slope", o.max_slope, "", slope, "Dormers are on slopes no steeper than this.")
      .advanced(by_hand)
      .number(
          "dormers_max_rest", o.max_rest, "", share,
          "Share of the squared difference from the slope that a dormer may leave; a tree or a chimney leaves more.")
      .advanced(decision_87)
      .number("dormers_gable_gain", o.gable_gain, "", share,
              "A dormer is gabled where that leaves less than this share of the error of a level one.")
      .advanced(by_hand);
}

void add_directions(OptionList& list, Options::Directions& o) {
  list.number("directions_same", o.same, "rad", angle,
              "Edges of a part that differ by at most this have one direction.")
      .advanced("5°; chosen by hand, not measured")
      .number("directions_other", o.other, "rad", angle,
              "A second direction of a part differs from the first by at least this.")
      .advanced("12°; nearer ones serve the same walls; not measured")
      .number("directions_second_share", o.second_share, "", share,
              "A second direction has at least this share of a part's outline.")
      .advanced(by_hand)
      .number("directions_min_weight", o.min_weight, "", {0.001, 1},
              "A place has a height where the cells around it that were sampled have at least this weight of "
              "bilinear interpolation.")
      .advanced(by_hand);
}

void add_regions(OptionList& list, Options::Regions& o) {
  list.number("regions_bin", o.bin, "m", {0.01, 10}, "Width of a bin in the histogram of height differences.")
      .advanced(by_hand)
      .number("regions_peak_share", o.peak_share, "", {0, 100},
              "A peak of the histogram holds at least this share of refine.least_area in its three bins.")
      .advanced(by_hand)
      .number("regions_valley", o.valley, "", share,
              "Two peaks of the histogram are two levels where the valley between them is lower than this share of the "
              "lower one.")
      .advanced(by_hand)
      .number("regions_level_clearance", o.level_clearance, "", {0, 100},
              "A level is used where it differs from the model by more than this multiple of refine.cuts_min_step.")
      .advanced(by_hand)
      .number("regions_min_area_share", o.min_area_share, "", share,
              "A region has at least this share of refine.least_area; its outline may have more.")
      .advanced(by_hand)
      .number("regions_seen_share", o.seen_share, "", share,
              "A region is used where at least this share of its cells was sampled.")
      .advanced(by_hand)
      .number("regions_hollow_share", o.hollow_share, "", share,
              "What a region surrounds is tried in its place where the region fills at most this share of its box.")
      .advanced(by_hand)
      .number("regions_agreement", o.agreement, "", share,
              "The walls of a region have a direction where their resultant is at least this share of their sum.")
      .advanced("noise around a square reaches 0.2; not measured further");
}

void add_rectangles(OptionList& list, Options::Outlines& o) {
  list.integer("outlines_cells", o.cells, "", {4, 1000},
               "Rectangles are looked for on a grid of at most this many cells a side.")
      .advanced(by_hand)
      .number("outlines_outside_price", o.outside_price, "", share,
              "Price of a cell outside the part, where a cell of the region has a worth of 1.")
      .advanced(by_hand)
      .integer("outlines_max_rectangles", o.max_rectangles, "", count, "Maximum number of rectangles of an outline.")
      .advanced(by_hand)
      .number("outlines_min_area_share", o.min_area_share, "", share,
              "A rectangle has at least this share of refine.least_area.")
      .advanced(by_hand)
      .number("outlines_min_addition", o.min_addition, "", share,
              "A rectangle adds at least this share of the region's cells.")
      .advanced(by_hand)
      .number("outlines_min_width_share", o.min_width_share, "", share,
              "A rectangle is at least this share of refine.cuts_min_width wide.")
      .advanced(by_hand);
}

void add_outlines(OptionList& list, Options::Outlines& o) {
  add_rectangles(list, o);
  list.number("outlines_min_contrast", o.min_contrast, "m", height,
              "A wall is moved to a step where the roofs on both sides differ by at least this.")
      .advanced(by_hand)
      .number("outlines_max_move", o.max_move, "m", length, "Maximum distance by which a wall is moved to a step.")
      .advanced(by_hand)
      .number("outlines_row_share", o.row_share, "", share,
              "A column beside a wall is used where at least this share of its rows was sampled.")
      .advanced(by_hand)
      .integer("outlines_step_rounds", o.step_rounds, "", count, "Number of times that a step is searched for again.")
      .advanced(by_hand)
      .integer("outlines_settle_rounds", o.settle_rounds, "", count,
               "Number of times that all walls of an outline are moved to steps.")
      .advanced(by_hand)
      .number("outlines_push_share", o.push_share, "", share,
              "A wall goes out to the part's edge where at least this share of its rows ends near it.")
      .advanced(by_hand)
      .number("outlines_near_edge", o.near_edge, "m", length,
              "A strip narrower than this between a wall and an edge of the part or another rectangle is closed.")
      .advanced(by_hand)
      .number("outlines_near_line", o.near_line, "m", length,
              "A wall nearer than this to the line of an edge farther along continues that edge.")
      .advanced(by_hand)
      .number("outlines_max_slant", o.max_slant, "", share,
              "A wall and an edge are parallel where the offset per length is at most this.")
      .advanced("0.09 is 5°; chosen by hand, not measured")
      .number("outlines_min_overlap", o.min_overlap, "m", length,
              "A wall is beside an edge where they overlap by at least this.")
      .advanced(by_hand)
      .number("outlines_max_gap", o.max_gap, "m", length,
              "A wall may continue an edge that ends at most this far from it.")
      .advanced(by_hand);
}

void add_splits(OptionList& list, Options::Splits& o) {
  list.number("splits_apart", o.apart, "m", length, "Two lines across a part are at least this far apart.")
      .advanced(by_hand)
      .number("splits_row_share", o.row_share, "", share,
              "A line is a step or a valley where more than this share of its rows is.")
      .advanced(by_hand)
      .number("splits_step_share", o.step_share, "", share,
              "A row has a step where it has at least this share of refine.cuts_min_step.")
      .advanced("clear of the noise of one row; not measured")
      .number("splits_min_valley", o.min_valley, "m", height,
              "A row has a valley where both sides are at least this much above its middle.")
      .advanced(by_hand);
}

void add_surfaces(OptionList& list, Options::Surfaces& o) {
  list.number("surfaces_ridge_min_area", o.ridge_min_area, "m²", area, "A ridge is tried on an area of at least this.")
      .advanced("on less, a ridge fits the crown of a tree as well as a roof; not measured")
      .number("surfaces_max_slope", o.max_slope, "", slope,
              "A ridge whose sides have a greater slope (rise per run) is not a roof.")
      .advanced("1.5 is 56°; steeper is a wall that melted; not measured")
      .number(
          "surfaces_model_share", o.model_share, "", share,
          "A cut is evaluated by what two surfaces explain beyond one where one explains at least all but this share "
          "of the model's error.")
      .advanced(by_hand);
}

}  // namespace

auto option_list(Options& o) -> OptionList {
  OptionList list("refine");
  add_objective(list, o);
  add_lines(list, o.lines);
  add_forms(list, o.forms);
  add_mansard(list, o.mansard);
  add_setback(list, o.setback);
  add_refit(list, o.refit);
  add_search(list, o.search);
  add_sharpen(list, o.sharpen);
  add_alike(list, o.alike);
  add_pieces(list, o.pieces);
  add_bare(list, o.bare);
  add_tall(list, o.tall);
  add_joins(list, o.joins);
  add_wings(list, o.wings);
  add_cuts(list, o.cuts);
  add_dormers(list, o.dormers);
  add_directions(list, o.directions);
  add_regions(list, o.regions);
  add_outlines(list, o.outlines);
  add_splits(list, o.splits);
  add_surfaces(list, o.surfaces);
  return list;
}

}  // namespace mansard::refine
