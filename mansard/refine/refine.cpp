#include "mansard/refine/refine.hpp"

#include <algorithm>
#include <map>

#include "mansard/refine/detail/owner.hpp"

namespace mansard::refine {

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
