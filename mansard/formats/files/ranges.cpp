#include "mansard/formats/files/ranges.hpp"

#include <cpl_vsi.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <mutex>

#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/running_hash.hpp"

namespace mansard::formats {
namespace {

class WholeFile : public RangeFile {
 public:
  explicit WholeFile(Bytes bytes) : bytes_(std::make_shared<const Bytes>(std::move(bytes))) {}
  [[nodiscard]] auto size() const -> std::uint64_t override { return bytes_->view().size(); }
  [[nodiscard]] auto hash() const -> base::Result<std::optional<std::string>> override {
    return std::optional(sha256(bytes_->view()));
  }
  [[nodiscard]] auto read(std::uint64_t offset, std::uint64_t count) const -> base::Result<Range> override {
    return Range(bytes_->view().substr(std::min(offset, size()), count), bytes_);
  }

 private:
  std::shared_ptr<const Bytes> bytes_;
};

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path) : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  Descriptor(const Descriptor&) = delete;
  auto operator=(const Descriptor&) -> Descriptor& = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  /// Of a regular file; none where it cannot be opened, or is another thing.
  [[nodiscard]] auto size() const -> std::optional<std::uint64_t> {
    struct stat status {};
    if (number_ < 0 || ::fstat(number_, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return static_cast<std::uint64_t>(status.st_size);
  }
  /// Fewer bytes at the end of the file; none where it cannot be read.
  [[nodiscard]] auto read(std::uint64_t offset, std::size_t count) const -> std::optional<std::string> {
    std::string bytes(count, '\0');
    std::size_t done = 0;
    while (done < count) {
      const auto some = ::pread(number_, bytes.data() + done, count - done, static_cast<off_t>(offset + done));
      if (some < 0 && errno == EINTR) continue;
      if (some < 0) return std::nullopt;
      if (some == 0) break;
      done += static_cast<std::size_t>(some);
    }
    bytes.resize(done);
    return bytes;
  }

 private:
  int number_;
};

class LocalFile : public RangeFile {
 public:
  LocalFile(std::filesystem::path path, std::uint64_t size) : path_(std::move(path)), size_(size) {}
  [[nodiscard]] auto size() const -> std::uint64_t override { return size_; }
  [[nodiscard]] auto hash() const -> base::Result<std::optional<std::string>> override {
    constexpr std::uint64_t piece = std::uint64_t{1} << 20;
    const Descriptor file(path_);
    Sha256 hash;
    for (std::uint64_t at = 0; at < size_; at += piece) {
      const auto bytes = file.read(at, static_cast<std::size_t>(std::min(piece, size_ - at)));
      if (!bytes || bytes->empty()) return unreadable();
      hash.add(*bytes);
    }
    return std::optional(hash.text());
  }
  [[nodiscard]] auto read(std::uint64_t offset, std::uint64_t count) const -> base::Result<Range> override {
    offset = std::min(offset, size_);
    const auto wanted = static_cast<std::size_t>(std::min(count, size_ - offset));
    auto bytes = Descriptor(path_).read(offset, wanted);
    if (!bytes || bytes->size() < wanted) return unreadable();
    const auto owner = std::make_shared<const std::string>(*std::move(bytes));
    return Range(*owner, owner);
  }

 private:
  [[nodiscard]] auto unreadable() const -> base::Diagnostic {
    return base::error("file-read", "the file cannot be read to its end; check whether it is being changed",
                       path_.string());
  }
  std::filesystem::path path_;
  std::uint64_t size_;
};

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

class ServedFile : public RangeFile {
 public:
  ServedFile(std::unique_ptr<VSILFILE, CloseFile> file, std::uint64_t size, std::string name)
      : file_(std::move(file)), size_(size), name_(std::move(name)) {}
  [[nodiscard]] auto size() const -> std::uint64_t override { return size_; }
  [[nodiscard]] auto hash() const -> base::Result<std::optional<std::string>> override {
    return std::optional<std::string>();
  }
  [[nodiscard]] auto read(std::uint64_t offset, std::uint64_t count) const -> base::Result<Range> override {
    offset = std::min(offset, size_);
    auto bytes = std::make_shared<std::string>(static_cast<std::size_t>(std::min(count, size_ - offset)), '\0');
    const std::scoped_lock lock(mutex_);
    const crs::GdalMessages messages;
    if (VSIFSeekL(file_.get(), offset, SEEK_SET) != 0 ||
        VSIFReadL(bytes->data(), 1, bytes->size(), file_.get()) != bytes->size())
      return base::error("file-read",
                         "the server does not give all of it" +
                             (messages.failure().empty() ? std::string() : " (" + messages.failure() + ")") +
                             "; try again",
                         name_);
    return Range(*bytes, bytes);
  }

 private:
  std::unique_ptr<VSILFILE, CloseFile> file_;
  std::uint64_t size_;
  std::string name_;
  mutable std::mutex mutex_;
};

/// Whether parts of such a file are fetched for themselves; in archives a part needs all that is before it.
auto is_served(const std::string& name) -> bool {
  static constexpr std::array<std::string_view, 8> prefixes{"/vsicurl/", "/vsis3/",  "/vsigs/",    "/vsiaz/",
                                                            "/vsiadls/", "/vsioss/", "/vsiswift/", "/vsiwebhdfs/"};
  return std::ranges::any_of(prefixes, [&](std::string_view prefix) { return name.starts_with(prefix); }) &&
         !name.ends_with(".gz");
}

}  // namespace

auto RangeFile::open(const std::filesystem::path& path) -> base::Result<std::shared_ptr<const RangeFile>> {
  if (is_served(path.string())) {
    const crs::GdalMessages messages;
    VSIStatBufL status{};
    std::unique_ptr<VSILFILE, CloseFile> file(VSIFOpenL(path.c_str(), "rb"));
    if (!file || VSIStatL(path.c_str(), &status) != 0 || status.st_size < 0) return why_missing(path);
    return std::shared_ptr<const RangeFile>(
        std::make_shared<ServedFile>(std::move(file), static_cast<std::uint64_t>(status.st_size), path.string()));
  }
  if (!is_virtual(path))
    if (const auto size = Descriptor(path).size())
      return std::shared_ptr<const RangeFile>(std::make_shared<LocalFile>(path, *size));
  auto bytes = Bytes::of(path);
  if (!bytes) return bytes.failure();
  return std::shared_ptr<const RangeFile>(std::make_shared<WholeFile>(*std::move(bytes)));
}

}  // namespace mansard::formats
