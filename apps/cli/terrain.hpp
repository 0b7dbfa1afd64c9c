// `--terrain-out FILE...`: the terrain around the models of a run.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/cli/made.hpp"
#include "mansard/formats/results.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::cli {

struct TerrainOut {
  std::vector<std::string> files;

  void add_to(CLI::App& verb);
  [[nodiscard]] auto asked() const -> bool { return !files.empty(); }
  /// By the file extensions. Fails with "terrain-format".
  [[nodiscard]] auto targets() const -> base::Result<std::vector<Target>>;
  /// Whether the files can be written, beside the results of the run. Fails with "usage", "output-…", "terrain-format".
  [[nodiscard]] auto check(const std::vector<std::filesystem::path>& results,
                           const std::vector<std::filesystem::path>& inputs, bool overwrite) const
      -> base::Result<void>;
  /// The files are there after Outputs::commit. Fails as terrain::make and formats::write_terrain do.
  [[nodiscard]] auto write(const Made& made, const model::Scene& scene, const ingest::MeshCells* cells,
                           const pipeline::Options& options, base::Outputs& outputs, const base::Run& run,
                           Progress& progress) const -> base::Result<void>;
};

}  // namespace mansard::cli
