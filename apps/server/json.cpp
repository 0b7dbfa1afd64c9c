#include "apps/server/json.hpp"

#include <array>
#include <cmath>

#include "mansard/formats/plans.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::server {
namespace {

auto json_of(geometry::Point2 p) -> Json { return Json::array({p.x, p.y}); }
auto json_of(geometry::Point3 p) -> Json { return Json::array({p.x, p.y, p.z}); }

template <class T>
auto or_null(const std::optional<T>& value) -> Json {
  return value ? Json(*value) : Json(nullptr);
}
auto or_null(const std::optional<base::Diagnostic>& value) -> Json {
  return value ? server::json_of(*value) : Json(nullptr);
}

constexpr std::array class_names{"wall", "party_wall", "roof", "ground", "soffit"};
constexpr std::array outcome_names{"full", "simplified", "two_part", "prism"};

auto json_of(const geometry::Polygon& polygon) -> Json {
  Json holes = Json::array();
  for (const auto& hole : polygon.holes) holes.push_back(server::json_of(hole));
  return {{"outer", server::json_of(polygon.outer)}, {"holes", holes}};
}

auto json_of(const std::vector<geometry::Polygon>& polygons) -> Json {
  Json out = Json::array();
  for (const auto& polygon : polygons) out.push_back(json_of(polygon));
  return out;
}

/// In plan the box of the outline, without the padding of the block's mesh.
auto box_of(const block::Block& block) -> geometry::Box3 {
  geometry::Box3 box;
  for (const auto& polygon : block.outline)
    for (const auto& p : polygon.outer) box.add({p.x, p.y, block.ground});
  for (const auto& v : block.mesh.vertices) {
    box.least.z = std::min(box.least.z, v.z);
    box.most.z = std::max(box.most.z, v.z);
  }
  return box;
}

}  // namespace

auto json_of(const block::Block& block, const model::Scene& scene) -> Json {
  Json buildings = Json::array();
  for (const auto& member : block.members) buildings.push_back(scene.feature(member.feature).id);
  const auto box = box_of(block);
  return {{"name", block.name},
          {"buildings", buildings},
          {"low", json_of(box.least)},
          {"high", json_of(box.most)},
          {"triangles", block.mesh.triangles.size()}};
}

