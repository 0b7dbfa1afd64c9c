// The segmentation as layers: what was measured, what each edge would have cost, and what was made of it.
#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "mansard/base/text.hpp"
#include "mansard/report/detail/later.hpp"
#include "mansard/report/detail/why.hpp"
#include "mansard/report/layers.hpp"

namespace mansard::report {
namespace {

using enum formats::FieldType;
using model::Value;
using Values = std::vector<Value>;
using Lines = std::vector<std::vector<geometry::Point2>>;

auto as_whole(std::size_t number) -> model::Value { return static_cast<std::int64_t>(number); }

template <class T>
auto as_whole(const std::optional<T>& number) -> model::Value {
  return number ? as_whole(*number) : model::Value();
}

auto id_of(const model::Scene& scene, const std::optional<std::size_t>& feature) -> model::Value {
  return feature ? model::Value(scene.feature(*feature).id) : model::Value();
}

auto length_of(const geometry::Segment2& s) -> double { return geometry::length(s.end - s.start); }

// ---- the input

auto as_text(const model::Value& value) -> model::Value {
  if (const auto* flag = std::get_if<bool>(&value)) return std::string(*flag ? "true" : "false");
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* number = std::get_if<double>(&value)) return base::to_text(*number);
  return value;
}

/// Sources have one type per attribute, but scenes need not: integers and real numbers become real numbers, others
/// text.
auto type_for(const model::Value& value, std::optional<formats::FieldType> before) -> formats::FieldType {
  const auto own = std::holds_alternative<bool>(value)           ? boolean
                   : std::holds_alternative<std::int64_t>(value) ? integer
                   : std::holds_alternative<double>(value)       ? real
                                                                 : string;
  if (!before || *before == own) return own;
  const auto is_number = [](formats::FieldType type) { return type == integer || type == real; };
  return is_number(own) && is_number(*before) ? real : string;
}

/// Every attribute of any feature, in the order of their first appearance.
auto attribute_fields(const std::vector<model::Footprint>& footprints) -> std::vector<formats::Field> {
  std::vector<std::string> names;
  std::map<std::string, std::optional<formats::FieldType>> types;
  for (const auto& footprint : footprints)
    for (const auto& [name, value] : footprint.attributes) {
      const auto [at, is_new] = types.try_emplace(name);
      if (is_new) names.push_back(name);
      if (!std::holds_alternative<std::monostate>(value)) at->second = type_for(value, at->second);
    }
  std::vector<formats::Field> fields;
  for (const auto& name : names) fields.push_back({name, types[name].value_or(string)});
  return fields;
}

auto gis_footprints(const model::Scene& scene, const std::vector<SegmentedBlock>& blocks) -> formats::Layer {
  formats::Layer layer{"gis_footprints",
                       "The footprints as they were read, with their own attributes",
                       formats::Shape::polygons,
                       {{"feature"}, {"block"}, {"parts", integer}, {"defect"}},
                       {}};
  const auto attributes = attribute_fields(scene.footprints);
  layer.fields.insert(layer.fields.end(), attributes.begin(), attributes.end());
  std::vector<model::Value> block_of(scene.footprints.size());
  for (const auto& block : blocks)
    for (const std::size_t f : block.features)
      if (f < block_of.size()) block_of[f] = block.name;
  const auto parts = parts_by_feature(scene, blocks);
  for (std::size_t f = 0; f < scene.footprints.size(); ++f) {
    const auto& footprint = scene.footprints[f];
    Values values{footprint.id, block_of[f], as_whole(parts[f]), model::Value()};
    if (footprint.defect) values.back() = footprint.defect->message;
    std::map<std::string, model::Value> own(footprint.attributes.begin(), footprint.attributes.end());
    for (const auto& [name, type] : attributes) values.push_back(type == string ? as_text(own[name]) : own[name]);
    layer.features.push_back({{}, footprint.polygons, std::move(values)});
  }
  return layer;
}

auto made_by_layer(const model::MadeBy& made_by) -> formats::Layer {
  formats::Layer layer{"made_by", "How this file was made", formats::Shape::none, {{"name"}, {"value"}}, {}};
  const auto add = [&](const std::string& name, const std::string& value) {
    layer.features.push_back({{}, {}, {name, value}});
  };
  add("mansard", made_by.version);
  for (const auto& input : made_by.inputs) add("input", input.path + " sha256:" + input.sha256);
  for (const auto& [name, value] : made_by.options) add(name, value);
  return layer;
}

// ---- what was found and measured

auto empty_sweep_edges() -> formats::Layer {
  return {"sweep_edges",
          "Walls as the mesh shows them, in plan; outside on the left",
          formats::Shape::line,
          {{"block"}, {"number", integer}, {"area", real}, {"low", real}, {"high", real}, {"length", real}},
          {}};
}

void add_sweep_edges(const SegmentedBlock& block, double z0, formats::Layer& layer) {
  for (std::size_t i = 0; i < block.sweep_edges.size(); ++i) {
    const auto& edge = block.sweep_edges[i];
    layer.features.push_back(
        {{{edge.segment.start, edge.segment.end}},
         {},
         {block.name, as_whole(i), edge.area, z0 + edge.low, z0 + edge.high, length_of(edge.segment)}});
  }
}

auto empty_faces() -> formats::Layer {
  return {"faces",
          "The fractured ground",
          formats::Shape::polygon,
          {{"block"},
           {"number", integer},
           {"inside", boolean},
           {"height", real},
           {"seen", boolean},
           {"gis_share", real},
           {"feature"},
           {"part", integer},
           {"area", real}},
          {}};
}

void add_faces(const SegmentedBlock& block, const model::Scene& scene, double z0, formats::Layer& layer) {
  const auto& faces = block.arrangement.faces;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    Values values{block.name, as_whole(f)};
    if (block.segmentation) {
      const auto& evidence = block.segmentation->faces[f];
      const model::Value height = evidence.seen ? model::Value(z0 + evidence.height) : model::Value();
      values.insert(values.end(), {evidence.inside, height, evidence.seen, evidence.gis_share,
                                   id_of(scene, evidence.feature), as_whole(block.segmentation->part_of_face[f])});
    } else {
      values.resize(values.size() + 6);  // nothing was measured
    }
    values.emplace_back(faces[f].area);
    layer.features.push_back({{}, {{block.arrangement.ring(f), {}}}, std::move(values)});
  }
}

