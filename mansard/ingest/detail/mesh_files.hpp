// From the paths on the command line to one raw mesh.
#pragma once

#include <filesystem>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/ingest/detail/raw_mesh.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::ingest::detail {

struct MeshFiles {
  RawMesh mesh;  ///< of all files, z up, without offset
  std::vector<InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
};

/// Gives up with "ingest-mesh-empty", "ingest-mesh-format", "ingest-mesh-truncated", "ingest-mesh-unusable",
/// "ingest-memory", "file-missing", "file-read", "cancelled".
[[nodiscard]] auto read_meshes(const std::vector<std::filesystem::path>& paths, UpAxis up, const base::Run& run)
    -> base::Result<MeshFiles>;

}  // namespace mansard::ingest::detail
