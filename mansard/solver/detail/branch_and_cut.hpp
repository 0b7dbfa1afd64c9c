// CBC, configured for programs of many small rows: the only place that knows its types.
#pragma once

#include <optional>
#include <vector>

#include "mansard/solver/solver.hpp"

namespace mansard::solver::detail {

/// May throw what the library throws. Precondition: the program has a variable, and its indices are in range.
[[nodiscard]] auto branch_and_cut(const Program& program, const Limits& limits,
                                  const std::optional<std::vector<double>>& incumbent) -> Solution;

}  // namespace mansard::solver::detail