// ---- what the program decided

auto lines_of(const SegmentedBlock& block, const segment::Candidate& candidate) -> Lines {
  Lines lines;
  for (const std::uint32_t h : candidate.half_edges) {
    const auto segment = block.arrangement.segment(h);
    lines.push_back({segment.start, segment.end});
  }
  return lines;
}

/// As solver::mps names it.
auto variable_name(std::size_t number) -> std::string {
  const auto digits = std::to_string(number);
  return "X" + std::string(digits.size() < 7 ? 7 - digits.size() : 0, '0') + digits;
}

/// A field of the edges and its value: the list of both.
struct EdgeField {
  formats::Field field;
  std::function<Value(const segment::Candidate&)> value;
};

/// What the terms are paid for: lengths of the edge first, then what is measured on all of it.
auto amount_fields() -> std::vector<EdgeField> {
  std::vector<EdgeField> fields;
  for (const bool of_length : {true, false})
    for (const auto& info : segment::terms())
      if (!info.amount.empty() && (info.share != nullptr) == of_length)
        fields.push_back(
            {{std::string(info.amount), real}, [term = info.term](const auto& c) { return c.amounts[term]; }});
  return fields;
}

/// What the edge costs then, altogether and by term.
auto cost_fields(const char* name, segment::Paid paid) -> std::vector<EdgeField> {
  std::vector<EdgeField> fields{{{name, real}, [paid](const auto& c) { return c.costs.sum(paid); }}};
  for (const auto& info : segment::terms())
    if (info.paid == paid)
      fields.push_back({{std::string(info.cost), real}, [term = info.term](const auto& c) { return c.costs[term]; }});
  return fields;
}

