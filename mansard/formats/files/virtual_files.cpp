#include "mansard/formats/files/virtual_files.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <cpl_vsi_error.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cstdint>
#include <optional>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/gdal_messages.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

auto ends_with(const fs::path& path, std::string_view ending) -> bool {
  return base::lower(path.extension().string()) == ending;
}

auto is_gdals(const fs::path& path) -> bool { return path.string().starts_with("/vsi"); }

/// GDAL would write how large a .gz is unpacked into a file beside it.
class NothingBeside {
 public:
  NothingBeside() { CPLSetThreadLocalConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO"); }
  NothingBeside(const NothingBeside&) = delete;
  auto operator=(const NothingBeside&) -> NothingBeside& = delete;
  ~NothingBeside() { CPLSetThreadLocalConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", nullptr); }
};

/// The first few names in an archive.
auto members_of(const std::string& name, const std::string& member) -> std::string {
  const std::string archive = name.substr(0, name.size() - member.size());
  const CPLStringList listed(VSIReadDirRecursive(archive.c_str()));
  constexpr int enough = 8;
  std::string all;
  for (int i = 0; i < listed.Count() && i < enough; ++i) all += (i > 0 ? ", " : "") + std::string(listed[i]);
  return listed.Count() > enough ? all + " …" : all;
}

auto last_words(const crs::GdalMessages& messages) -> std::string {
  if (!messages.failure().empty()) return messages.failure();
  const char* words = VSIGetLastErrorMsg();
  return words == nullptr ? std::string() : std::string(words);
}

struct Close {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

struct Mapping {
  void* start;
  std::size_t size;
  Mapping(void* at, std::size_t bytes) : start(at), size(bytes) {}
  Mapping(const Mapping&) = delete;
  auto operator=(const Mapping&) -> Mapping& = delete;
  ~Mapping() { ::munmap(start, size); }
};

/// Nothing for what cannot be mapped: a pipe, an empty file, one that is not there.
auto mapped(const fs::path& path) -> std::shared_ptr<const Mapping> {
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);  // a pipe would wait for its writer
  if (file < 0) return nullptr;
  struct stat status {};
  void* start = MAP_FAILED;
  if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0)
    start = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, MAP_PRIVATE, file, 0);
  ::close(file);
  if (start == MAP_FAILED) return nullptr;
  const auto size = static_cast<std::size_t>(status.st_size);
  ::madvise(start, size, MADV_SEQUENTIAL);
  return std::make_shared<const Mapping>(start, size);
}

/// DEFLATE shrinks to a 1032nd at most (zlib's technical details). Meshes as text shrink to a third to a tenth, rasters
/// with large empty areas to a hundredth. Up to the first number of bytes, nothing is refused.
constexpr std::uint64_t always_unpacked = std::uint64_t{256} << 20;
constexpr std::uint64_t most_growth = 200;

/// The largest size of a file in an archive on disk, or of a .gz; none for what is on a server.
auto most_unpacked(const fs::path& path) -> std::optional<std::uint64_t> {
  std::error_code failure;
  auto place = is_gdals(path) ? archive_of(path.string()).first : path;
  if (place.empty()) return std::nullopt;
  const auto size = fs::file_size(place, failure);
  if (failure) return std::nullopt;
  return std::max<std::uint64_t>(always_unpacked, most_growth * size);
}

auto unpacked(const fs::path& path) -> base::Result<std::string> {
  const std::string name = name_for_gdal(path);
  const crs::GdalMessages messages;
  const NothingBeside nothing_beside;
  VSIErrorReset();
  const std::unique_ptr<VSILFILE, Close> file(VSIFOpenExL(name.c_str(), "rb", TRUE));
  if (!file) return why_missing(path);
  // The size of a .gz is known only once it is unpacked: read in ever larger pieces.
  constexpr std::size_t first_piece = std::size_t{1} << 20;
  const auto most = most_unpacked(path);
  std::string bytes;
  std::size_t got = 0;
  for (std::size_t piece = first_piece;; piece = std::max(piece, got)) {
    if (most) piece = std::min<std::size_t>(piece, *most + 1 - got);
    bytes.resize(got + piece);
    const std::size_t more = VSIFReadL(bytes.data() + got, 1, piece, file.get());
    got += more;
    if (most && got > *most)
      return base::error("file-read",
                         "unpacks to more than " + std::to_string(most_growth) +
                             " times the size of its archive, as no mesh "
                             "and no raster does; unpack it, check what it is, and give the unpacked file",
                         path.string());
    if (more < piece) break;
  }
  bytes.resize(got);
  if (const std::string words = last_words(messages); !messages.failure().empty() || (got == 0 && !words.empty()))
    return base::error("file-read", "cannot be read (" + words + "); check the archive or the server, and try again",
                       path.string());
  return bytes;
}

}  // namespace

auto is_virtual(const fs::path& path) -> bool { return is_gdals(path) || ends_with(path, ".gz"); }

auto plain_name(const fs::path& path) -> fs::path {
  return ends_with(path, ".gz") ? fs::path(path).replace_extension() : path;
}

