#include "mansard/formats/plans.hpp"

#include "mansard/base/files.hpp"
#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/plans/plan_text.hpp"

namespace mansard::formats {

auto plans(const model::City& city) -> std::string {
  base::TextSink sink;
  detail::PlansText text({city.frame, city.made_by}, sink);
  for (const model::Building& building : city.buildings) text.add(building);
  text.end();
  return std::move(sink.text);
}

auto read_plans(const std::filesystem::path& path) -> base::Result<model::City> {
  auto reader = detail::plans_reader(path);
  return reader ? read_whole(**reader) : base::Result<model::City>(reader.failure());
}

auto plan_json(const model::Plan& plan) -> std::string {
  detail::JsonText json;
  detail::append_plan(json.begin_object(), plan);
  return std::move(json.end_object()).str();
}

auto read_plan(std::string_view json, const std::string& name) -> base::Result<model::Plan> {
  return detail::parse_plan(json, name);
}

}  // namespace mansard::formats
