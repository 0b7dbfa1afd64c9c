// What `reconstruct` and `segment` share: meshes and footprints in, options of every room.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/cli/progress.hpp"
#include "apps/cli/settings.hpp"

namespace mansard::cli {

struct ScanRequest {
  std::vector<std::string> inputs;  // meshes, then the footprints
  std::string report;
  bool overwrite = false, quiet = false, verbose = false;
  std::size_t jobs = 0;
  Settings settings;
};

/// Inputs and the options that every room and both verbs have.
void add_to(CLI::App& verb, ScanRequest& request);

/// Gives up with "usage" where footprints or meshes are missing, and as Settings::apply.
[[nodiscard]] auto options_of(const ScanRequest& request) -> base::Result<pipeline::Options>;

/// Whether these files, and the report, can be written there. Gives up with "output-input", "output-exists",
/// "file-write".
[[nodiscard]] auto files_free(const ScanRequest& request, std::vector<std::filesystem::path> files)
    -> base::Result<void>;

/// Sets the number of threads. `progress` must outlive the run.
[[nodiscard]] auto start(const ScanRequest& request, const pipeline::Options& options, const base::Cancel& cancel,
                         Progress& progress) -> base::Run;

/// Reads meshes and footprints and says their warnings.
[[nodiscard]] auto read_scan(const ScanRequest& request, const pipeline::Options& options, const base::Run& run,
                             Progress& progress) -> base::Result<ingest::Scene>;

}  // namespace mansard::cli
