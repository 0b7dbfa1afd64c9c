#include "apps/server/models.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/files.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::server {
namespace {

/// m; buildings farther apart have nothing to do with each other.
constexpr double near = 1.0;

auto box_of(const std::vector<edit::NamedPlan>& parts) -> geometry::Box2 {
  geometry::Box2 box;
  for (const auto& part : parts)
    for (const auto& point : part.plan.outer.points) box.add(point);
  return box;
}

auto touch(const geometry::Box2& a, const geometry::Box2& b) -> bool {
  return a.least.x <= b.most.x + near && b.least.x <= a.most.x + near && a.least.y <= b.most.y + near &&
         b.least.y <= a.most.y + near;
}

auto number(const model::Attributes& attributes, std::string_view name) -> std::optional<double> {
  for (const auto& [key, value] : attributes)
    if (const auto* found = std::get_if<double>(&value); found != nullptr && key == name) return *found;
  return std::nullopt;
}

auto squared(const std::optional<double>& value) -> std::optional<double> {
  return value ? std::optional(*value * *value) : std::nullopt;
}

auto joined(const std::vector<std::string>& texts) -> std::string {
  std::string all = "[";
  for (const auto& text : texts) all += (all.size() > 1 ? "," : "") + text;
  return all + "]";
}

auto without_braces(const Json& json) -> std::string {
  const auto text = text_of(json);
  return text.substr(1, text.size() - 2);
}

auto no_building(const std::string& id) -> base::Diagnostic {
  return base::error("edit-building", "the run has no such building", id);
}

/// The run's city as it stands after the edits: plans and ids, without attributes.
auto standing(const model::City& city, const edit::History& history) -> model::City {
  model::City out{city.frame, city.made_by, {}};
  for (const auto& building : city.buildings) {
    model::Building now{building.id, {}, {}, building.ground, {}};
    for (const auto& part : *history.parts(building.id)) now.parts.push_back({part.id, part.plan, {}, {}});
    out.buildings.push_back(std::move(now));
  }
  return out;
}

/// The error of a building's parts, weighted by their area.
auto together(const std::vector<edit::RaisedPart>& parts) -> std::optional<double> {
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

Models::Models(model::City city, edit::History history, Journal journal, pipeline::Options options)
    : city_(std::move(city)), options_(std::move(options)), history_(std::move(history)), journal_(std::move(journal)) {
  for (std::size_t b = 0; b < city_.buildings.size(); ++b) index_[city_.buildings[b].id] = b;
}

auto Models::open(const std::filesystem::path& folder, const RunRecord& run, const SceneOrNone& scene)
    -> base::Result<std::shared_ptr<Models>> {
  pipeline::Options options;
  if (auto set = set_all(options, run.options); !set) return set.error();
  auto city = formats::read_plans(folder / "plans.json");
  if (!city) return city.error();
  const auto path = folder / "journal.jsonl";
  std::error_code status;
  std::string text;
  if (std::filesystem::exists(path, status)) {
    auto read = base::read_file(path);
    if (!read) return read.error();
    text = std::move(*read);
  }
  auto replayed = edit::replay(*city, text);
  if (!replayed) {
    auto why = replayed.error();
    why.subject = path.string();
    return why;
  }
  auto journal = Journal::open(path, replayed->kept);
  if (!journal) return journal.error();
  const std::shared_ptr<Models> models(
      new Models(std::move(*city), std::move(replayed->history), std::move(*journal), std::move(options)));
  if (auto read = models->read_reports(folder / "report.json"); !read) return read.error();
  if (auto raised = models->raise_all(scene.get()); !raised) return raised.error();
  return models;
}

auto Models::read_reports(const std::filesystem::path& path) -> base::Result<void> {
  const auto text = base::read_file(path);
  if (!text) return text.error();
  try {
    const auto json = Json::parse(*text);
    const auto z0 = static_cast<double>(city_.frame.origin[2]);
    reports_.resize(city_.buildings.size());
    for (const auto& building : json.at("buildings")) {
      const auto at = index_.find(building.at("id").get<std::string>());
      if (at == index_.end()) continue;
      Json reasons = Json::array();
      for (const auto& reason : building.at("reasons")) reasons.push_back(reason);
      // Of a building without parts the report has no ground; the plans have it.
      const double ground = building.contains("ground_m") ? building.at("ground_m").get<double>() - z0
                                                          : city_.buildings[at->second].ground;
      const Json fixed{{"block", building.at("block")},
                       {"outcome", building.at("outcome")},
                       {"reasons", reasons},
                       {"ground", ground}};
      reports_[at->second] = {building.at("block").get<std::string>(), without_braces(fixed)};
    }
    for (std::size_t b = 0; b < reports_.size(); ++b)
      if (reports_[b].fixed.empty())
        return base::error("server-project", "the report says nothing of a building of plans.json; delete the run",
                           city_.buildings[b].id);
  } catch (const Json::exception& e) {
    return base::error(
        "server-project",
        std::string("the report of a run cannot be read: ") + e.what() + "; restore it, or delete the run",
        path.string());
  }
  return {};
}

/// As export does: all plans at once. What is as the run left it has the error that the run measured.
auto Models::raise_all(const OpenScene* scene) -> base::Result<void> {
  auto raised = pipeline::raise_plans(standing(city_, history_), options_, {});
  if (!raised) return raised.error();
  auto view = std::make_shared<View>();
  view->history = text_of(json_of(history_));
  auto fell_short = raised->fell_short.begin();
  for (std::size_t b = 0; b < city_.buildings.size(); ++b) {
    auto& source = raised->city.buildings[b];
    const bool edited = history_.edited(source.id);
    const auto* mesh = edited && scene != nullptr ? scene->rays_of(source.id) : nullptr;
    edit::RaisedBuilding building;
    for (std::size_t p = 0; p < source.parts.size(); ++p) {
      edit::RaisedPart part{source.parts[p].id, std::move(source.parts[p].model), extrude::Outcome::full, {}, {}, 0};
      if (fell_short != raised->fell_short.end() && fell_short->building == b && fell_short->part == p) {
        part.outcome = fell_short->outcome;
        part.diagnostics = std::move(fell_short->reasons);
        ++fell_short;
      }
      part.volume = solid::volume(part.model->solid);
      if (!edited) part.mse = squared(number(city_.buildings[b].parts[p].attributes, "ms_rmse_lod22"));
      if (mesh != nullptr) {
        const double mse = evaluate::error_over(part.model->solid, model::polygon_of(source.parts[p].plan), *mesh,
                                                options_.evaluate.grid);
        if (std::isfinite(mse)) part.mse = mse;
      }
      building.parts.push_back(std::move(part));
    }
    building.mse = together(building.parts);
    view->buildings.push_back(seen(source.id, building, !edited || scene != nullptr));
  }
  view_ = std::move(view);
  return {};
}

auto Models::view() const -> std::shared_ptr<const View> {
  const std::scoped_lock lock(view_mutex_);
  return view_;
}

auto Models::all() const -> std::string {
  const auto now = view();
  std::vector<std::string> texts;
  for (const auto& building : now->buildings) texts.push_back(building->json);
  return R"({"buildings":)" + joined(texts) + R"(,"history":)" + now->history + "}";
}

auto Models::known(const edit::Change& change, const View& view) const -> base::Result<std::size_t> {
  const auto at = index_.find(change.building);
  if (at == index_.end() || at->second >= view.buildings.size()) return no_building(change.building);
  return at->second;
}

/// The neighbours are as they would be with the changes that come together with this one.
auto Models::raised(const edit::Change& change, std::size_t at, const std::vector<edit::Change>& together,
                    const View& view, const OpenScene* scene) const -> edit::RaisedBuilding {
  const auto box = box_of(change.parts);
  std::vector<model::Plan> neighbours;
  for (std::size_t b = 0; b < view.buildings.size(); ++b) {
    if (b == at) continue;
    const auto& other = *view.buildings[b];
    const auto changed = std::ranges::find(together, other.id, &edit::Change::building);
    const auto& parts = changed == together.end() ? other.parts : changed->parts;
    if (!touch(box, changed == together.end() ? other.box : box_of(parts))) continue;
    for (const auto& part : parts) neighbours.push_back(part.plan);
  }
  const auto* mesh = scene == nullptr ? nullptr : scene->rays_of(change.building);
  return edit::raise(change.parts, {neighbours, view.buildings[at]->parts, mesh}, options_);
}

auto Models::preview(const std::vector<edit::Change>& changes, const OpenScene* scene) const
    -> base::Result<std::string> {
  const auto now = view();
  std::vector<std::string> texts;
  for (const auto& change : changes) {
    const auto at = known(change, *now);
    if (!at) return at.error();
    const auto building = raised(change, *at, changes, *now, scene);
    texts.push_back(text_of(json_of(change.building, now->buildings[*at]->revision, change.parts, building)));
  }
  return R"({"buildings":)" + joined(texts) + "}";
}

auto Models::plan_of(const PartName& name) const -> base::Result<model::Plan> {
  const auto now = view();
  const auto at = index_.find(name.building);
  if (at == index_.end()) return no_building(name.building);
  const auto& parts = now->buildings[at->second]->parts;
  const auto part = std::ranges::find(parts, name.part, &edit::NamedPlan::id);
  if (part == parts.end())
    return base::error("edit-part", "the building has no part '" + name.part + "'", name.building);
  return part->plan;
}

auto Models::split(const SplitRequest& request) const -> base::Result<std::string> {
  const auto now = view();
  const auto at = index_.find(request.at.building);
  if (at == index_.end()) return no_building(request.at.building);
  const auto& building = *now->buildings[at->second];
  auto parts = edit::split(building.id, building.parts, request.at.part, request.line);
  if (!parts) return parts.error();
  const Json change = json_of(edit::Change{building.id, building.revision, std::move(*parts)});
  return text_of({{"changes", Json::array({change})}});
}

auto Models::merge(const MergeRequest& request) const -> base::Result<std::string> {
  const auto now = view();
  const auto& [first, second] = request;
  if (first.building == second.building && first.part == second.part)
    return base::error("edit-merge", "this is one part; choose two", first.part);
  const auto a = plan_of(first), b = plan_of(second);
  if (!a) return a.error();
  if (!b) return b.error();
  auto plan = edit::merge(*a, *b);
  if (!plan) return plan.error();
  std::vector<edit::Change> changes;
  for (const auto* name : {&first, &second}) {
    if (!changes.empty() && changes.front().building == name->building) continue;
    const auto& building = *now->buildings[index_.find(name->building)->second];
    edit::Change change{building.id, building.revision, building.parts};
    if (building.id == second.building)
      std::erase_if(change.parts, [&](const auto& part) { return part.id == second.part; });
    if (building.id == first.building)
      for (auto& part : change.parts)
        if (part.id == first.part) part.plan = *plan;
    changes.push_back(std::move(change));
  }
  Json all = Json::array();
  for (const auto& change : changes) all.push_back(json_of(change));
  return text_of({{"changes", std::move(all)}});
}

auto Models::seen(const std::string& id, const edit::RaisedBuilding& raised, bool measured) const
    -> std::shared_ptr<const Seen> {
  auto out = std::make_shared<Seen>();
  out->id = id;
  out->revision = history_.revision(id);
  out->parts = *history_.parts(id);
  out->box = box_of(out->parts);
  out->measured = measured;
  out->json = "{" + without_braces(json_of(id, out->revision, out->parts, raised)) + "," +
              reports_[index_.find(id)->second].fixed + R"(,"edited":)" + (history_.edited(id) ? "true" : "false") +
              "}";
  return out;
}

/// Raises what changed, and what stands so near that its party walls may have, and shows all of it at once.
auto Models::publish(const std::vector<std::string>& changed, const OpenScene* scene) -> Changed {
  const auto before = view();
  std::vector<geometry::Box2> boxes;
  for (const auto& id : changed) {
    boxes.push_back(before->buildings[index_.find(id)->second]->box);
    boxes.push_back(box_of(*history_.parts(id)));
  }
  std::vector<edit::Change> now;
  for (const auto& id : changed) now.push_back({id, 0, *history_.parts(id)});
  for (const auto& building : before->buildings) {
    const auto near_by = [&](const geometry::Box2& box) { return touch(box, building->box); };
    if (std::ranges::find(changed, building->id) == changed.end() && !building->parts.empty() &&
        std::ranges::any_of(boxes, near_by))
      now.push_back({building->id, 0, building->parts});
  }
  std::vector<std::shared_ptr<const Seen>> anew(now.size());
  base::parallel_for(now.size(), [&](std::size_t i) {
    const auto at = index_.find(now[i].building)->second;
    const auto building = raised(now[i], at, now, *before, scene);
    anew[i] = seen(now[i].building, building, scene != nullptr);
  });

  auto after = std::make_shared<View>(*before);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < now.size(); ++i) {
    auto& slot = after->buildings[index_.find(now[i].building)->second];
    if (i >= changed.size() && slot->json == anew[i]->json) continue;
    if (i >= changed.size() && scene == nullptr) continue;  // its error would be lost
    slot = anew[i];
    texts.push_back(slot->json);
  }
  after->history = text_of(json_of(history_));
  ++after->number;
  {
    const std::scoped_lock lock(view_mutex_);
    view_ = after;
  }
  return {joined(texts), after->history, history_.done()};
}

auto Models::apply(edit::Edit edit, const OpenScene* scene) -> base::Result<Changed> {
  const std::scoped_lock lock(edits_);
  const auto now = view();
  auto tried = history_;  // all that apply() may find wrong comes before the work
  if (auto applied = tried.apply(edit); !applied) return applied.error();
  std::vector<std::string> changed;
  for (const auto& change : edit.changes) {
    const auto at = known(change, *now);
    if (!at) return at.error();
    const auto building = raised(change, *at, edit.changes, *now, scene);
    changed.push_back(change.building);
    if (building.valid()) continue;
    auto why = building.diagnostics;
    for (const auto& part : building.parts) why.insert(why.end(), part.diagnostics.begin(), part.diagnostics.end());
    const auto worst = std::ranges::find(why, base::Severity::error, &base::Diagnostic::severity);
    return base::error("edit-invalid",
                       "the models would not be valid" +
                           (worst == why.end() ? std::string() : ": " + worst->message + " [" + worst->code + "]"),
                       worst == why.end() || worst->subject.empty() ? change.building : worst->subject);
  }
  if (auto written = journal_.append(edit::journal_line(edit)); !written) return written.error();
  history_ = std::move(tried);
  return publish(changed, scene);
}

auto Models::step(base::Result<std::vector<std::string>> (edit::History::*one)(), std::string_view line,
                  const OpenScene* scene) -> base::Result<Changed> {
  const std::scoped_lock lock(edits_);
  auto tried = history_;
  const auto changed = (tried.*one)();
  if (!changed) return changed.error();
  if (auto written = journal_.append(line); !written) return written.error();
  history_ = std::move(tried);
  return publish(*changed, scene);
}

auto Models::undo(const OpenScene* scene) -> base::Result<Changed> {
  return step(&edit::History::undo, edit::undo_line, scene);
}

auto Models::redo(const OpenScene* scene) -> base::Result<Changed> {
  return step(&edit::History::redo, edit::redo_line, scene);
}

auto Models::measure(const OpenScene& scene) -> std::optional<Changed> {
  const std::scoped_lock lock(edits_);
  std::vector<std::string> unmeasured;
  for (const auto& building : view()->buildings)
    if (!building->measured) unmeasured.push_back(building->id);
  if (unmeasured.empty()) return std::nullopt;
  return publish(unmeasured, &scene);
}

auto Models::edited(const SceneOrNone& scene) -> base::Result<std::shared_ptr<const model::City>> {
  const std::scoped_lock lock(export_mutex_);
  std::optional<edit::History> history;
  std::uint64_t number = 0;
  {
    const std::scoped_lock edits(edits_);
    number = view()->number;
    if (export_ && export_->number == number && export_->with_scene == (scene != nullptr)) return export_->city;
    history = history_;
  }
  const auto mesh_of = [&](std::string_view id) { return scene ? scene->rays_of(id) : nullptr; };
  auto city = edit::edited_city(city_, *history, mesh_of, options_);
  if (!city) return city.error();
  export_ = Export{number, scene != nullptr, std::make_shared<const model::City>(std::move(*city))};
  return export_->city;
}

}  // namespace mansard::server
