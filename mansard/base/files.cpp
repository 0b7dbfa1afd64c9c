#include "mansard/base/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "mansard/base/stopped.hpp"
#include "mansard/base/unfinished.hpp"

namespace mansard::base {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

}  // namespace

auto write_files(const std::vector<FileToWrite>& files, const Cancel* cancel) -> Result<void> {
  const auto clean_up = [&] {
    std::error_code ignored;
    for (const auto& file : files) {
      std::filesystem::remove(beside(file.path, Beside::part), ignored);
      forget_unfinished(beside(file.path, Beside::part));
    }
  };
  const auto give_up = [&](const std::string& what, const FileToWrite& file) -> Diagnostic {
    clean_up();
    return error("file-write", what + "; choose a place that can be written and has room", file.path.string());
  };
  for (const auto& file : files) {
    // Renaming onto a folder fails only when others are in place already.
    std::error_code status;
    if (std::filesystem::is_directory(file.path, status)) return give_up("cannot write: this is a folder", file);
    sweep_beside(file.path);
    const auto made = beside(file.path, Beside::part);
    note_unfinished(made);
    File out(std::fopen(made.c_str(), "wb"));
    const bool written = out && std::fwrite(file.bytes.data(), 1, file.bytes.size(), out.get()) == file.bytes.size() &&
                         std::fclose(out.release()) == 0;
    if (!written) return give_up(std::string("cannot write: ") + std::strerror(errno), file);
    if (cancel != nullptr && cancel->requested()) {
      clean_up();
      return stopped();
    }
  }
  const Finishing together;
  for (const auto& file : files)
    if (std::rename(beside(file.path, Beside::part).c_str(), file.path.c_str()) != 0)
      return give_up(std::string("cannot rename into place: ") + std::strerror(errno), file);
  for (const auto& file : files) forget_unfinished(beside(file.path, Beside::part));
  return {};
}

auto write_file(const std::filesystem::path& path, std::string_view bytes) -> Result<void> {
  return write_files({{path, bytes}});
}

auto check_no_pipe(const std::filesystem::path& path) -> Result<void> {
  std::error_code status;
  if (!std::filesystem::is_fifo(path, status)) return {};
  return error(
      "file-read",
      "this is a pipe, which can be read only once, while inputs are read several times; write what comes out of "
      "it to a file, and give that file",
      path.string());
}

auto read_file(const std::filesystem::path& path) -> Result<std::string> {
  std::error_code status;
  if (!std::filesystem::exists(path, status))
    return error("file-missing", "no such file; check the path", path.string());
  if (std::filesystem::is_directory(path, status))
    return error("file-read", "this is a folder, not a file; name a file in it", path.string());
  if (auto checked = check_no_pipe(path); !checked) return checked.failure();
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) return error("file-read", std::string("cannot read: ") + std::strerror(errno), path.string());
  // Devices have no size, and files of /proc are larger than they say: both are read to their end.
  const auto size = std::filesystem::file_size(path, status);
  const std::size_t stated = status ? 0 : size;
  constexpr std::size_t piece = 1 << 16;
  std::string bytes;
  std::size_t got = 0;
  do {
    bytes.resize(got == 0 && stated > 0 ? stated + 1 : got + piece);  // one more, to see the end
    got += std::fread(bytes.data() + got, 1, bytes.size() - got, file.get());
  } while (got == bytes.size());
  if (std::ferror(file.get()) != 0)
    return error("file-read", std::string("cannot be read to its end: ") + std::strerror(errno), path.string());
  if (got < stated) return error("file-read", "the file ended before its stated size; copy it again", path.string());
  bytes.resize(got);
  return bytes;
}

auto codes() -> std::vector<Code> {
  return {
      {"file-missing", "A file named on the command line does not exist.", "Check the path.", 3},
      {"file-read", "A file exists but cannot be read (a folder, a pipe, no permission, a failing disk).",
       "Check its permissions, or name a file rather than a folder or a pipe.", 3},
      {"file-write", "An output file cannot be written; nothing half-written is left behind.",
       "Check the folder's permissions and the free space.", 3},
      {"option-value", "An option was given a value outside its range or of the wrong kind.",
       "'mansard options' lists each option with its unit, range and default.", 4},
      {"option-unknown", "An option, or a key of the configuration file, does not exist.",
       "The message names the nearest known one; 'mansard options' lists them all.", 4},
      {"cancelled", "The run was stopped on request (Ctrl-C) before it was done.",
       "Start it again; nothing half-written was left.", 6},
      {"memory", "The machine ran out of memory.", "Use a smaller piece of the mesh (--bbox), or a larger machine.", 3},
      {"bug", "Something happened that should not be possible.", "Please report it, with the command line used.", 70},
  };
}

}  // namespace mansard::base
