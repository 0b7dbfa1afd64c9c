// A picture of the ground from the tiles of a map: on a server, or in a folder.
#pragma once

#include <string>

#include "mansard/base/result.hpp"
#include "mansard/formats/ground_picture.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::formats {

/// Whether the name is that of tiles and not of one raster: an address ("https://…"), a pattern with "{z}", or a folder
/// of folders that zoom levels name.
[[nodiscard]] auto is_ground_tiles(const std::string& name) -> bool;

/// The pattern of the name of a tile, with {z} for the zoom level, {x} for the column, and {y} for the row, counted
/// from the north, or {-y}, counted from the south: "https://…/{z}/{x}/{y}.png", "/maps/{z}/{x}/{y}.jpg". Of a folder,
/// what its tiles are called; rows are counted from the south where it has a tilemapresource.xml (TMS). Paths are made
/// absolute. Fails with "ingest-ground-tiles" where it is no such pattern.
[[nodiscard]] auto ground_tiles_pattern(const std::string& name) -> base::Result<std::string>;

/// The tiles of Web Mercator (EPSG:3857; PNG, JPEG or WebP) that cover a box of `crs`, transformed to it. The zoom
/// level is the finest one with at most `most` pixels along a side that has a tile in the middle of the box; tiles that
/// are missing are transparent. A pattern that is an address is the only thing that makes this use the network, and it
/// sends nothing but the numbers of the tiles. Fails with "ingest-ground-tiles": there are none, what answers is none,
/// or the server does not answer.
[[nodiscard]] auto read_ground_tiles(const std::string& pattern, const std::string& crs, const geometry::Box2& around,
                                     int most) -> base::Result<GroundPicture>;

}  // namespace mansard::formats
