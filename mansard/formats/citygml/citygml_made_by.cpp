#include "mansard/formats/citygml_made_by.hpp"

#include "mansard/formats/json/json_item.hpp"
#include "mansard/formats/plans/plan_items.hpp"

namespace mansard::formats {

namespace {

/// Whether what is before the comment is the root element's start alone: a file of another producer may quote ours
/// anywhere in it.
auto is_root_alone(std::string_view before) -> bool {
  const auto root = before.find("<CityModel");
  if (root == std::string_view::npos) return false;
  const auto end = before.find('>', root);
  return end != std::string_view::npos && before.find_first_not_of(" \t\r\n", end + 1) == std::string_view::npos;
}

}  // namespace

auto citygml_made_by(std::string_view text) -> std::optional<model::MadeBy> {
  const auto start = text.find(citygml_made_by_start);
  if (start == std::string_view::npos || !is_root_alone(text.substr(0, start))) return std::nullopt;
  const auto json = start + citygml_made_by_start.size(), end = text.find(" -->", json);
  if (end == std::string_view::npos) return std::nullopt;
  const auto parsed = Json::parse(text.substr(json, end - json), nullptr, false);
  if (parsed.is_discarded()) return std::nullopt;
  try {
    auto made_by = detail::read_made_by({parsed, {}});
    if (made_by.version.empty()) return std::nullopt;
    return made_by;
  } catch (const detail::Defect&) {
    return std::nullopt;
  }
}

}  // namespace mansard::formats
