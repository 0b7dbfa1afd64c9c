// Exit codes, and how an error is reported: a line on stderr for each diagnostic.
#pragma once

#include <string>
#include <vector>

#include "mansard/base/result.hpp"

namespace mansard::cli {

enum Exit : int {
  all_done = 0,
  some_fell_back = 1,
  usage = 2,
  input_unreadable = 3,
  option_invalid = 4,
  nothing_reconstructed = 5,
  cancelled = 6,
  bug = 70,
};

/// When the program ends with which code.
struct ExitMeaning {
  int code = all_done;
  std::string when;
};
[[nodiscard]] auto exits() -> std::vector<ExitMeaning>;

/// Prints the diagnostics and returns the exit code that the first one's code is listed with (70 for one that is not
/// listed). There must be one.
[[nodiscard]] auto give_up(const std::vector<base::Diagnostic>& diagnostics) -> int;
[[nodiscard]] auto give_up(const base::Diagnostic& diagnostic) -> int;

/// Codes of the command line itself.
[[nodiscard]] auto codes() -> std::vector<base::Code>;

/// The codes of every module and of the command line.
[[nodiscard]] auto all_codes() -> std::vector<base::Code>;

}  // namespace mansard::cli