auto edge_fields() -> std::vector<EdgeField> {
  std::vector<EdgeField> fields{{{"left", integer}, [](const auto& c) { return as_whole(c.left); }},
                                {{"right", integer}, [](const auto& c) { return as_whole(c.right); }},
                                {{"length", real}, [](const auto& c) { return c.length; }}};
  const auto add = [&fields](std::vector<EdgeField> more) {
    for (auto& field : more) fields.push_back(std::move(field));
  };
  add(amount_fields());
  add(cost_fields("cost_if_cut", segment::Paid::cut));
  add(cost_fields("cost_if_uncut", segment::Paid::uncut));
  add({{{"sweep", boolean}, [](const auto& c) { return c.sweep; }},
       {{"forced", boolean}, [](const auto& c) { return c.forced; }},
       {{"solved", boolean}, [](const auto& c) { return c.solved; }},
       {{"chosen", boolean}, [](const auto& c) { return c.chosen; }}});
  return fields;
}

auto empty_edges() -> formats::Layer {
  formats::Layer layer{"edges",
                       "Edges between inside faces, one variable of the program each, with what they cost and why they "
                       "were cut or not",
                       formats::Shape::lines,
                       {{"block"}, {"number", integer}},
                       {}};
  for (auto& field : edge_fields()) layer.fields.push_back(std::move(field.field));
  layer.fields.insert(layer.fields.end(), {{"kept_length", real},
                                           {"moved_length", real},
                                           {"dropped_length", real},
                                           {"moved_by", real},
                                           {"variable"},
                                           {"why"}});
  return layer;
}

/// `walls`: of the models; none where there are none.
void add_edges(const SegmentedBlock& block, const detail::FinalWalls* walls, formats::Layer& layer) {
  const auto& segmentation = block.segmentation;
  if (!segmentation) return;
  const auto fields = edge_fields();
  const auto conflicts = detail::walls_in_conflict(*segmentation);
  for (std::size_t i = 0; i < segmentation->candidates.size(); ++i) {
    const auto& c = segmentation->candidates[i];
    Values values{block.name, as_whole(i)};
    for (const auto& field : fields) values.push_back(field.value(c));
    std::vector<geometry::Segment2> segments;
    for (const std::uint32_t h : c.half_edges) segments.push_back(block.arrangement.segment(h));
    detail::Beside beside{conflicts[i], segmentation->phi, {}, {}};
    if (!c.sweep) beside.sweep_edge = detail::parallel_sweep_edge(segments, block.sweep_edges);
    if (walls && c.chosen) {
      const auto& [kept, moved, dropped, by] = beside.later.emplace(walls->later(segments));
      values.insert(values.end(), {kept, moved, dropped, moved > 0 ? Value(by) : Value()});
    } else {
      values.resize(values.size() + 4);
    }
    values.emplace_back(variable_name(i));
    values.emplace_back(detail::why(c, beside));
    layer.features.push_back({lines_of(block, c), {}, std::move(values)});
  }
}

auto empty_conflicts() -> formats::Layer {
  return {"conflicts",
          "Bad pairs: two edges, or one and the outline, which make a sliver or a needle if both are cut",
          formats::Shape::lines,
          {{"block"}, {"number", integer}, {"first", integer}, {"second", integer}, {"phi", real}, {"paid", boolean}},
          {}};
}

void add_conflicts(const SegmentedBlock& block, formats::Layer& layer) {
  const auto& segmentation = block.segmentation;
  if (!segmentation) return;
  const auto& [candidates, conflicts, phi] =
      std::tie(segmentation->candidates, segmentation->conflicts, segmentation->phi);
  for (std::size_t i = 0; i < conflicts.size(); ++i) {
    const auto& [first, second] = conflicts[i];
    Lines lines = lines_of(block, candidates[first]);
    if (second)
      for (auto& line : lines_of(block, candidates[*second])) lines.push_back(std::move(line));
    const bool paid = candidates[first].solved && (!second || candidates[*second].solved);
    layer.features.push_back(
        {std::move(lines), {}, {block.name, as_whole(i), as_whole(first), as_whole(second), phi, paid}});
  }
}

