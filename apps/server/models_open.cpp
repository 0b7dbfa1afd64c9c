// Models: opened from what a run left, all plans extruded.
#include "apps/server/models.hpp"

#include <malloc.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "apps/server/model_boxes.hpp"
#include "apps/server/options.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::server {
namespace {

auto number(const model::Attributes& attributes, std::string_view name) -> std::optional<double> {
  for (const auto& [key, value] : attributes)
    if (const auto* found = std::get_if<double>(&value); found != nullptr && key == name) return *found;
  return std::nullopt;
}

/// Whether the building was edited before it was exported and opened again.
auto has_mark(const model::Building& building) -> bool {
  const auto marked = [](const model::Attributes& attributes) {
    return std::ranges::any_of(attributes, [](const auto& one) {
      const auto* flag = std::get_if<bool>(&one.second);
      return one.first == edit::edited_mark && (flag == nullptr || *flag);
    });
  };
  return marked(building.attributes) ||
         std::ranges::any_of(building.parts, [&](const auto& part) { return marked(part.attributes); });
}

auto squared(const std::optional<double>& value) -> std::optional<double> {
  return value ? std::optional(*value * *value) : std::nullopt;
}

/// The run's city after the edits: plans and ids, without attributes.
auto city_after(const model::City& city, const edit::History& history) -> model::City {
  model::City out{city.frame, city.made_by, {}};
  for (const auto& building : city.buildings) {
    model::Building now{building.id, {}, {}, building.ground, {}};
    for (const auto& part : *history.parts(building.id)) now.parts.push_back({part.id, part.plan, {}, {}});
    out.buildings.push_back(std::move(now));
  }
  return out;
}

/// The error of a building: that of its parts, weighted by area.
auto mean_error(const std::vector<edit::RaisedPart>& parts) -> std::optional<double> {
  double sum = 0, area = 0;
  for (const auto& part : parts) {
    if (!part.mse || !part.model) continue;
    const double own = label::areas(*part.model).ground;
    sum += *part.mse * own;
    area += own;
  }
  return area > 0 ? std::optional(sum / area) : std::nullopt;
}

}  // namespace

namespace {

/// The plans of a large run, with the attributes put aside.
auto read_aside(const std::filesystem::path& path, AttributesAside& aside,
                const std::function<void(const model::Building&)>& look) -> base::Result<model::City> {
  auto reader = formats::read_city(path);
  if (!reader) return reader.failure();
  model::City city{(*reader)->header().frame, (*reader)->header().made_by, {}};
  while (true) {
    auto next = (*reader)->next();
    if (!next) return next.failure();
    if (!*next) break;
    look(**next);
    aside.add(**next);
    city.buildings.push_back(std::move(**next));
  }
  if (auto refused = (*reader)->refused(); !refused.empty()) return base::Failure{std::move(refused)};
  return city;
}

}  // namespace

Models::Models(model::City city, edit::History history, Journal journal, pipeline::Options options)
    : city_(std::move(city)), options_(std::move(options)), history_(std::move(history)), journal_(std::move(journal)) {
  for (std::size_t b = 0; b < city_.buildings.size(); ++b) index_[city_.buildings[b].id] = b;
}

auto Models::open(const std::filesystem::path& folder, const RunRecord& run, const SceneOrNone& scene,
                  const std::string& inputs) -> base::Result<std::shared_ptr<Models>> {
  pipeline::Options options;
  if (auto set = set_all(options, run.options); !set) return set.error();
  const bool large = run.buildings > most_at_once;
  std::unique_ptr<AttributesAside> aside;
  std::vector<Own> own;
  if (large) {
    auto opened = AttributesAside::open();
    if (!opened) return opened.error();
    aside = std::move(*opened);
  }
  auto city = large ? read_aside(folder / "plans.json", *aside,
                                 [&](const model::Building& building) {
                                   Own of{has_mark(building), {}};
                                   for (const auto& part : building.parts) {
                                     const auto rmse = number(part.attributes, "ms_rmse_lod22");
                                     of.rmse.push_back(rmse ? std::optional(static_cast<float>(*rmse)) : std::nullopt);
                                   }
                                   own.push_back(std::move(of));
                                 })
                    : formats::read_plans(folder / "plans.json");
  if (!city) return city.error();
  const auto path = journal_of(folder);
  const auto text = read_journal(path);
  if (!text) return text.error();
  auto replayed = edit::replay(*city, *text);
  if (!replayed) {
    auto why = replayed.error();
    why.subject = path.string();
    return why;
  }
  auto journal = Journal::open(path, replayed->kept);
  if (!journal) return journal.error();
  const std::shared_ptr<Models> models(
      new Models(std::move(*city), std::move(replayed->history), std::move(*journal), std::move(options)));
  models->aside_ = std::move(aside);
  models->own_ = std::move(own);
  if (auto read = models->read_reports(folder / "report.json"); !read) return read.error();
  if (models->city_.buildings.size() > most_at_once) {
    models->list_all(scene.get());
    ::malloc_trim(0);  // what reading took is not kept
    return models;
  }
  models->folder_ = folder;
  models->inputs_ = inputs;
  models->read_measures();
  if (auto raised = models->raise_all(scene.get()); !raised) return raised.error();
  if (scene) models->keep_measures(*scene);
  return models;
}

