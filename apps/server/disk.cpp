#include "apps/server/disk.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <utility>
#include <vector>

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

auto cannot(const std::string& what, const fs::path& path) -> base::Diagnostic {
  return base::error(
      "file-write",
      "cannot " + what + ": " + std::strerror(errno) + "; check the permissions and the free space of the folder",
      path.string());
}

auto write_all(int file, std::string_view bytes) -> bool {
  while (!bytes.empty()) {
    const auto written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// A new name is durable only after its folder has been flushed.
auto flush_folder(const fs::path& folder) -> bool {
  const Descriptor open(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return open.is_open() && ::fsync(open.number()) == 0;
}

auto same_bytes(const fs::path& a, const fs::path& b) -> bool {
  std::error_code status;
  if (fs::file_size(a, status) != fs::file_size(b, status) || status) return false;
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  std::vector<char> left(std::size_t{1} << 20), right(left.size());
  while (first && second) {
    first.read(left.data(), static_cast<std::streamsize>(left.size()));
    second.read(right.data(), static_cast<std::streamsize>(right.size()));
    if (first.gcount() != second.gcount() || !std::equal(left.begin(), left.begin() + first.gcount(), right.begin()))
      return false;
  }
  return first.eof() && second.eof();
}

/// Renames unless the new name is taken. Some file systems cannot rename so; a second name does the same there.
auto rename_to_new(const fs::path& from, const fs::path& to) -> bool {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  return ::link(from.c_str(), to.c_str()) == 0 && ::unlink(from.c_str()) == 0;
}

/// A temporary name in the same folder, unique in this process. Other processes do not write here: projects are locked.
auto temporary_name(const fs::path& path) -> fs::path {
  static std::atomic<unsigned> count{0};
  return path.parent_path() / ("." + path.filename().string() + "." + std::to_string(count++) + ".part");
}

}  // namespace

auto Descriptor::operator=(Descriptor&& other) noexcept -> Descriptor& {
  if (this != &other) {
    if (is_open()) ::close(number_);
    number_ = other.release();
  }
  return *this;
}

Descriptor::~Descriptor() {
  if (is_open()) ::close(number_);
}

auto Descriptor::release() -> int { return std::exchange(number_, -1); }

auto write_durably(const fs::path& path, std::string_view bytes) -> base::Result<void> {
  auto file = Arriving::open(path);
  if (!file) return file.error();
  if (auto added = file->add(bytes); !added) return added;
  return file->finish();
}

auto name_taken(const fs::path& path) -> base::Diagnostic {
  return base::error("server-exists",
                     "the project has another file of this name, and inputs are never replaced; upload the file into "
                     "another folder of the inputs (?folder=2), or rename it",
                     path.string());
}

auto make_folder(const fs::path& path) -> base::Result<void> {
  if (::mkdir(path.c_str(), 0777) != 0) {
    std::error_code status;
    if (errno == EEXIST && fs::is_directory(fs::symlink_status(path, status))) return {};
    if (errno == EEXIST)
      return base::error("file-write",
                         "expected a folder, but this is a file or a symbolic link; move it away, then start again",
                         path.string());
    return cannot("make this folder", path);
  }
  if (!flush_folder(path.parent_path())) return cannot("flush the folder of", path);
  return {};
}

auto move_durably(const fs::path& from, const fs::path& to) -> base::Result<void> {
  if (::rename(from.c_str(), to.c_str()) != 0) return cannot("rename to '" + to.string() + "'", from);
  if (!flush_folder(to.parent_path()) || !flush_folder(from.parent_path())) return cannot("flush the folder of", to);
  return {};
}

Journal::Journal(fs::path path, Descriptor file, std::uint64_t size)
    : path_(std::move(path)), file_(std::move(file)), size_(size) {}

auto Journal::open(const fs::path& path, std::uint64_t kept) -> base::Result<Journal> {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (!file.is_open()) return cannot("open", path);
  if (::ftruncate(file.number(), static_cast<off_t>(kept)) != 0 || ::fsync(file.number()) != 0 ||
      !flush_folder(path.parent_path()))
    return cannot("write", path);
  return Journal(path, std::move(file), kept);
}

auto Journal::append(std::string_view line) -> base::Result<void> {
  std::string whole(line);
  whole += '\n';
  if (write_all(file_.number(), whole) && ::fsync(file_.number()) == 0) {
    size_ += whole.size();
    return {};
  }
  auto why = cannot("write", path_);
  // Nothing may be appended to an incomplete line. If truncating fails too, the next start drops the line.
  if (::ftruncate(file_.number(), static_cast<off_t>(size_)) != 0) file_ = Descriptor();
  return why;
}

Arriving::Arriving(fs::path path, fs::path beside, Descriptor file)
    : path_(std::move(path)), beside_(std::move(beside)), file_(std::move(file)) {}

auto Arriving::open(fs::path path) -> base::Result<Arriving> {
  auto name = temporary_name(path);
  Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (!file.is_open()) return cannot("write", path);
  return Arriving(std::move(path), std::move(name), std::move(file));
}

Arriving::~Arriving() {
  if (file_.is_open()) ::unlink(beside_.c_str());
}

auto Arriving::add(std::string_view bytes) -> base::Result<void> {
  if (!write_all(file_.number(), bytes)) return cannot("write", path_);
  size_ += bytes.size();
  return {};
}

auto Arriving::finish() -> base::Result<void> {
  if (::fsync(file_.number()) != 0) return cannot("write", path_);
  if (::rename(beside_.c_str(), path_.c_str()) != 0) return cannot("rename into place", path_);
  file_ = Descriptor();
  if (!flush_folder(path_.parent_path())) return cannot("flush the folder of", path_);
  return {};
}

auto Arriving::finish_new() -> base::Result<void> {
  if (::fsync(file_.number()) != 0) return cannot("write", path_);
  if (rename_to_new(beside_, path_)) {
    file_ = Descriptor();
    if (!flush_folder(path_.parent_path())) return cannot("flush the folder of", path_);
    return {};
  }
  if (errno != EEXIST) return cannot("rename into place", path_);
  if (same_bytes(beside_, path_)) return {};
  return name_taken(path_);
}

}  // namespace mansard::server
