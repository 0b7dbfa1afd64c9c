// What is in a vector source, a raster or a tileset, without reading its features, cells or tiles.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// xmin ymin xmax ymax, in the source's coordinates.
using SourceExtent = std::array<double, 4>;

struct SourceLayer {
  std::string name;
  std::string geometry;  ///< as GDAL calls it: "Polygon", "Multi Polygon", "Unknown (any)", "None"
  std::string crs;       ///< "EPSG:n", or the name of another; empty for none
  std::optional<std::int64_t> features;
  std::optional<SourceExtent> extent;
  std::vector<std::pair<std::string, std::string>> fields;  ///< name, type as GDAL calls it
};

struct VectorSource {
  std::string driver;  ///< GDAL's short name of the format
  std::vector<SourceLayer> layers;
};

/// Any OGR vector source. Fails with "file-missing", "ingest-footprints-format".
[[nodiscard]] auto vector_source(const std::filesystem::path& path) -> base::Result<VectorSource>;

struct RasterSource {
  std::string driver, crs, unit;  ///< of the heights, as the file says; empty for nothing said
  std::int64_t columns = 0, rows = 0, bands = 0;
  std::array<double, 2> cell{};  ///< along columns and rows, in units of the CRS
  SourceExtent extent{};
  std::optional<double> nodata;
};

/// Any GDAL raster. Fails with "file-missing", "ingest-raster".
[[nodiscard]] auto raster_source(const std::filesystem::path& path) -> base::Result<RasterSource>;

struct TilesetSource {
  struct Level {
    std::size_t tiles = 0, contents = 0;
    std::optional<double> minimum_error, maximum_error;  ///< m, geometric error; none where no tile has one
  };
  std::string version;  ///< of 3D Tiles; empty for none
  bool placed_on_the_earth = false;
  /// As JSON, as the file has them: of the tileset, and of its root. Empty where they are missing.
  std::string geometric_error, bounding_volume;
  std::vector<Level> levels;  ///< from the root
  std::size_t tilesets = 0;   ///< those within it, at any depth, that could be opened
};

/// A tileset.json, or a folder with one; none where it is not a tileset. Tilesets within it are followed.
[[nodiscard]] auto tileset_source(const std::filesystem::path& path) -> std::optional<TilesetSource>;

/// Whether read_scene takes the file for a raster, by its name.
[[nodiscard]] auto named_as_raster(const std::filesystem::path& path) -> bool;

}  // namespace mansard::formats
