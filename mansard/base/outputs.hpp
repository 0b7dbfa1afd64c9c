// Results that grow piece by piece and appear together: all files and folders of a run, or none.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::base {

/// Takes bytes in order.
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  auto operator=(const Sink&) -> Sink& = delete;
  virtual ~Sink() = default;
  /// What cannot be written is reported by the owner of the sink, at the end: Outputs::commit, Spool::copy_to.
  virtual void append(std::string_view bytes) = 0;
};

/// Bytes in memory.
class TextSink : public Sink {
 public:
  void append(std::string_view bytes) override { text.append(bytes); }
  std::string text;
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

/// Bytes put aside until it is their turn, in a file without a name that goes with the object: for what is known before
/// it may be written. Memory does not grow with what is put aside.
class Spool : public Sink {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open() -> Result<std::unique_ptr<Spool>>;
  void append(std::string_view bytes) override;
  [[nodiscard]] auto size() const -> std::uint64_t { return size_; }
  /// Everything, in pieces. Fails with "file-write" where something could not be put aside.
  [[nodiscard]] auto copy_to(Sink& sink) -> Result<void>;
  /// `count` bytes from `offset` on. Fails with "file-write".
  [[nodiscard]] auto read(std::uint64_t offset, std::size_t count) -> Result<std::string>;

 private:
  OpenFile file_;
  std::uint64_t size_ = 0;
  int failure_ = 0;
};

/// Files and folders being made beside their places. Whatever was not committed is taken away again at the end.
class Outputs {
 public:
  Outputs() = default;
  Outputs(const Outputs&) = delete;
  auto operator=(const Outputs&) -> Outputs& = delete;
  ~Outputs();

  /// A file that shall stand at `path`; lives as long as this. Fails with "file-write".
  [[nodiscard]] auto file(const std::filesystem::path& path) -> Result<Sink*>;
  /// Where to make such a file or folder until then, for libraries that open files themselves. Nothing is there yet.
  [[nodiscard]] auto place(const std::filesystem::path& path) -> Result<std::filesystem::path>;
  /// The same, as an empty folder. The one at `path`, if any, is replaced as a whole.
  [[nodiscard]] auto folder(const std::filesystem::path& path) -> Result<std::filesystem::path>;

  /// Those of another take their places with these. What it gave out stays valid.
  void take(Outputs&& other);

  /// Everything takes its place. Fails with "file-write", and with "cancelled" where the run is cancelled before.
  [[nodiscard]] auto commit(const Cancel* cancel = nullptr) -> Result<void>;

 private:
  class File;
  struct Entry {
    std::filesystem::path path, beside;
    std::unique_ptr<Sink> sink;  ///< a File; none where others write
  };
  std::vector<Entry> entries_;
};

}  // namespace mansard::base
