#include "mansard/compare/compare.hpp"

namespace mansard::compare {

auto option_list(Options& options) -> base::OptionList {
  base::OptionList list("compare");
  auto& o = options;
  list.number("smallest", o.smallest, "m", {0.05, 10},
              "Smallest change of interest: differences in height up to this, and places that are narrower than twice "
              "this, count as unchanged.")
      .source("evaluate::step_of_walls: less is no step of a roof")
      .number("false_share", o.false_share, "", {1e-6, 0.5},
              "Share of false ones that is accepted among the buildings that are reported as changed.")
      .source("false discovery rate of Benjamini and Hochberg, 1995")
      .number("old_error", o.old_error, "m", {0.001, 100},
              "Root mean square vertical error of old models without the attributes ms_error, ms_rmse_lod22 and "
              "b3_rmse_lod22; without this option 1 m.")
      .source("AdV, product standard of LoD2: heights within 1 m")
      .number("new_error", o.new_error, "m", {0.001, 100}, "The same as old_error, of new models.")
      .source("as old_error")
      .flag("keep_offset", o.keep_offset,
            "Count a shift that all buildings have in common as a change, instead of taking it off.")
      .source("surveys differ by their datum and adjustment before buildings do");
  return list;
}

auto to_string(Kind kind) -> std::string_view {
  static constexpr std::array<std::string_view, kinds> names{
      "unchanged", "new", "gone", "raised", "lowered", "extended", "reduced", "re-roofed", "not compared"};
  return names[static_cast<std::size_t>(kind)];
}

auto Comparison::count(Kind kind) const -> std::size_t {
  std::size_t found = 0;
  for (const auto& change : changes) found += change.kind == kind ? 1 : 0;
  return found;
}

}  // namespace mansard::compare
