// Of models that mansard wrote: counts, validity, and how they were made.
#include <algorithm>
#include <map>

#include "apps/cli/info.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/pipeline/compared.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

auto attribute(const model::Attributes& attributes, std::string_view name) -> const model::Value* {
  for (const auto& [key, value] : attributes)
    if (key == name) return &value;
  return nullptr;
}

/// What adds up building by building.
class Tally {
 public:
  Tally(const model::Frame& frame, pipeline::ComparedSolids compared) : frame_(frame), compared_(std::move(compared)) {}

  void add(const model::Building& building) {
    ++buildings_;
    const auto* derived = attribute(building.attributes, "ms_derived");
    derived_ += derived != nullptr && std::get_if<bool>(derived) != nullptr && std::get<bool>(*derived) ? 1 : 0;
    for (const auto& polygon : building.footprint)
      for (const auto p : polygon.outer) extent_.add({p.x, p.y, building.ground}, frame_);
    for (const auto& part : building.parts) add(part);
    std::vector<Named> solids;
    for (const auto& [parts, model, part_of_face] : building.solids)
      solids.push_back(
          {parts.size() == building.parts.size() ? building.id : building.parts[parts.front()].id, &model});
    if (building.solids.empty())
      for (const auto& part : building.parts)
        if (!part.model.solid.faces.empty()) solids.push_back({part.id, &part.model});
    std::vector<std::vector<base::Diagnostic>> wrong(solids.size());
    base::parallel_for(wrong.size(),
                       [&](std::size_t i) { wrong[i] = solid::check(solids[i].model->solid, solid::written_rules()); });
    std::vector<const model::LabelledSolid*> models;
    for (const Named& named : solids) models.push_back(named.model);
    for (auto& [i, what] : solid::overlapping(models)) wrong[i].push_back(std::move(what));
    for (std::size_t i = 0; i < wrong.size(); ++i) add(building, solids[i], wrong[i]);
    compared_.add(building);
  }

  /// Compares the solids with each other, after the last building.
  [[nodiscard]] auto compare(const base::Run& run) -> base::Result<void> {
    auto found = compared_.overlapping(run);
    if (!found) return found.failure();
    overlapping_ = std::move(*found);
    return {};
  }

  [[nodiscard]] auto counts() const -> Json {
    return {{"buildings", buildings_},
            {"parts", parts_},
            {"faces", faces_},
            {"triangles", triangles_},
            {"vertices", vertices_}};
  }
  [[nodiscard]] auto extent() const -> Json { return extent_.json(); }
  [[nodiscard]] auto validity() const -> Json {
    Json overlaps = Json::array();
    for (const auto* some : {&overlapping_.in_all, &overlapping_.of_each})
      for (const auto& one : *some)
        overlaps.push_back({{"code", one.code}, {"solid", one.subject}, {"message", one.message}});
    return {{"planarity_m", 1e-4},
            {"solids", solids_},
            {"valid", solids_ - invalid_.size()},
            {"invalid", invalid_},
            {"overlaps", std::move(overlaps)}};
  }
  [[nodiscard]] auto fallbacks() const -> Json {
    Json out = Json::object();
    for (const auto& [code, count] : fallbacks_) out[code] = count;
    return out;
  }
  [[nodiscard]] auto footprints() const -> Json { return {{"surveyed", buildings_ - derived_}, {"derived", derived_}}; }

 private:
  struct Named {
    std::string id;  ///< of the building, or of its first part
    const model::LabelledSolid* model = nullptr;
  };

  void add(const model::Part& part) {
    ++parts_;
    const auto* fallback = attribute(part.attributes, "ms_fallback");
    if (const auto* code = fallback == nullptr ? nullptr : std::get_if<std::string>(fallback)) ++fallbacks_[*code];
  }

  void add(const model::Building& building, const Named& named, const std::vector<base::Diagnostic>& wrong) {
    const auto& solid = named.model->solid;
    ++solids_;
    faces_ += solid.faces.size();
    vertices_ += solid.vertices.size();
    // A polygon of n corners with h holes is n + 2 h − 2 triangles.
    for (const auto& face : solid.faces) {
      std::size_t corners = 0;
      for (const auto& loop : face.loops) corners += loop.size();
      triangles_ += corners + 2 * (face.loops.size() - 1) - 2;
    }
    for (const auto p : solid.vertices) extent_.add(p, frame_);
    if (wrong.empty()) return;
    Json reasons = Json::array();
    for (const auto& reason : wrong) reasons.push_back({{"code", reason.code}, {"message", reason.message}});
    invalid_.push_back({{"building", building.id}, {"part", named.id}, {"reasons", std::move(reasons)}});
  }

  model::Frame frame_;
  pipeline::ComparedSolids compared_;
  pipeline::ComparedSolids::Overlapping overlapping_;
  Extent3 extent_;
  std::size_t buildings_ = 0, derived_ = 0, parts_ = 0, solids_ = 0, faces_ = 0, triangles_ = 0, vertices_ = 0;
  Json invalid_ = Json::array();
  std::map<std::string, std::size_t> fallbacks_;
};

auto options_json(const model::MadeBy& made_by, bool all) -> Json {
  pipeline::Options defaults;
  std::map<std::string, std::string> usual;
  for (const auto& list : pipeline::option_lists(defaults))
    for (const auto& option : list.options()) usual[list.module() + "." + option.name] = option.get();
  Json out = Json::object();
  for (const auto& [name, value] : made_by.options) {
    const auto at = usual.find(name);
    if (all || at == usual.end() || at->second != value) out[name] = value;
  }
  return out;
}

