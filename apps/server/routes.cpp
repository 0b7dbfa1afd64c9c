#include "apps/server/routes.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <vector>

#include "apps/server/assets.hpp"
#include "apps/server/json.hpp"
#include "apps/server/options.hpp"
#include "apps/server/server.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

constexpr std::string_view octets = "application/octet-stream";

/// A handler that parses the body with `read` and passes the result to `work`.
template <class Read, class Work>
auto with_body(Read read, Work work) {
  return [=](Workspace& workspace, const Call& call) -> Text {
    auto request = read(call.body);
    if (!request) return request.error();
    return work(workspace, call, std::move(*request));
  };
}

auto run_of(const Call& call) -> const std::string& { return call.captured.find("run")->second; }

auto parameter(const Call& call, const char* name) -> base::Result<std::string> {
  const auto at = call.query.find(name);
  if (at == call.query.end())
    return base::error("server-body", std::string("the query lacks the parameter '") + name + "'", name);
  return at->second;
}

auto maybe(const Call& call, const char* name) -> std::optional<std::string> {
  const auto at = call.query.find(name);
  return at == call.query.end() ? std::nullopt : std::optional(at->second);
}

auto section_of_part(Workspace& workspace, const Call& call) -> Text {
  const auto building = parameter(call, "building"), part = parameter(call, "part"), ring = parameter(call, "ring"),
             edge = parameter(call, "edge"), share = parameter(call, "share");
  for (const auto* read : {&building, &part, &ring, &edge, &share})
    if (!*read) return read->error();
  const auto ring_number = base::to_integer(*ring), edge_number = base::to_integer(*edge);
  const auto at = base::to_number(*share);
  if (!ring_number || *ring_number < 0 || !edge_number || *edge_number < 0 || !at)
    return base::error("server-body",
                       "expected ring and edge as integers of at least 0 and share as a number from 0 to 1");
  return workspace.section(run_of(call), {*building, *part}, static_cast<std::size_t>(*ring_number),
                           static_cast<std::size_t>(*edge_number), *at);
}

auto without_body(Text (Workspace::*work)(const std::string&, const std::string&)) {
  return [=](Workspace& workspace, const Call& call) -> Text {
    if (auto read = read_nothing(call.body); !read) return read.error();
    return (workspace.*work)(run_of(call), call.client);
  };
}

