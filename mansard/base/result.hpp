// Results and diagnostics: what passes a door when something is wrong with the data.
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace mansard::base {

enum class Severity { warning, error };

/// One thing to tell the user: what (code, message), where (subject), and in the message what to do.
/// `code` is one of a room's `codes()`, e.g. "ingest-mesh-empty"; codes are kept for life.
struct Diagnostic {
  Severity severity = Severity::error;
  std::string code;
  std::string message;
  std::string subject;  ///< a file, a feature id, an option name; empty when nothing can be named

  friend auto operator==(const Diagnostic&, const Diagnostic&) -> bool = default;
};

[[nodiscard]] inline auto error(std::string code, std::string message, std::string subject = {}) -> Diagnostic {
  return {Severity::error, std::move(code), std::move(message), std::move(subject)};
}
[[nodiscard]] inline auto warning(std::string code, std::string message, std::string subject = {}) -> Diagnostic {
  return {Severity::warning, std::move(code), std::move(message), std::move(subject)};
}

/// "error[code] subject: message", on one line.
[[nodiscard]] auto to_string(const Diagnostic& diagnostic) -> std::string;

/// A value, or the error that kept it from being made.
template <class T>
class [[nodiscard]] Result {
 public:
  using value_type = T;

  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT: implicit on purpose
  Result(Diagnostic diagnostic) : state_(std::in_place_index<1>, std::move(diagnostic)) {}  // NOLINT

  [[nodiscard]] auto has_value() const -> bool { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  [[nodiscard]] auto value() & -> T& {
    assert(has_value());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] auto value() const& -> const T& {
    assert(has_value());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] auto value() && -> T&& {
    assert(has_value());
    return std::move(*std::get_if<0>(&state_));
  }
  [[nodiscard]] auto error() const -> const Diagnostic& {
    assert(!has_value());
    return *std::get_if<1>(&state_);
  }

  auto operator*() & -> T& { return value(); }
  auto operator*() const& -> const T& { return value(); }
  auto operator*() && -> T&& { return std::move(*this).value(); }
  auto operator->() -> T* { return &value(); }
  auto operator->() const -> const T* { return &value(); }

 private:
  std::variant<T, Diagnostic> state_;
};

/// Success, or the error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Diagnostic diagnostic) : error_(std::move(diagnostic)) {}  // NOLINT: implicit on purpose

  [[nodiscard]] auto has_value() const -> bool { return !error_.has_value(); }
  explicit operator bool() const { return has_value(); }
  [[nodiscard]] auto error() const -> const Diagnostic& {
    assert(error_.has_value());
    return *error_;
  }

 private:
  std::optional<Diagnostic> error_;
};

/// What `mansard explain CODE` prints. Each room lists its own.
struct Code {
  std::string code;
  std::string cause;   ///< what it means
  std::string remedy;  ///< what to do
  int exit_code = 0;   ///< the exit code when it ends the run; 1 when it only costs one building; 0 for a warning
};

}  // namespace mansard::base
