#include "apps/server/requests.hpp"

#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "mansard/base/nesting.hpp"
#include "mansard/base/options.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/plans.hpp"

namespace mansard::server {
namespace {

using Json = nlohmann::ordered_json;

/// Maximum nesting of a body; each level costs memory.
constexpr std::size_t maximum_depth = 64;

/// Thrown and caught inside this file.
struct Refused {
  base::Diagnostic why;
};

auto bad(const std::string& what, const std::string& where = {}) -> base::Diagnostic {
  return base::error("server-body", what, where);
}

/// A value and its place in the body.
struct Item {
  const Json& json;
  std::string place;

  [[nodiscard]] auto where() const -> std::string { return place.empty() ? "the body" : place; }
  [[noreturn]] void refuse(const std::string& wanted) const {
    throw Refused{bad(where() + " must be " + wanted, place)};
  }

  auto object(std::initializer_list<const char*> names) const -> const Item& {
    if (!json.is_object()) refuse("an object");
    const std::vector<std::string> known(names.begin(), names.end());
    for (const auto& [key, value] : json.items())
      if (std::ranges::find(known, key) == known.end())
        throw Refused{bad(where() + " has the unknown member \"" + base::on_one_line(key) + "\"" +
                              base::did_you_mean(base::nearest_word(key, known)),
                          place)};
    return *this;
  }
  [[nodiscard]] auto has(const char* name) const -> bool { return json.contains(name); }
  [[nodiscard]] auto member(const char* name) const -> Item {
    const auto found = json.find(name);
    if (found == json.end()) throw Refused{bad(where() + " has no \"" + name + "\"", place)};
    return {*found, place.empty() ? name : place + "." + name};
  }
  template <class Work>
  void each(Work work) const {
    if (!json.is_array()) refuse("an array");
    for (std::size_t i = 0; i < json.size(); ++i) work(Item{json[i], place + "[" + std::to_string(i) + "]"});
  }
  [[nodiscard]] auto text() const -> std::string {
    if (!json.is_string()) refuse("a string");
    return json.get<std::string>();
  }
  [[nodiscard]] auto texts() const -> std::vector<std::string> {
    std::vector<std::string> out;
    each([&](const Item& item) { out.push_back(item.text()); });
    return out;
  }
  [[nodiscard]] auto map() const -> Texts {
    if (!json.is_object()) refuse("an object of strings");
    Texts out;
    for (const auto& [key, value] : json.items()) out[key] = Item{value, place + "." + key}.text();
    return out;
  }
  [[nodiscard]] auto number() const -> double {
    if (!json.is_number()) refuse("a number");
    return json.get<double>();
  }
  [[nodiscard]] auto integer() const -> std::uint64_t {
    if (!json.is_number_unsigned()) refuse("an integer of at least 0");
    return json.get<std::uint64_t>();
  }
  [[nodiscard]] auto flag() const -> bool {
    if (!json.is_boolean()) refuse("true or false");
    return json.get<bool>();
  }
  [[nodiscard]] auto point() const -> geometry::Point2 {
    if (!json.is_array() || json.size() != 2) refuse("an array of 2 numbers");
    return {Item{json[0], place + "[0]"}.number(), Item{json[1], place + "[1]"}.number()};
  }
  [[nodiscard]] auto plan() const -> model::Plan {
    auto plan = formats::read_plan(json.dump(), place);
    if (!plan) throw Refused{plan.error()};
    return std::move(*plan);
  }
};

template <class Work>
auto reading(std::string_view body, Work work) -> base::Result<decltype(work(std::declval<const Item&>()))> {
  try {
    if (base::nests_too_deep(body, maximum_depth))
      return bad("the body is nested deeper than " + std::to_string(maximum_depth) + " levels");
    const auto json = Json::parse(body);
    return work(Item{json, {}});
  } catch (const Json::parse_error& e) {
    return bad("the body is not valid JSON at byte " + std::to_string(e.byte));
  } catch (const Json::exception&) {  // a number out of range, a string that is not UTF-8
    return bad("the body has a number out of range or a string that is not UTF-8");
  } catch (const Refused& refused) {
    return refused.why;
  }
}

auto change_of(const Item& item) -> edit::Change {
  item.object({"building", "revision", "parts"});
  edit::Change change{item.member("building").text(), item.member("revision").integer(), {}};
  item.member("parts").each([&](const Item& part) {
    part.object({"id", "plan"});
    change.parts.push_back({part.member("id").text(), part.member("plan").plan()});
  });
  return change;
}

auto changes_of(const Item& item) -> std::vector<edit::Change> {
  std::vector<edit::Change> changes;
  item.each([&](const Item& change) { changes.push_back(change_of(change)); });
  return changes;
}

auto part_of(const Item& item) -> PartName { return {item.member("building").text(), item.member("part").text()}; }

}  // namespace

auto read_inputs(std::string_view body) -> base::Result<InputsRequest> {
  return reading(body, [](const Item& item) {
    item.object({"meshes", "footprints", "reading"});
    InputsRequest request{item.member("meshes").texts(), item.member("footprints").text(), {}};
    if (request.meshes.empty()) item.member("meshes").refuse("an array of at least one file or folder");
    if (item.has("reading")) request.reading = item.member("reading").map();
    return request;
  });
}

auto read_run(std::string_view body) -> base::Result<RunRequest> {
  return reading(body, [](const Item& item) {
    item.object({"label", "preset", "options", "blocks"});
    RunRequest request;
    if (item.has("label")) request.label = base::on_one_line(item.member("label").text());
    if (item.has("preset")) request.preset = item.member("preset").text();
    if (item.has("options")) request.options = item.member("options").map();
    if (item.has("blocks")) request.blocks = item.member("blocks").texts();
    return request;
  });
}

auto read_import(std::string_view body) -> base::Result<ImportRequest> {
  return reading(body, [](const Item& item) {
    item.object({"path", "label"});
    ImportRequest request{item.member("path").text(), {}};
    if (item.has("label")) request.label = base::on_one_line(item.member("label").text());
    return request;
  });
}

auto read_label(std::string_view body) -> base::Result<std::string> {
  return reading(body,
                 [](const Item& item) { return base::on_one_line(item.object({"label"}).member("label").text()); });
}

auto read_section(std::string_view body) -> base::Result<SectionRequest> {
  return reading(body, [](const Item& item) {
    item.object({"plan", "ring", "edge", "share"});
    return SectionRequest{item.member("plan").plan(), item.member("ring").integer(), item.member("edge").integer(),
                          item.member("share").number()};
  });
}

auto read_changes(std::string_view body) -> base::Result<std::vector<edit::Change>> {
  return reading(body, [](const Item& item) { return changes_of(item.object({"changes"}).member("changes")); });
}

auto read_edit(std::string_view body) -> base::Result<edit::Edit> {
  return reading(body, [](const Item& item) {
    item.object({"what", "changes"});
    return edit::Edit{base::on_one_line(item.member("what").text()), changes_of(item.member("changes"))};
  });
}

auto read_split(std::string_view body) -> base::Result<SplitRequest> {
  return reading(body, [](const Item& item) {
    item.object({"building", "part", "line"});
    SplitRequest request{part_of(item), {}};
    item.member("line").each([&](const Item& point) { request.line.push_back(point.point()); });
    return request;
  });
}

auto read_roofs(std::string_view body) -> base::Result<RoofsRequest> {
  return reading(body, [](const Item& item) {
    item.object({"kind", "parts"});
    RoofsRequest request;
    if (const auto kind = item.member("kind").text(); kind != "fitted") {
      const auto known = std::ranges::find(refine::kinds, kind, refine::to_string);
      if (known == refine::kinds.end()) item.member("kind").refuse("fitted, or one of the kinds of roof");
      request.kind = *known;
    }
    item.member("parts").each([&](const Item& part) {
      request.parts.push_back({part_of(part.object({"building", "part", "plan"})), part.member("plan").plan()});
    });
    return request;
  });
}

auto read_merge(std::string_view body) -> base::Result<MergeRequest> {
  return reading(body, [](const Item& item) {
    std::vector<PartName> parts;
    item.object({"parts"}).member("parts").each([&](const Item& part) {
      parts.push_back(part_of(part.object({"building", "part"})));
    });
    if (parts.size() != 2) item.member("parts").refuse("an array of two parts");
    return MergeRequest{parts.front(), parts.back()};
  });
}

auto read_review_request(std::string_view body) -> base::Result<ReviewRequest> {
  constexpr std::size_t longest_note = 2000;  // bytes; attributes of some formats take no more
  return reading(body, [](const Item& item) {
    item.object({"building", "revision", "decision", "note"});
    ReviewRequest request{item.member("building").text(), item.member("revision").integer(), {}, {}};
    if (const auto decision = item.member("decision"); !decision.json.is_null()) {
      request.decision = report::verdict_of(decision.text());
      if (!request.decision) decision.refuse("\"right\", \"wrong\", \"later\" or null");
    }
    if (item.has("note")) request.note = base::on_one_line(item.member("note").text());
    if (request.note.size() > longest_note) item.member("note").refuse("a string of at most 2000 bytes");
    return request;
  });
}

auto read_export(std::string_view body) -> base::Result<ExportRequest> {
  return reading(body, [](const Item& item) {
    item.object({"overwrite", "formats"});
    ExportRequest request{item.member("overwrite").flag(), {}};
    if (item.has("formats")) request.formats = item.member("formats").texts();
    return request;
  });
}

auto read_from(std::string_view body) -> base::Result<std::string> {
  return reading(body, [](const Item& item) { return item.object({"from"}).member("from").text(); });
}

auto read_nothing(std::string_view body) -> base::Result<void> {
  if (body.empty()) return {};
  const auto read = reading(body, [](const Item& item) { return item.object({}).json.empty(); });
  return read ? base::Result<void>() : read.error();
}

auto check_edge(const model::Plan& plan, std::size_t ring, std::size_t edge, double share) -> base::Result<void> {
  if (ring > plan.holes.size()) return bad("ring must be at most " + std::to_string(plan.holes.size()), "ring");
  const auto edges = (ring == 0 ? plan.outer : plan.holes[ring - 1]).points.size();
  if (edge >= edges) return bad("edge must be less than " + std::to_string(edges), "edge");
  if (!(share >= 0 && share <= 1)) return bad("share must be from 0 to 1", "share");
  return {};
}

}  // namespace mansard::server
