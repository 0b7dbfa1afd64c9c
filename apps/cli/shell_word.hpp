// Commands that users or schedulers give to a shell.
#pragma once

#include <string>

namespace mansard::cli {

/// A word as a shell takes it for itself.
[[nodiscard]] auto quoted(const std::string& word) -> std::string;

}  // namespace mansard::cli
