// Models of large runs: a list of all buildings, and models for those that a page shows.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "apps/server/inspect.hpp"
#include "apps/server/model_boxes.hpp"
#include "apps/server/models.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

/// Buildings whose models are kept: about 100 MB of houses.
constexpr std::size_t most_kept = 10'000;
/// Side of a tile, m: some hundred houses.
constexpr std::int64_t tile_size = 200;

auto tile_of(const geometry::Box2& box) -> std::pair<std::int64_t, std::int64_t> {
  const auto along = [](double low, double high) {
    return static_cast<std::int64_t>(std::floor((low + high) / 2 / static_cast<double>(tile_size)));
  };
  if (box.least.x > box.most.x) return {0, 0};  // a building without parts
  return {along(box.least.x, box.most.x), along(box.least.y, box.most.y)};
}

/// Where the roof of a plan is at about half its height: what a box in place of the model has as its top.
auto middle_of_roof(const model::Plan& plan) -> double {
  double eaves = plan.cap, top = 0;
  for (const auto& profile : plan.profiles) {
    for (const auto& point : profile) top = std::max(top, point.height);
    const auto leaves = std::ranges::find_if(profile, [](const auto& point) { return point.inward > 0; });
    if (leaves != profile.begin() && leaves != profile.end()) eaves = std::min(eaves, std::prev(leaves)->height);
  }
  top = std::min(top > 0 ? top : plan.cap, plan.cap);
  return std::isfinite(top) ? (std::min(eaves, top) + top) / 2 : 0;
}

auto centimetres(double metres) -> std::string { return std::to_string(std::llround(100 * metres)); }

/// [base, height, x, y, x, y …] of every part, in centimetres.
auto shapes_of(const std::vector<edit::NamedPlan>& parts) -> std::string {
  std::string out = "[";
  for (const auto& part : parts) {
    if (out.size() > 1) out += ',';
    (((out += '[') += centimetres(part.plan.base)) += ',') += centimetres(middle_of_roof(part.plan));
    for (const auto& p : part.plan.outer.points) (((out += ',') += centimetres(p.x)) += ',') += centimetres(p.y);
    out += ']';
  }
  return out + ']';
}

/// One column of the list.
template <class Rows, class Text>
auto listed(const char* name, const Rows& rows, Text text) -> std::string {
  std::string out = std::string(",\"") + name + "\":[";
  for (std::size_t i = 0; i < rows.size(); ++i) (out += i == 0 ? "" : ",") += text(i);
  return out + ']';
}

/// A word of a search: a text, or a comparison such as measuredHeight>12. As src/panels/attribute_text.ts has it.
struct Term {
  std::string text, name, value;
  char is = 0;
};

auto terms_of(const std::string& words) -> std::vector<Term> {
  std::vector<Term> out;
  std::string word;
  for (const char c : base::lower(words) + ' ') {
    if (c != ' ' && c != '\t' && c != '\n') {
      word += c;
      continue;
    }
    if (word.empty()) continue;
    const auto at = word.find_first_of("<>=");
    if (at == std::string::npos || at == 0 || at + 1 == word.size()) out.push_back({word, {}, {}, 0});
    else out.push_back({{}, word.substr(0, at), word.substr(at + 1), word[at]});
    word.clear();
  }
  return out;
}

/// As the page shows it.
auto shown(const model::Value& value) -> std::string {
  if (const auto* text = std::get_if<std::string>(&value)) return base::lower(*text);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "yes" : "no";
  return {};
}

auto as_number(const model::Value& value) -> std::optional<double> {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  return std::nullopt;
}

auto holds(const Term& term, const model::Value& value) -> bool {
  const auto number = as_number(value);
  const auto wanted = base::to_number(term.value);
  if (term.is == '=') return number ? wanted && *number == *wanted : shown(value) == term.value;
  return number && wanted && (term.is == '<' ? *number < *wanted : *number > *wanted);
}

/// Whether one of the lists has such a value. A name may be given by its end, where none is equal to it.
auto holds(const Term& term, const std::vector<const model::Attributes*>& lists) -> bool {
  for (const bool whole : {true, false}) {
    bool named = false, found = false;
    for (const auto* list : lists)
      for (const auto& [name, value] : *list) {
        const auto own = base::lower(name);
        if (whole ? own != term.name : !own.ends_with(term.name)) continue;
        named = true;
        found = found || holds(term, value);
      }
    if (named) return found;
  }
  return false;
}

}  // namespace

