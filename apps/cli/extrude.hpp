// What the two halves of `mansard extrude` share: one raises plans again, the other footprints without a mesh.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/made.hpp"
#include "apps/cli/run_folder.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/terrain.hpp"
#include "mansard/base/run.hpp"
#include "mansard/formats/layers.hpp"

namespace mansard::cli {

struct ExtrudeRequest {
  std::string input, out, report, formats;
  bool overwrite = false, picture = false, quiet = false, verbose = false, no_resume = false;
  std::size_t jobs = 0;
  Join join;
  TerrainOut terrain;
  Settings settings;
};

/// Whatever may be wrong with the outputs, before any work. Fails with "output-…", "file-write".
[[nodiscard]] auto check_outputs(const ExtrudeRequest& request) -> base::Result<void>;

/// What the outputs are. Fails with "usage", "option-value".
[[nodiscard]] auto targets_of(const ExtrudeRequest& request) -> base::Result<std::vector<Target>>;

/// Locks the output until the end of the run; null where that is a database. Fails as RunFolder::open does.
[[nodiscard]] auto open_run(const ExtrudeRequest& request) -> base::Result<std::unique_ptr<RunFolder>>;

/// The models as OUT and --formats ask for them, with a picture if asked for; what there is no file of. `more` are
/// layers for a GeoPackage beside those of the city.
[[nodiscard]] auto write_out(const model::City& city, const pipeline::Options& options, const ExtrudeRequest& request,
                             const base::Run& run, const std::vector<formats::Layer>& more = {})
    -> base::Result<Missing>;

/// The same of a run over `scene`, with its report in a folder and where --report says. For a picture, all models are
/// in memory.
[[nodiscard]] auto write_out(const Made& made, const model::Scene& scene, const pipeline::Options& options,
                             const ExtrudeRequest& request, const base::Run& run, Progress& progress)
    -> base::Result<Missing>;

/// `mansard extrude FOOTPRINTS -o OUT`; the exit code.
[[nodiscard]] auto extrude_footprints(const ExtrudeRequest& request, const base::Cancel& cancel) -> int;

}  // namespace mansard::cli
