// mansard-reader: reads meshes for mansard with libraries that damaged files can bring down. It answers one question
// after the other on its socket, and ends with it.
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "apps/reader/reader.hpp"

namespace mansard::reader {
namespace {

using formats::outside::Outcome;

auto receive(void* to, std::size_t size) -> bool {
  auto* at = static_cast<char*>(to);
  while (size > 0) {
    const auto got = ::recv(formats::outside::channel, at, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}
auto send(const void* from, std::size_t size) -> bool {
  const auto* at = static_cast<const char*>(from);
  while (size > 0) {
    const auto sent = ::send(formats::outside::channel, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}
auto receive_text(std::string& text) -> bool {
  std::uint64_t size = 0;
  if (!receive(&size, sizeof size)) return false;
  text.resize(size);
  return receive(text.data(), text.size());
}

/// A damaged file may ask for any memory or never end: it gets what a sound file of its size needs, many times over.
/// FBX as text, the largest seen, takes 30 bytes a byte; all formats read 10 MB a second and more.
void set_limits(std::size_t bytes) {
  constexpr rlim_t memory_each = 100, memory_least = rlim_t{2} << 30, bytes_per_second = 100'000, seconds_least = 60;
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const rlim_t so_far = static_cast<rlim_t>(used.ru_utime.tv_sec) + static_cast<rlim_t>(used.ru_stime.tv_sec);
  [[maybe_unused]] const rlimit memory{memory_least + memory_each * bytes, RLIM_INFINITY},
      time{so_far + seconds_least + bytes / bytes_per_second, RLIM_INFINITY}, core{0, 0};
#ifndef __SANITIZE_ADDRESS__  // the sanitizer's own memory does not fit under a limit
  ::setrlimit(RLIMIT_AS, &memory);
#endif
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &core);
}

auto answer(const std::string& extension, const std::string& bytes) -> std::pair<Outcome, std::string> {
  set_limits(bytes.size());
  try {
    return {Outcome::scene,
            formats::outside::packed(extension == "osgb" ? read_osgb(bytes) : read_assimp(bytes, extension))};
  } catch (const Truncated&) {
    return {Outcome::truncated, ""};
  } catch (const std::bad_alloc&) {
    return {Outcome::wrong, "it asks for more memory than a file of its size can need"};
  } catch (const std::exception& e) {
    return {Outcome::wrong, e.what()};
  }
}

}  // namespace
}  // namespace mansard::reader

int main() {
  using namespace mansard::reader;
  struct stat channel {};
  if (::fstat(mansard::formats::outside::channel, &channel) != 0 || !S_ISSOCK(channel.st_mode)) {
    std::fputs("mansard-reader reads meshes for mansard, which starts it; see 'mansard --help'\n", stderr);
    return 2;
  }
  std::string extension, bytes;
  while (receive_text(extension) && receive_text(bytes)) {
    const auto [outcome, text] = answer(extension, bytes);
    const std::uint64_t size = text.size();
    if (!send(&outcome, sizeof outcome) || !send(&size, sizeof size) || !send(text.data(), text.size())) return 1;
  }
  return 0;
}
