// The best roof over a fixed outline.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

enum class Search : std::uint8_t {
  settled,   ///< the draft's own form, settled: for what is left of a roof that was searched before
  quick,     ///< the forms as they are and the best of them settled: to tell whether it is worth searching
  thorough,  ///< edge by edge as well
};

/// From the draft with its caps over the common forms to the cheapest that was found. `changed`: words about what was
/// done. The search ends early where it is clear that the roof will cost more than it is `worth`. `found`: by a quicker
/// search, so that none is dearer; may be null. Gives up where not even the draft can be raised.
[[nodiscard]] auto best_roof(const Draft& draft, const Judge& judge, Search search, double worth, const Judged* found,
                             std::vector<std::string>& changed) -> base::Result<Judged>;

}  // namespace mansard::refine::detail
