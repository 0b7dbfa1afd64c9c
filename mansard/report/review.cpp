#include "mansard/report/review.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "mansard/base/files.hpp"
#include "mansard/base/nesting.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/hash.hpp"

namespace mansard::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* review_type = "mansard-review";
constexpr int review_version = 1;
constexpr std::size_t review_depth = 8;  // levels of nesting; a file has three

auto unreadable_review(const std::string& why, const std::string& subject) -> base::Diagnostic {
  return base::error("review-file",
                     "these are no decisions of a review: " + why +
                         "; expected review.json of a project, as 'mansard serve' writes it",
                     subject);
}

auto decision_of(const Json& json) -> base::Result<Decision> {
  const auto text = [&](const char* name) { return json.at(name).get<std::string>(); };
  Decision out;
  out.building = text("building");
  const auto verdict = verdict_of(text("decision"));
  if (!verdict) return base::error("review-file", "unknown decision '" + base::on_one_line(text("decision")) + "'");
  out.verdict = *verdict;
  out.note = text("note");
  out.reviewer = text("reviewer");
  out.time = text("time");
  // Times are compared as strings, which is right for this form alone.
  const bool dated = out.time.size() == 20 && out.time[10] == 'T' && out.time[19] == 'Z';
  if (!dated)
    return base::error("review-file",
                       "the time '" + base::on_one_line(out.time) + "' is not of the form 2026-11-28T15:43:31Z");
  out.model = text("model");
  return out;
}

/// Of two decisions on one building the greater counts: the later one, and of equal times always the same.
auto rank(const Decision& one) { return std::tie(one.time, one.verdict, one.reviewer, one.note, one.model); }

/// Millimetres of a coordinate of the files: whole metres of the frame are added as integers.
auto millimetres(std::int64_t origin, double local) -> std::string {
  constexpr int per_metre = 1000;
  return std::to_string(origin * per_metre + std::llround(local * per_metre));
}

}  // namespace

auto verdict_of(std::string_view name) -> std::optional<Verdict> {
  const auto at = std::ranges::find(verdict_names, name);
  if (at == verdict_names.end()) return std::nullopt;
  return static_cast<Verdict>(at - verdict_names.begin());
}

auto review_text(const Decisions& decisions) -> std::string {
  std::string out = R"({"type":")" + std::string(review_type) + R"(","version":)" + std::to_string(review_version) +
                    R"(,"decisions":[)";
  bool first = true;
  for (const auto& [building, one] : decisions) {
    const Json json{{"building", one.building}, {"decision", to_string(one.verdict)},
                    {"note", one.note},         {"reviewer", one.reviewer},
                    {"time", one.time},         {"model", one.model}};
    (out += first ? "\n" : ",\n") += json.dump(-1, ' ', false, Json::error_handler_t::replace);
    first = false;
  }
  return out + "\n]}\n";
}

auto parse_review(std::string_view text, const std::string& subject) -> base::Result<Decisions> {
  std::size_t number = 0;
  const auto place = [&] { return "decision " + std::to_string(number) + ": "; };
  try {
    if (base::nests_too_deep(text, review_depth)) return unreadable_review("it is nested too deep", subject);
    const auto json = Json::parse(text);
    if (!json.is_object() || json.value("type", "") != review_type)
      return unreadable_review(R"(it has no "type": ")" + std::string(review_type) + "\"", subject);
    if (json.at("version") != review_version) return unreadable_review("another version of mansard wrote it", subject);
    if (!json.at("decisions").is_array()) return unreadable_review("\"decisions\" is not an array", subject);
    Decisions out;
    for (const auto& one : json.at("decisions")) {
      ++number;
      auto decision = decision_of(one);
      if (!decision) return unreadable_review(place() + decision.error().message, subject);
      const auto building = decision->building;
      if (!out.emplace(building, std::move(*decision)).second)
        return unreadable_review(place() + "the building " + base::on_one_line(building) + " has one already", subject);
    }
    return out;
  } catch (const Json::parse_error& e) {
    return unreadable_review("it is not valid JSON at byte " + std::to_string(e.byte), subject);
  } catch (const Json::exception& e) {
    return unreadable_review((number > 0 ? place() : std::string()) + base::on_one_line(e.what()), subject);
  }
}

