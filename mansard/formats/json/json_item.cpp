#include "mansard/formats/json/json_item.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/base/nesting.hpp"
#include "mansard/base/options.hpp"
#include "mansard/base/text.hpp"

namespace mansard::formats::detail {

auto Place::words() const -> std::string {
  if (parent == nullptr) return {};
  const std::string before = parent->words();
  if (name.empty()) return before + "[" + std::to_string(index) + "]";
  return before.empty() ? std::string(name) : before + "." + std::string(name);
}

auto Item::where() const -> std::string {
  const std::string words = place.words();
  return words.empty() ? "the file" : words;
}

void Item::refuse(const std::string& wanted) const {
  throw Defect{"write-plan-value", where() + " must be " + wanted + ", not " + shown()};
}

auto Item::shown() const -> std::string {
  if (json.is_object()) return "an object";
  if (json.is_array()) return "an array of " + std::to_string(json.size());
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= 40 ? text : text.substr(0, 37) + "…";
}

auto Item::member(std::string_view name) const -> Item {
  const auto found = json.find(name);
  if (found == json.end())
    throw Defect{"write-plan-missing", where() + " has no \"" + std::string(name) + "\"; add it"};
  return {*found, {&place, name, 0}};
}

auto Item::object(std::initializer_list<const char*> names) const -> const Item& {
  return object(std::vector<std::string>(names.begin(), names.end()));
}

auto Item::object(const std::vector<std::string>& names) const -> const Item& {
  if (!json.is_object()) refuse("an object");
  for (const auto& [key, value] : json.items())
    if (std::find(names.begin(), names.end(), key) == names.end()) {
      const auto meant = base::nearest_word(key, names);
      throw Defect{"write-plan-key", where() + " has an unknown member \"" + key + "\"" +
                                         (meant ? "; did you mean \"" + *meant + "\"?" : "; take it out")};
    }
  return *this;
}

auto Item::text() const -> std::string {
  if (!json.is_string()) refuse("a text");
  return json.get<std::string>();
}

auto Item::number() const -> double {
  if (!json.is_number()) refuse("a number");
  // Of the two zeros always the one: "-0", as the other is written, reads back as a whole number.
  return json.get<double>() + 0.0;
}

auto Item::number_up_to(double most) const -> double {
  const double value = number();
  if (!(std::abs(value) <= most)) refuse("a number from -" + base::to_text(most, 0) + " to " + base::to_text(most, 0));
  return value;
}

auto Item::whole() const -> std::int64_t {
  const bool fits = json.is_number_integer() &&
                    (!json.is_number_unsigned() ||
                     json.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
  if (!fits) refuse("a whole number");
  return json.get<std::int64_t>();
}

auto parse_json(std::string_view text) -> Json {
  if (base::nests_too_deep(text))
    throw Defect{"write-plan-json", "this JSON nests more than " + std::to_string(base::deepest_json) +
                                        " levels deep, which no file of mansard's does; check what it is"};
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& e) {
    throw Defect{"write-plan-json",
                 "this is not JSON: it goes wrong at byte " + std::to_string(e.byte) + "; is the file whole?"};
  } catch (const Json::exception&) {  // a number that no double can hold
    throw Defect{"write-plan-json", "this is not JSON that can be read: it has a number out of range"};
  }
}

}  // namespace mansard::formats::detail