auto table() -> std::vector<Route> {
  constexpr auto nothing = Sends::nothing, sends = Sends::json, file = Sends::file;
  constexpr auto gives = Gives::json, bytes = Gives::bytes, events = Gives::events;
  return {
      {"GET", "/api/status", nothing, gives, [](auto& w, const auto&) { return w.status(); }},
      {"GET", "/api/openapi.json", nothing, gives, [](auto&, const auto&) { return Text(std::string(openapi())); }},
      {"GET", "/api/options", nothing, gives, [](auto&, const auto&) { return Text(text_of(options_json())); }},
      {"GET", "/api/project", nothing, gives, [](auto& w, const auto&) { return w.project(); }},
      {"POST", "/api/project/inputs", sends, gives,
       with_body(read_inputs, [](auto& w, const auto&, auto request) { return w.open_inputs(request); })},
      {"POST", "/api/project/alignment", sends, gives,
       with_body(read_inputs, [](auto& w, const auto&, auto request) { return w.alignment(request); })},
      {"POST", "/api/project/sample", sends, gives,
       [](auto& w, const auto& call) {
         const auto read = read_nothing(call.body);
         return read ? w.open_sample() : Text(read.error());
       }},
      {"PUT", "/api/uploads/{name}", file, gives, {}},
      {"GET", "/api/scene", nothing, gives, [](auto& w, const auto&) { return w.scene(); }},
      {"GET", "/api/scene/tiles", nothing, gives, [](auto& w, const auto&) { return w.tiles(); }},
      {"GET", "/api/scene/tiles/{id}", nothing, bytes,
       [](auto& w, const auto& call) { return w.tile(call.captured.at("id")); }},
      {"POST", "/api/scene/textures", sends, gives,
       [](auto& w, const auto& call) {
         const auto read = read_nothing(call.body);
         return read ? w.read_textures() : Text(read.error());
       }},
      {"GET", "/api/scene/tiles/{id}/texture", nothing, bytes,
       [](auto& w, const auto& call) { return w.tile_texture(call.captured.at("id")); }},
      {"POST", "/api/runs", sends, gives,
       with_body(read_run, [](auto& w, const auto&, auto request) { return w.start_run(request); })},
      {"POST", "/api/runs/import", sends, gives,
       with_body(read_import, [](auto& w, const auto&, auto request) { return w.import_model(request); })},
      {"DELETE", "/api/runs/{run}", nothing, gives,
       [](auto& w, const auto& call) { return w.remove_run(run_of(call)); }},
      {"PATCH", "/api/runs/{run}", sends, gives,
       with_body(read_label, [](auto& w, const auto& call, auto label) { return w.rename_run(run_of(call), label); })},
      {"GET", "/api/runs/{run}/report", nothing, gives,
       [](auto& w, const auto& call) { return w.report(run_of(call)); }},
      {"GET", "/api/runs/{run}/buildings", nothing, gives,
       [](auto& w, const auto& call) { return w.buildings(run_of(call), maybe(call, "building")); }},
      {"GET", "/api/runs/{run}/list", nothing, gives, [](auto& w, const auto& call) { return w.list(run_of(call)); }},
      {"GET", "/api/runs/{run}/tiles/{tile}", nothing, gives,
       [](auto& w, const auto& call) { return w.tile_of_models(run_of(call), call.captured.at("tile")); }},
      {"GET", "/api/runs/{run}/search", nothing, gives,
       [](auto& w, const auto& call) -> Text {
         const auto words = parameter(call, "words");
         return words ? w.search(run_of(call), *words) : Text(words.error());
       }},
      {"GET", "/api/runs/{run}/layers", nothing, gives,
       [](auto& w, const auto& call) { return w.layers(run_of(call)); }},
      {"GET", "/api/runs/{run}/attributes", nothing, gives,
       [](auto& w, const auto& call) { return w.attributes(run_of(call), maybe(call, "building")); }},
      {"GET", "/api/runs/{run}/column", nothing, gives,
       [](auto& w, const auto& call) -> Text {
         const auto attribute = parameter(call, "attribute");
         return attribute ? w.column(run_of(call), *attribute) : Text(attribute.error());
       }},
      {"GET", "/api/runs/{run}/levels/{lod}", nothing, gives,
       [](auto& w, const auto& call) { return w.level(run_of(call), call.captured.at("lod")); }},
      {"GET", "/api/runs/{run}/terrain", nothing, bytes,
       [](auto& w, const auto& call) { return w.terrain(run_of(call)); }},
      {"GET", "/api/runs/{run}/basemap", nothing, bytes,
       [](auto& w, const auto& call) { return w.basemap(run_of(call)); }},
      {"GET", "/api/runs/{run}/textures/{building}", nothing, bytes,
       [](auto& w, const auto& call) { return w.building_texture(run_of(call), call.captured.at("building")); }},
      {"POST", "/api/models", sends, gives,
       with_body(read_import, [](auto& w, const auto&, auto request) { return w.other_model(request); })},
      {"GET", "/api/runs/{run}/scores", nothing, gives,
       [](auto& w, const auto& call) { return w.scores(run_of(call)); }},
      {"GET", "/api/runs/{run}/error", nothing, gives,
       [](auto& w, const auto& call) { return w.error_maps(run_of(call)); }},
      {"GET", "/api/runs/{run}/error/{block}", nothing, bytes,
       [](auto& w, const auto& call) { return w.error_map(run_of(call), call.captured.at("block")); }},
      {"GET", "/api/runs/{run}/section", nothing, gives, section_of_part},
      {"POST", "/api/runs/{run}/section", sends, gives,
       with_body(read_section,
                 [](auto& w, const auto& call, auto request) { return w.section(run_of(call), request); })},
      {"POST", "/api/runs/{run}/preview", sends, gives,
       with_body(read_changes,
                 [](auto& w, const auto& call, auto changes) { return w.preview(run_of(call), changes); })},
      {"GET", "/api/runs/{run}/unedited", nothing, gives,
       [](auto& w, const auto& call) { return w.unedited(run_of(call)); }},
      {"POST", "/api/runs/{run}/roofs", sends, gives,
       with_body(read_roofs, [](auto& w, const auto& call, auto request) { return w.roofs(run_of(call), request); })},
      {"POST", "/api/runs/{run}/split", sends, gives,
       with_body(read_split, [](auto& w, const auto& call, auto request) { return w.split(run_of(call), request); })},
      {"POST", "/api/runs/{run}/merge", sends, gives,
       with_body(read_merge, [](auto& w, const auto& call, auto request) { return w.merge(run_of(call), request); })},
      {"POST", "/api/runs/{run}/edits", sends, gives,
       with_body(read_edit, [](auto& w, const auto& call,
                               auto edit) { return w.apply(run_of(call), std::move(edit), call.client); })},
      {"POST", "/api/runs/{run}/edits/carry-over", sends, gives,
       with_body(read_from,
                 [](auto& w, const auto& call, auto from) { return w.carry_over(run_of(call), from, call.client); })},
      {"POST", "/api/runs/{run}/undo", sends, gives, without_body(&Workspace::undo)},
      {"POST", "/api/runs/{run}/redo", sends, gives, without_body(&Workspace::redo)},
      {"GET", "/api/review", nothing, gives, [](auto& w, const auto&) { return w.review_of_project(); }},
      {"POST", "/api/review/merge", sends, gives,
       [](auto& w, const auto& call) { return w.merge_review(call.body, call.client); }},
      {"GET", "/api/runs/{run}/review", nothing, gives,
       [](auto& w, const auto& call) { return w.review(run_of(call)); }},
      {"POST", "/api/runs/{run}/review", sends, gives,
       with_body(read_review_request,
                 [](auto& w, const auto& call, auto request) { return w.decide(run_of(call), request, call.client); })},
      {"GET", "/api/runs/{run}/review/case", nothing, gives,
       [](auto& w, const auto& call) -> Text {
         const auto building = parameter(call, "building");
         return building ? w.review_case(run_of(call), *building) : Text(building.error());
       }},
      {"GET", "/api/runs/{run}/export/{file}", nothing, bytes,
       [](auto& w, const auto& call) { return w.export_file(run_of(call), call.captured.at("file")); }},
      {"POST", "/api/runs/{run}/export", sends, gives,
       with_body(read_export,
                 [](auto& w, const auto& call, auto request) { return w.export_all(run_of(call), request); })},
      {"GET", "/api/jobs", nothing, gives, [](auto& w, const auto&) { return w.jobs(); }},
      {"DELETE", "/api/jobs/{id}", nothing, gives,
       [](auto& w, const auto& call) { return w.cancel(call.captured.at("id")); }},
      {"GET", "/api/events", nothing, events, {}},
  };
}

