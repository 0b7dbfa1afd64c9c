#include "mansard/formats/outside/process.hpp"

#include <dlfcn.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mansard/base/text.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

constexpr const char* program = "mansard-reader";

/// Beside the program or the library that this code is in, or where both are installed; or else as the shell finds it.
auto place_of_program() -> std::string {
  Dl_info info{};
  std::error_code failure;
  if (dladdr(reinterpret_cast<const void*>(&place_of_program), &info) != 0 && info.dli_fname != nullptr) {
    fs::path self = fs::canonical(info.dli_fname, failure);
    // Of a program that was started by its name alone, dladdr() has that name.
    if (failure) self = fs::read_symlink("/proc/self/exe", failure);
    for (const auto* folder : {".", "../libexec/mansard", "../../bin", "../../../../libexec/mansard"})
      if (const auto path = self.parent_path() / folder / program; fs::exists(path, failure))
        return path.lexically_normal().string();
  }
  return program;
}

/// Another process, and the socket that leads to it.
class Reader {
 public:
  Reader() = default;
  Reader(const Reader&) = delete;
  auto operator=(const Reader&) -> Reader& = delete;
  ~Reader() {
    if (socket_ >= 0) ::close(socket_);
    if (process_ > 0 && owner_ == ::getpid()) {
      if (failed_) ::kill(process_, SIGKILL);
      int status = 0;
      while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
    }
  }

  [[nodiscard]] auto start() -> bool {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return false;
    socket_ = ends[0];
    owner_ = ::getpid();
    static const std::string path = place_of_program();
    posix_spawn_file_actions_t actions{};
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], outside::channel);
    std::string name = path;
    std::array<char*, 2> words{name.data(), nullptr};
    const int wrong = ::posix_spawnp(&process_, path.c_str(), &actions, nullptr, words.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (wrong != 0) process_ = -1;
    return wrong == 0;
  }
  /// After a fork, the socket belongs to the parent.
  [[nodiscard]] auto is_ours() const -> bool { return owner_ == ::getpid(); }

  [[nodiscard]] auto send(std::string_view bytes) -> bool {
    while (!bytes.empty()) {
      const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) return failed_ = true, false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  [[nodiscard]] auto receive(void* to, std::size_t size) -> bool {
    auto* at = static_cast<char*>(to);
    while (size > 0) {
      const auto got = ::recv(socket_, at, size, 0);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return failed_ = true, false;
      at += got;
      size -= static_cast<std::size_t>(got);
    }
    return true;
  }

 private:
  int socket_ = -1;
  pid_t process_ = -1, owner_ = -1;
  bool failed_ = false;
};

/// Readers that wait for a question.
class Pool {
 public:
  auto take() -> std::unique_ptr<Reader> {
    const std::scoped_lock lock(mutex_);
    while (!idle_.empty()) {
      auto reader = std::move(idle_.back());
      idle_.pop_back();
      if (reader->is_ours()) return reader;
    }
    return nullptr;
  }
  void give(std::unique_ptr<Reader> reader) {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(reader));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Reader>> idle_;
};

auto pool() -> Pool& {
  static Pool all;
  return all;
}

}  // namespace

auto read_outside(std::string_view extension, std::string_view bytes, const fs::path& path)
    -> base::Result<outside::Scene> {
  const auto wrong = [&](const std::string& what) { return base::error("ingest-mesh-format", what, path.string()); };
  auto reader = pool().take();
  if (!reader) {
    reader = std::make_unique<Reader>();
    if (!reader->start())
      return wrong("the program " + std::string(program) + ", which reads ." + std::string(extension) +
                   ", was not found; install it beside mansard, or in a folder of PATH");
  }
  outside::Packer question;
  question.take(std::string(extension));
  question.size(bytes.size());
  outside::Outcome outcome{};
  std::uint64_t size = 0;
  std::string answer;
  const bool answered = reader->send(question.bytes()) && reader->send(bytes) &&
                        reader->receive(&outcome, sizeof outcome) && reader->receive(&size, sizeof size);
  if (answered) answer.resize(size);
  if (!answered || !reader->receive(answer.data(), answer.size()))
    return wrong("not ." + std::string(extension) + " that can be read: " + program +
                 " was ended by it, or is not there; export it again");
  pool().give(std::move(reader));
  if (outcome == outside::Outcome::truncated)
    return base::error("ingest-mesh-truncated", "the file ends before its scene does; copy or export it again",
                       path.string());
  if (outcome == outside::Outcome::wrong)
    return wrong("not ." + std::string(extension) + " that can be read (" + base::on_one_line(answer) +
                 "); export it again");
  outside::Scene scene;
  if (!outside::unpack(answer, scene))
    return wrong("the answer of " + std::string(program) + " makes no sense; install the same version of both");
  return scene;
}

}  // namespace mansard::formats
