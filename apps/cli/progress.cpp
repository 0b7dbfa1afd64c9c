#include "apps/cli/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace mansard::cli {

Progress::Progress(bool quiet)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) != 0), start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
  drawn_ = false;
}

void Progress::show(std::string_view stage, std::string_view subject, double fraction) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_) {
    // A line per finished block or new sequential stage: enough for a log, never a flood.
    if (stage != "done" && (fraction > 0 || stage == last_stage_ || last_fraction_ >= 0)) return;
    last_stage_ = stage;
    if (stage == "done") last_fraction_ = fraction;
    std::fprintf(stderr, "mansard: %.*s %.*s (%.0f %%)\n", static_cast<int>(stage.size()), stage.data(),
                 static_cast<int>(subject.size()), subject.data(), 100 * fraction);
    return;
  }
  using namespace std::chrono_literals;
  if (drawn_ && now - drawn_at_ < 50ms && fraction < 1) return;
  drawn_at_ = now;
  constexpr int width = 30;
  const int full = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
  const double spent = std::chrono::duration<double>(now - start_).count();
  std::string left;
  if (fraction > 0.02 && fraction < 1) {
    const int seconds = static_cast<int>(spent * (1 - fraction) / fraction + 0.5);
    left = std::to_string(seconds) + " s left";
  }
  std::fprintf(stderr, "\r\x1b[K[%s%s] %3.0f %%  %.*s %.*s  %s", std::string(static_cast<std::size_t>(full), '#').c_str(),
               std::string(static_cast<std::size_t>(width - full), '.').c_str(), 100 * fraction,
               static_cast<int>(stage.size()), stage.data(), static_cast<int>(subject.size()), subject.data(),
               left.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::say(const std::string& line) {
  clear();
  if (!quiet_) std::fprintf(stderr, "mansard: %s\n", line.c_str());
}

}  // namespace mansard::cli