auto split(std::string_view path) -> std::vector<std::string_view> {
  std::vector<std::string_view> words;
  for (std::size_t from = 0; from <= path.size();) {
    const auto end = std::min(path.find('/', from), path.size());
    words.push_back(path.substr(from, end - from));
    from = end + 1;
  }
  return words;
}

auto matches(const Route& route, const std::vector<std::string_view>& words, Words& captured) -> bool {
  const auto pattern = split(route.path);
  if (pattern.size() != words.size()) return false;
  captured.clear();
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (pattern[i].starts_with('{')) captured.emplace(pattern[i].substr(1, pattern[i].size() - 2), words[i]);
    else if (pattern[i] != words[i]) return false;
  }
  return true;
}

/// The HTTP status of a diagnostic code.
auto status_of(std::string_view code) -> int {
  static constexpr std::array<std::pair<std::string_view, int>, 37> known{{
      {"server-body", 400},        {"option-value", 400},      {"option-unknown", 400},
      {"file-missing", 400},       {"server-upload", 400},     {"server-token", 401},
      {"server-host", 403},        {"server-origin", 403},     {"server-path", 404},
      {"server-unknown", 404},     {"server-no-scene", 404},   {"server-sample", 404},
      {"edit-building", 404},      {"edit-part", 404},         {"pipeline-block-unknown", 404},
      {"server-method", 405},      {"edit-stale", 409},        {"edit-nothing", 409},
      {"server-busy", 409},        {"server-inputs", 409},     {"server-input", 400},
      {"file-read", 400},          {"server-not-done", 409},   {"output-exists", 409},
      {"server-large", 413},       {"server-listeners", 503},  {"server-exists", 409},
      {"server-changed", 409},     {"server-damaged", 409},    {"server-archive", 400},
      {"server-no-textures", 404}, {"pipeline-nothing", 409},  {"terrain-no-ground", 409},
      {"terrain-extent", 409},     {"server-no-basemap", 409}, {"ingest-ground-tiles", 409},
      {"review-file", 400},
  }};
  const auto at = std::ranges::find(known, code, &std::pair<std::string_view, int>::first);
  if (at != known.end()) return at->second;
  if (code.starts_with("ingest-")) return 400;
  if (code.starts_with("write-plan-") || code.starts_with("write-read-")) return 400;
  if (code.starts_with("edit-")) return 422;
  return 500;
}

}  // namespace

