// The file formats that can be opened and exported, as one list: the page's file choosers, hints and menus are made
// from it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/server/json.hpp"
#include "mansard/base/result.hpp"
#include "mansard/formats/results.hpp"

namespace mansard::server {

/// Formats of openapi.json.
[[nodiscard]] auto formats_json() -> Json;
/// Extensions of compressed files: the format is that of the name without them.
[[nodiscard]] auto compressed_extensions_json() -> Json;

/// Whether the file extension is that of a mesh.
[[nodiscard]] auto has_mesh_extension(const std::filesystem::path& path) -> bool;

/// The files of a format that can be downloaded: "model.obj" and "model.mtl"; of tiles, which are a folder,
/// "model.3dtiles.zip".
[[nodiscard]] auto files_of(formats::Format format) -> std::vector<std::string>;
/// Formats to write, by their names; all of them where none is named. Gives up with "option-value".
[[nodiscard]] auto formats_named(const std::vector<std::string>& names) -> base::Result<std::vector<formats::Format>>;

}  // namespace mansard::server
