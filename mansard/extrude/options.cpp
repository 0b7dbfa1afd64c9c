#include "mansard/extrude/extrude.hpp"

namespace mansard::extrude {
namespace {

constexpr const char* by_hand = "chosen by hand; not measured";

void add_advanced(base::OptionList& list, Options& o) {
  list.number("lines_share_move", o.lines.share_move, "m", {0, 1},
              "An edge takes the direction of a longer one where that moves its ends by at most this, and by at most a "
              "sixteenth of extrude.tolerance.")
      .advanced("docs/extrude.md: what surveys differ by; not measured")
      .number("lines_share_turn", o.lines.share_turn, "rad", {0, 0.7},
              "An edge takes the direction of a longer one where that turns it by at most this.")
      .advanced(by_hand)
      .number("simpler_detail", o.simpler.detail, "m", {0.001, 10},
              "A building that cannot be extruded in full is extruded without details under this size.")
      .advanced("docs/extrude.md, the ladder; chosen by hand, not measured")
      .number("simpler_merge_angle", o.simpler.merge_angle, "rad", {0, 0.7},
              "A building that cannot be extruded in full is extruded with turns under this straightened.")
      .advanced("5°; docs/extrude.md, the ladder; chosen by hand, not measured")
      .number("shared_min_overlap", o.shared.min_overlap, "m", {0, 100},
              "Walls of neighbours are put on one line where they overlap by at least this, or by half of the shorter.")
      .advanced("docs/decisions/0027-shared-walls-on-one-line.md")
      .number("shared_max_turn", o.shared.max_turn, "rad", {0, 0.7},
              "Walls of neighbours are put on one line where that turns them by at most this.")
      .advanced("docs/decisions/0027-shared-walls-on-one-line.md")
      .number("short_arc", o.short_arc, "m", {0, 0.1},
              "Edges of a solid shorter than this are drawn together where that changes no face; 0: none.")
      .advanced("docs/decisions/0007-rounded-before-the-check.md");
}

}  // namespace

auto option_list(Options& options) -> base::OptionList {
  base::OptionList list("extrude");
  list.number("merge_angle", options.merge_angle, "rad", {0, 0.2},
              "Turns of the footprint under this are straightened.")
      .source("half a degree: less than surveys distinguish; docs/canonical-footprint.md")
      .number("tolerance", options.tolerance, "m", {0.001, 1},
              "The footprint that is extruded is nowhere farther than this from the given one.")
      .source("docs/canonical-footprint.md")
      .number("overhang", options.overhang, "m", {0, 3},
              "How far the lowest eaves overhang, with a level soffit below them.")
      .source("0: a scan shows no soffits; not measured");
  add_advanced(list, options);
  return list;
}

}  // namespace mansard::extrude
