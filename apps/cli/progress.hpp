// Progress: a bar on a terminal, plain lines elsewhere, nothing when quiet.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace mansard::cli {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  auto operator=(const Progress&) -> Progress& = delete;

  /// The stage, what it works on, and the fraction of the whole run that is done.
  void show(std::string_view stage, std::string_view subject, double fraction);
  /// A line of its own, over the bar.
  void say(const std::string& line);

 private:
  void clear();

  bool quiet_, terminal_, drawn_ = false;
  double last_fraction_ = -1;
  std::size_t lines_ = 0;
  std::string last_stage_;
  std::chrono::steady_clock::time_point start_, drawn_at_;
};

}  // namespace mansard::cli
