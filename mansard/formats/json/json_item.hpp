// A value of a JSON file that knows its place, so that every complaint says where: buildings[3].parts[0].plan.cap.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/json/json_access.hpp"

namespace mansard::formats::detail {

/// What is wrong with a file; thrown and caught by readers, never beyond this module.
struct Defect {
  std::string code, message;
};

/// A place in the document; made on the way down, put into words only for a complaint.
struct Place {
  const Place* parent = nullptr;
  std::string_view name;  ///< of a member; of an item when empty
  std::size_t index = 0;

  [[nodiscard]] auto words() const -> std::string;
};

/// A value and its place.
struct Item {
  const Json& json;
  Place place;

  [[nodiscard]] auto where() const -> std::string;
  [[noreturn]] void refuse(const std::string& wanted) const;
  [[nodiscard]] auto shown() const -> std::string;
  [[nodiscard]] auto member(std::string_view name) const -> Item;
  [[nodiscard]] auto has(std::string_view name) const -> bool { return json.contains(name); }
  /// An object with no members but these.
  auto object(std::initializer_list<const char*> names) const -> const Item&;
  auto object(const std::vector<std::string>& names) const -> const Item&;

  /// Calls `work` with every item of an array.
  template <class Work>
  void each(Work work) const {
    if (!json.is_array()) refuse("an array");
    for (std::size_t i = 0; i < json.size(); ++i) work(Item{json[i], {&place, {}, i}});
  }

  [[nodiscard]] auto text() const -> std::string;
  [[nodiscard]] auto number() const -> double;
  /// A number of that size at most, either sign.
  [[nodiscard]] auto number_up_to(double most) const -> double;
  [[nodiscard]] auto whole() const -> std::int64_t;
  template <std::size_t n>
  [[nodiscard]] auto numbers() const -> std::array<double, n> {
    std::array<double, n> values{};
    if (!json.is_array() || json.size() != n) refuse("an array of " + std::to_string(n) + " numbers");
    each([&](const Item& item) { values[item.place.index] = item.number(); });
    return values;
  }
};

/// The text as JSON. Throws a Defect: "write-plan-json".
[[nodiscard]] auto parse_json(std::string_view text) -> Json;

/// What `read` makes of the JSON, with the file's faults as diagnostics.
template <class Value, class Read>
auto parsed(std::string_view text, const std::string& name, const Read& read) -> base::Result<Value> {
  try {
    const Json json = parse_json(text);
    return read(Item{json, {}});
  } catch (const Defect& defect) {
    return base::error(defect.code, defect.message, name);
  }
}

}  // namespace mansard::formats::detail
