// A picture of the ground, such as an aerial photograph or a map, to be shown under models.
#pragma once

#include <filesystem>
#include <string>

#include "mansard/base/result.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::formats {

struct GroundPicture {
  std::string png;       ///< north up; transparent where the raster has nothing
  geometry::Box2 place;  ///< of its edges, in the CRS that was asked for
};

/// Any raster that GDAL reads and that says where it is: GeoTIFF, PNG or JPEG with a world file, a VRT of tiles. It is
/// transformed where it has another CRS than `crs`; a raster without a CRS is taken to be in it. Its longer side
/// becomes at most `most` pixels. Fails with "ingest-raster" (what is wrong), "ingest-outside", "file-missing",
/// "file-read".
[[nodiscard]] auto read_ground_picture(const std::filesystem::path& path, const std::string& crs, int most)
    -> base::Result<GroundPicture>;

}  // namespace mansard::formats
