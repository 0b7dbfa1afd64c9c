#include "mansard/formats/detail/records.hpp"

#include "mansard/formats/plans/plan_items.hpp"
#include "mansard/formats/plans/plan_text.hpp"

namespace mansard::formats::detail {

auto building_record(const model::Building& building) -> std::string {
  JsonText json;
  append_building(json, building);
  return std::move(json).str();
}

auto header_record(const Header& header) -> std::string {
  JsonText json;
  append_header(json.begin_object(), header);
  return std::move(json.end_object()).str();
}

auto read_building_record(std::string_view json, const std::string& name) -> base::Result<model::Building> {
  return parsed<model::Building>(json, name, [](const Item& item) { return read_building(item); });
}

auto read_header_record(std::string_view json, const std::string& name) -> base::Result<Header> {
  return parsed<Header>(json, name, [](const Item& item) { return read_header(item, {}); });
}

}  // namespace mansard::formats::detail
