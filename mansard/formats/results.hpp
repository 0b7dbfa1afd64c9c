// What results are called in a folder, and a whole city as one or more of them.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/formats/stream.hpp"

namespace mansard::formats {

/// One result: a file, a file with its library beside it, or a folder of tiles.
struct Target {
  Format format = Format::cityjson;
  std::filesystem::path path;
};

/// What a format's file is called in a folder of results: model.city.json, plans.json, …
[[nodiscard]] auto name_in_folder(Format format) -> std::string;
[[nodiscard]] auto targets_in(const std::filesystem::path& folder, const std::vector<Format>& formats)
    -> std::vector<Target>;
/// The folder of the images with textures beside a file: "model_obj_textures" beside "model.obj".
[[nodiscard]] auto textures_beside(const std::filesystem::path& file) -> std::filesystem::path;
/// Of formats that have their textures in such a folder, that one.
[[nodiscard]] auto textures_of(const Target& target) -> std::optional<std::filesystem::path>;
/// Whether a folder, no link to one, has nothing in it but images that are named as textures are.
[[nodiscard]] auto holds_textures_only(const std::filesystem::path& folder) -> bool;
/// Every file or folder that there will be: the library of an OBJ too; but for a folder of textures.
[[nodiscard]] auto places_of(const Target& target) -> std::vector<std::filesystem::path>;

/// What came of several targets: what one format cannot hold is not the others' loss.
struct Written {
  std::vector<base::Diagnostic> warnings;  ///< what could not be written as it was meant
  struct Missing {
    Target target;
    base::Diagnostic why;
  };
  std::vector<Missing> missing;  ///< targets of which there will be no file
};

/// One target after the other, since each writer may put bytes aside. `fill` adds all buildings to a writer and
/// finishes it. The files are there after Outputs::commit. Fails as the first target does where there is none of any,
/// and with "cancelled" as `fill`.
[[nodiscard]] auto write_each(const std::vector<Target>& targets, const Header& header, const WriteOptions& options,
                              const std::vector<Layer>& more,
                              const std::function<base::Result<void>(CityWriter&)>& fill, base::Outputs& outputs)
    -> base::Result<Written>;

/// The same with the whole city.
[[nodiscard]] auto write_models(const model::City& city, const std::vector<Target>& targets,
                                const WriteOptions& options, base::Outputs& outputs,
                                const std::vector<Layer>& more = {}) -> base::Result<Written>;

}  // namespace mansard::formats