auto Models::read_reports(const std::filesystem::path& path) -> base::Result<void> {
  std::ifstream file(path, std::ios::binary);
  if (!file) return base::error("file-missing", "the report of the run is missing; delete the run", path.string());
  const auto z0 = static_cast<double>(city_.frame.origin[2]);
  reports_.resize(city_.buildings.size());
  const auto read = [&](const Json& building) {
    const auto at = index_.find(building.at("id").get<std::string>());
    if (at == index_.end()) return;
    auto& report = reports_[at->second];
    if (const auto& reasons = building.at("reasons"); !reasons.empty()) report.reasons = text_of(reasons);
    report.block = building.at("block").get<std::string>();
    report.outcome = building.at("outcome").get<std::string>();
    // The report has no ground height for a building without parts; the plans have it.
    report.ground =
        building.contains("ground_m") ? building.at("ground_m").get<double>() - z0 : city_.buildings[at->second].ground;
    if (building.contains("confidence")) report.confidence = building.at("confidence").at("right").get<double>();
    if (building.contains("volume_m3")) report.volume = building.at("volume_m3").get<double>();
  };
  try {
    std::string list;  // the member of the whole that is being read
    // Items of the long lists are dropped as soon as they are whole.
    const auto whole = Json::parse(file, [&](int depth, Json::parse_event_t event, Json& parsed) {
      if (event == Json::parse_event_t::key && depth == 1) list = parsed.get<std::string>();
      if (event != Json::parse_event_t::object_end || depth != 2) return true;
      if (list == "buildings") read(parsed);
      return list != "buildings" && list != "blocks" && list != "warnings";
    });
    if (!whole.is_object())
      return base::error("server-project", "the report of a run is no JSON object; restore the file, or delete the run",
                         path.string());
    for (std::size_t b = 0; b < reports_.size(); ++b)
      if (reports_[b].outcome.empty())
        return base::error("server-project",
                           "the report lacks a building of plans.json; delete the run and start it again",
                           city_.buildings[b].id);
  } catch (const Json::exception& e) {
    return base::error(
        "server-project",
        std::string("the report of a run cannot be read: ") + e.what() + "; restore the file, or delete the run",
        path.string());
  }
  return {};
}

/// All plans at once, as for an export. With a scene, every building is measured over its footprint, edited or not;
/// without one, buildings without edits keep the error that the run measured over their parts.
auto Models::raise_all(const OpenScene* scene) -> base::Result<void> {
  auto raised = pipeline::raise_plans(city_after(city_, history_), options_, {});
  if (!raised) return raised.failure();
  if (!raised->refused.empty()) return base::Failure{std::move(raised->refused)};
  auto view = std::make_shared<View>();
  view->history = json_of(history_);
  view->applied = history_.done();
  std::vector<edit::RaisedBuilding> buildings(city_.buildings.size());
  auto fell_short = raised->fell_short.begin();
  for (std::size_t b = 0; b < city_.buildings.size(); ++b) {
    auto& source = raised->city.buildings[b];
    for (std::size_t p = 0; p < source.parts.size(); ++p) {
      edit::RaisedPart part{source.parts[p].id, std::move(source.parts[p].model), extrude::Outcome::full, {}, {}, 0};
      if (fell_short != raised->fell_short.end() && fell_short->building == b && fell_short->part == p) {
        part.outcome = fell_short->outcome;
        part.diagnostics = std::move(fell_short->reasons);
        ++fell_short;
      }
      part.volume = solid::volume(part.model->solid);
      if (!history_.edited(source.id)) part.mse = mse_of_run(b, p);
      buildings[b].parts.push_back(std::move(part));
    }
  }
  std::vector<geometry::Box2> boxes;
  for (const auto& building : city_.buildings) boxes.push_back(box_of(*history_.parts(building.id)));
  std::vector<std::string> plans;
  if (!measures_.empty())
    for (const auto& building : city_.buildings) plans.push_back(hash_of(*history_.parts(building.id)));
  std::vector<char> measured(buildings.size(), scene == nullptr ? 0 : 1);
  base::parallel_for(buildings.size(), [&](std::size_t b) {
    auto& building = buildings[b];
    const auto& source = raised->city.buildings[b];
    if (const auto kept = measures_.find(source.id);
        kept != measures_.end() && kept->second.mse_of_parts.size() == building.parts.size() &&
        kept->second.key == measure_key(b, kept->second.over, plans, boxes)) {
      building.mse = kept->second.mse;
      for (std::size_t p = 0; p < building.parts.size(); ++p) building.parts[p].mse = kept->second.mse_of_parts[p];
      measured[b] = 1;
      return;
    }
    const auto mesh = scene == nullptr ? nullptr : scene->rays_of(source.id);
    const auto* member = scene == nullptr ? nullptr : scene->member_of(source.id);
    if (mesh == nullptr || member == nullptr) {
      building.mse = mean_error(building.parts);
      return;
    }
    if (history_.edited(source.id))
      for (std::size_t p = 0; p < source.parts.size(); ++p) {
        const double mse = evaluate::error_over(building.parts[p].model->solid, model::polygon_of(source.parts[p].plan),
                                                *mesh, options_.evaluate);
        if (std::isfinite(mse)) building.parts[p].mse = mse;
      }
    const auto own = geometry::bounds(member->polygons);
    std::vector<const model::Solid*> solids;
    for (std::size_t other = 0; other < buildings.size(); ++other)
      if (other == b || touch(own, boxes[other]))
        for (const auto& part : buildings[other].parts) solids.push_back(&part.model->solid);
    building.mse = evaluate::footprint_error(solids, *mesh, member->polygons, member->ground, options_.evaluate);
  });
  for (std::size_t b = 0; b < buildings.size(); ++b)
    view->buildings.push_back(seen(city_.buildings[b].id, buildings[b], measured[b] != 0));
  view_ = std::move(view);
  return {};
}

