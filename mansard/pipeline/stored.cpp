#include "mansard/pipeline/stored.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "mansard/base/stopped.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/formats/written.hpp"
#include "mansard/model/append.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/solids.hpp"

namespace mansard::pipeline {
namespace {

namespace fs = std::filesystem;

/// What is made of a plan depends on nothing else.
auto raises(std::string_view name) -> bool { return name.starts_with("extrude.") || name.starts_with("label."); }

auto raising_options(const Options& options) -> std::vector<std::pair<std::string, std::string>> {
  Options copy = options;
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& list : {extrude::option_list(copy.extrude), label::option_list(copy.label)})
    for (const auto& option : list.options()) out.emplace_back(list.module() + "." + option.name, option.get());
  return out;
}

auto value_of(const model::MadeBy& made_by, std::string_view name) -> const std::string* {
  for (const auto& [key, value] : made_by.options)
    if (key == name) return &value;
  return nullptr;
}

auto class_of(model::FaceClass kind) -> model::SurfaceClass {
  switch (kind) {
    case model::FaceClass::wall:
    case model::FaceClass::party_wall: return model::SurfaceClass::wall;
    case model::FaceClass::roof: return model::SurfaceClass::roof;
    case model::FaceClass::ground: return model::SurfaceClass::ground;
    case model::FaceClass::soffit: break;
  }
  return model::SurfaceClass::other;
}

auto part_of(const model::Part& part, const model::LabelledSolid& labelled) -> model::ModelPart {
  model::ModelPart out{part.id, {}};
  for (const auto& [key, value] : part.attributes)
    if (const auto* text = std::get_if<std::string>(&value); text && key == "ms_role") out.role = *text;
  const auto& solid = labelled.solid;
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    auto& face = out.faces.emplace_back();
    face.kind = class_of(labelled.classes[f]);
    for (const auto& loop : solid.faces[f].loops) {
      auto& points = face.loops.emplace_back();
      for (const auto v : loop) points.push_back(solid.vertices[v]);
    }
  }
  return out;
}

/// Whether both have the same corners in the same order, face by face.
auto same_corners(const model::Solid& a, const model::Solid& b) -> bool {
  const auto same = [&](std::uint32_t u, std::uint32_t v) { return a.vertices[u] == b.vertices[v]; };
  return std::ranges::equal(a.faces, b.faces, [&](const model::Face& f, const model::Face& g) {
    return std::ranges::equal(f.loops, g.loops,
                              [&](const auto& x, const auto& y) { return std::ranges::equal(x, y, same); });
  });
}

auto same_solid(const model::PartsSolid& a, const model::PartsSolid& b) -> bool {
  return a.parts == b.parts && a.model.classes == b.model.classes && same_corners(a.model.solid, b.model.solid);
}

/// The solids of a building as a file has them, and how many parts they are of.
struct Stored {
  std::size_t parts = 0;
  std::vector<model::PartsSolid> solids;
};

/// Whether a building's parts are written as these solids.
auto is_written_as(const model::Building& building, const std::vector<model::PartsSolid>& solids) -> bool {
  return std::ranges::equal(formats::written_solids(building, formats::Solids::part), solids,
                            [](const model::LabelledSolid& a, const model::PartsSolid& b) {
                              return a.classes == b.model.classes && same_corners(a.solid, b.model.solid);
                            });
}

/// Puts the solids of a file in the place of others that came of its plans. Those of single parts are united, unless
/// they are wanted as they are.
void keep_stored(RaisedPlans& raised, std::map<std::string, Stored> stored, bool of_parts, formats::Solids wanted) {
  auto& buildings = raised.city.buildings;
  std::vector<Stored*> changed(buildings.size(), nullptr);
  base::parallel_for(buildings.size(), [&](std::size_t b) {
    const auto found = stored.find(buildings[b].id);
    if (found == stored.end()) return;
    const auto& [parts, solids] = found->second;
    if (solids.empty() || parts != buildings[b].parts.size()) return;
    const bool same =
        of_parts ? is_written_as(buildings[b], solids) : std::ranges::equal(buildings[b].solids, solids, same_solid);
    if (!same) changed[b] = &found->second;
  });
  if (std::ranges::none_of(changed, [](const auto* own) { return own != nullptr; })) return;
  for (std::size_t b = 0; b < buildings.size(); ++b) {
    if (changed[b] == nullptr) continue;
    buildings[b].solids = std::move(changed[b]->solids);
    if (!of_parts) continue;
    for (auto& part : buildings[b].parts) part.model = {};
    for (const auto& solid : buildings[b].solids)
      model::append(solid.model, buildings[b].parts[solid.parts.front()].model);
  }
  if (!of_parts || wanted == formats::Solids::part) return;
  // All of them, since walls of neighbours are put on the same points.
  auto united = unite_parts(buildings);
  for (std::size_t b = 0; b < united.size(); ++b) {
    detail::drop_lost(raised, b, united[b]);
    buildings[b].solids = std::move(united[b].solids);
    if (changed[b] == nullptr) continue;
    for (auto& warning : united[b].warnings) {
      warning.subject = buildings[b].id;
      raised.remarks.push_back(std::move(warning));
    }
  }
}

