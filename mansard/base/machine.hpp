// Where and when a process runs, for people and for other processes to read.
#pragma once

#include <string>

namespace mansard::base {

/// The machine's name, as it can be part of a file name.
[[nodiscard]] auto host() -> const std::string&;

/// Now in UTC: "2026-11-23T17:35:00Z".
[[nodiscard]] auto utc_now() -> std::string;

}  // namespace mansard::base
