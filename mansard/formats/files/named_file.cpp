#include "mansard/formats/files/named_file.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <thread>

#include "mansard/formats/files/reach.hpp"

namespace mansard::formats {

auto bytes_of_named(const std::filesystem::path& path) -> base::Result<Bytes> {
  const std::string name = path.string();
  std::error_code failure;
  const auto type = std::filesystem::status(path, failure).type();
  using Type = std::filesystem::file_type;
  const bool endless = type == Type::character || type == Type::block || type == Type::fifo || type == Type::socket;
  if (endless || name.find("/vsistdin/") != name.npos)
    return base::error("file-read", "a file names this, which is no file but a device; check who made it", name);
  return Bytes::of(path);
}

auto check_pipe(const std::filesystem::path& path) -> base::Result<void> {
  std::error_code failure;
  if (!std::filesystem::is_fifo(path, failure)) return {};
  const int pipe = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  int aside[2] = {-1, -1};
  bool written = pipe < 0 || ::pipe2(aside, O_CLOEXEC) != 0;  // then opening it says what is wrong
  // tee() takes nothing out of a pipe. It says 0 where nobody has the other end open, who programs that are started
  // together may do a little later.
  constexpr int steps = 100;
  for (int i = 0; !written && i < steps; ++i) {
    if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    written = ::tee(pipe, aside[1], 1, SPLICE_F_NONBLOCK) != 0;
  }
  // Where somebody writes, this end stays open to the end of the program: without a reader, writing would fail.
  for (const int file : {written ? -1 : pipe, aside[0], aside[1]})
    if (file >= 0) ::close(file);
  if (written) return {};
  return base::error("file-read", "no program writes to this pipe; start that one first, or give a file",
                     path.string());
}

auto named_beside(const std::filesystem::path& given, const std::filesystem::path& from, std::string name)
    -> base::Result<std::filesystem::path> {
  std::ranges::replace(name, '\\', '/');
  const auto folder = from.parent_path();
  auto path = folder / name;
  const auto reach = check_reach(given, path);
  if (reach && is_there(path)) return path;
  auto here = folder / std::filesystem::path(name).filename();
  if (check_reach(given, here) && is_there(here)) return here;
  return reach ? base::Result<std::filesystem::path>(std::move(path)) : reach.failure();
}

}  // namespace mansard::formats
