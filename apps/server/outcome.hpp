// A run from options to files.
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

/// "error-3.bin": of the map of that number.
[[nodiscard]] auto error_name(std::size_t map) -> std::string;

struct RunOutcome {
  RunRecord record;                                        ///< with the numbers
  std::vector<std::pair<std::string, std::string>> files;  ///< all that the run's folder gets, but for run.json
};

/// Gives up as pipeline::reconstruct does, and with "write-…".
[[nodiscard]] auto reconstruct(const OpenScene& scene, RunRecord record, const base::Run& run)
    -> base::Result<RunOutcome>;

}  // namespace mansard::server
