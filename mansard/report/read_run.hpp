// What run.json says: for later runs, and for the report of the run.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/accuracy.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::report {

struct EarlierRun {
  std::vector<model::InputFile> inputs;
  std::vector<std::pair<std::string, std::string>> options;  ///< module.name → value
  std::optional<model::Accuracy> accuracy;                   ///< of its scan
};
/// Members that are missing or of another type are left out. Fails with "report-run" where it is no JSON object.
[[nodiscard]] auto read_run(std::string_view json, const std::string& subject) -> base::Result<EarlierRun>;

/// An error over cells: a mean square, m², and of how many cells.
struct MeanSquare {
  double mse = 0;
  double cells = 0;
};
/// The scores of a block or of a run, as run.json has them; what is missing there is absent.
struct RunScores {
  std::optional<MeanSquare> vertical, footprint, inside, inside_each;
  std::optional<double> median, median_absolute, p95_absolute;                         ///< m
  std::optional<double> footprint_median_absolute, inside_median, inside_each_median;  ///< m, absolute
  std::optional<double> missed, invented;                                              ///< m²
};
/// A building of run.json.
struct RunBuilding {
  std::string id, outcome;
  std::vector<std::pair<std::string, std::string>> reasons;  ///< code and message
  std::optional<double> right;                               ///< probability
  std::optional<double> error, rmse;                         ///< m
};
struct RunFile : EarlierRun {
  std::string version, crs;
  std::array<std::int64_t, 3> origin{0, 0, 0};
  std::map<std::string, std::size_t, std::less<>> counts;
  std::map<std::string, std::pair<std::size_t, std::string>, std::less<>> warnings;  ///< code → how many, the first
  std::optional<RunScores> scores;
  std::vector<RunScores> blocks;
};
/// All of run.json but for its buildings, each of which `visit` is given, in their order. Memory: two numbers for each
/// block, and one building at a time. Fails with "file-missing", "file-read", and with "report-run" where it is no
/// report of models.
[[nodiscard]] auto read_run_file(const std::filesystem::path& path, const std::function<void(RunBuilding)>& visit)
    -> base::Result<RunFile>;

/// What has changed since another state.
struct Changed {
  std::string since;                                           ///< the old state; empty: unknown
  std::vector<std::pair<std::string, std::size_t>> by_kind;    ///< in the words of `mansard compare`
  std::vector<std::pair<std::string, std::size_t>> kept_from;  ///< an earlier run, and how many of its models were kept
};
/// Of changes.json of `mansard compare`. Fails with "report-changes".
[[nodiscard]] auto read_changed(std::string_view json, const std::string& subject) -> base::Result<Changed>;

}  // namespace mansard::report
