#include "mansard/formats/citygml_made_by.hpp"

#include "mansard/formats/json/json_item.hpp"
#include "mansard/formats/plans/plan_items.hpp"

namespace mansard::formats {

auto citygml_made_by(std::string_view text) -> std::optional<model::MadeBy> {
  const auto start = text.find(citygml_made_by_start);
  // A file of another producer may quote ours anywhere in it.
  if (start == std::string_view::npos || text.substr(0, start).find("<CityModel") != std::string_view::npos)
    return std::nullopt;
  const auto json = start + citygml_made_by_start.size(), end = text.find(" -->", json);
  if (end == std::string_view::npos) return std::nullopt;
  const auto parsed = Json::parse(text.substr(json, end - json), nullptr, false);
  if (parsed.is_discarded()) return std::nullopt;
  try {
    return detail::read_made_by({parsed, {}});
  } catch (const detail::Defect&) {
    return std::nullopt;
  }
}

}  // namespace mansard::formats
