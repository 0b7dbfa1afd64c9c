// Writes what is known of a scan: a field on a grid as GeoTIFF, and a mesh with a class per triangle as PLY or GLB.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/frame.hpp"
#include "mansard/model/surfaces.hpp"

namespace mansard::formats {

/// One value per cell.
struct Raster {
  geometry::Point2 centre;  ///< of cell (0, 0), the south-west one; local frame, metres
  double cell = 1;          ///< m
  std::size_t columns = 0, rows = 0;
  std::span<const float> values;  ///< row by row from the south; NaN for none
};

/// The bytes of a GeoTIFF: one band of 32-bit floats, deflated, north up, NaN as its value for nothing, in the frame's
/// file coordinates and CRS. The same raster gives the same bytes. Fails with "write-geotiff" (no cells, or the
/// library's words).
[[nodiscard]] auto geotiff(const Raster& raster, const model::Frame& frame) -> base::Result<std::string>;

/// Binary PLY in file coordinates: vertices as doubles, per face `class` (uchar: 0 wall, 1 roof, 2 ground, 3 other).
[[nodiscard]] auto labelled_ply(const geometry::Mesh& mesh, std::span<const model::SurfaceClass> classes,
                                const model::Frame& frame) -> std::string;

/// Binary glTF 2.0, y up, single precision around the origin (kept in asset.extras): one mesh with a primitive and a
/// named, coloured material per class that occurs. Fails with "write-glb-size".
[[nodiscard]] auto labelled_glb(const geometry::Mesh& mesh, std::span<const model::SurfaceClass> classes,
                                const model::Frame& frame) -> base::Result<std::string>;

}  // namespace mansard::formats
