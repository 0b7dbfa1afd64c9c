// How much each parameter matters: every option of the pipeline halved and doubled, one at a time.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lab/explore/explore.hpp"

namespace mansard::explore {

/// The parameters that patterns name ("sweep.*", "sweep.gamma", "gamma"), each with the values to try: numbers halved
/// and doubled, within their range; flags and choices: every other value. Without patterns: all of the modules that a
/// reconstruction decides by. Left out are texts, numbers without a value, and values that are the one they have.
/// Fails with "explore-axis" where a pattern names nothing.
[[nodiscard]] auto parameters_of(const std::vector<std::string>& patterns, const pipeline::Options& options)
    -> base::Result<std::vector<Axis>>;

/// What one run gave. Without a key it is the run that the others are compared with.
struct Trial {
  std::string dataset, key, value;
  double rmse = 0, rmse_inside = 0;  ///< m, model against scan, over the footprints and inside them
  std::size_t faces = 0, parts = 0;  ///< of all models
  double cpu_seconds = 0;            ///< of the whole reconstruction, without reading and writing
  std::string models;                ///< a digest of all models, but for how they were made
  std::string failure;               ///< why there is nothing, if so
};

struct SensitivityRequest {
  std::vector<Dataset> datasets;
  std::vector<Axis> parameters;
  pipeline::Options options;
  std::vector<Trial> known;                   ///< of an earlier run with the same options and version: not run again
  std::function<void(const Trial&)> on_done;  ///< after each run, one at a time
  std::vector<std::string> command;           ///< the words of the command line, told in the report
  std::string version;
};

/// Trials as text. The head tells what makes them comparable: version and options.
[[nodiscard]] auto trials_head(const SensitivityRequest& request) -> std::string;
[[nodiscard]] auto trial_line(const Trial& trial) -> std::string;
/// The whole lines under that head; none under another one.
[[nodiscard]] auto trials_from(std::string_view text, const SensitivityRequest& request) -> std::vector<Trial>;

/// One parameter at one value on all datasets.
struct Effect {
  std::string key, value, usual;
  std::vector<Trial> trials;  ///< as Sensitivity::usual; without a dataset's trial an empty one
  /// The largest relative change of either error and of the number of faces, over the datasets.
  double largest = 0;
  bool none = true;  ///< the models are the same bytes on every dataset
};

struct Sensitivity {
  std::vector<Trial> usual;     ///< per dataset, with the options of the request
  std::vector<Effect> effects;  ///< parameter by parameter, the one with the largest effect first
  std::string command, version;
};

/// Runs are independent of each other and share the threads. Guarantees: 1 every parameter has an effect for each of
/// its values · 2 an effect is `none` only where no run failed and all models are equal · 3 the same request gives the
/// same answer but for seconds. Fails with "cancelled", and as ingest::read_scene where a dataset cannot be read.
[[nodiscard]] auto sensitivity(const SensitivityRequest& request, const base::Run& run = {})
    -> base::Result<Sensitivity>;

/// Puts trials together; those of a parameter at the value that it has anyway are the comparison's own.
[[nodiscard]] auto effects_of(const std::vector<Trial>& usual, const std::vector<Trial>& trials,
                              const std::vector<Axis>& parameters, const pipeline::Options& options)
    -> std::vector<Effect>;

/// index.html (complete without a network and without scripts), results.json and results.csv: names and bytes.
[[nodiscard]] auto report(const Sensitivity& result) -> std::vector<std::pair<std::string, std::string>>;

}  // namespace mansard::explore