/// The levels of detail in a file, by its format and the option that it was written with.
auto lods_in(formats::Format format, const model::MadeBy& made_by) -> std::vector<std::string> {
  std::string asked;
  for (const auto& [name, value] : made_by.options)
    if (name == "write.lod") asked = value;
  auto lods = formats::lods_of(asked, format);
  if (!lods) lods = formats::default_lods(format);
  std::vector<std::string> out;
  for (const auto lod : *lods) out.emplace_back(formats::name_of(lod));
  if (format == formats::Format::tiles) out.insert(out.begin(), "1.2");  // of tiles that are seen from far away
  return out;
}

auto size_of(const fs::path& path) -> std::uintmax_t {
  std::error_code status;
  if (!fs::is_directory(path, status)) return fs::file_size(path, status);
  std::uintmax_t sum = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path, status))
    if (entry.is_regular_file(status)) sum += entry.file_size(status);
  return sum;
}

/// Adds every building, its model rebuilt where the file has none. Whether there were models.
auto add_all(formats::CityReader& reader, const base::Run& run, Tally& tally, std::vector<base::Diagnostic>& warnings)
    -> base::Result<bool> {
  if (!reader.has_models() && !reader.has_solids()) {
    pipeline::Options options;
    warnings = pipeline::take_options(reader.header().made_by, options);
    const auto raised = pipeline::read_raised(reader, options, run);
    if (!raised) return raised.failure();
    warnings.insert(warnings.end(), raised->refused.begin(), raised->refused.end());
    for (const auto& building : raised->city.buildings) tally.add(building);
    return false;
  }
  for (;;) {
    if (run.cancelled()) return base::error("cancelled", "stopped on request");
    const auto building = reader.next();
    if (!building) return building.failure();
    if (!*building) return true;
    tally.add(**building);
  }
}

}  // namespace

auto made_by_json(const model::MadeBy& made_by, bool all_options) -> Json {
  Json inputs = Json::array();
  for (const auto& input : made_by.inputs)
    inputs.push_back({{"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  return {{"version", made_by.version},
          {all_options ? "options" : "options_not_default", options_json(made_by, all_options)},
          {"inputs", std::move(inputs)}};
}

auto info_of_terrain(const fs::path& path, const formats::TerrainInfo& terrain, bool all_options) -> Json {
  Json out;
  out["file"] = path.string();
  out["kind"] = "terrain";
  out["format"] =
      formats::extension_of(path) == ".json" || formats::extension_of(path) == ".cityjson" ? "cityjson" : "cityjsonseq";
  out["bytes"] = size_of(path);
  out["by"] = terrain.made_by ? "mansard" : "others";
  out["crs"] = terrain.crs;
  Extent3 extent;
  if (!terrain.box.empty()) {
    extent.add(terrain.box.least, {});
    extent.add(terrain.box.most, {});
  }
  out["extent"] = extent.json();
  out["counts"] = {{"triangles", terrain.triangles}, {"vertices", terrain.vertices}};
  if (!terrain.lod.empty()) out["lods"] = Json::array({terrain.lod});
  if (terrain.made_by) out["made_by"] = made_by_json(*terrain.made_by, all_options);
  return out;
}

void Extent3::add(geometry::Point3 p, const model::Frame& frame) {
  box_.add({p.x + static_cast<double>(frame.origin[0]), p.y + static_cast<double>(frame.origin[1]),
            p.z + static_cast<double>(frame.origin[2])});
}

auto Extent3::json() const -> Json {
  if (box_.empty()) return nullptr;
  return {box_.least.x, box_.least.y, box_.least.z, box_.most.x, box_.most.y, box_.most.z};
}

auto info_of_city(const fs::path& path, formats::CityReader& reader, bool all_options, const base::Run& run)
    -> base::Result<Json> {
  // The header stays while buildings are read.
  const formats::Header header = reader.header();
  auto compared = pipeline::ComparedSolids::open();
  if (!compared) return compared.failure();
  Tally tally(header.frame, std::move(*compared));
  std::vector<base::Diagnostic> warnings;
  const auto has_models = add_all(reader, run, tally, warnings);
  if (!has_models) return has_models.failure();
  if (auto done = tally.compare(run); !done) return done.failure();
  // By its name; the content distinguishes CityJSON from plans, which may both have the extension ".json".
  auto format = formats::format_of(path).value_or(formats::Format::plans);
  if (*has_models && format == formats::Format::plans) format = formats::Format::cityjson;
  const auto name = std::ranges::find(formats::formats(), format, &formats::FormatName::format);
  Json out;
  out["file"] = path.string();
  out["kind"] = "models";
  out["format"] = name->name;
  out["bytes"] = size_of(path);
  out["by"] = "mansard";
  out["crs"] = header.frame.crs;
  out["extent"] = tally.extent();
  out["counts"] = tally.counts();
  out["lods"] = lods_in(format, header.made_by);
  out["raised"] = !*has_models;
  out["validity"] = tally.validity();
  out["fallbacks"] = tally.fallbacks();
  out["footprints"] = tally.footprints();
  out["made_by"] = made_by_json(header.made_by, all_options);
  out["warnings"] = Json::array();
  for (const auto& warning : warnings)
    out["warnings"].push_back({{"code", warning.code}, {"subject", warning.subject}, {"message", warning.message}});
  if (format == formats::Format::tiles) out["tileset"] = info_of_tileset(path);
  if (format == formats::Format::geopackage) {
    auto layers = info_of_layers(path);
    if (!layers) return layers.failure();
    out["layers"] = std::move(*layers);
  }
  return out;
}

}  // namespace mansard::cli
