#include "mansard/base/outputs.hpp"

#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "mansard/base/stopped.hpp"
#include "mansard/base/unfinished.hpp"

namespace mansard::base {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t piece = 1 << 20;
constexpr auto set_aside = "cannot put bytes aside in the folder for temporary files (TMPDIR)";

auto failed(const std::string& what, int why, const fs::path& path = {}) -> Diagnostic {
  return error("file-write", what + ": " + std::strerror(why) + "; choose a place that can be written and has room",
               path.string());
}

/// Nothing may lie at a null address, which fwrite must not be given.
auto written(std::string_view bytes, std::FILE& file) -> bool {
  return bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), &file) == bytes.size();
}

/// One file or folder on its way: where it goes, and where what stood there is kept until all are in place.
struct Placed {
  fs::path path, old;
  bool replaced = false, there = false;
};

/// Renames `beside` to `path`. A file that stood there stands there until that moment: it is kept by a second name. A
/// folder cannot be renamed onto one with something in it, nor have a second name.
auto put(const fs::path& made, const fs::path& path, std::error_code& failure) -> Placed {
  Placed placed{path, beside(path, Beside::old)};
  std::error_code status;
  fs::remove_all(placed.old, status);  // of a process of that number that was killed
  const auto type = fs::symlink_status(path, status).type();
  if (type != fs::file_type::not_found && type != fs::file_type::none) {
    if (type == fs::file_type::regular) fs::create_hard_link(path, placed.old, failure);
    if (type != fs::file_type::regular || failure) fs::rename(path, placed.old, failure);  // or no second names there
    if (failure) return placed;
    placed.replaced = true;
  }
  fs::rename(made, path, failure);
  placed.there = !failure;
  return placed;
}

void take_back(const Placed& placed) {
  std::error_code ignored;
  if (placed.there) fs::remove_all(placed.path, ignored);
  if (!placed.replaced) return;
  // Where nothing came to its place, what stood there still does, by both names: renaming one to the other does
  // nothing.
  if (!placed.there && fs::equivalent(placed.old, placed.path, ignored)) fs::remove(placed.old, ignored);
  else fs::rename(placed.old, placed.path, ignored);
}

}  // namespace

auto Spool::open() -> Result<std::unique_ptr<Spool>> {
  // As std::tmpfile, but where TMPDIR says: what is put aside may be larger than /tmp.
  auto spool = std::make_unique<Spool>();
  std::error_code failure;
  auto name = (fs::temp_directory_path(failure) / "mansard-XXXXXX").string();
  const int file = failure ? -1 : ::mkstemp(name.data());
  if (file >= 0) ::unlink(name.c_str());
  if (file >= 0) spool->file_.reset(::fdopen(file, "w+b"));
  if (!spool->file_) return failed(set_aside, failure ? failure.value() : errno);
  return spool;
}

void Spool::append(std::string_view bytes) {
  if (failure_ == 0 && !written(bytes, *file_)) failure_ = errno;
  size_ += bytes.size();
}

auto Spool::copy_to(Sink& sink) -> Result<void> {
  for (std::uint64_t at = 0; at < size_;) {
    const auto bytes = read(at, static_cast<std::size_t>(std::min<std::uint64_t>(piece, size_ - at)));
    if (!bytes) return bytes.error();
    sink.append(*bytes);
    at += bytes->size();
  }
  return {};
}

auto Spool::read(std::uint64_t offset, std::size_t count) -> Result<std::string> {
  if (failure_ == 0 && std::fflush(file_.get()) != 0) failure_ = errno;
  std::string bytes(count, '\0');
  if (failure_ == 0 && ::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) failure_ = errno;
  if (failure_ == 0 && std::fread(bytes.data(), 1, count, file_.get()) != count) failure_ = errno != 0 ? errno : EIO;
  if (failure_ == 0 && ::fseeko(file_.get(), 0, SEEK_END) != 0) failure_ = errno;
  if (failure_ != 0) return failed(set_aside, failure_);
  return bytes;
}

class Outputs::File : public Sink {
 public:
  explicit File(OpenFile file) : file_(std::move(file)) {}
  void append(std::string_view bytes) override {
    if (failure_ == 0 && !written(bytes, *file_)) failure_ = errno;
  }
  /// 0, or what the system says went wrong.
  auto close() -> int {
    if (std::fclose(file_.release()) != 0 && failure_ == 0) failure_ = errno;
    return failure_;
  }

 private:
  OpenFile file_;
  int failure_ = 0;
};

Outputs::~Outputs() {
  for (; !entries_.empty(); entries_.pop_back()) {
    auto& entry = entries_.back();
    entry.sink.reset();
    std::error_code ignored;
    fs::remove_all(entry.beside, ignored);
    forget_unfinished(entry.beside);
  }
}

void Outputs::take(Outputs&& other) {
  std::ranges::move(other.entries_, std::back_inserter(entries_));
  other.entries_.clear();
}

auto Outputs::place(const fs::path& path) -> Result<fs::path> {
  const auto made = beside(path, Beside::part);
  std::error_code ignored;
  fs::remove_all(made, ignored);  // of a process of that number that was killed
  sweep_beside(path);
  note_unfinished(made);
  entries_.push_back({path, made, nullptr});
  return made;
}

auto Outputs::file(const fs::path& path) -> Result<Sink*> {
  std::error_code status;
  if (fs::is_directory(path, status)) return failed("cannot write this file", EISDIR, path);
  const auto made = place(path);
  OpenFile opened(std::fopen(made->c_str(), "wb"));
  if (!opened) return failed("cannot write this file", errno, path);
  entries_.back().sink = std::make_unique<File>(std::move(opened));
  return entries_.back().sink.get();
}

auto Outputs::folder(const fs::path& path) -> Result<fs::path> {
  auto made = place(path);
  std::error_code failure;
  fs::create_directories(*made, failure);
  if (failure) return failed("cannot make this folder", failure.value(), path);
  return made;
}

auto Outputs::commit(const Cancel* cancel) -> Result<void> {
  for (auto& entry : entries_)
    if (auto* file = static_cast<File*>(entry.sink.get())) {
      const int why = file->close();
      entry.sink.reset();
      if (why != 0) return failed("cannot write this file", why, entry.path);
    }
  if (cancel != nullptr && cancel->requested()) return stopped();
  const Finishing together;
  std::vector<Placed> placed;
  for (const auto& entry : entries_) {
    std::error_code failure;
    placed.push_back(put(entry.beside, entry.path, failure));
    if (!failure) continue;
    while (!placed.empty()) {
      take_back(placed.back());
      placed.pop_back();
    }
    return failed("cannot rename into place", failure.value(), entry.path);
  }
  std::error_code ignored;
  for (const auto& one : placed) fs::remove_all(one.old, ignored);
  for (const auto& entry : entries_) forget_unfinished(entry.beside);
  entries_.clear();
  return {};
}

}  // namespace mansard::base
