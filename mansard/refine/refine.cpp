#include "mansard/refine/refine.hpp"

#include <algorithm>
#include <map>
#include <ranges>

#include "mansard/refine/detail/alike.hpp"
#include "mansard/refine/detail/owner.hpp"

namespace mansard::refine {

auto refine(std::span<const Draft> drafts, const rays::Scene& mesh, const Options& options,
            const extrude::Options& raising, const base::Run& run, const rays::Scene* above) -> Refined {
  std::map<std::size_t, std::vector<std::size_t>> owners;
  for (std::size_t i = 0; i < drafts.size(); ++i) owners[drafts[i].owner].push_back(i);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [owner, mine] : owners) groups.push_back(std::move(mine));

  const detail::Work work(mesh, above, options, raising, run);
  std::vector<detail::Roofed> each(groups.size());
  base::parallel_for(groups.size(), [&](std::size_t g) {
    if (!run.cancelled()) each[g] = detail::refine_owner(drafts, groups[g], work.for_owner());
  });
  Refined out;
  std::vector<detail::Piece> pieces;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    auto& one = each[g];
    std::ranges::move(one.pieces, std::back_inserter(pieces));
    std::ranges::move(one.rest.parts, std::back_inserter(out.parts));
    std::ranges::move(one.rest.failed, std::back_inserter(out.failed));
    out.searches.emplace_back(drafts[groups[g].front()].owner, one.search);
  }
  if (options.effort != Effort::caps) detail::make_alike(pieces, work);
  std::vector<std::vector<detail::Piece>> made(pieces.size());
  base::parallel_for(pieces.size(), [&](std::size_t i) { made[i] = work.with_dormers(std::move(pieces[i])); });
  for (auto& piece : std::views::join(made))
    if (auto& raised = piece.raised)  // each has one by now
      out.parts.push_back({drafts[piece.draft_index].owner, piece.draft_index, std::move(piece.roof.plan),
                           *std::move(raised), std::move(piece.changes)});
  std::ranges::stable_sort(out.parts, {}, &Part::draft);
  std::ranges::stable_sort(out.failed, {}, [](const auto& failure) { return failure.first; });
  return out;
}

auto codes() -> std::vector<base::Code> {
  return {{"refine-bound",
           "The search for a building's roofs ended at the bound of its work, which grows with the building; the best "
           "roofs that it had by then are used.",
           "Look at the building. Divide its footprint, or give it fewer corners.", 0},
          {"refine-kind", "The outline of a part takes no roof of this kind.",
           "Choose another roof, or split the part.", 2},
          {"refine-unseen", "A roof was to be fitted to the scan, which does not cover the part.",
           "Give the roof its heights by hand.", 2}};
}

}  // namespace mansard::refine