auto Models::list() const -> std::string {
  const auto now = view();
  const auto& all = now->buildings;
  std::string reasons;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!reports_[i].reasons.empty())
      (((reasons += reasons.empty() ? "" : ",") += text_of(all[i]->id)) += ':') += reports_[i].reasons;
  std::string out = R"({"tile_size":)" + std::to_string(tile_size);
  out += listed("ids", all, [&](auto i) { return text_of(all[i]->id); });
  out += listed("blocks", all, [&](auto i) { return text_of(reports_[i].block); });
  out += listed("outcomes", all, [&](auto i) { return text_of(reports_[i].outcome); });
  out += listed("volumes", all, [&](auto i) { return text_of(std::round(all[i]->volume * 100) / 100); });
  out += listed("errors", all, [&](auto i) { return all[i]->mse ? text_of(*all[i]->mse) : std::string("null"); });
  out += listed("confidences", all, [&](auto i) {
    const auto& right = reports_[i].confidence;
    return right && !all[i]->edited ? text_of(*right) : std::string("null");
  });
  out += listed("edited", all, [&](auto i) { return std::string(all[i]->edited ? "true" : "false"); });
  out += listed("shapes", all, [&](auto i) { return shapes_of(all[i]->parts); });
  out += R"(,"attributes":)" + text_of(meanings_json(names()));
  return out + R"(,"reasons":{)" + reasons + R"(},"history":)" + text_of(now->history) + '}';
}

auto Models::tile(std::int64_t column, std::int64_t row) const -> std::string {
  const auto now = view();
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < now->buildings.size(); ++i)
    if (tile_of(now->buildings[i]->box) == std::pair(column, row)) which.push_back(i);
  std::string out;
  for (const auto& building : made_all(which, *now)) (out += out.empty() ? "" : ",") += building->json;
  return R"({"buildings":[)" + out + "]}";
}

auto Models::names() const -> std::vector<std::string> {
  std::vector<std::string> order;
  std::set<std::string, std::less<>> seen;
  std::vector<std::string_view> last, now;  // most buildings have the names of the one before
  const auto note = [&](const std::string& name) {
    if (seen.insert(name).second) order.push_back(name);
  };
  if (aside_) std::ranges::for_each(aside_->names(), note);
  const auto add = [&](const model::Attributes& attributes) {
    now.clear();
    for (const auto& one : attributes) now.emplace_back(one.first);
    if (now == last) return;
    for (const auto name : now)
      if (seen.emplace(name).second) order.emplace_back(name);
    std::swap(last, now);
  };
  for (const auto& building : city_.buildings) add(building.attributes);
  for (const auto& building : city_.buildings)
    for (const auto& part : building.parts) add(part.attributes);
  for (const auto& own : report::review_attributes()) note(own.name);
  return order;
}

auto Models::column(const std::string& attribute,
                    const std::map<std::string, model::Attributes, std::less<>>& more) const
    -> base::Result<std::string> {
  const auto known = names();
  if (std::ranges::find(known, attribute) == known.end())
    return base::error("server-unknown", "no building of the run has this attribute", base::on_one_line(attribute));
  const auto meaning = meanings_json({attribute});
  const bool computed = !meaning[0]["source"].get<bool>();
  const auto of_reviews = report::review_attributes();
  const bool of_review = std::ranges::find(of_reviews, attribute, &formats::Attribute::name) != of_reviews.end();
  const auto in = [&](const model::Attributes& attributes) {
    return std::ranges::find(attributes, attribute, &model::Attributes::value_type::first);
  };
  const auto now = view();
  std::string out = R"({"attribute":)" + text_of(meaning[0]) + R"(,"values":[)";
  for (std::size_t b = 0; b < now->buildings.size(); ++b) {
    if (b > 0) out += ',';
    model::Building kept;
    if (aside_)
      if (auto read = attributes_of(b, kept); !read) return read.failure();
    const auto& building = aside_ ? kept : city_.buildings[b];
    const auto& id = now->buildings[b]->id;
    if (of_review)
      if (const auto decided = more.find(id); decided != more.end()) {
        const auto at = in(decided->second);
        out += at == decided->second.end() ? std::string("null") : text_of(value_json(at->second));
        continue;
      }
    const model::Value* value = nullptr;
    if (const auto at = in(building.attributes); at != building.attributes.end()) value = &at->second;
    for (const auto& part : building.parts) {
      if (value != nullptr) break;
      if (const auto at = in(part.attributes); at != part.attributes.end()) value = &at->second;
    }
    const bool changed = computed && now->buildings[b]->edited && model_now(id)->changed;
    out += value == nullptr || changed ? std::string("null") : text_of(value_json(*value));
  }
  return out + "]}";
}

