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
    if (const auto& text = *reports_[i].reasons; !text.empty())
      (((reasons += reasons.empty() ? "" : ",") += text_of(all[i]->id)) += ':') += text;
  std::string out = R"({"tile_size":)" + std::to_string(tile_size);
  out += listed("ids", all, [&](auto i) { return text_of(all[i]->id); });
  out += listed("blocks", all, [&](auto i) { return text_of(*reports_[i].block); });
  out += listed("outcomes", all, [&](auto i) { return text_of(*reports_[i].outcome); });
  out += listed("volumes", all, [&](auto i) { return text_of(std::round(all[i]->volume * 100) / 100); });
  out += listed("errors", all, [&](auto i) { return all[i]->mse ? text_of(*all[i]->mse) : std::string("null"); });
  out += listed("confidences", all, [&](auto i) {
    const auto& right = reports_[i].confidence;
    return right && !all[i]->edited ? text_of(*right) : std::string("null");
  });
  out += listed("edited", all, [&](auto i) { return std::string(all[i]->edited ? "true" : "false"); });
  out += listed("shapes", all,
                [&](auto i) { return all[i]->parts ? shapes_of(*all[i]->parts) : std::string(first_->shapes(i)); });
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
  auto order = first_->attributes();
  std::set<std::string, std::less<>> seen(order.begin(), order.end());
  for (const auto& own : report::review_attributes())
    if (seen.insert(own.name).second) order.push_back(own.name);
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
  std::vector<std::string> values(now->buildings.size(), "null");
  first_->each([&](std::size_t b, const model::Building& building) {
    const auto& id = now->buildings[b]->id;
    if (of_review)
      if (const auto decided = more.find(id); decided != more.end()) {
        const auto at = in(decided->second);
        if (at != decided->second.end()) values[b] = text_of(value_json(at->second));
        return;
      }
    const model::Value* value = nullptr;
    if (const auto at = in(building.attributes); at != building.attributes.end()) value = &at->second;
    for (const auto& part : building.parts) {
      if (value != nullptr) break;
      if (const auto at = in(part.attributes); at != part.attributes.end()) value = &at->second;
    }
    const bool changed = computed && now->buildings[b]->edited && model_now(id)->changed;
    if (value != nullptr && !changed) values[b] = text_of(value_json(*value));
  });
  std::string out = R"({"attribute":)" + text_of(meaning[0]) + R"(,"values":[)";
  for (std::size_t b = 0; b < values.size(); ++b) (out += b == 0 ? "" : ",") += values[b];
  return out + "]}";
}

auto Models::search(const std::string& words, const std::map<std::string, model::Attributes, std::less<>>& more) const
    -> std::string {
  const auto now = view();
  const auto terms = terms_of(words);
  std::vector<char> found(now->buildings.size());
  first_->each([&](std::size_t b, const model::Building& own) {
    const auto& building = *now->buildings[b];
    std::vector<const model::Attributes*> lists{&own.attributes};
    for (const auto& part : own.parts) lists.push_back(&part.attributes);
    if (const auto decided = more.find(building.id); decided != more.end()) lists.push_back(&decided->second);
    const auto has = [&](const Term& term) {
      if (term.is != 0) return holds(term, lists);
      const auto in = [&](const std::string& text) { return base::lower(text).find(term.text) != std::string::npos; };
      if (in(building.id) || in(*reports_[b].block) || in(*reports_[b].outcome)) return true;
      if (building.edited && in("edited")) return true;
      return std::ranges::any_of(lists, [&](const auto* list) {
        return std::ranges::any_of(*list, [&](const auto& one) {
          const auto* text = std::get_if<std::string>(&one.second);
          return text != nullptr && in(*text);
        });
      });
    };
    found[b] = std::ranges::all_of(terms, has) ? 1 : 0;
  });
  std::string out;
  for (std::size_t b = 0; b < found.size(); ++b)
    if (found[b] != 0) (out += out.empty() ? "" : ",") += text_of(now->buildings[b]->id);
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
  auto own = *known;
  own.parts = parts_of(at, own);
  auto building = raised({own.id, 0, *own.parts}, at, {}, view, nullptr);
  if (!own.edited) {
    const auto first = first_->building(at);
    for (std::size_t p = 0; p < building.parts.size(); ++p) building.parts[p].mse = mse_of_run(*first, p);
  }
  building.mse = own.mse;
  auto made = with_models(std::move(own), building);
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
  model::City city{first_->frame(), first_->made_by(), {}};
  std::vector<edit::Change> changes;
  const auto add = [&](std::size_t b) {
    const auto& building_now = *now->buildings[b];
    const auto& own = city.buildings.emplace_back(*first_->building(b));
    if (building_now.parts &&
        !std::ranges::equal(own.parts, *building_now.parts, [](const auto& part, const auto& plan) {
          return part.id == plan.id && part.plan == plan.plan;
        }))
      changes.push_back({building_now.id, 0, *building_now.parts});
  };
  add(at->second);
  for (std::size_t b = 0; b < now->buildings.size(); ++b)
    if (b != at->second && touch(now->buildings[at->second]->box, now->buildings[b]->box)) add(b);
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
