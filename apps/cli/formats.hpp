// Models in every format that there is: which ones a command line asks for, where they go, and their writing.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/write/stream.hpp"

namespace mansard::cli {

/// One result: a file, a file with its library beside it, or a folder of tiles.
struct Target {
  write::Format format = write::Format::cityjson;
  std::filesystem::path path;
};

/// The names of all formats: "cityjson, cityjsonseq, obj, …".
[[nodiscard]] auto format_names() -> std::string;
/// And their endings: ".city.json, .city.jsonl, …".
[[nodiscard]] auto endings() -> std::string;
/// Gives up with "option-value".
[[nodiscard]] auto format_named(const std::string& name) -> base::Result<write::Format>;
/// "cityjson,glb", "all", or "default" for what a folder of results has when nothing is said; in the order of
/// write::formats(), each once. Gives up with "option-value".
[[nodiscard]] auto formats_in(const std::string& list) -> base::Result<std::vector<write::Format>>;
inline constexpr auto default_formats = "cityjson,obj,glb,geopackage,plans";
/// What the option --formats says of itself.
[[nodiscard]] auto formats_help() -> std::string;

/// What a format's file is called in a folder of results: model.city.json, plans.json, …
[[nodiscard]] auto name_in_folder(write::Format format) -> std::string;
[[nodiscard]] auto targets_in(const std::filesystem::path& folder, const std::vector<write::Format>& formats)
    -> std::vector<Target>;
/// Every name that a folder of results may have: of any format, the report, pictures.
[[nodiscard]] auto all_results() -> const std::vector<std::string>&;
/// By the ending of its name. Gives up with "usage" where no format has it.
[[nodiscard]] auto target_at(const std::filesystem::path& path) -> base::Result<Target>;

/// What mansard wrote, by write::read_city; a missing file is told as one whatever it is called. Gives up with
/// "file-missing" and as that does.
[[nodiscard]] auto open_city(const std::filesystem::path& path) -> base::Result<std::unique_ptr<write::CityReader>>;

/// Every file or folder that there will be: the library of an OBJ too.
[[nodiscard]] auto places_of(const Target& target) -> std::vector<std::filesystem::path>;
/// As file_free, and of tiles: a folder that is not there, empty, or with `overwrite` an older tileset and nothing else
/// that would be lost. Gives up with "output-exists", "file-write".
[[nodiscard]] auto target_free(const Target& target, bool overwrite) -> base::Result<void>;

using Writers = std::vector<std::unique_ptr<write::CityWriter>>;
/// One writer per target, in order. Gives up as write::open_writer does.
[[nodiscard]] auto open_writers(const std::vector<Target>& targets, const write::Header& header,
                                const write::WriteOptions& options, base::Outputs& outputs,
                                const std::vector<write::Layer>& more = {}) -> base::Result<Writers>;
/// The whole city to every target; the files are there after Outputs::commit. What could not be written as it was meant,
/// as warnings. Gives up as the writers do.
[[nodiscard]] auto write_models(const write::City& city, const std::vector<Target>& targets,
                                const write::WriteOptions& options, base::Outputs& outputs,
                                const std::vector<write::Layer>& more = {})
    -> base::Result<std::vector<base::Diagnostic>>;
/// One file as a whole.
[[nodiscard]] auto write_bytes(const std::filesystem::path& path, std::string_view bytes, base::Outputs& outputs)
    -> base::Result<void>;

}  // namespace mansard::cli
