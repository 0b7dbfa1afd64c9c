// The state of a run or a job.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace mansard::server {

enum class State : std::uint8_t { queued, running, done, failed, cancelled, interrupted };

inline constexpr std::array<std::string_view, 6> state_names{"queued", "running",   "done",
                                                             "failed", "cancelled", "interrupted"};

[[nodiscard]] constexpr auto to_string(State state) -> std::string_view {
  return state_names[static_cast<std::size_t>(state)];
}

[[nodiscard]] constexpr auto state_of(std::string_view name) -> std::optional<State> {
  for (std::size_t i = 0; i < state_names.size(); ++i)
    if (state_names[i] == name) return static_cast<State>(i);
  return std::nullopt;
}

/// Whether the state is final.
[[nodiscard]] constexpr auto over(State state) -> bool { return state != State::queued && state != State::running; }

}  // namespace mansard::server
