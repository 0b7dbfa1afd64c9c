// What `mansard info` reports of a file: JSON, from which its text is made. docs/cli.md lists the members.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "mansard/base/run.hpp"
#include "mansard/cloud/classes.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/formats/terrain.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::cli {

using Json = nlohmann::ordered_json;

/// xmin ymin zmin xmax ymax zmax in file coordinates, metres; null for nothing.
class Extent3 {
 public:
  void add(geometry::Point3 p, const model::Frame& frame);
  [[nodiscard]] auto json() const -> Json;

 private:
  geometry::Box3 box_;
};

/// A file of models that mansard wrote. `all_options`: those at their defaults too.
[[nodiscard]] auto info_of_city(const std::filesystem::path& path, formats::CityReader& reader, bool all_options,
                                const base::Run& run) -> base::Result<Json>;

/// {"version", "options_not_default", "inputs"}; "options" of `all_options`.
[[nodiscard]] auto made_by_json(const model::MadeBy& made_by, bool all_options) -> Json;

/// Anything else: models of other producers, STL, tilesets, meshes, point clouds, rasters, footprint sources. `why`:
/// why mansard did not write it. `classes`: what the classes of points are taken for.
[[nodiscard]] auto info_of_other(const std::filesystem::path& path, const base::Diagnostic& why, bool all_options,
                                 const cloud::ClassMap& classes, const base::Run& run) -> base::Result<Json>;

/// What a tileset.json has: its version, and per level how many tiles and what geometric errors; null where there is
/// none in the folder.
[[nodiscard]] auto info_of_tileset(const std::filesystem::path& path) -> Json;

/// A CityJSON with terrain and no buildings.
[[nodiscard]] auto info_of_terrain(const std::filesystem::path& path, const formats::TerrainInfo& terrain,
                                   bool all_options) -> Json;

/// The layers of a vector source, with geometry, CRS, number of features, extent and fields. Fails with
/// "file-missing", "ingest-footprints-format".
[[nodiscard]] auto info_of_layers(const std::filesystem::path& path) -> base::Result<Json>;

/// For a person, within 80 columns.
[[nodiscard]] auto info_text(const Json& info) -> std::string;

}  // namespace mansard::cli
