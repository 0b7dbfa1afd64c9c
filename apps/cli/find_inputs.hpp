// Which of the files in a folder are meshes, and which are the footprints.
#pragma once

#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/pipeline/inputs.hpp"

namespace mansard::cli {

struct FoundInputs {
  pipeline::InputPaths paths;      ///< with derive_footprints where there are none
  std::vector<std::string> notes;  ///< what was found and is left out, a sentence each
};

/// Meshes and footprints by what their names say, in any order; folders are searched, four levels deep. A folder of
/// tiles is one mesh. Files that are named are all taken; of those that are found in a folder, meshes come before point
/// clouds and these before rasters, and a file called "footprints" before other vector files with polygons. Folders of
/// projects and of results are passed over. Fails with "file-missing", "file-read", and "new-inputs" where nothing is
/// found, footprints are alone, or it is not clear which file has the footprints.
[[nodiscard]] auto find_inputs(const std::vector<std::string>& given) -> base::Result<FoundInputs>;

}  // namespace mansard::cli
