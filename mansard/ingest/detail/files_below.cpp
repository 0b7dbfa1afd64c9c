#include "mansard/ingest/detail/files_below.hpp"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <optional>
#include <string_view>

#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/files/zip_directory.hpp"

namespace mansard::ingest::detail {

namespace fs = std::filesystem;

namespace {

/// What is in a ZIP file on disk, or in a folder of it.
auto in_archive(const fs::path& folder) -> std::optional<std::vector<fs::path>> {
  constexpr std::string_view opener = "/vsizip/";
  const std::string name = folder.string();
  if (!name.starts_with(opener) || name.find("/vsi", opener.size()) != name.npos) return std::nullopt;
  auto [archive, member] = formats::archive_of(name);
  const auto names = archive.empty() ? std::nullopt : formats::names_in_zip(archive);
  if (!names) return std::nullopt;
  if (!member.empty() && !member.ends_with('/')) member += '/';
  std::vector<fs::path> found;
  for (const auto& one : *names)
    if (one.starts_with(member)) found.push_back(folder / one.substr(member.size()));
  return found;
}

}  // namespace

auto files_below(const fs::path& folder) -> base::Result<std::vector<fs::path>> {
  std::vector<fs::path> found;
  if (formats::is_virtual(folder)) {
    if (auto names = in_archive(folder)) return std::move(*names);
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
