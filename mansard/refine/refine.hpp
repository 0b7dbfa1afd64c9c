// Makes every part's roof the one the scan shows: planes refitted, gables, forms and caps chosen by measured error, and
// what stands on a roof or beside it given a plan of its own, at a price for every face.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine {

/// What is known of a part before the scan is asked as a whole.
struct Draft {
  std::size_t owner = 0;  ///< only parts of one owner are joined: the feature that they belong to
  model::Plan plan;
  std::vector<double> caps;  ///< m above the base, the likeliest first; at least one
  /// Per profile of the plan, others that its edges may carry.
  std::vector<std::vector<model::Profile>> alternatives;
};

struct Part {
  std::size_t owner = 0;
  std::size_t draft = 0;  ///< the draft it was made of; of several that were joined, the first
  model::Plan plan;
  extrude::Raised raised;
  std::vector<std::string> changes;  ///< what was done to the draft, in words
};

/// What the search for the roofs of one owner took.
struct SearchWork {
  std::uint64_t samples = 0, corners = 0;  ///< of the parts that it began with
  std::uint64_t work = 0;                  ///< in units of 10 ns, as docs/decisions/0132-bounded-work.md counts them
  std::uint64_t bound = 0;  ///< the most that it might take, in the same units; 0 where it is not bounded
  bool met_bound = false;   ///< the parts are the best that it had by then
};

struct Refined {
  std::vector<Part> parts;  ///< by draft; of one draft its own remainder first, then what was cut out of it
  std::vector<std::pair<std::size_t, base::Diagnostic>> failed;   ///< drafts that could not be raised, and why
  std::vector<std::pair<std::size_t, SearchWork>> searches = {};  ///< by owner, ascending
};

/// Parts joined where one roof suits both, each given the roof that suits the scan best, and cut where two suit better.
/// Guarantees: 1 every solid is of extrude::raise · 2 the polygons of an owner's parts are simple, disjoint, and cover
/// what its drafts covered, but for gaps under a millimetre that joining closes · 3 the same drafts and mesh give the
/// same parts at any thread count · 4 a draft over which the mesh shows nothing stays as it is.
/// `above`: the mesh with the crowns of trees, where `mesh` is without; a roof that they hide is below them.
/// Cost: some dozens to hundreds of raises a draft. The work of an owner is at most about 100 µs a sample of its parts;
/// a corner counts as 100 samples (docs/decisions/0132-bounded-work.md).
[[nodiscard]] auto refine(std::span<const Draft> drafts, const rays::Scene& mesh, const Options& options,
                          const extrude::Options& raising, const base::Run& run = {},
                          const rays::Scene* above = nullptr) -> Refined;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::refine