auto text_of(const Json& json) -> std::string { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

auto json_of(const base::Diagnostic& d) -> Json {
  return {{"severity", d.severity == base::Severity::error ? "error" : "warning"},
          {"code", d.code},
          {"message", d.message},
          {"subject", d.subject}};
}

auto json_of(std::span<const base::Diagnostic> diagnostics) -> Json {
  Json out = Json::array();
  for (const auto& diagnostic : diagnostics) out.push_back(json_of(diagnostic));
  return out;
}

auto json_of(const Job& job) -> Json {
  return {
      {"id", job.id},       {"kind", job.kind},       {"run", or_null(job.run)},  {"state", to_string(job.state)},
      {"stage", job.stage}, {"subject", job.subject}, {"fraction", job.fraction}, {"failure", or_null(job.failure)}};
}

auto json_of(const MapInfo& map) -> Json {
  return {{"block", map.block},
          {"origin", json_of(map.origin)},
          {"grid", map.grid},
          {"columns", map.columns},
          {"rows", map.rows}};
}

auto json_of(const base::Spent& spent) -> Json {
  return {{"cpu_seconds", spent.cpu_seconds}, {"wall_seconds", spent.wall_seconds}};
}

auto json_of(const report::Times& times) -> Json {
  Json stages = Json::array();
  for (const auto& [stage, spent] : times.stages) {
    stages.push_back({{"stage", stage}});
    stages.back().update(json_of(spent));
  }
  Json out = json_of(times.total);
  out["stages"] = std::move(stages);
  return out;
}

auto json_of(const std::optional<RunScores>& scores) -> Json {
  if (!scores) return nullptr;
  return {{"mse", scores->mse},
          {"footprint_mse", scores->footprint_mse},
          {"footprint_median_absolute", scores->footprint_median_absolute},
          {"inside_mse", scores->inside_mse},
          {"missed", scores->missed},
          {"invented", scores->invented}};
}

auto json_of(const RunRecord& run, std::size_t edits) -> Json {
  return {{"id", run.id},
          {"label", run.label},
          {"state", to_string(run.state)},
          {"failure", or_null(run.failure)},
          {"created", run.created},
          {"preset", run.preset},
          {"options", run.options},
          {"blocks", run.blocks},
          {"scores", json_of(run.scores)},
          {"times", json_of(run.times)},
          {"buildings", run.buildings},
          {"full", run.full},
          {"parts", run.parts},
          {"faces", run.faces},
          {"edits", edits}};
}

/// As in plans.json.
auto json_of(const model::Plan& plan) -> Json { return Json::parse(formats::plan_json(plan)); }

auto json_of(const model::ProfilePoint& point) -> Json { return Json::array({point.inward, point.height}); }

auto json_of(std::span<const geometry::Point2> points) -> Json {
  Json out = Json::array();
  for (const auto& p : points) out.push_back(json_of(p));
  return out;
}

auto json_of(const model::LabelledSolid& model) -> Json {
  const auto& solid = model.solid;
  const auto cut = solid::triangulate(solid);
  if (!cut) return nullptr;
  Json positions = Json::array(), triangles = Json::array(), faces = Json::array();
  for (const auto& v : solid.vertices)
    for (const double c : {v.x, v.y, v.z}) positions.push_back(c);
  for (const auto& triangle : cut->triangles)
    for (const auto v : triangle) triangles.push_back(v);
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const auto& from = solid.faces[f].provenance;
    faces.push_back({{"loops", solid.faces[f].loops},
                     {"class", class_names[static_cast<std::size_t>(model.classes[f])]},
                     {"ring", from ? Json(from->ring) : Json(nullptr)},
                     {"edge", from ? Json(from->edge) : Json(nullptr)}});
  }
  return {{"positions", std::move(positions)},
          {"triangles", std::move(triangles)},
          {"face_of", cut->face_of},
          {"faces", std::move(faces)}};
}

auto json_of(const edit::NamedPlan& part) -> Json { return {{"id", part.id}, {"plan", json_of(part.plan)}}; }

auto json_of(const edit::Change& change) -> Json {
  Json parts = Json::array();
  for (const auto& part : change.parts) parts.push_back(json_of(part));
  return {{"building", change.building}, {"revision", change.revision}, {"parts", std::move(parts)}};
}

auto json_of(const edit::History& history) -> Json {
  Json edits = Json::array();
  for (const auto& edit : history.edits()) edits.push_back(edit.what);
  return {{"edits", std::move(edits)}, {"done", history.done()}};
}

auto both_of(const std::string& buildings, const Json& history) -> std::string {
  return R"({"buildings":)" + buildings + R"(,"history":)" + text_of(history) + '}';
}

auto json_of(const std::string& id, std::uint64_t revision, std::span<const edit::NamedPlan> plans,
             const edit::RaisedBuilding& raised) -> Json {
  Json parts = Json::array();
  for (std::size_t i = 0; i < raised.parts.size(); ++i) {
    const auto& part = raised.parts[i];
    parts.push_back({{"id", part.id},
                     {"plan", json_of(plans[i].plan)},
                     {"geometry", part.model ? json_of(*part.model) : Json(nullptr)},
                     {"outcome", outcome_names[static_cast<std::size_t>(part.outcome)]},
                     {"diagnostics", json_of(part.diagnostics)},
                     {"mse", or_null(part.mse)},
                     {"volume", part.volume}});
  }
  return {{"id", id},
          {"revision", revision},
          {"valid", raised.valid()},
          {"parts", std::move(parts)},
          {"diagnostics", json_of(raised.diagnostics)},
          {"mse", or_null(raised.mse)}};
}

