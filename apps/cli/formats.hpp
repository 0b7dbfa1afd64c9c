// Models in every format that there is: which ones a command line asks for, where they go, and their writing.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/formats/layers.hpp"
#include "mansard/formats/results.hpp"

namespace mansard::cli {

/// What can be read as each kind of input, in words for help and messages.
struct ReadableFormats {
  std::string meshes, footprints;
  std::string models;      ///< of any producer
  std::string own_models;  ///< with plans: what mansard wrote
};
[[nodiscard]] auto readable_formats() -> const ReadableFormats&;

using formats::name_in_folder;
using formats::places_of;
using formats::Target;
using formats::targets_in;
using formats::write_models;

/// The file extensions of all formats: ".city.json, .city.jsonl, …".
[[nodiscard]] auto extensions() -> std::string;
/// Fails with "option-value".
[[nodiscard]] auto format_named(const std::string& name) -> base::Result<formats::Format>;
/// "cityjson,glb", "all", or "default" for what a folder of results has when nothing is said; in the order of
/// formats::formats(), each once. Fails with "option-value".
[[nodiscard]] auto formats_in(const std::string& list) -> base::Result<std::vector<formats::Format>>;
inline constexpr auto default_formats = "cityjson,obj,glb,geopackage,plans";
/// The meaning of the option --formats.
inline constexpr auto formats_help = "Formats of the models: a list with commas, or 'all'";

/// Every name that a folder of results may have: of any format, the report, pictures.
[[nodiscard]] auto all_results() -> const std::vector<std::string>&;
/// By the file extension. Fails with "usage" where no format has it.
[[nodiscard]] auto target_at(const std::filesystem::path& path) -> base::Result<Target>;

/// That a mesh does not have the place of the model, nor the model that of a mesh, where their names leave no doubt:
/// `model` is at its place, `other` at that of a mesh. `call` is how the verb is called. Fails with "usage".
[[nodiscard]] auto check_model_place(const std::filesystem::path& model, const std::filesystem::path& other,
                                     const std::string& call) -> base::Result<void>;

/// What mansard wrote, by formats::read_city; a missing file is told as one whatever it is called. Fails with
/// "file-missing" and as that does.
[[nodiscard]] auto open_city(const std::filesystem::path& path) -> base::Result<std::unique_ptr<formats::CityReader>>;

/// What the input has beside its city, for those of the results that have a place for it: GeoPackages. Where none has,
/// one warning names what stays behind. Fails as CityReader::beside does.
[[nodiscard]] auto layers_beside(formats::CityReader& reader, const std::string& input,
                                 const std::vector<Target>& targets) -> base::Result<formats::Beside>;

/// As file_free, and of tiles: a folder that is not there, empty, or with `overwrite` an older tileset and nothing else
/// that would be lost. Fails with "output-exists", "file-write".
[[nodiscard]] auto target_free(const Target& target, bool overwrite) -> base::Result<void>;

/// Targets of which there is no file, because the models cannot be written as their format needs it.
using Missing = std::vector<formats::Written::Missing>;
/// Why there is no file of each, with the command that makes it from one of `sources`, the first that can be read back.
[[nodiscard]] auto reasons_of(const Missing& missing, const std::vector<Target>& sources)
    -> std::vector<base::Diagnostic>;
/// One file as a whole.
[[nodiscard]] auto write_bytes(const std::filesystem::path& path, std::string_view bytes, base::Outputs& outputs)
    -> base::Result<void>;

}  // namespace mansard::cli
