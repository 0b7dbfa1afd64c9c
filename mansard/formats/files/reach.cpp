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

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

/// GDAL's file systems that reach a network (https://gdal.org/user/virtual_file_systems.html), and addresses.
constexpr std::array<std::string_view, 11> remote_names{
    "/vsicurl",  "/vsis3",   "/vsigs",      "/vsiaz", "/vsiadls",          "/vsioss",
    "/vsiswift", "/vsihdfs", "/vsiwebhdfs", "://",    "/vsicurl_streaming"};

/// No file has it, so GDAL opens nothing on servers.
constexpr const char* no_extension = ".mansard-offline";
constexpr const char* allowed_extensions = "CPL_VSIL_CURL_ALLOWED_EXTENSIONS";

auto all_allowed() -> bool {
  const char* value = std::getenv("MANSARD_OUTSIDE");
  return value != nullptr && base::lower(value) == "yes";
}

auto refuse(const char*, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*, void*) -> CPLHTTPResult* {
  CPLError(CE_Failure, CPLE_AppDefined,
           "the file refers to a server, and files on disk may not; download what it refers to");
  // Without an answer GDAL would ask its own handler.
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("no network for files on disk");
  return result;
}

/// "/vsicurl/https://host:port"; empty for what is not on a server.
auto server_of(const std::string& name) -> std::string {
  const auto scheme = name.find("://");
  if (scheme == name.npos) return {};
  return name.substr(0, name.find_first_of("/?#", scheme + 3));
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
    if (!own.empty()) return server_of(named.string()) == own ? base::Result<void>() : outside(given, named);
  } else if (is_remote(named)) {
    return outside(given, named);
  }
  const auto folder = given.parent_path().lexically_normal();
  const auto place = named.lexically_normal();
  if (place == given.lexically_normal()) return {};
  if (folder.empty() || folder == ".") {
    const bool climbs = place.is_absolute() || (!place.empty() && *place.begin() == "..");
    return climbs ? outside(given, named) : base::Result<void>();
  }
  const auto own = folder.has_filename() ? folder : folder.parent_path();  // without a slash at its end
  const auto end = std::mismatch(own.begin(), own.end(), place.begin(), place.end()).first;
  return end == own.end() ? base::Result<void>() : outside(given, named);
}

Offline::Offline(const fs::path& given) : active_(!is_remote(given) && !all_allowed()) {
  if (!active_) return;
  CPLSetThreadLocalConfigOption(allowed_extensions, no_extension);
  CPLHTTPPushFetchCallback(&refuse, nullptr);
}

Offline::~Offline() {
  if (!active_) return;
  CPLHTTPPopFetchCallback();
  CPLSetThreadLocalConfigOption(allowed_extensions, nullptr);
}

}  // namespace mansard::formats
