#include "mansard/refine/refine.hpp"

#include <algorithm>
#include <map>

#include "mansard/refine/detail/owner.hpp"

namespace mansard::refine {

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("refine");
  list.choice("effort", o.effort, {{"caps", Effort::caps}, {"planes", Effort::planes}, {"parts", Effort::parts}},
              "What may be changed by measured error: the height caps; the profiles too; or the plan as well.")
      .number("grid", o.grid, "m", {0.05, 5}, "Distance between samples from above.")
      .number("face_price", o.face_price, "m²·m²", {0, 1000},
              "Minimum reduction of the sum of squared differences for each additional face.")
      .number(
          "part_price", o.part_price, "m²·m²", {0, 1000},
          "Minimum reduction of the sum of squared differences for each additional part, besides that for its faces.")
      .number("robust", o.robust, "m", {0.05, 100},
              "Differences from the mesh greater than this count linearly, not squared: trees, debris.")
      .number("margin", o.margin, "m", {0, 5},
              "Samples within this distance of a part's outline have less weight, because walls of meshes are rounded.")
      .number("least_area", o.least_area, "m²", {0.5, 1000},
              "Roof structures with a smaller area than this stay part of the roof around them.");
  return list;
}

auto refine(std::span<const Draft> drafts, const rays::Scene& mesh, const Options& options,
            const extrude::Options& raising, const base::Run& run) -> Refined {
  std::map<std::size_t, std::vector<std::size_t>> owners;
  for (std::size_t i = 0; i < drafts.size(); ++i) owners[drafts[i].owner].push_back(i);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [owner, mine] : owners) groups.push_back(std::move(mine));

  std::vector<Refined> each(groups.size());
  base::parallel_for(groups.size(), [&](std::size_t g) {
    if (!run.cancelled()) each[g] = detail::refine_owner(drafts, groups[g], mesh, options, raising, run);
  });
  Refined out;
  for (auto& one : each) {
    std::ranges::move(one.parts, std::back_inserter(out.parts));
    std::ranges::move(one.failed, std::back_inserter(out.failed));
  }
  std::ranges::stable_sort(out.parts, {}, &Part::draft);
  std::ranges::stable_sort(out.failed, {}, [](const auto& failure) { return failure.first; });
  return out;
}

}  // namespace mansard::refine
