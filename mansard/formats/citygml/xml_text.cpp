#include "mansard/formats/citygml/xml_text.hpp"

#include "mansard/base/utf8.hpp"

namespace mansard::formats::detail {

auto xml_id(std::string_view name) -> std::string {
  std::string out;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    const bool later = (c >= '0' && c <= '9') || c == '-' || c == '.';
    if (out.empty() && !letter) out += '_';
    out += letter || later ? c : '_';
  }
  return out.empty() ? "_" : out;
}

auto XmlText::open(std::string_view name, std::string_view attributes) -> XmlText& {
  line();
  text_ += '<';
  text_ += name;
  if (!attributes.empty()) (text_ += ' ') += attributes;
  text_ += ">\n";
  open_.emplace_back(name);
  return *this;
}

auto XmlText::close() -> XmlText& {
  const std::string name = std::move(open_.back());
  open_.pop_back();
  line();
  text_ += "</" + name + ">\n";
  return *this;
}

auto XmlText::leaf(std::string_view name, std::string_view text, std::string_view attributes) -> XmlText& {
  line();
  text_ += '<';
  text_ += name;
  if (!attributes.empty()) (text_ += ' ') += attributes;
  text_ += '>';
  text_ += base::markup_escaped(text);
  text_ += "</";
  text_ += name;
  text_ += ">\n";
  return *this;
}

auto XmlText::empty(std::string_view name, std::string_view attributes) -> XmlText& {
  line();
  text_ += '<';
  text_ += name;
  text_ += ' ';
  text_ += attributes;
  text_ += "/>\n";
  return *this;
}

}  // namespace mansard::formats::detail
