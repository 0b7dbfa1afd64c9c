// A run, from its options to its files.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "apps/server/project.hpp"
#include "apps/server/scene.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::server {

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
