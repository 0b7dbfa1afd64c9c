// The journal: a line an edit, as JSON, only ever appended to.
#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "mansard/base/nesting.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/formats/plans.hpp"

namespace mansard::edit {
namespace {

using Json = nlohmann::json;

/// Thrown and caught inside this file.
struct Defect {
  std::string what;
};

auto member(const Json& object, const char* name) -> const Json& {
  const auto found = object.find(name);
  if (found == object.end()) throw Defect{std::string("there is no \"") + name + "\""};
  return *found;
}

/// The members that an object may have, and no others.
void only(const Json& object, std::initializer_list<std::string_view> names) {
  if (!object.is_object()) throw Defect{"an object was expected"};
  for (const auto& [key, value] : object.items())
    if (std::find(names.begin(), names.end(), key) == names.end()) throw Defect{"\"" + key + "\" is not known"};
}

auto text_of(const Json& json) -> std::string {
  if (!json.is_string()) throw Defect{"a text was expected"};
  return json.get<std::string>();
}

auto items_of(const Json& json) -> const Json& {
  if (!json.is_array()) throw Defect{"an array was expected"};
  return json;
}

auto part_of(const Json& json) -> NamedPlan {
  only(json, {"id", "plan"});
  auto plan = formats::read_plan(member(json, "plan").dump(), "plan");
  if (!plan) throw Defect{plan.error().message};
  return {text_of(member(json, "id")), std::move(*plan)};
}

auto change_of(const Json& json) -> Change {
  only(json, {"building", "revision", "parts"});
  Change change;
  change.building = text_of(member(json, "building"));
  if (!member(json, "revision").is_number_unsigned()) throw Defect{"a revision is a whole number"};
  change.revision = member(json, "revision").get<std::uint64_t>();
  for (const auto& part : items_of(member(json, "parts"))) change.parts.push_back(part_of(part));
  return change;
}

auto edit_of(const Json& json) -> Edit {
  only(json, {"what", "changes"});
  Edit edit;
  edit.what = text_of(member(json, "what"));
  for (const auto& change : items_of(member(json, "changes"))) edit.changes.push_back(change_of(change));
  return edit;
}

/// Does what the line says; what is wrong with it otherwise.
auto fault_of(std::string_view line, History& history) -> std::optional<std::string> {
  const auto fault = [](const auto& result) -> std::optional<std::string> {
    if (result) return std::nullopt;
    return result.error().message;
  };
  if (base::nests_too_deep(line)) return "it is nested too deep";
  try {
    if (line == undo_line) return fault(history.undo());
    if (line == redo_line) return fault(history.redo());
    return fault(history.apply(edit_of(Json::parse(line))));
  } catch (const Json::exception&) {
    return "it is not JSON";
  } catch (const Defect& defect) {
    return defect.what;
  }
}

/// The lines of a journal without their line breaks. What follows the last line break was cut short and is dropped.
auto complete_lines(std::string_view journal) -> std::vector<std::string_view> {
  std::vector<std::string_view> lines;
  for (std::size_t from = 0;;) {
    const auto end = journal.find('\n', from);
    if (end == std::string_view::npos) return lines;
    lines.push_back(journal.substr(from, end - from));
    from = end + 1;
  }
}

}  // namespace

auto journal_line(const Edit& edit) -> std::string {
  using Ordered = nlohmann::ordered_json;
  Ordered line{{"what", edit.what}, {"changes", Ordered::array()}};
  for (const auto& change : edit.changes) {
    Ordered parts = Ordered::array();
    for (const auto& part : change.parts)
      parts.push_back({{"id", part.id}, {"plan", Ordered::parse(formats::plan_json(part.plan))}});
    line["changes"].push_back(
        {{"building", change.building}, {"revision", change.revision}, {"parts", std::move(parts)}});
  }
  return line.dump(-1, ' ', false, Ordered::error_handler_t::replace);
}

auto replay(const model::City& city, std::string_view journal) -> base::Result<Replayed> {
  return replay(History(city), journal);
}

auto replay(History start, std::string_view journal) -> base::Result<Replayed> {
  Replayed out{std::move(start), 0};
  std::size_t number = 0;
  for (const auto line : complete_lines(journal)) {
    ++number;
    if (const auto fault = fault_of(line, out.history))
      return base::error("edit-journal", "line " + std::to_string(number) + " cannot be done again: " + *fault +
                                             "; take out that line and those after it, or restore the file");
    out.kept += line.size() + 1;
  }
  return out;
}

auto applied_edits(std::string_view journal) -> std::size_t {
  std::size_t applied = 0;
  for (const auto line : complete_lines(journal)) {
    if (line != undo_line) ++applied;
    else if (applied > 0) --applied;
  }
  return applied;
}

}  // namespace mansard::edit