/// The file, or every file of a folder of tiles, by name.
auto inputs_of(const fs::path& path) -> base::Result<std::vector<model::InputFile>> {
  std::vector<fs::path> files;
  std::error_code status;
  if (fs::is_directory(path, status)) {
    for (const auto& entry : fs::recursive_directory_iterator(path, status))
      if (entry.is_regular_file(status)) files.push_back(entry.path());
    std::ranges::sort(files);
  } else {
    files.push_back(path);
  }
  std::vector<model::InputFile> out;
  for (const auto& file : files) {
    auto input = formats::input_file(file);
    if (!input) return input.error();
    out.push_back(std::move(*input));
  }
  return out;
}

/// A plans.json ends like any JSON, CityJSON among it; read_model reads that, of any producer.
auto read_model_knows(const fs::path& path) -> bool {
  const auto format = formats::format_of(path);
  if (format == formats::Format::plans) {
    const auto opened = formats::read_city(path);
    return opened ? (*opened)->has_models() : is_foreign(opened.error());
  }
  return format == formats::Format::cityjson || format == formats::Format::cityjsonseq ||
         format == formats::Format::citygml || format == formats::Format::obj;
}

}  // namespace

auto is_foreign(const base::Diagnostic& why) -> bool {
  static constexpr std::array codes{"write-read-format", "write-read-plans", "write-plan-type"};
  return std::ranges::find(codes, why.code) != codes.end();
}

auto take_options(const model::MadeBy& made_by, Options& options) -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> warnings;
  auto lists = option_lists(options);
  for (const auto& [name, value] : made_by.options) {
    if (!raises(name)) continue;
    if (auto set = set_option(lists, name, value); !set) {
      auto why = set.error();
      warnings.push_back(base::warning(why.code, why.message + "; the default is used", name));
    }
  }
  return warnings;
}

void note_options(const Options& options, model::MadeBy& made_by) {
  const auto defaults = raising_options({});
  const auto used = raising_options(options);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto at = std::ranges::find(made_by.options, used[i].first, &std::pair<std::string, std::string>::first);
    if (at != made_by.options.end()) at->second = used[i].second;
    else if (used[i] != defaults[i]) made_by.options.push_back(used[i]);
  }
}

auto same_options(const model::MadeBy& made_by, const Options& options) -> bool {
  const auto defaults = raising_options({});
  const auto used = raising_options(options);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto* before = value_of(made_by, used[i].first);
    if (used[i].second != (before != nullptr ? *before : defaults[i].second)) return false;
  }
  return true;
}

auto read_raised(formats::CityReader& reader, const Options& options, const base::Run& run)
    -> base::Result<RaisedPlans> {
  std::vector<base::Diagnostic> refused;
  auto city = formats::read_whole(reader, &refused);
  if (!city) return city.failure();
  if (!refused.empty() && std::ranges::all_of(city->buildings, [](const auto& b) { return b.parts.empty(); }))
    return base::Failure{std::move(refused)};
  const bool as_made = same_options(city->made_by, options);
  note_options(options, city->made_by);
  std::map<std::string, Stored> stored;
  if (as_made)
    for (auto& building : city->buildings) stored[building.id] = {building.parts.size(), std::move(building.solids)};
  auto raised = raise_plans(std::move(*city), options, run);
  if (!raised) return raised;
  if (run.cancelled()) return base::stopped();
  keep_stored(*raised, std::move(stored), reader.has_models(), options.write.solids);
  raised->refused.insert(raised->refused.begin(), refused.begin(), refused.end());
  return raised;
}

auto model_of(const model::City& city) -> model::Model {
  model::Model model;
  model.frame = city.frame;
  model.lod = "2.2";
  for (const auto& building : city.buildings) {
    model::ModelBuilding out{building.id, {}};
    for (const auto& [parts, solid, part_of_face] : building.solids)
      out.parts.push_back(part_of(building.parts[parts.front()], solid));
    if (building.solids.empty())
      for (const auto& part : building.parts)
        if (!part.model.solid.faces.empty()) out.parts.push_back(part_of(part, part.model));
    if (!out.parts.empty()) model.buildings.push_back(std::move(out));
  }
  return model;
}

auto read_any_model(const fs::path& path, const ingest::ModelOptions& wanted, const base::Run& run)
    -> base::Result<model::Model> {
  if (read_model_knows(path)) return ingest::read_model(path, wanted);
  auto reader = formats::read_city(path);
  if (!reader) return reader.error();
  const std::string subject = path.string();
  if (!wanted.lod.empty() && !std::string("2.2").starts_with(wanted.lod))
    return base::error("ingest-model-lod", "there is no LoD " + wanted.lod + " in it, but 2.2", subject);
  Options options;
  auto warnings = take_options((*reader)->header().made_by, options);
  auto raised = read_raised(**reader, options, run);
  if (!raised) return raised.failure();
  for (const auto& part : raised->refused)
    warnings.push_back(base::warning(part.code, part.message + "; the part is left out", part.subject));
  auto model = model_of(raised->city);
  if (model.buildings.empty())
    return base::error("ingest-model-empty", "there is no building with a surface in it", subject);
  if (wanted.crs == "local") {
    model.frame.crs.clear();
  } else if (!wanted.crs.empty()) {
    auto frame = model.frame;
    frame.crs = wanted.crs;
    auto checked = ingest::in_frame(std::move(model), frame);
    if (!checked) return checked.error();
    model = std::move(*checked);
  }
  auto inputs = inputs_of(path);
  if (!inputs) return inputs.error();
  model.inputs = std::move(*inputs);
  model.warnings = std::move(warnings);
  return model;
}

}  // namespace mansard::pipeline
