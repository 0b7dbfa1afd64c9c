// The output folder: nothing is overwritten silently, and files appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/write/write.hpp"

namespace mansard::cli {

/// Checks that the folder is empty or may be overwritten, makes it, and checks that it can be written, before any work.
/// Gives up with "output-exists", "file-write".
[[nodiscard]] auto prepare(const std::filesystem::path& folder, bool overwrite) -> base::Result<void>;

/// Names and contents of the model files: model.city.json, model.obj, model.mtl, model.glb, plans.json.
[[nodiscard]] auto model_files(const write::City& city)
    -> base::Result<std::vector<std::pair<std::string, std::string>>>;

}  // namespace mansard::cli
