// Models: what was measured is kept in the folder of the run, so that a project that is opened again shows its errors
// before the mesh has been read, and only what was edited since is measured again.
#include "apps/server/model_boxes.hpp"
#include "apps/server/models.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/plans.hpp"

namespace mansard::server {
namespace {

auto file_in(const std::filesystem::path& folder) -> std::filesystem::path { return folder / "measured.json"; }

auto or_null(const std::optional<double>& value) -> Json { return value ? Json(*value) : Json(nullptr); }
auto number_or_none(const Json& value) -> std::optional<double> {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

}  // namespace

auto hash_of(const std::vector<edit::NamedPlan>& parts) -> std::string {
  std::string text;
  for (const auto& part : parts) ((text += part.id) += '\n') += formats::plan_json(part.plan) + '\n';
  return formats::sha256(text);
}

auto Models::measure_key(std::size_t building, const geometry::Box2& over, const std::vector<std::string>& plans,
                         const std::vector<geometry::Box2>& boxes) const -> std::string {
  std::string text = inputs_ + plans[building];
  for (std::size_t other = 0; other < boxes.size(); ++other)
    if (other != building && touch(over, boxes[other])) text += plans[other];
  return formats::sha256(text);
}

/// A file that is missing, damaged or of other inputs costs a measurement, and nothing else.
void Models::read_measures() {
  if (inputs_.empty()) return;
  const auto text = base::read_file(file_in(folder_));
  if (!text) return;
  try {
    const auto json = Json::parse(*text);
    if (json.at("inputs") != inputs_) return;
    for (const auto& [id, one] : json.at("buildings").items()) {
      Measure measure;
      const auto& over = one.at("over");
      measure.over = {{over.at(0), over.at(1)}, {over.at(2), over.at(3)}};
      measure.key = one.at("key");
      measure.mse = number_or_none(one.at("mse"));
      for (const auto& part : one.at("parts")) measure.mse_of_parts.push_back(number_or_none(part));
      measures_.emplace(id, std::move(measure));
    }
  } catch (const Json::exception&) {
    measures_.clear();
  }
}

void Models::keep_measures(const OpenScene& scene) const {
  if (inputs_.empty()) return;
  const auto now = view();
  std::vector<std::string> plans;
  std::vector<geometry::Box2> boxes;
  for (const auto& building : now->buildings) {
    plans.push_back(hash_of(*building->parts));  // a large run keeps no measures
    boxes.push_back(building->box);
  }
  Json all = Json::object();
  for (std::size_t b = 0; b < now->buildings.size(); ++b) {
    const auto& building = *now->buildings[b];
    if (!building.measured) continue;
    const auto* member = scene.member_of(building.id);
    const auto over = member == nullptr ? building.box : geometry::bounds(member->polygons);
    if (!(over.least.x <= over.most.x)) continue;  // neither footprint nor parts
    Json parts = Json::array();
    for (const auto& mse : building.mse_of_parts) parts.push_back(or_null(mse));
    all[building.id] = {{"over", {over.least.x, over.least.y, over.most.x, over.most.y}},
                        {"key", measure_key(b, over, plans, boxes)},
                        {"mse", or_null(building.mse)},
                        {"parts", std::move(parts)}};
  }
  (void)write_durably(file_in(folder_), text_of({{"inputs", inputs_}, {"buildings", std::move(all)}}));
}

}  // namespace mansard::server
