// Heights on a regular grid, as GDAL reads them: a surface model as a mesh, a terrain model as heights of the ground.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::formats {

/// Whether a file is a raster by its name.
[[nodiscard]] auto is_raster(const std::filesystem::path& path) -> bool;

struct RasterMesh {
  RawMesh mesh;     ///< a vertex per cell with a height, at its centre; coordinates of the raster's CRS, z in metres
  std::string crs;  ///< WKT of the plane part; empty when the raster has none
  std::vector<base::Diagnostic> warnings;
};
/// Two triangles between four neighbouring cells that all have a height, cut along the diagonal that rises less, seen
/// counter-clockwise from above. With `within`, in the raster's coordinates, only that part is read: none of it is an
/// empty mesh. Fails with "ingest-raster" (what is wrong), "file-missing", "file-read"; warns "ingest-raster-bands".
[[nodiscard]] auto read_raster(const std::filesystem::path& path, const std::optional<geometry::Box2>& within)
    -> base::Result<RasterMesh>;

/// Heights of the ground in the local frame around `within` (local frame). Cells are the raster's own where it lies in
/// the frame's CRS, north up, with square cells; else they are as large, and heights are between its four nearest
/// centres. Fails with "ingest-raster" (also where it does not cover any of it), "file-missing", "file-read".
[[nodiscard]] auto read_terrain(const std::filesystem::path& path, const model::Frame& frame,
                                const geometry::Box2& within) -> base::Result<model::HeightGrid>;

}  // namespace mansard::formats
