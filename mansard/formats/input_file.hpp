// Which file it was that was read.
#pragma once

#include <filesystem>

#include "mansard/base/result.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// Path, size and SHA-256 of a file as it is now, for comparing with Scene::inputs. Fails with "file-missing",
/// "file-read". Cost: the file is read as a whole.
[[nodiscard]] auto input_file(const std::filesystem::path& path) -> base::Result<model::InputFile>;

}  // namespace mansard::formats
