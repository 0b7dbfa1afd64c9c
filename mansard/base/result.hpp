// Results and diagnostics: what a public function returns when something is wrong with the data.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace mansard::base {

enum class Severity { warning, error };

/// One thing to tell the user: what (code, message), where (subject), and in the message what to do.
/// `code` is one of a module's `codes()`, e.g. "ingest-mesh-empty"; codes are never renamed.
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

/// Several diagnostics as one failure: the most important first. Never empty.
struct Failure {
  std::vector<Diagnostic> diagnostics;
};

namespace detail {
/// Ends the program: `value()` of a failure, or `error()` of a success, is a bug of the caller in every build.
[[noreturn]] void bad_result_access(const std::vector<Diagnostic>* failure);
}  // namespace detail

/// A value, or the diagnostics that say why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  using value_type = T;

  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT: implicit on purpose
  Result(Diagnostic diagnostic) : state_(std::in_place_index<1>) {       // NOLINT: implicit on purpose
    std::get_if<1>(&state_)->push_back(std::move(diagnostic));
  }
  Result(Failure failure)  // NOLINT: implicit on purpose
      : state_(std::in_place_index<1>, std::move(failure.diagnostics)) {
    if (std::get_if<1>(&state_)->empty()) detail::bad_result_access(nullptr);
  }

  [[nodiscard]] auto has_value() const -> bool { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  /// Ends the program where there is none, in every build.
  [[nodiscard]] auto value() & -> T& { return *held(this); }
  [[nodiscard]] auto value() const& -> const T& { return *held(this); }
  [[nodiscard]] auto value() && -> T&& { return std::move(*held(this)); }
  /// The first and most important diagnostic of a failure. Ends the program where there is a value.
  [[nodiscard]] auto error() const -> const Diagnostic& { return errors().front(); }
  [[nodiscard]] auto errors() const -> const std::vector<Diagnostic>& {
    if (has_value()) detail::bad_result_access(nullptr);
    return *std::get_if<1>(&state_);
  }
  /// All diagnostics, to be returned as the failure of another result.
  [[nodiscard]] auto failure() const -> Failure { return {errors()}; }

  auto operator*() & -> T& { return value(); }
  auto operator*() const& -> const T& { return value(); }
  auto operator*() && -> T&& { return std::move(*this).value(); }
  auto operator->() -> T* { return &value(); }
  auto operator->() const -> const T* { return &value(); }

  /// `next(value)`, itself a Result, or this failure.
  template <class F>
  [[nodiscard]] auto and_then(F&& next) && -> std::invoke_result_t<F, T&&> {
    if (!has_value()) return failure();
    return std::forward<F>(next)(std::move(*this).value());
  }
  /// `change(value)` as the value, or this failure.
  template <class F>
  [[nodiscard]] auto transform(F&& change) && -> Result<std::invoke_result_t<F, T&&>> {
    if (!has_value()) return failure();
    return std::forward<F>(change)(std::move(*this).value());
  }
  /// A failure with one more diagnostic, after those it has; a value stays as it is.
  [[nodiscard]] auto also(Diagnostic diagnostic) && -> Result {
    if (auto* all = std::get_if<1>(&state_)) all->push_back(std::move(diagnostic));
    return std::move(*this);
  }

 private:
  template <class Self>
  static auto held(Self* self) {
    if (!self->has_value()) detail::bad_result_access(std::get_if<1>(&self->state_));
    return std::get_if<0>(&self->state_);
  }

  std::variant<T, std::vector<Diagnostic>> state_;
};

/// Success, or the diagnostics that say why not.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Diagnostic diagnostic) { errors_.push_back(std::move(diagnostic)); }  // NOLINT: implicit on purpose
  Result(Failure failure) : errors_(std::move(failure.diagnostics)) {          // NOLINT: implicit on purpose
    if (errors_.empty()) detail::bad_result_access(nullptr);
  }

  [[nodiscard]] auto has_value() const -> bool { return errors_.empty(); }
  explicit operator bool() const { return has_value(); }
  [[nodiscard]] auto error() const -> const Diagnostic& { return errors().front(); }
  [[nodiscard]] auto errors() const -> const std::vector<Diagnostic>& {
    if (has_value()) detail::bad_result_access(nullptr);
    return errors_;
  }
  [[nodiscard]] auto failure() const -> Failure { return {errors()}; }
  /// `next()`, itself a Result, or this failure.
  template <class F>
  [[nodiscard]] auto and_then(F&& next) const -> std::invoke_result_t<F> {
    if (!has_value()) return failure();
    return std::forward<F>(next)();
  }
  [[nodiscard]] auto also(Diagnostic diagnostic) && -> Result {
    if (!has_value()) errors_.push_back(std::move(diagnostic));
    return std::move(*this);
  }

 private:
  std::vector<Diagnostic> errors_;
};

/// What `mansard explain CODE` prints. Each module lists its own.
struct Code {
  std::string code;
  std::string cause;   ///< what it means
  std::string remedy;  ///< what to do
  int exit_code = 0;   ///< the exit code when it ends the run; 1 when it only costs one building; 0 for a warning
};

}  // namespace mansard::base
