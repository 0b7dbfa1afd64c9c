#include "mansard/formats/files/ranges.hpp"

#include <cpl_vsi.h>
#include <algorithm>
#include <array>
#include <mutex>

#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/files/virtual_files.hpp"

namespace mansard::formats {
namespace {

class WholeFile : public RangeFile {
 public:
  explicit WholeFile(Bytes bytes) : bytes_(std::make_shared<const Bytes>(std::move(bytes))) {}
  [[nodiscard]] auto size() const -> std::uint64_t override { return bytes_->view().size(); }
  [[nodiscard]] auto all() const -> std::string_view override { return bytes_->view(); }
  [[nodiscard]] auto read(std::uint64_t offset, std::uint64_t count) const -> base::Result<Range> override {
    return Range(bytes_->view().substr(std::min(offset, size()), count), bytes_);
  }

 private:
  std::shared_ptr<const Bytes> bytes_;
};

struct Close {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

class ServedFile : public RangeFile {
 public:
  ServedFile(std::unique_ptr<VSILFILE, Close> file, std::uint64_t size, std::string name)
      : file_(std::move(file)), size_(size), name_(std::move(name)) {}
  [[nodiscard]] auto size() const -> std::uint64_t override { return size_; }
  [[nodiscard]] auto all() const -> std::string_view override { return {}; }
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
  std::unique_ptr<VSILFILE, Close> file_;
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
    std::unique_ptr<VSILFILE, Close> file(VSIFOpenL(path.c_str(), "rb"));
    if (!file || VSIStatL(path.c_str(), &status) != 0 || status.st_size < 0) return why_missing(path);
    return std::shared_ptr<const RangeFile>(
        std::make_shared<ServedFile>(std::move(file), static_cast<std::uint64_t>(status.st_size), path.string()));
  }
  auto bytes = Bytes::of(path);
  if (!bytes) return bytes.failure();
  return std::shared_ptr<const RangeFile>(std::make_shared<WholeFile>(*std::move(bytes)));
}

}  // namespace mansard::formats
