// XML, element by element.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mansard::formats::detail {

/// A name of an object as an xs:ID: letters, digits, '-', '_' and '.', a letter or '_' first. Others become '_'.
[[nodiscard]] auto xml_id(std::string_view name) -> std::string;

/// Elements on lines of their own, indented by one blank a level.
class XmlText {
 public:
  explicit XmlText(std::size_t level = 0) : base_(level) {}
  /// `attributes` as they stand in the tag, escaped.
  auto open(std::string_view name, std::string_view attributes = {}) -> XmlText&;
  auto close() -> XmlText&;
  auto leaf(std::string_view name, std::string_view text, std::string_view attributes = {}) -> XmlText&;
  auto empty(std::string_view name, std::string_view attributes) -> XmlText&;
  [[nodiscard]] auto take() -> std::string { return std::move(text_); }

 private:
  void line() { text_.append(base_ + open_.size(), ' '); }
  std::size_t base_;
  std::vector<std::string> open_;
  std::string text_;
};

}  // namespace mansard::formats::detail
