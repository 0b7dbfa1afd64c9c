#include "apps/cli/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>
#include <cstdio>

#include "mansard/base/text.hpp"

namespace mansard::cli {

namespace {

/// As much of the line as the terminal is wide: a bar that wraps cannot be wiped out again.
auto fitted(const std::string& drawn) -> std::string {
  std::string line = base::on_one_line(drawn);
  winsize size{};
  const std::size_t columns = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
  std::size_t shown = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if ((static_cast<unsigned char>(line[i]) & 0xc0) == 0x80) continue;  // goes on with a letter of several bytes
    if (++shown >= columns) {
      line.resize(i);
      break;
    }
  }
  return line;
}

}  // namespace

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
    // A line per finished block or new sequential stage: enough for a log, never a flood: of a city one
    // in ten seconds.
    if (stage != "done" && (fraction > 0 || stage == last_stage_ || last_fraction_ >= 0)) return;
    last_stage_ = stage;
    if (stage == "done") last_fraction_ = fraction;
    using namespace std::chrono_literals;
    if (stage == "done" && ++lines_ > 100 && now - drawn_at_ < 10s && fraction < 1) return;
    drawn_at_ = now;
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
  std::string line = "[" + std::string(static_cast<std::size_t>(full), '#') +
                     std::string(static_cast<std::size_t>(width - full), '.') + "] " +
                     base::to_text(100 * fraction, 0) + " %  " + left + (left.empty() ? "" : "  ");
  line += std::string(stage) + " " + std::string(subject);
  std::fprintf(stderr, "\r\x1b[K%s", fitted(line).c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::say(const std::string& line) {
  clear();
  if (!quiet_) std::fprintf(stderr, "mansard: %s\n", line.c_str());
}

}  // namespace mansard::cli
