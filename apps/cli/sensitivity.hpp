// `mansard explore sensitivity`: every parameter halved and doubled.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/cli/scan.hpp"
#include "lab/explore/explore.hpp"

namespace mansard::cli {

/// Runs the study's datasets with each of the parameters and writes the report into `out`. Runs that runs.csv in that
/// folder has, of the same options, are not made again. Returns the exit code.
[[nodiscard]] auto explore_sensitivity(const ScanRequest& scan, const explore::Request& study,
                                       const std::vector<std::string>& parameters, const std::filesystem::path& out,
                                       const base::Cancel& cancel) -> int;

}  // namespace mansard::cli
