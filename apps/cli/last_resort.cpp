#include "apps/cli/last_resort.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <new>
#include <string>
#include <thread>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/run_folder.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/unfinished.hpp"
#include "mansard/geometry/exact_memory.hpp"

namespace mansard::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto grace = 1500ms;  // from the request to the end; what users are promised is 2 s

// A signal handler and a new handler can only reach globals.
base::Cancel* request = nullptr;       // NOLINT
std::array<int, 2> signalled{-1, -1};  // NOLINT: a pipe
std::atomic<void*> reserve = nullptr;  // NOLINT: for the removal of files when there is no memory
std::string without_memory, stopped;   // NOLINT: composed while there is memory
std::atomic<bool> reported = false;    // NOLINT

void on_signal(int) {
  if (request->requested()) ::_exit(cancelled);  // the second Ctrl-C ends it at once
  request->request();
  (void)!::write(signalled[1], "!", 1);
}

/// Only one thread comes through.
[[noreturn]] void end_now(int code, const std::string& words) {
  static bool removing = false;
  base::remove_unfinished();
  if (!removing) {
    removing = true;
    leave_run_folder();
    remove_folders_left_empty();
  }
  (void)!::write(STDERR_FILENO, words.data(), words.size());
  ::_exit(code);
}

auto line(const char* code, const char* message) -> std::string {
  return "mansard: " + base::to_string(base::error(code, message)) + "\n";
}

auto memory_is_exhausted() -> bool {
  constexpr std::size_t some = 1 << 20;
  void* const place = ::mmap(nullptr, some, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) return true;
  ::munmap(place, some);
  return false;
}

[[noreturn]] void end_without_memory_now() {
  std::free(reserve.exchange(nullptr));
  end_now(input_unreadable, reported ? std::string() : without_memory);
}

void on_no_memory() {
  // The request may be larger than any machine: who made it knows best what to say then.
  if (!memory_is_exhausted()) throw std::bad_alloc();
  end_without_memory_now();
}

void on_abort(int) {
  if (memory_is_exhausted()) end_without_memory_now();
  std::signal(SIGABRT, SIG_DFL);
  std::raise(SIGABRT);
}

}  // namespace

void stop_on_signals(base::Cancel& cancel) {
  request = &cancel;
  stopped = line("cancelled", "stopped on request; nothing unfinished was left");
  (void)!::pipe2(signalled.data(), O_CLOEXEC);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, on_signal);
}

void stop_in_time() {
  std::thread([] {
    char mark = 0;
    while (::read(signalled[0], &mark, 1) < 0 && errno == EINTR) continue;
    if (!request->requested()) return;  // there is no pipe
    std::this_thread::sleep_for(grace);
    end_now(cancelled, stopped);
  }).detach();
}

void end_without_memory() {
  without_memory = line("memory", "out of memory; process a smaller area (--bbox)");
  constexpr std::size_t enough = 4 << 20;
  reserve = std::malloc(enough);
  std::set_new_handler(on_no_memory);
  geometry::exact_numbers_end_by_new_handler();
  std::signal(SIGABRT, on_abort);
}

void an_error_is_reported() { reported = true; }

void go_on_without_memory() {
  std::set_new_handler(nullptr);
  std::signal(SIGABRT, SIG_DFL);
}

void fail_writes_beyond_limit() { std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace mansard::cli