auto Models::search(const std::string& words, const std::map<std::string, model::Attributes, std::less<>>& more) const
    -> std::string {
  const auto now = view();
  const auto terms = terms_of(words);
  std::string out;
  for (std::size_t b = 0; b < now->buildings.size(); ++b) {
    const auto& building = *now->buildings[b];
    model::Building kept;
    if (aside_) (void)attributes_of(b, kept);  // where the disk fails it is found by the rest
    const auto& own = aside_ ? kept : city_.buildings[b];
    std::vector<const model::Attributes*> lists{&own.attributes};
    for (const auto& part : own.parts) lists.push_back(&part.attributes);
    if (const auto found = more.find(building.id); found != more.end()) lists.push_back(&found->second);
    const auto has = [&](const Term& term) {
      if (term.is != 0) return holds(term, lists);
      const auto in = [&](const std::string& text) { return base::lower(text).find(term.text) != std::string::npos; };
      if (in(building.id) || in(reports_[b].block) || in(reports_[b].outcome)) return true;
      if (building.edited && in("edited")) return true;
      return std::ranges::any_of(lists, [&](const auto* list) {
        return std::ranges::any_of(*list, [&](const auto& one) {
          const auto* text = std::get_if<std::string>(&one.second);
          return text != nullptr && in(*text);
        });
      });
    };
    if (std::ranges::all_of(terms, has)) (out += out.empty() ? "" : ",") += text_of(building.id);
  }
  return R"({"ids":[)" + out + "]}";
}

auto Models::made(std::size_t at, const View& view) const -> std::shared_ptr<const Seen> {
  const auto& known = view.buildings[at];
  if (known->made) return known;
  {
    const std::scoped_lock lock(kept_mutex_);
    if (const auto found = kept_at_.find(known.get()); found != kept_at_.end()) {
      kept_.splice(kept_.begin(), kept_, found->second);
      return kept_.front().made;
    }
  }
  auto building = raised({known->id, 0, known->parts}, at, {}, view, nullptr);
  for (std::size_t p = 0; p < building.parts.size() && !known->edited; ++p) building.parts[p].mse = mse_of_run(at, p);
  building.mse = known->mse;
  auto made = with_models(*known, building);
  const std::scoped_lock lock(kept_mutex_);
  kept_.push_front({known, made});
  kept_at_[known.get()] = kept_.begin();
  if (kept_.size() > most_kept) {
    kept_at_.erase(kept_.back().from.get());
    kept_.pop_back();
  }
  return made;
}

auto Models::made_all(const std::vector<std::size_t>& which, const View& view) const
    -> std::vector<std::shared_ptr<const Seen>> {
  std::vector<std::shared_ptr<const Seen>> out(which.size());
  base::parallel_for(which.size(), [&](std::size_t i) { out[i] = made(which[i], view); });
  return out;
}

auto Models::edited_around(const std::string& building, const SceneOrNone& scene) const -> base::Result<model::City> {
  const auto now = view();
  const auto at = index_.find(building);
  if (at == index_.end())
    return base::error("edit-building", "unknown building; /api/runs/{run}/list lists those of the run", building);
  model::City city{city_.frame, city_.made_by, {}};
  std::vector<edit::Change> changes;
  const auto take = [&](std::size_t b) {
    const auto& building_now = *now->buildings[b];
    const auto& first = city_.buildings[b].parts;
    const bool same = std::ranges::equal(first, building_now.parts, [](const auto& part, const auto& plan) {
      return part.id == plan.id && part.plan == plan.plan;
    });
    if (!same) changes.push_back({building_now.id, 0, building_now.parts});
  };
  const auto add = [&](std::size_t b) -> base::Result<void> {
    auto own = with_attributes(b);
    if (!own) return own.failure();
    city.buildings.push_back(std::move(*own));
    take(b);
    return {};
  };
  if (auto added = add(at->second); !added) return added.failure();
  for (std::size_t b = 0; b < now->buildings.size(); ++b)
    if (b != at->second && touch(now->buildings[at->second]->box, now->buildings[b]->box))
      if (auto added = add(b); !added) return added.failure();
  edit::History history(city);
  if (!changes.empty())
    if (auto applied = history.apply({"edits", std::move(changes)}); !applied) return applied.error();
  std::vector<std::shared_ptr<const rays::Scene>> used;  // until the city is made
  std::mutex mutex;
  const auto mesh_of = [&](std::string_view id) -> const rays::Scene* {
    auto mesh = scene ? scene->rays_of(id) : nullptr;
    const std::scoped_lock adding(mutex);
    return used.emplace_back(std::move(mesh)).get();
  };
  return edit::edited_city(city, history, mesh_of, options_);
}

}  // namespace mansard::server
