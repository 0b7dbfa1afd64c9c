#include "mansard/formats/mesh/mesh_stream.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

#include "mansard/formats/drivers.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/files/words.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

enum class Kind { none, obj, ply };

/// By the same rules as read_mesh_file: what the file starts with, then its name.
auto kind_of(std::string_view bytes, const fs::path& path) -> Kind {
  const std::string extension = extension_of(path);
  for (const auto& driver : drivers())
    if (driver.mesh.parse != nullptr &&
        std::ranges::any_of(driver.mesh.signatures, [&](auto signature) { return bytes.starts_with(signature); }))
      return driver.name == "ply" ? Kind::ply : Kind::none;
  for (const auto& driver : drivers())
    if (driver.mesh.by_extension && std::ranges::find(driver.extensions, extension) != driver.extensions.end())
      return driver.name == "obj" ? Kind::obj : Kind::none;
  return Kind::none;
}

}  // namespace

auto FileWindow::open(const fs::path& path) -> std::optional<FileWindow> {
  if (is_virtual(path)) return std::nullopt;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  FileWindow out(file, 0, path.string());
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size <= 0) return std::nullopt;
  out.size_ = static_cast<std::uint64_t>(status.st_size);
  ::posix_fadvise(file, 0, 0, POSIX_FADV_SEQUENTIAL);
  return out;
}

FileWindow::FileWindow(FileWindow&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      size_(other.size_),
      read_(other.read_),
      name_(std::move(other.name_)),
      bytes_(std::move(other.bytes_)),
      start_(other.start_),
      at_end_(other.at_end_),
      hash_(std::move(other.hash_)) {}

FileWindow::~FileWindow() {
  if (file_ >= 0) ::close(file_);
}

auto FileWindow::fill(std::size_t count) -> base::Result<void> {
  if (at_end_ || view().size() >= count) return {};
  bytes_.erase(0, start_);
  start_ = 0;
  std::size_t got = bytes_.size();
  bytes_.resize(count);
  while (got < count && !at_end_) {
    const auto more = ::read(file_, bytes_.data() + got, count - got);
    if (more < 0 && errno == EINTR) continue;
    if (more < 0)
      return base::error("file-read", "cannot be read (" + std::string(std::strerror(errno)) + "); check the disk",
                         name_);
    hash_.add(std::string_view(bytes_).substr(got, static_cast<std::size_t>(more)));
    got += static_cast<std::size_t>(more);
    read_ += static_cast<std::size_t>(more);
    at_end_ = more == 0 || read_ == size_;
  }
  bytes_.resize(got);
  return {};
}

auto FileWindow::sha256() -> base::Result<std::string> {
  while (!at_end_) {
    advance(view().size());
    if (auto filled = fill(usual); !filled) return filled.failure();
  }
  return hash_.text();
}

auto too_many_vertices(const std::string& name) -> base::Diagnostic {
  return base::error("ingest-memory", "more than 4 thousand million vertices in one file; cut it into tiles", name);
}

auto stream_mesh_file(const fs::path& path, UpAxis up, const TakePiece& take, const base::Run& run)
    -> std::optional<MeshPiece> {
  auto file = FileWindow::open(path);
  if (!file) return std::nullopt;
  const std::string name = path.string();
  MeshPiece out;
  const auto take_up = [&](RawMesh piece) {
    if (up == UpAxis::y)
      for (auto& v : piece.vertices) v = {v.x, -v.z, v.y};
    out.vertices += piece.vertices.size();
    out.triangles += piece.triangles.size();
    take(std::move(piece));
  };
  const auto stream = [&]() -> base::Result<bool> {
    if (auto filled = file->fill(FileWindow::usual); !filled) return filled.failure();
    const auto start = without_mark(file->view());
    const auto kind = kind_of(start, path);
    if (start.empty() || kind == Kind::none) return false;
    file->advance(file->view().size() - start.size());
    if (kind == Kind::ply) return stream_ply(*file, name, take_up, run);
    if (auto done = stream_obj(*file, name, take_up, run); !done) return done.failure();
    return true;
  };
  try {
    auto done = stream();
    if (done && !*done) return std::nullopt;
    if (!done) return out.failure = done.error(), out;
    if (run.cancelled()) return out;
    auto hash = file->sha256();
    if (!hash) return out.failure = hash.error(), out;
    out.inputs.push_back({name, file->size(), std::move(*hash)});
  } catch (const std::bad_alloc&) {
    out.failure = base::error("ingest-memory", "the mesh does not fit into memory; cut it into tiles", name);
  } catch (const std::exception& e) {
    out.failure =
        base::error("ingest-mesh-format", std::string("cannot be read (") + e.what() + "); check what it is", name);
  }
  return out;
}

}  // namespace mansard::formats
