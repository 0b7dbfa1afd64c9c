#include "mansard/model/value_text.hpp"

#include "mansard/base/text.hpp"

namespace mansard::model {

auto text_of(const Value& value) -> std::string {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return base::to_text(*number);
  return {};
}

}  // namespace mansard::model