auto name_for_gdal(const fs::path& path) -> std::string {
  std::string name = path.string();
  // On a server or in an archive too, unless the name says already how it is opened.
  const auto says = [&](const char* opener) { return name.find(opener) != name.npos; };
  if (ends_with(path, ".gz") && !says("/vsigzip/") && !says("/vsitar/")) return "/vsigzip/" + name;
  if (ends_with(path, ".zip") && !says("/vsizip/")) return "/vsizip/" + name;
  return name;
}

auto is_there(const fs::path& path) -> bool {
  std::error_code failure;
  if (!is_gdals(path)) return fs::exists(path, failure);
  const crs::GdalMessages messages;
  const NothingBeside nothing_beside;
  VSIStatBufL status;
  return VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0;
}

auto archive_of(const std::string& name) -> std::pair<fs::path, std::string> {
  std::string rest = name;
  while (rest.starts_with("/vsi")) {
    const std::size_t end = rest.find('/', 1);
    if (end == rest.npos) return {};
    rest.erase(0, end + 1);
  }
  // "/vsizip/{ARCHIVE}/MEMBER", where the archive's own ending does not say what it is.
  if (const auto brace = rest.find('}'); rest.starts_with('{') && brace != rest.npos) {
    rest.erase(brace, 1);
    rest.erase(0, 1);
  }
  for (fs::path at = rest; !at.empty() && at != at.root_path(); at = at.parent_path()) {
    std::error_code failure;
    if (fs::is_regular_file(at, failure)) {
      const std::string archive = at.string();
      return {at, rest.size() > archive.size() ? rest.substr(archive.size() + 1) : std::string()};
    }
  }
  return {};
}

auto inside_of(std::string name) -> std::string {
  if (!name.starts_with("/vsizip/")) return name;
  const auto [archive, member] = archive_of(name);
  if (archive.empty() || !member.empty()) return name;
  const crs::GdalMessages messages;
  for (;;) {
    const CPLStringList listed(VSIReadDir(name.c_str()));
    std::string only;
    for (int i = 0; i < listed.Count(); ++i) {
      const std::string_view entry = listed[i];
      if (entry.starts_with('.') || entry == "__MACOSX") continue;
      if (!only.empty()) return name;
      only = entry;
    }
    if (only.empty()) return name;
    name += "/" + only;
  }
}

auto why_missing(const fs::path& path) -> base::Diagnostic {
  const std::string name = path.string();
  const crs::GdalMessages messages;
  if (!is_gdals(path)) {
    std::error_code failure;
    if (fs::is_directory(path, failure))
      return base::error("file-read", "this is a folder, not a file; name a file in it", name);
    if (fs::exists(path, failure))
      return base::error("file-read", "cannot be unpacked; check what it is, or its permissions", name);
    if (name.starts_with("http://") || name.starts_with("https://"))
      return base::error("file-missing", "what lies on a server is read by the name /vsicurl/" + name, name);
    return base::error("file-missing", "no such file; check the path", name);
  }
  const std::size_t end = name.find('/', 1);
  const std::string kind = name.substr(0, end == name.npos ? name.size() : end + 1);
  const CPLStringList known(VSIGetFileSystemsPrefixes());
  const bool streamed = kind == "/vsicurl/" || kind == "/vsis3/" || kind == "/vsigs/" || kind == "/vsiaz/";
  if (known.FindString(kind.c_str()) < 0)
    return base::error("file-missing", "GDAL here knows no files under '" + kind + "'; check the path", name);
  VSIErrorReset();
  const std::unique_ptr<VSILFILE, Close> again(VSIFOpenExL(name.c_str(), "rb", TRUE));
  const std::string words = last_words(messages);
  if (name.find("/vsicurl/") != name.npos || streamed)
    return base::error("file-read",
                       "the server does not give it" + (words.empty() ? std::string() : " (" + words + ")") +
                           "; check the address, the network and what GDAL needs to know of the server",
                       name);
  const auto [archive, member] = archive_of(name);
  if (archive.empty()) return base::error("file-missing", "no such archive; check the path", name);
  if (member.empty())
    return base::error("file-read",
                       "the archive cannot be read" + (words.empty() ? std::string() : " (" + words + ")") +
                           "; name a member of it, or check what it is",
                       name);
  const std::string members = members_of(name, member);
  if (members.empty())
    return base::error("file-read",
                       "'" + archive.string() + "' cannot be read as an archive" +
                           (words.empty() ? std::string() : " (" + words + ")") + "; check what it is",
                       name);
  return base::error("file-missing", "the archive has no '" + member + "'; it has: " + members, name);
}

auto Bytes::of(const fs::path& path) -> base::Result<Bytes> {
  Bytes bytes;
  if (!is_virtual(path))
    if (auto mapping = mapped(path)) {
      bytes.view_ = {static_cast<const char*>(mapping->start), mapping->size};
      bytes.owner_ = std::move(mapping);
      return bytes;
    }
  auto text = is_virtual(path) ? unpacked(path) : base::read_file(path);
  if (!text) return !is_virtual(path) && text.error().code == "file-missing" ? why_missing(path) : text.error();
  auto kept = std::make_shared<const std::string>(*std::move(text));
  bytes.view_ = *kept;
  bytes.owner_ = std::move(kept);
  return bytes;
}

}  // namespace mansard::formats