auto routes() -> std::span<const Route> {
  static const auto all = table();
  return all;
}

auto find_route(Call& call) -> base::Result<const Route*> {
  const auto words = split(call.path);
  bool other_method = false;
  for (const auto& route : routes()) {
    if (!matches(route, words, call.captured)) continue;
    if (route.method == call.method) return &route;
    other_method = true;
  }
  call.captured.clear();
  if (other_method)
    return base::error("server-method",
                       "the method " + call.method + " is not supported here; /api/openapi.json lists all calls");
  return base::error("server-path", "unknown path; /api/openapi.json lists all calls",
                     base::on_one_line(call.path.substr(0, 200)));
}

auto refusal(const base::Diagnostic& why) -> Answer {
  return {status_of(why.code), "application/json", text_of({{"error", json_of(why)}}), {}};
}

auto answer(Workspace& workspace, const Route& route, const Call& call) -> Answer {
  try {
    auto text = route.answer(workspace, call);
    if (!text) return refusal(text.error());
    Answer out;
    out.body = std::move(*text);
    if (route.gives == Gives::bytes) out.type = octets;
    return out;
  } catch (const Unreadable& e) {
    return refusal(e.why);
  } catch (const std::bad_alloc&) {
    return refusal(base::error("memory", "out of memory; read a smaller part of the mesh (ingest.bbox)"));
  } catch (const std::exception& e) {
    return refusal(base::error("bug", std::string(e.what()) + "; please report it"));
  }
}

auto page(std::string_view path, std::string_view known_hash) -> Answer {
  const auto* asset = path.starts_with('/') ? find_asset(path.substr(1)) : nullptr;
  if (asset == nullptr)
    return refusal(base::error("server-path", "unknown path", base::on_one_line(std::string(path.substr(0, 200)))));
  const auto tag = "\"" + std::string(asset->hash) + "\"";
  // Names under assets/ contain a hash of the file; that of the page does not.
  Answer out{200, std::string(asset->mime), {}, {{"ETag", tag}}};
  out.headers["Cache-Control"] =
      asset->name.starts_with("assets/") ? "private, max-age=31536000, immutable" : "no-cache";
  if (known_hash == tag) out.status = 304;
  else out.body = asset->bytes;
  return out;
}

}  // namespace mansard::server