auto empty_footprints() -> formats::Layer {
  return {"footprints",
          "The parts: faces that were put together",
          formats::Shape::polygon,
          {{"block"}, {"number", integer}, {"feature"}, {"height", real}, {"area", real}, {"faces", integer}},
          {}};
}

void add_footprints(const SegmentedBlock& block, const model::Scene& scene, double z0, formats::Layer& layer) {
  for (std::size_t i = 0; i < block.segmentation->parts.size(); ++i) {
    const auto& part = block.segmentation->parts[i];
    layer.features.push_back({{},
                              {part.polygon},
                              {block.name, as_whole(i), id_of(scene, part.feature), z0 + part.height,
                               geometry::area(part.polygon), as_whole(part.faces.size())}});
  }
}

}  // namespace

auto segment_layers(const model::Scene& scene, const std::vector<SegmentedBlock>& blocks, const model::MadeBy& made_by,
                    std::span<const model::Building> buildings) -> std::vector<formats::Layer> {
  std::optional<detail::FinalWalls> walls;
  if (!buildings.empty()) walls.emplace(buildings);
  const auto z0 = static_cast<double>(scene.frame.origin[2]);
  auto sweep_edges = empty_sweep_edges(), faces = empty_faces(), edges = empty_edges();
  auto conflicts = empty_conflicts(), footprints = empty_footprints();
  for (const SegmentedBlock& block : blocks) {
    add_sweep_edges(block, z0, sweep_edges);
    add_faces(block, scene, z0, faces);
    if (!block.segmentation) continue;
    add_edges(block, walls ? &*walls : nullptr, edges);
    add_conflicts(block, conflicts);
    add_footprints(block, scene, z0, footprints);
  }
  return {gis_footprints(scene, blocks), std::move(sweep_edges), std::move(faces),      std::move(edges),
          std::move(conflicts),          std::move(footprints),  made_by_layer(made_by)};
}

auto diagnostics_layer(const Reconstruction& reconstruction, const model::Scene& scene) -> formats::Layer {
  formats::Layer layer{
      "diagnostics",
      "What went otherwise than it should, and why: a row for each reason of each feature, and for each "
      "warning of the run, which has no place.",
      formats::Shape::polygons,
      {{"feature", string},
       {"block", string},
       {"outcome", string},
       {"severity", string},
       {"code", string},
       {"subject", string},
       {"message", string}},
      {}};
  const auto add = [&](const base::Diagnostic& reason, Values where, const std::vector<geometry::Polygon>& polygons) {
    where.insert(where.end(), {Value(std::string(reason.severity == base::Severity::error ? "error" : "warning")),
                               Value(reason.code), Value(reason.subject), Value(reason.message)});
    layer.features.push_back({{}, polygons, std::move(where)});
  };
  for (std::size_t i = 0; i < reconstruction.buildings.size(); ++i) {
    const auto& building = reconstruction.buildings[i];
    for (const auto& reason : building.reasons)
      add(reason, {Value(building.id), Value(building.block), Value(std::string(to_string(building.outcome)))},
          scene.footprints[i].polygons);
  }
  for (const auto* warnings : {&scene.warnings, &reconstruction.warnings})
    for (const auto& warning : *warnings) add(warning, {Value(), Value(), Value()}, {});
  return layer;
}

auto overlaps_layer(const Summary& summary) -> std::optional<formats::Layer> {
  if (summary.overlaps.empty()) return std::nullopt;
  formats::Layer layer{
      "overlaps",
      "The ground that two solids share: a row for each two that overlap.",
      formats::Shape::polygons,
      {{"first", string}, {"second", string}, {"area", real}, {"height", real}, {"volume_at_most", real}},
      {}};
  for (const auto& o : summary.overlaps)
    layer.features.push_back(
        {{}, o.polygons, {Value(o.first), Value(o.second), Value(o.area), Value(o.height), Value(o.area * o.height)}});
  return layer;
}

}  // namespace mansard::report
