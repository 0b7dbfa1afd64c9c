// Models: opened from what a run left, all plans extruded.
#include "apps/server/models.hpp"

#include <malloc.h>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "apps/server/model_boxes.hpp"
#include "apps/server/options.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/formats/plans_file.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::server {
namespace {

auto squared(const std::optional<double>& value) -> std::optional<double> {
  return value ? std::optional(*value * *value) : std::nullopt;
}

/// The run's city after the edits: plans and ids, without attributes.
auto city_after(const model::City& city, const edit::History& history) -> model::City {
  model::City out{city.frame, city.made_by, {}};
  for (const auto& building : city.buildings) {
    model::Building now{building.id, {}, {}, building.ground, {}};
    const auto parts = history.parts(building.id);
    for (const auto& part : *parts) now.parts.push_back({part.id, part.plan, {}, {}});
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

Models::Models(std::shared_ptr<const RunBuildings> first, edit::History history, Journal journal,
               pipeline::Options options)
    : first_(std::move(first)),
      options_(std::move(options)),
      history_(std::move(history)),
      journal_(std::move(journal)) {
  index_.reserve(first_->size());
  for (std::size_t b = 0; b < first_->size(); ++b) index_[first_->id(b)] = b;
}

auto Models::open(const std::filesystem::path& folder, const RunRecord& run, const SceneOrNone& scene,
                  const std::string& inputs) -> base::Result<std::shared_ptr<Models>> {
  pipeline::Options options;
  if (auto set = set_all(options, run.options); !set) return set.error();
  const auto plans = folder / "plans.json";
  auto index = run.buildings > most_at_once ? run_index(folder) : std::nullopt;
  if (index && index->ids.size() <= most_at_once) index.reset();  // the record of the run is wrong
  std::shared_ptr<const RunBuildings> first;
  if (index)
    if (auto file = formats::PlansFile::open(plans, index->header))
      first = std::make_shared<const RunBuildings>(std::move(file), *index);
  if (!first) {
    index.reset();
    auto city = formats::read_plans(plans);
    if (!city) return city.failure();
    first = std::make_shared<const RunBuildings>(std::move(*city));
  }
  const auto path = journal_of(folder);
  const auto text = read_journal(path);
  if (!text) return text.error();
  auto replayed = edit::replay(first->in_memory() ? edit::History(*first->city()) : edit::History(first), *text);
  if (!replayed) {
    auto why = replayed.error();
    why.subject = path.string();
    return why;
  }
  auto journal = Journal::open(path, replayed->kept);
  if (!journal) return journal.error();
  const std::shared_ptr<Models> models(
      new Models(first, std::move(replayed->history), std::move(*journal), std::move(options)));
  if (index) models->take_reports(*index);
  else if (auto read = models->read_reports(folder / "report.json"); !read) return read.error();
  if (first->size() > most_at_once) {
    std::vector<std::optional<double>> errors(first->size());
    std::vector<geometry::Box2> boxes(first->size());
    if (!index)
      first->each([&](std::size_t b, const model::Building& building) {
        errors[b] = error_of(building);
        boxes[b] = box_of(*first->plans(b));
      });
    models->list_all(scene.get(), index ? index->errors : errors, index ? index->boxes : boxes);
    index.reset();
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

auto Models::shared(std::string_view text) -> const std::string* {
  const auto found = strings_.find(text);
  return &*(found != strings_.end() ? found : strings_.emplace(text).first);
}

void Models::take_reports(RunIndex& index) {
  std::vector<const std::string*> strings;
  for (const auto& text : index.strings) strings.push_back(shared(text));
  for (std::size_t b = 0; b < first_->size(); ++b)
    reports_.push_back({strings[index.blocks[b]], strings[index.outcomes[b]], strings[index.reasons[b]],
                        index.grounds[b], index.volumes[b], index.confidences[b]});
}

auto Models::read_reports(const std::filesystem::path& path) -> base::Result<void> {
  std::ifstream file(path, std::ios::binary);
  if (!file) return base::error("file-missing", "the report of the run is missing; delete the run", path.string());
  const auto z0 = static_cast<double>(first_->frame().origin[2]);
  const auto city = first_->city();
  const auto* none = shared("");
  reports_.assign(first_->size(), Report{none, none, none, 0, 0, {}});
  const auto read = [&](const Json& building) {
    const auto at = index_.find(building.at("id").get<std::string>());
    if (at == index_.end()) return;
    auto& report = reports_[at->second];
    if (const auto& reasons = building.at("reasons"); !reasons.empty()) report.reasons = shared(text_of(reasons));
    report.block = shared(building.at("block").get<std::string>());
    report.outcome = shared(building.at("outcome").get<std::string>());
    // The report has no ground height for a building without parts; the plans have it.
    report.ground =
        building.contains("ground_m") ? building.at("ground_m").get<double>() - z0 : city->buildings[at->second].ground;
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
      if (reports_[b].outcome->empty())
        return base::error("server-project",
                           "the report lacks a building of plans.json; delete the run and start it again",
                           first_->id(b));
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
  const auto whole = first_->city();
  const auto& city = *whole;
  auto raised = pipeline::raise_plans(city_after(city, history_), options_, {});
  if (!raised) return raised.failure();
  if (!raised->refused.empty()) return base::Failure{std::move(raised->refused)};
  auto view = std::make_shared<View>();
  view->history = json_of(history_);
  view->applied = history_.done();
  std::vector<edit::RaisedBuilding> buildings(city.buildings.size());
  auto fell_short = raised->fell_short.begin();
  for (std::size_t b = 0; b < city.buildings.size(); ++b) {
    auto& source = raised->city.buildings[b];
    for (std::size_t p = 0; p < source.parts.size(); ++p) {
      edit::RaisedPart part{source.parts[p].id, std::move(source.parts[p].model), extrude::Outcome::full, {}, {}, 0};
      if (fell_short != raised->fell_short.end() && fell_short->building == b && fell_short->part == p) {
        part.outcome = fell_short->outcome;
        part.diagnostics = std::move(fell_short->reasons);
        ++fell_short;
      }
      part.volume = solid::volume(part.model->solid);
      if (!history_.edited(source.id)) part.mse = mse_of_run(city.buildings[b], p);
      buildings[b].parts.push_back(std::move(part));
    }
  }
  std::vector<geometry::Box2> boxes;
  for (const auto& building : city.buildings) boxes.push_back(box_of(*history_.parts(building.id)));
  std::vector<std::string> plans;
  if (!measures_.empty())
    for (const auto& building : city.buildings) plans.push_back(hash_of(*history_.parts(building.id)));
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
    view->buildings.push_back(seen(city.buildings[b].id, buildings[b], measured[b] != 0));
  view_ = std::move(view);
  return {};
}

/// Without models, but for the edited buildings. The others keep the error that the run measured over their parts.
void Models::list_all(const OpenScene* scene, const std::vector<std::optional<double>>& errors,
                      const std::vector<geometry::Box2>& boxes) {
  auto view = std::make_shared<View>();
  view->history = json_of(history_);
  view->applied = history_.done();
  std::vector<std::size_t> edited;
  for (std::size_t b = 0; b < first_->size(); ++b) {
    auto listed = std::make_shared<Seen>();
    listed->id = first_->id(b);
    if (history_.revision(listed->id) > 0) {
      *listed = named(listed->id);
    } else {
      listed->box = boxes[b];
      listed->edited = first_->marked(b);
      if (first_->in_memory()) listed->parts = history_.parts(listed->id);
    }
    listed->measured = true;
    listed->volume = reports_[b].volume;
    if (history_.edited(listed->id)) edited.push_back(b);
    else listed->mse = errors[b];
    view->buildings.push_back(std::move(listed));
  }
  for (const auto b : edited) {
    const auto& id = view->buildings[b]->id;
    const auto raised = this->raised({id, 0, *history_.parts(id)}, b, {}, *view, scene);
    view->buildings[b] = seen(id, raised, scene != nullptr);
  }
  view_ = std::move(view);
}

auto Models::mse_of_run(const model::Building& building, std::size_t part) const -> std::optional<double> {
  const auto& parts = building.parts;
  return part < parts.size() ? squared(number_of(parts[part].attributes, "ms_rmse_lod22")) : std::nullopt;
}

auto Models::named(const std::string& id) const -> Seen {
  Seen out;
  out.id = id;
  out.revision = history_.revision(id);
  out.parts = history_.parts(id);
  out.box = box_of(*out.parts);
  out.edited = history_.edited(id) || first_->marked(index_.find(id)->second);
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
  auto json = json_of(out->id, out->revision, *out->parts, raised);
  const auto& report = reports_[index_.find(out->id)->second];
  json["block"] = *report.block;
  json["outcome"] = *report.outcome;
  json["reasons"] = report.reasons->empty() ? Json::array() : Json::parse(*report.reasons);
  json["ground"] = report.ground;
  json["edited"] = out->edited;
  json["confidence"] = report.confidence && !out->edited ? Json(*report.confidence) : Json(nullptr);
  out->json = text_of(json);
  return out;
}

}  // namespace mansard::server
