// The states of a city that are compared: what is read of a run, or of models of any producer.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mansard/compare/compare.hpp"
#include "mansard/model/city.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/changes.hpp"

namespace mansard::pipeline {

struct StateOptions {
  std::vector<std::filesystem::path> scans;  ///< instead of those that the run names
  bool use_scans = true;
  bool keep_city = false;  ///< StateFiles::city, for models that are written again
};

/// A state, and how it came to be.
struct StateFiles {
  std::filesystem::path path;       ///< as given
  std::filesystem::path models;     ///< the file that was read
  std::optional<model::City> city;  ///< with the models
  compare::State state;             ///< in `frame`
  model::Frame frame;
  bool measured = false;                     ///< the accuracy is that of a run
  bool own = false;                          ///< mansard wrote it
  std::vector<std::filesystem::path> scans;  ///< that were read
  std::vector<model::InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
};

/// Reads a folder of `mansard reconstruct` with its models, their accuracy and, where its files are still as they were,
/// its scan; or one file of models: what mansard wrote, CityJSON, CityJSONSeq, CityGML and OBJ of any producer; or
/// footprints with heights, which are extruded. `options` are for what has to be read or extruded.
/// Fails with "compare-state" (a folder without models), "compare-scan" (a scan that was named and cannot be used) and
/// as the readers do.
[[nodiscard]] auto read_state(const std::filesystem::path& path, const StateOptions& wanted, const Options& options,
                              const base::Run& run = {}) -> base::Result<StateFiles>;

/// What has changed between two states, the old one in the frame of the new one, which both are after it. They must
/// live as long as what is returned. Fails as in_one_frame, and when the run is cancelled.
[[nodiscard]] auto changes_between(StateFiles& old, const StateFiles& now, const compare::Options& options,
                                   const base::Run& run = {}) -> base::Result<report::Changes>;

/// The old state in the frame of the new one. Fails with "compare-crs" (they have different CRS), "compare-overlap".
[[nodiscard]] auto in_one_frame(StateFiles& old, const StateFiles& now) -> base::Result<void>;

}  // namespace mansard::pipeline
