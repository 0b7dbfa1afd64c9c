#include "mansard/solver/detail/branch_and_cut.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

// CBC's headers do not compile under this project's warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wextra"
#include <CbcCompareDefault.hpp>
#include <CbcHeuristic.hpp>
#include <CbcHeuristicRINS.hpp>
#include <CbcModel.hpp>
#include <CglClique.hpp>
#include <CglGomory.hpp>
#include <CglKnapsackCover.hpp>
#include <CglMixedIntegerRounding2.hpp>
#include <CglProbing.hpp>
#include <OsiClpSolverInterface.hpp>
#pragma GCC diagnostic pop

namespace mansard::solver::detail {
namespace {

auto bound_of(double value) -> double {
  if (value == std::numeric_limits<double>::infinity()) return COIN_DBL_MAX;
  if (value == -std::numeric_limits<double>::infinity()) return -COIN_DBL_MAX;
  return value;
}

void load(OsiClpSolverInterface& clp, const Program& program) {
  const auto count = static_cast<int>(program.variables.size());
  std::vector<double> least, most, cost, row_least, row_most, coefficients;
  std::vector<int> columns;
  std::vector<CoinBigIndex> starts{0};
  for (const Variable& v : program.variables) {
    least.push_back(bound_of(v.least));
    most.push_back(bound_of(v.most));
    cost.push_back(v.cost);
  }
  for (const Row& row : program.rows) {
    for (const auto& [column, coefficient] : row.terms) {
      columns.push_back(static_cast<int>(column));
      coefficients.push_back(coefficient);
    }
    starts.push_back(static_cast<CoinBigIndex>(columns.size()));
    row_least.push_back(bound_of(row.least));
    row_most.push_back(bound_of(row.most));
  }
  // Row by row would copy the matrix for each.
  const CoinPackedMatrix matrix(false, count, static_cast<int>(program.rows.size()), starts.back(), coefficients.data(),
                                columns.data(), starts.data(), nullptr);
  clp.loadProblem(matrix, least.data(), most.data(), cost.data(), row_least.data(), row_most.data());
  for (int i = 0; i < count; ++i)
    if (program.variables[static_cast<std::size_t>(i)].whole) clp.setInteger(i);
}

void add_cuts(CbcModel& model) {
  CglProbing probing;
  probing.setUsingObjective(1);
  probing.setMaxPass(1);
  probing.setMaxPassRoot(2);
  probing.setMaxProbe(10);
  probing.setMaxProbeRoot(50);
  probing.setMaxLook(10);
  probing.setMaxLookRoot(50);
  probing.setMaxElements(200);
  probing.setRowCuts(3);
  CglGomory gomory;
  gomory.setLimit(300);
  CglKnapsackCover knapsack;
  CglMixedIntegerRounding2 rounding;
  CglClique clique;
  clique.setStarCliqueReport(false);
  clique.setRowCliqueReport(false);
  // −98: used at the root, and below it as often as it proved useful there.
  model.addCutGenerator(&probing, -98, "probing");
  model.addCutGenerator(&gomory, -98, "gomory");
  model.addCutGenerator(&knapsack, -98, "knapsack");
  model.addCutGenerator(&clique, -98, "clique");
  model.addCutGenerator(&rounding, -98, "rounding");
}

}  // namespace

auto branch_and_cut(const Program& program, const Limits& limits, const std::optional<std::vector<double>>& incumbent)
    -> Solution {
  const auto count = static_cast<int>(program.variables.size());
  OsiClpSolverInterface clp;
  clp.messageHandler()->setLogLevel(0);
  clp.setHintParam(OsiDoReducePrint, true, OsiHintTry);
  load(clp, program);

  CbcModel model(clp);
  model.messageHandler()->setLogLevel(0);
  model.setLogLevel(0);
  model.solver()->messageHandler()->setLogLevel(0);
  model.setPrintingMode(0);
  model.setPrintFrequency(0);
  model.setNumberThreads(0);
  model.setRandomSeed(1);
  model.setUseElapsedTime(true);
  model.setAllowableGap(limits.gap);
  model.setAllowableFractionGap(0);
  if (limits.seconds) model.setMaximumSeconds(std::max(0.0, *limits.seconds));
  constexpr std::int64_t most_nodes = std::numeric_limits<int>::max();
  if (limits.nodes) model.setMaximumNodes(static_cast<int>(std::clamp<std::int64_t>(*limits.nodes, 0, most_nodes)));

  add_cuts(model);
  CbcRounding round(model);
  model.addHeuristic(&round, "rounding");
  CbcHeuristicRINS neighbourhood(model);
  neighbourhood.setHowOften(100);
  model.addHeuristic(&neighbourhood, "neighbourhood");
  // Strong branching and zero-half cuts were seen to cost two to three times the time they save on segmentations.
  model.setNumberStrong(0);
  CbcCompareDefault order;
  model.setNodeComparison(order);

  const auto cost_of = [&](const double* values) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += program.variables[static_cast<std::size_t>(i)].cost * values[i];
    return sum;
  };
  model.initialSolve();
  Solution solution;
  if (model.solver()->isProvenPrimalInfeasible()) return solution;
  const double relaxed =
      model.solver()->isProvenOptimal() ? model.solver()->getObjValue() : -std::numeric_limits<double>::infinity();
  // Only now: the incumbent's cutoff would make the relaxation itself look infeasible where nothing is better.
  if (incumbent) model.setBestSolution(incumbent->data(), count, cost_of(incumbent->data()), false);
  model.branchAndBound();

  solution.nodes = model.getNodeCount();
  // Where nothing beats the incumbent, CBC may finish, or stop, without a solution of its own.
  const double* best = model.bestSolution();
  if (best == nullptr && incumbent) best = incumbent->data();
  const bool finished = model.status() == 0;
  if (finished && best == nullptr) return solution;

  if (best != nullptr) {
    solution.values.assign(best, best + count);
    for (int i = 0; i < count; ++i)
      if (program.variables[static_cast<std::size_t>(i)].whole)
        solution.values[static_cast<std::size_t>(i)] = std::round(best[i]);
    solution.objective = cost_of(solution.values.data());
  }
  solution.status = finished ? Status::optimal : Status::stopped;
  // A finished search proves its point up to the allowed gap; one that was stopped proves what CBC says of its open
  // nodes, or the relaxation where it never came to open one (CBC answers ±1e50 then).
  double proven = model.getBestPossibleObjValue();
  if (finished) proven = std::max(limits.gap > 0 ? proven : solution.objective, solution.objective - limits.gap);
  if (!(std::abs(proven) < 1e40)) proven = relaxed;
  proven = std::max(proven, relaxed);
  solution.bound = best != nullptr ? std::min(proven, solution.objective) : proven;
  solution.objective += program.constant;
  solution.bound += program.constant;
  return solution;
}

}  // namespace mansard::solver::detail
