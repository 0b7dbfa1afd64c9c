// A run, from its options to its files.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/server/project.hpp"
#include "apps/server/scene.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/evaluate/evaluate.hpp"

namespace mansard::server {

/// The scores of blocks as those of the run.
[[nodiscard]] auto scores_of(const evaluate::Scores& scores) -> RunScores;
[[nodiscard]] auto scores_of(const std::vector<std::shared_ptr<const evaluate::Comparison>>& blocks) -> RunScores;
/// The values of an error map as bytes.
[[nodiscard]] auto bytes_of(const std::vector<float>& values) -> std::string;

/// File name of an error map: "error-3.bin".
[[nodiscard]] auto error_name(std::size_t map) -> std::string;

struct RunOutcome {
  RunRecord record;                                        ///< with scores, times and counts
  std::vector<std::pair<std::string, std::string>> files;  ///< all files of the run's folder except run.json
};

/// Sets the numbers of buildings, parts and faces of a run.
void count_models(const std::vector<report::BuildingReport>& reports, const model::City& city, RunRecord& record);

/// Fails as pipeline::reconstruct does, and with "write-…".
[[nodiscard]] auto reconstruct(const OpenScene& scene, RunRecord record, const base::Run& run)
    -> base::Result<RunOutcome>;

}  // namespace mansard::server
