// What verbs share: threads, progress and options; of `reconstruct`, `segment` and `explore` meshes and footprints in.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/cli/progress.hpp"
#include "apps/cli/settings.hpp"
#include "mansard/pipeline/inputs.hpp"

namespace mansard::cli {

/// What every verb that measures or makes something has.
struct Common {
  bool overwrite = false, quiet = false;
  std::size_t jobs = 0;
  Settings settings;
};

/// --jobs.
void add_jobs(CLI::App& verb, std::size_t& jobs);
/// --overwrite, --jobs, --quiet ("Print no progress and no " `silenced`) and the options of the modules that the verb
/// reads: of the pipeline, or of a menu of the verb's own.
void add_common(CLI::App& verb, Common& common, const std::string& silenced);
void add_common(CLI::App& verb, Common& common, const std::string& silenced, const Menu& menu);

/// Sets the number of threads. `progress` must outlive the run.
[[nodiscard]] auto start(const Common& common, std::int64_t seed, const base::Cancel& cancel, Progress& progress)
    -> base::Run;

/// A table that is joined to the footprints by their ids.
struct Join {
  std::string table, key;
  void add_to(CLI::App& verb);
  /// Fails with "usage" where one of the two is missing, and as ingest::join. Prints its warnings.
  [[nodiscard]] auto apply(model::Scene& scene, const ingest::Options& options, Progress& progress) const
      -> base::Result<void>;
};

struct ScanRequest : Common {
  std::vector<std::string> inputs;  // meshes, then the footprints
  bool derive_footprints = false;   // then all inputs are meshes
  bool align = false;               // moves the mesh to the footprints
  std::string report;
  std::string ground_attribute;  ///< of the footprints; roof.ground_attribute
  Join join;
  bool verbose = false;
  std::vector<std::string> words;  ///< the whole command line, from which messages make the command to run instead
};

/// Inputs and the options that these verbs share; --derive-footprints where the verb `may_derive`.
void add_to(CLI::App& verb, ScanRequest& request, bool may_derive = true);

/// That the footprints come last, and that there are none where they are to be derived. Fails with "usage", which names
/// the command to run.
[[nodiscard]] auto check_order(const ScanRequest& request) -> base::Result<void>;

/// Fails with "usage" where footprints or meshes are missing, as check_order and as Settings::apply.
[[nodiscard]] auto options_of(const ScanRequest& request) -> base::Result<pipeline::Options>;

/// Whether these files, and the report, can be written there. Fails with "output-input", "output-exists",
/// "file-write".
[[nodiscard]] auto files_free(const ScanRequest& request, std::vector<std::filesystem::path> files)
    -> base::Result<void>;

/// The inputs as meshes and footprints.
[[nodiscard]] auto paths_of(const ScanRequest& request) -> pipeline::InputPaths;
/// Reads meshes and footprints, or derives these from the mesh, and prints the warnings. With --align, the offset of
/// the mesh in the options becomes the one with which it is where the footprints are.
[[nodiscard]] auto read_scan(const ScanRequest& request, pipeline::Options& options, const base::Run& run,
                             Progress& progress) -> base::Result<model::Scene>;
/// The same; a large mesh is in cells on disk.
[[nodiscard]] auto read_city_scan(const ScanRequest& request, pipeline::Options& options, const base::Run& run,
                                  Progress& progress) -> base::Result<ingest::CityScene>;

}  // namespace mansard::cli
