// JSON as text, member by member, in the order it is told.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace mansard::formats::detail {

/// Appends JSON to a string. Why not a document first: a city has hundreds of thousands of coordinates, members must
/// keep their order, and numbers must be the shortest that read back the same. Commas are its business; the caller
/// balances begin and end.
class JsonText {
 public:
  auto begin_object() -> JsonText& { return open('{'); }
  auto end_object() -> JsonText& { return close('}'); }
  auto begin_array() -> JsonText& { return open('['); }
  auto end_array() -> JsonText& { return close(']'); }
  auto key(std::string_view name) -> JsonText&;

  auto text(std::string_view value) -> JsonText&;
  /// Shortest form that reads back the same; what is not finite becomes null.
  auto number(double value) -> JsonText&;
  /// The same, but always with a point or an exponent, so that readers see a real and not an integer.
  auto real(double value) -> JsonText&;
  auto whole(std::int64_t value) -> JsonText&;
  auto flag(bool value) -> JsonText& { return raw(value ? "true" : "false"); }
  auto null() -> JsonText& { return raw("null"); }
  /// JSON made elsewhere.
  auto raw(std::string_view json) -> JsonText&;
  /// The next item starts on a new line, indented by two spaces a level.
  auto line(int level = 0) -> JsonText&;

  [[nodiscard]] auto str() const& -> const std::string& { return text_; }
  /// What there is so far, to be written by now; what is told next goes on from there.
  [[nodiscard]] auto take() -> std::string { return std::exchange(text_, {}); }
  /// The value of the last key, or items of the innermost array, were put aside: they are written between what was
  /// taken and what comes next. Without any (`some` is false) nothing changes.
  auto aside(bool some = true) -> JsonText& {
    first_ = first_ && !some;
    after_key_ = after_key_ && !some;
    return *this;
  }
  [[nodiscard]] auto str() && -> std::string { return std::move(text_); }

 private:
  auto open(char bracket) -> JsonText&;
  auto close(char bracket) -> JsonText&;
  void separate();

  std::string text_;
  bool first_ = true;  ///< nothing yet in the innermost object or array
  bool after_key_ = false;
  int level_ = -1;  ///< of the line that was asked for; negative when none
};

/// The string in quotes, escaped; bytes that are not UTF-8 become U+FFFD, since JSON must be UTF-8.
[[nodiscard]] auto quoted(std::string_view value) -> std::string;

}  // namespace mansard::formats::detail
