// The models of a run as files to take away: in every format that there is, each as `mansard extrude` writes it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/server/json.hpp"
#include "mansard/base/result.hpp"
#include "mansard/formats/results.hpp"

namespace mansard::server {

/// Of the run, before edits: layers for a GIS that say why walls are where they are.
inline constexpr const char* run_layers = "segment.gpkg";

/// What of a format can be fetched: "model.obj" and "model.mtl"; of tiles, which are a folder, "model.3dtiles.zip".
[[nodiscard]] auto files_of(formats::Format format) -> std::vector<std::string>;
/// [{"name", "files", "meaning"}]
[[nodiscard]] auto formats_json() -> Json;
/// By their names; all of them where none is named. Gives up with "option-value".
[[nodiscard]] auto formats_named(const std::vector<std::string>& names) -> base::Result<std::vector<formats::Format>>;

/// The bytes of one such file. `work` is a folder to work in, which is made and taken away again. Gives up as the
/// writers do, and with "server-unknown".
[[nodiscard]] auto exported(const model::City& city, const formats::WriteOptions& options, std::string_view file,
                            const std::filesystem::path& work) -> base::Result<std::string>;

struct Exported {
  std::vector<std::string> files;
  std::vector<base::Diagnostic> warnings;
};
/// All of these formats into a folder, and the run's layers where there are some; what an earlier export left there,
/// and this one does not have, is taken away. All of it or nothing. Gives up as the writers do.
[[nodiscard]] auto export_to(const std::filesystem::path& folder, const model::City& city,
                             const formats::WriteOptions& options, const std::vector<formats::Format>& formats,
                             const std::optional<std::string>& layers) -> base::Result<Exported>;

}  // namespace mansard::server
