// Integer programs, solved by CBC, which no other module includes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"

namespace mansard::solver {

struct Variable {
  double cost = 0;
  double least = 0, most = 1;
  bool whole = true;
};

/// least ≤ Σ coefficient · variable ≤ most.
struct Row {
  std::vector<std::pair<std::uint32_t, double>> terms;
  double least = 0, most = 0;
};

/// Minimise Σ cost · x + constant.
struct Program {
  std::vector<Variable> variables;
  std::vector<Row> rows;
  double constant = 0;
};

enum class Status : std::uint8_t { optimal, stopped, infeasible };

struct Limits {
  std::optional<double> seconds;
  std::optional<std::int64_t> nodes;
  double gap = 0;  ///< stop when (objective − bound) is at most this, absolute
};

struct Solution {
  Status status = Status::infeasible;
  std::vector<double> values;  ///< of the best point found; empty when there is none
  double objective = 0;        ///< of that point
  double bound = 0;            ///< no point is cheaper than this (proven)
  std::int64_t nodes = 0;
};

/// One thread, fixed order: the same program gives the same solution. `incumbent`, when given, must be feasible.
/// Fails with "solver-failed".
[[nodiscard]] auto minimise(const Program& program, const Limits& limits,
                            const std::optional<std::vector<double>>& incumbent = std::nullopt)
    -> base::Result<Solution>;

/// The program as strict fixed-column MPS, which every solver reads: variables X0000000 …, rows R0000000 …, objective
/// COST with the constant as its negative right-hand side; rows without bounds are left out. Numbers keep their value
/// exactly, by their shortest text; whole ones below 10¹¹ always fit. `name` is cut to 8 letters and digits. Fails
/// with "solver-mps" where a number is not finite or needs more than 12 columns, bounds cross, a row's two bounds have
/// no exact difference, a term's variable does not exist, or there are more than 10⁷ variables or rows.
[[nodiscard]] auto mps(const Program& program, std::string_view name) -> base::Result<std::string>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::solver