auto layers_json(const std::vector<report::SegmentedBlock>& blocks) -> Json {
  Json sweep_edges = Json::array(), faces = Json::array(), edges = Json::array();
  for (const auto& block : blocks) {
    for (const auto& edge : block.sweep_edges)
      sweep_edges.push_back({{"block", block.name},
                             {"from", json_of(edge.segment.start)},
                             {"to", json_of(edge.segment.end)},
                             {"low", edge.low},
                             {"high", edge.high}});
    for (std::uint32_t f = 0; f < block.arrangement.faces.size(); ++f) {
      const auto* evidence = block.segmentation ? &block.segmentation->faces[f] : nullptr;
      faces.push_back({{"block", block.name},
                       {"outer", json_of(block.arrangement.ring(f))},
                       {"holes", Json::array()},  // faces are simply connected
                       {"inside", evidence != nullptr && evidence->inside},
                       {"height", evidence != nullptr && evidence->seen ? Json(evidence->height) : Json(nullptr)},
                       {"part", evidence != nullptr ? or_null(block.segmentation->part_of_face[f]) : Json(nullptr)}});
    }
    if (!block.segmentation) continue;
    for (const auto& candidate : block.segmentation->candidates) {
      Json lines = Json::array();
      for (const auto h : candidate.half_edges) {
        const auto segment = block.arrangement.segment(h);
        lines.push_back(Json::array({json_of(segment.start), json_of(segment.end)}));
      }
      edges.push_back({{"block", block.name},
                       {"lines", std::move(lines)},
                       {"chosen", candidate.chosen},
                       {"cost_cut", candidate.costs.sum(segment::Paid::cut)},
                       {"cost_uncut", candidate.costs.sum(segment::Paid::uncut)}});
    }
  }
  return {{"sweep_edges", std::move(sweep_edges)}, {"faces", std::move(faces)}, {"edges", std::move(edges)}};
}

auto id_of(const picture::Tile& tile) -> std::string {
  return std::to_string(tile.level) + "-" + std::to_string(tile.column) + "-" + std::to_string(tile.row);
}

auto json_of(const picture::Tile& tile) -> Json {
  return {{"id", id_of(tile)},
          {"level", tile.level},
          {"column", tile.column},
          {"row", tile.row},
          {"low", json_of(tile.low)},
          {"high", json_of(tile.high)},
          {"centre", json_of(tile.centre)},
          {"vertices", tile.positions.size() / 3},
          {"triangles", tile.triangles.size() / 3}};
}

auto json_of(const model::Scene& scene, std::span<const block::Block> blocks, std::vector<Json> shown) -> Json {
  std::vector<Json> block_of(scene.footprints.size(), nullptr), ground(scene.footprints.size(), 0.0);
  Json block_list(std::move(shown)), footprints = Json::array();
  for (const auto& block : blocks) {
    for (const auto& member : block.members) {
      if (member.feature >= scene.footprints.size()) continue;
      block_of[member.feature] = block.name;
      ground[member.feature] = member.ground;
    }
  }
  for (std::size_t f = 0; f < scene.footprints.size(); ++f) {
    const auto& footprint = scene.footprints[f];
    footprints.push_back({{"id", footprint.id},
                          {"block", block_of[f]},
                          {"polygons", json_of(footprint.polygons)},
                          {"ground", ground[f]},
                          {"defect", or_null(footprint.defect)}});
  }
  const auto box = geometry::Box3::of(scene.mesh.vertices);
  return {{"origin", scene.frame.origin},
          {"crs", scene.frame.crs},
          {"triangles", scene.mesh.triangles.size()},
          {"low", json_of(box.least)},
          {"high", json_of(box.most)},
          {"blocks", std::move(block_list)},
          {"footprints", std::move(footprints)},
          {"warnings", json_of(scene.warnings)}};
}

}  // namespace mansard::server