/// Without models, but for the edited buildings. The others keep the error that the run measured over their parts.
void Models::list_all(const OpenScene* scene) {
  auto view = std::make_shared<View>();
  view->history = json_of(history_);
  view->applied = history_.done();
  for (std::size_t b = 0; b < city_.buildings.size(); ++b) {
    auto listed = std::make_shared<Seen>(named(city_.buildings[b].id));
    listed->measured = true;
    listed->volume = reports_[b].volume;
    double sum = 0, area = 0;
    for (std::size_t p = 0; p < listed->parts.size() && !history_.edited(listed->id); ++p) {
      const auto mse = mse_of_run(b, p);
      const double own = geometry::area(model::polygon_of(listed->parts[p].plan));
      if (mse) sum += *mse * own, area += own;
    }
    if (area > 0) listed->mse = sum / area;
    view->buildings.push_back(std::move(listed));
  }
  for (std::size_t b = 0; b < view->buildings.size(); ++b) {
    const auto& id = view->buildings[b]->id;
    if (!history_.edited(id)) continue;
    const auto raised = this->raised({id, 0, *history_.parts(id)}, b, {}, *view, scene);
    view->buildings[b] = seen(id, raised, scene != nullptr);
  }
  view_ = std::move(view);
}

auto Models::mse_of_run(std::size_t building, std::size_t part) const -> std::optional<double> {
  if (aside_) {
    const auto& rmse = own_[building].rmse;
    return part < rmse.size() && rmse[part] ? squared(static_cast<double>(*rmse[part])) : std::nullopt;
  }
  const auto& parts = city_.buildings[building].parts;
  return part < parts.size() ? squared(number(parts[part].attributes, "ms_rmse_lod22")) : std::nullopt;
}

auto Models::with_attributes(std::size_t building) const -> base::Result<model::Building> {
  auto out = city_.buildings[building];
  if (aside_)
    if (auto restored = aside_->restore(building, out); !restored) return restored.failure();
  return out;
}

auto Models::attributes_of(std::size_t building, model::Building& to) const -> base::Result<void> {
  to.parts.resize(city_.buildings[building].parts.size());
  return aside_->restore(building, to);
}

auto Models::named(const std::string& id) const -> Seen {
  Seen out;
  out.id = id;
  out.revision = history_.revision(id);
  out.parts = *history_.parts(id);
  out.box = box_of(out.parts);
  const auto at = index_.find(id)->second;
  out.edited = history_.edited(id) || (aside_ ? own_[at].marked : has_mark(city_.buildings[at]));
  return out;
}

auto Models::seen(const std::string& id, const edit::RaisedBuilding& raised, bool measured) const
    -> std::shared_ptr<const Seen> {
  auto out = named(id);
  out.measured = measured;
  return with_models(std::move(out), raised);
}

auto Models::with_models(Seen named, const edit::RaisedBuilding& raised) const -> std::shared_ptr<const Seen> {
  auto out = std::make_shared<Seen>(std::move(named));
  out->made = true;
  out->volume = 0;
  out->mse = raised.mse;
  for (const auto& part : raised.parts) {
    out->volume += part.volume;
    out->mse_of_parts.push_back(part.mse);
    if (part.model) out->models.push_back(*part.model);
  }
  auto json = json_of(out->id, out->revision, out->parts, raised);
  const auto& report = reports_[index_.find(out->id)->second];
  json["block"] = report.block;
  json["outcome"] = report.outcome;
  json["reasons"] = report.reasons.empty() ? Json::array() : Json::parse(report.reasons);
  json["ground"] = report.ground;
  json["edited"] = out->edited;
  json["confidence"] = report.confidence && !out->edited ? Json(*report.confidence) : Json(nullptr);
  out->json = text_of(json);
  return out;
}

}  // namespace mansard::server
