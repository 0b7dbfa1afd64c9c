#include "mansard/solver/solver.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <limits>
#include <new>

#include "mansard/solver/detail/branch_and_cut.hpp"

// CoinUtils throws CoinError, which is no std::exception.
#include <CoinError.hpp>

namespace mansard::solver {
namespace {

auto broken(const Program& program) -> bool {
  const auto number = [](double v) { return !std::isnan(v); };
  const auto bad_variable = [&](const Variable& v) {
    return !std::isfinite(v.cost) || !number(v.least) || !number(v.most);
  };
  const auto bad_row = [&](const Row& row) {
    return !number(row.least) || !number(row.most) || std::ranges::any_of(row.terms, [&](const auto& term) {
      return term.first >= program.variables.size() || !std::isfinite(term.second);
    });
  };
  return !std::isfinite(program.constant) || std::ranges::any_of(program.variables, bad_variable) ||
         std::ranges::any_of(program.rows, bad_row);
}

/// A program without variables asks only whether 0 lies within every row.
auto trivial(const Program& program) -> Solution {
  const bool feasible =
      std::ranges::all_of(program.rows, [](const Row& row) { return row.least <= 0 && 0 <= row.most; });
  if (!feasible) return {};
  return {Status::optimal, {}, program.constant, program.constant, 0};
}

}  // namespace

auto minimise(const Program& program, const Limits& limits, const std::optional<std::vector<double>>& incumbent)
    -> base::Result<Solution> {
  assert(!incumbent || incumbent->size() == program.variables.size());
  if (broken(program)) return base::error("solver-failed", "the program holds a value that is no number");
  if (program.variables.empty()) return trivial(program);
  try {
    Solution solution = detail::branch_and_cut(program, limits, incumbent);
    if (solution.status != Status::infeasible && !std::isfinite(solution.bound) && solution.values.empty())
      return base::error("solver-failed", "the program is unbounded");
    return solution;
  } catch (const CoinError& error) {
    return base::error("solver-failed", error.className() + "::" + error.methodName() + ": " + error.message());
  } catch (const std::bad_alloc&) {
    throw;  // the program is not at fault, and another machine would solve it
  } catch (const std::exception& error) {
    return base::error("solver-failed", error.what());
  }
}

auto codes() -> std::vector<base::Code> {
  return {{"solver-failed", "The integer program solver gave up.",
           "Report the input that led here; the best answer found before is used.", 1},
          {"solver-mps", "An integer program cannot be written as MPS.",
           "Round costs, coefficients and bounds to at most 11 digits; no lower bound may exceed its upper one.", 3}};
}

}  // namespace mansard::solver
