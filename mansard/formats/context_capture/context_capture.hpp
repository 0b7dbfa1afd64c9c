// metadata.xml: what photogrammetry programs write beside a mesh to say where it is.
#pragma once

#include <filesystem>
#include <optional>

#include "mansard/base/result.hpp"
#include "mansard/crs/mesh_crs.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

struct Georeference {
  crs::MeshCrs crs;
  model::InputFile input;
};

/// Looks for metadata.xml in a folder, then in the two above it: ContextCapture has Production/metadata.xml over
/// Production/Data/Tile_…/ (in an archive or on a server, in the folder only). A file of that name with another root
/// element is somebody else's. Nothing where there is none. Fails with "ingest-mesh-metadata" where <SRS> or
/// <SRSOrigin> cannot be understood.
[[nodiscard]] auto georeference_of(const std::filesystem::path& folder) -> base::Result<std::optional<Georeference>>;

}  // namespace mansard::formats
