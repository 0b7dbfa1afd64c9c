#include "mansard/refine/options.hpp"

namespace mansard::refine {
namespace {

using base::OptionList;
using base::Range;

constexpr const char* by_hand = "chosen by hand; not measured";
constexpr const char* decision_14 = "docs/decisions/0014-refined-by-measured-error.md";
constexpr const char* decision_17 = "docs/decisions/0017-setbacks-by-measured-error.md";
constexpr const char* decision_41 = "docs/decisions/0041-faces-want-evidence.md";
constexpr const char* decision_137 = "docs/decisions/0137-planes-propose.md";
constexpr const char* decision_87 = "docs/decisions/0087-dormers-by-default.md";

constexpr Range count{0, 1000};              // things; none switches the step off
constexpr Range some{1, 1000};               // things, of which there must be one
constexpr Range length{0, 100};              // m
constexpr Range positive_length{0.01, 100};  // m
constexpr Range height{0, 1000};             // m
constexpr Range slope{0, 100};               // rise per run
constexpr Range area{0, 10'000};             // m²
constexpr Range angle{0, 1.6};               // rad; directions repeat after a quarter turn

void add_objective(OptionList& list, Options& o) {
  list.choice("effort", o.effort, {{"caps", Effort::caps}, {"planes", Effort::planes}, {"parts", Effort::parts}},
              "What may be changed by measured error: the height caps; the profiles too; or the plan as well.")
      .source(decision_14)
      .number("detail", o.detail, "m", {0.001, 10},
              "The smallest detail of interest: a step in height of this size over 4 m². What the scan shows more "
              "finely is "
              "left out.")
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
      .number(
          "least_area", o.least_area, "m²", {0.5, 1000},
          "A structure with a smaller ground area stays with the roof around it; where the scan shows less, so does a "
          "larger one, up to 4 m².")
      .source(decision_137);
}

void add_forms(OptionList& list, Options::Forms& o) {
  list.number("forms_min_height", o.min_height, "m", {0.01, 100},
              "Minimum height of a proposed wall or cap above the base.")
      .advanced("any positive height gives a solid; chosen by hand")
      .number("forms_max_slope", o.max_slope, "", slope,
              "A form with a greater slope (rise per run) is not proposed, and no refitted plane is steeper.")
      .advanced("a steeper one is a scan's rounding of a wall (79°); decision 113");
}

void add_mansard(OptionList& list, Options::Mansard& o) {
  list.number("mansard_max_depth", o.max_depth, "m", length, "Maximum run of the steep part of a mansard roof.")
      .advanced(by_hand)
      .number("mansard_min_rise", o.min_rise, "m", height, "Minimum rise of the steep part of a mansard roof.")
      .advanced("a melted corner is smaller; docs/refine.md, not measured");
}

void add_setback(OptionList& list, Options::Setback& o) {
  list.number("setback_max_depth", o.max_depth, "m", length, "Maximum depth of a level strip along a side.")
      .advanced(decision_17)
      .number("setback_behind", o.behind, "m", length,
              "Behind the deepest strip, samples are read up to this distance.")
      .advanced(by_hand)
      .number("setback_min_rise", o.min_rise, "m", height,
              "What is located behind a strip rises above it by at least this.")
      .advanced(decision_17);
}

void add_sharpen(OptionList& list, Options::Sharpen& o) {
  list.number(
          "sharpen_level_slope", o.level_slope, "", slope,
          "A roof with no greater slope (rise per run) becomes a flat one where its pitches explain little of what a "
          "flat one leaves.")
      .advanced("0.6 is 31°; docs/decisions/0102-pitches-that-explain-little.md");
}

void add_pieces(OptionList& list, Options::Pieces& o) {
  list.number("pieces_min_width", o.min_width, "m", length,
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
      .number("bare_area", o.area, "m²", area, "A steep face with samples over this area is shown by the scan.")
      .advanced("as mansard evaluate counts them");
}

void add_tall(OptionList& list, Options::Tall& o) {
  list.number("tall_ratio", o.ratio, "", {0, 1000},
              "No part is cut out that is taller than this many times the root of its area, unless the scan shows its "
              "walls; 0: without limit.")
      .advanced("as mansard evaluate counts them")
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
  list.number(
          "joins_recut_reach", o.recut_reach, "m", length,
          "Only differences nearer than this to the other part are evidence that two parts meet in the wrong place.")
      .advanced(by_hand);
}

void add_wings(OptionList& list, Options::Wings& o) {
  list.integer("wings_max_cuts", o.max_cuts, "", count,
               "Of all cuts between wings, this many are tried, those with "
               "the most error around them.")
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
      .advanced(by_hand);
}

void add_directions(OptionList& list, Options::Directions& o) {
  list.number("directions_same", o.same, "rad", angle,
              "Edges of a part that differ by at most this have one direction.")
      .advanced("5°; chosen by hand, not measured");
}

void add_outlines(OptionList& list, Options::Outlines& o) {
  list.number("outlines_near_edge", o.near_edge, "m", length,
              "A strip narrower than this between a wall and an edge of the part is closed.")
      .advanced(by_hand)
      .number("outlines_near_line", o.near_line, "m", length,
              "A wall nearer than this to the line of an edge farther along continues that edge.")
      .advanced(by_hand)
      .number("outlines_min_overlap", o.min_overlap, "m", length,
              "A wall is beside an edge where they overlap by at least this.")
      .advanced(by_hand)
      .number("outlines_max_gap", o.max_gap, "m", length,
              "A wall may continue an edge that ends at most this far from it.")
      .advanced(by_hand);
}

void add_splits(OptionList& list, Options::Splits& o) {
  list.number("splits_apart", o.apart, "m", length, "Two lines across a part are at least this far apart.")
      .advanced(by_hand);
}

void add_surfaces(OptionList& list, Options::Surfaces& o) {
  list.number("surfaces_max_slope", o.max_slope, "", slope,
              "A ridge whose sides have a greater slope (rise per run) is not a roof.")
      .advanced("1.5 is 56°; steeper is a wall that melted; not measured");
}

}  // namespace

auto option_list(Options& o) -> OptionList {
  OptionList list("refine");
  add_objective(list, o);
  add_forms(list, o.forms);
  add_mansard(list, o.mansard);
  add_setback(list, o.setback);
  add_sharpen(list, o.sharpen);
  add_pieces(list, o.pieces);
  add_bare(list, o.bare);
  add_tall(list, o.tall);
  add_joins(list, o.joins);
  add_wings(list, o.wings);
  add_dormers(list, o.dormers);
  add_directions(list, o.directions);
  add_outlines(list, o.outlines);
  add_splits(list, o.splits);
  add_surfaces(list, o.surfaces);
  return list;
}

}  // namespace mansard::refine
