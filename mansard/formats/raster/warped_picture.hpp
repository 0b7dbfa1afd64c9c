// What gdal_translate and gdalwarp do, for pictures of the ground.
#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

#include "mansard/formats/ground_picture.hpp"

namespace mansard::formats {

/// As gdal_translate and gdalwarp do it; null where they fail.
[[nodiscard]] auto translated(GDALDataset& from, const std::string& to, const std::vector<std::string>& words)
    -> GDALDatasetUniquePtr;
[[nodiscard]] auto warped(GDALDataset& from, const std::vector<std::string>& words) -> GDALDatasetUniquePtr;

/// As PNG, with its longer side at most `most` pixels; without a PNG where it cannot be read. The dataset is north up.
[[nodiscard]] auto ground_picture_of(GDALDataset& dataset, int most) -> GroundPicture;

}  // namespace mansard::formats