auto read_review(const fs::path& path) -> base::Result<Decisions> {
  std::error_code status;
  auto file = path;
  if (fs::is_directory(path, status)) {
    file = path / review_file;
    if (!fs::exists(path / "project.json", status) && !fs::exists(file, status))
      return base::error("review-file",
                         "the folder is no project and has no review.json; give the folder of a project, or the file",
                         path.string());
    if (!fs::exists(file, status)) return Decisions();
  } else if (!fs::exists(path, status)) {
    return base::error("file-missing", "the file does not exist; check its path", path.string());
  }
  const auto text = base::read_file(file);
  return text ? parse_review(*text, file.string()) : base::Result<Decisions>(text.failure());
}

auto merged(const Decisions& first, const Decisions& second) -> MergedReview {
  MergedReview out;
  out.decisions = first;
  for (const auto& [building, other] : second) {
    const auto [at, is_new] = out.decisions.emplace(building, other);
    if (is_new) ++out.added;
    if (is_new || at->second == other) continue;
    const bool later = rank(at->second) < rank(other);
    if (at->second.verdict != other.verdict)
      out.conflicts.push_back({later ? other : at->second, later ? at->second : other});
    if (!later) continue;
    at->second = other;
    ++out.replaced;
  }
  return out;
}

auto model_key(std::span<const model::Plan* const> parts, const model::Frame& frame) -> std::string {
  std::string text;
  for (const auto* part : parts) {
    const auto& plan = *part;
    (((text += "part ") += millimetres(frame.origin[2], plan.base)) += ' ') += millimetres(0, plan.cap);
    const auto ring = [&](const model::PlanRing& of) {
      text += "\nring";
      for (std::size_t e = 0; e < of.points.size(); ++e) {
        (((text += ' ') += millimetres(frame.origin[0], of.points[e].x)) += ' ') +=
            millimetres(frame.origin[1], of.points[e].y);
        if (!of.overhang_of_edge.empty()) (text += " over ") += millimetres(0, of.overhang_of_edge[e]);
        // By what they are: profiles may be numbered in another order.
        for (const auto& point : plan.profiles[of.profile_of_edge[e]])
          (((text += ':') += millimetres(0, point.inward)) += ',') += millimetres(0, point.height);
      }
    };
    ring(plan.outer);
    for (const auto& hole : plan.holes) ring(hole);
    text += '\n';
  }
  return formats::sha256(text);
}

auto attributes_of(const Decision& decision) -> model::Attributes {
  model::Attributes out{{"ms_review", std::string(to_string(decision.verdict))}};
  if (!decision.note.empty()) out.emplace_back("ms_review_note", decision.note);
  if (!decision.reviewer.empty()) out.emplace_back("ms_reviewer", decision.reviewer);
  out.emplace_back("ms_review_time", decision.time);
  return out;
}

void set_review(model::Attributes& attributes, const Decision* decision) {
  const auto names = review_attributes();
  std::erase_if(attributes, [&](const auto& one) {
    return std::ranges::find(names, one.first, &formats::Attribute::name) != names.end();
  });
  if (decision == nullptr) return;
  for (auto& one : attributes_of(*decision)) attributes.push_back(std::move(one));
}

auto has_review(const model::Attributes& attributes) -> bool {
  return std::ranges::any_of(attributes, [](const auto& one) { return one.first == "ms_review"; });
}

auto review_attributes() -> std::vector<formats::Attribute> {
  const auto one = [](const char* name, const char* meaning) {
    return formats::Attribute{name, "serve", {"Building"}, "text", "", meaning};
  };
  return {one("ms_review",
              "What a person decided about the model in the workbench: right, wrong or later; absent where nobody did, "
              "or the model changed since."),
          one("ms_review_note", "The note of that person; absent without one."),
          one("ms_reviewer", "Who decided; absent if 'mansard serve' was not told (--reviewer)."),
          one("ms_review_time", "When, in UTC (ISO 8601); present with ms_review.")};
}

}  // namespace mansard::report
