#include "mansard/formats/files/reach.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_http.h>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/address.hpp"
#include "mansard/formats/files/virtual_files.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

/// GDAL's file systems that reach a network (https://gdal.org/user/virtual_file_systems.html), and addresses.
constexpr std::array<std::string_view, 11> remote_names{
    "/vsicurl",  "/vsis3",   "/vsigs",      "/vsiaz", "/vsiadls",          "/vsioss",
    "/vsiswift", "/vsihdfs", "/vsiwebhdfs", "://",    "/vsicurl_streaming"};

auto all_allowed() -> bool {
  const char* value = std::getenv("MANSARD_OUTSIDE");
  return value != nullptr && base::lower(value) == "yes";
}

/// "https://host:port"; empty for what is not on a server.
auto server_of(const std::string& name) -> std::string {
  const auto scheme = name.find("://");
  if (scheme == name.npos) return {};
  const auto from = name.rfind('/', scheme);
  const auto start = from == name.npos ? 0 : from + 1;
  return name.substr(start, name.find_first_of("/?#", scheme + 3) - start);
}

/// A driver's request to a server, which does not pass GDAL's files.
auto fetch(const char* address, CSLConstList options, GDALProgressFunc progress, void* progress_data,
           CPLHTTPFetchWriteFunc write, void* write_data, void* server) -> CPLHTTPResult* {
  const auto& own = *static_cast<const std::string*>(server);
  if (!own.empty() && server_of(address) == own) {
    CPLHTTPPopFetchCallback();
    auto* result = CPLHTTPFetchEx(address, options, progress, progress_data, write, write_data);
    CPLHTTPPushFetchCallback(&fetch, server);
    return result;
  }
  if (auto* reach = crs::GdalReach::current()) reach->refuse(address);
  CPLError(CE_Failure, CPLE_AppDefined,
           "the file refers to a server, and files on disk may not; download what it refers to");
  // Without an answer GDAL would ask its own handler.
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("no network for files on disk");
  return result;
}

auto outside(const fs::path& given, const fs::path& named) -> base::Diagnostic {
  return base::error(
      "ingest-outside",
      "the input '" + shown_name(given) + "' refers to this, which is not in its folder" +
          (is_remote(named) && !is_remote(given) ? " but on a server" : "") +
          "; copy what it refers to into the folder, give that itself as the input, or set MANSARD_OUTSIDE=yes if "
          "the file is to be trusted",
      base::on_one_line(named.string()));
}

/// Where the names lead on the disk. A given file may itself be a link; GDAL then looks beside the file it leads to.
auto stays(const fs::path& given, const fs::path& named) -> bool {
  std::error_code failure;
  const auto here = fs::current_path(failure);
  const auto place = fs::weakly_canonical(here / named, failure);
  if (failure || named.empty()) return false;
  const auto folder = (here / given).parent_path();
  for (const auto& own :
       {fs::weakly_canonical(folder, failure), fs::weakly_canonical(here / given, failure).parent_path()})
    if (!own.empty() && std::mismatch(own.begin(), own.end(), place.begin(), place.end()).first == own.end())
      return true;
  return false;
}

}  // namespace

auto is_remote(const fs::path& path) -> bool {
  const auto name = path.string();
  return is_database(path) ||
         std::ranges::any_of(remote_names, [&](auto part) { return name.find(part) != name.npos; });
}

auto check_reach(const fs::path& given, const fs::path& named) -> base::Result<void> {
  if (all_allowed()) return {};
  if (is_remote(given)) {
    // Files in a bucket have no "://": there the folder decides, as on disk.
    const auto own = server_of(given.string());
    if (!own.empty())
      return is_remote(named) && server_of(named.string()) == own ? base::Result<void>() : outside(given, named);
  } else if (is_remote(named)) {
    return outside(given, named);
  }
  if (named.lexically_normal() == given.lexically_normal()) return {};
  return stays(given, named) ? base::Result<void>() : outside(given, named);
}

Confined::Confined(const fs::path& given) : given_(given) {
  if (all_allowed()) return;
  const auto name = name_for_gdal(given);
  // All of an archive is one folder, and nothing beside it.
  const auto archive = name.starts_with("/vsi") && !is_remote(name) ? archive_of(name).first : fs::path();
  reach_.emplace(name, [given, archive](const std::string& named) {
    return archive.empty() ? bool(check_reach(given, named)) : fs::path(named) == archive;
  });
  server_ = server_of(name);
  // Buckets, and databases, need requests of their own.
  offline_ = !is_remote(given) || !server_.empty();
  if (offline_) CPLHTTPPushFetchCallback(&fetch, &server_);
}

Confined::~Confined() {
  if (offline_) CPLHTTPPopFetchCallback();
}

auto Confined::check() const -> base::Result<void> {
  if (!reach_ || !reach_->refused()) return {};
  return outside(given_, *reach_->refused());
}

}  // namespace mansard::formats
