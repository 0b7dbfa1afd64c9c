#include "mansard/ingest/detail/files_below.hpp"

#include <cpl_string.h>
#include <cpl_vsi.h>

#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/files/virtual_files.hpp"

namespace mansard::ingest::detail {

namespace fs = std::filesystem;

auto files_below(const fs::path& folder) -> base::Result<std::vector<fs::path>> {
  std::vector<fs::path> found;
  if (formats::is_virtual(folder)) {
    const crs::GdalMessages messages;
    const CPLStringList names(VSIReadDirRecursive(folder.string().c_str()));
    for (int i = 0; i < names.size(); ++i) found.push_back(folder / names[i]);
    return found;
  }
  std::error_code failure;
  for (fs::recursive_directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
    std::error_code status;  // a link that leads nowhere is no file, and no end of the folder
    if (at->is_regular_file(status)) found.push_back(at->path());
  }
  if (failure) return base::error("file-read", "cannot list the folder: " + failure.message(), folder.string());
  return found;
}

}  // namespace mansard::ingest::detail
