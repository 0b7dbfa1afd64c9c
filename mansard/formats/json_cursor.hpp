// JSON text that is read once, from front to back, without a tree of its values: for long lists whose items are alike.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "mansard/model/attributes.hpp"

namespace mansard::formats {

/// Takes values off the front of a text. Where the text is not JSON, or a value is not of the requested kind, the
/// cursor fails, and everything after that fails as well; it does not say what is wrong. A reader that explains faults
/// reads the text again.
///
/// Stricter than JSON in what no program writes on purpose: integers of more than 18 digits, numbers that no double
/// holds, and more than 64 levels fail.
class JsonCursor {
 public:
  explicit JsonCursor(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  [[nodiscard]] auto good() const -> bool { return good_; }
  void fail() { good_ = false; }
  /// Whether nothing but blanks is left, and nothing failed.
  [[nodiscard]] auto done() -> bool;

  /// Calls member(name) for every member in order; it has to take the value. The name lives as long as the call.
  template <class Member>
  auto object(Member member) -> bool {
    return list('{', '}', [&] {
      std::string escaped;
      const auto name = key(escaped);
      if (good_) member(name);
    });
  }
  /// Calls item() for every item in order; it has to take the value.
  template <class Work>
  auto array(Work item) -> bool {
    return list('[', ']', item);
  }

  [[nodiscard]] auto number() -> double;
  [[nodiscard]] auto text() -> std::string;
  /// Null, a number with or without a fraction, a text, true or false.
  [[nodiscard]] auto value() -> model::Value;
  /// Leaves a value of any kind out; the text of it.
  auto skip() -> std::string_view;
  /// Leaves out a value of a text that was read before: that it is JSON is not checked again.
  void leave_out();

 private:
  using Number = std::variant<double, std::int64_t>;
  static constexpr int deepest = 64;

  template <class Work>
  auto list(char open, char close, Work work) -> bool {
    if (!take(open) || ++depth_ > deepest) return good_ = false;
    if (next() == close) return ++at_, --depth_, good_;
    do work();
    while (good_ && next() == ',' && (++at_, true));
    --depth_;
    return take(close);
  }
  /// The next character that is not a blank; 0 at the end.
  auto next() -> char {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
    return at_ == end_ ? '\0' : *at_;
  }
  auto take(char c) -> bool {
    if (!good_ || next() != c || at_ == end_) return good_ = false;
    ++at_;
    return true;
  }
  /// A string, in `escaped` where it has escapes, else in the text itself.
  auto string(std::string& escaped) -> std::string_view;
  auto key(std::string& escaped) -> std::string_view;
  auto word(std::string_view name) -> bool;
  auto any_number() -> Number;

  const char* at_;
  const char* end_;
  int depth_ = 0;
  bool good_ = true;
};

}  // namespace mansard::formats
