// The table of drivers as the page needs it: for its file choosers, hints and menus.
#pragma once

#include <string>
#include <vector>

#include "apps/server/json.hpp"
#include "mansard/base/result.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/results.hpp"

namespace mansard::server {

/// Formats of openapi.json.
[[nodiscard]] auto formats_json() -> Json;
/// Extensions of compressed files: the format is that of the name without them.
[[nodiscard]] auto compressed_extensions_json() -> Json;

/// The files of a format that can be downloaded: "model.obj" and "model.mtl"; of tiles, which are a folder,
/// "model.3dtiles.zip".
[[nodiscard]] auto files_of(formats::Format format) -> std::vector<std::string>;
/// Every format that is written.
[[nodiscard]] auto written_formats() -> std::vector<formats::Format>;
/// Formats to write, by their names; all of them where none is named. Fails with "option-value".
[[nodiscard]] auto formats_named(const std::vector<std::string>& names) -> base::Result<std::vector<formats::Format>>;

}  // namespace mansard::server
