#include "apps/server/inputs.hpp"

#include <algorithm>
#include <set>

#include "apps/server/options.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/input_name.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

auto is_mesh(const fs::path& path) -> bool { return formats::has_extension(path, &formats::Reads::mesh); }

auto no_database(const std::string& name, const char* what) -> base::Result<void> {
  if (!formats::is_database_name(name)) return {};
  return base::error("server-input",
                     std::string("a database can hold footprints but no ") + what +
                         "; give a file, a folder, or a GDAL name such as '/vsizip/…'",
                     formats::name_to_show(name));
}

auto check(const Inputs& inputs) -> base::Result<void> {
  for (const auto& mesh : inputs.meshes) {
    if (auto file = no_database(mesh, "mesh"); !file) return file;
    if (auto there = formats::check_input(mesh); !there) return there;
  }
  const auto terrain = inputs.reading.find(terrain_option);
  if (terrain != inputs.reading.end() && !terrain->second.empty()) {
    if (auto file = no_database(terrain->second, "raster"); !file) return file;
    if (auto there = formats::check_input(terrain->second); !there) return there;
  }
  return inputs.footprints.empty() ? base::Result<void>() : formats::check_input(inputs.footprints);
}

/// Whether the file is the source, is in it (a folder, an archive), or is a sidecar file of it (as those of a
/// Shapefile).
auto belongs_to(const std::string& file, const std::string& source) -> bool {
  if (file == formats::name_to_show(source)) return true;
  if (formats::is_disk_name(source)) {
    const auto place = formats::disk_place_of(file);
    if (place && (*place == source || place->string().starts_with(source + "/"))) return true;
  } else if (file.starts_with(source + "/")) {
    return true;
  }
  const fs::path own(file), of(source);
  return !is_mesh(own) && own.parent_path() == of.parent_path() && own.stem() == of.stem();
}

}  // namespace

auto absolute_name(const std::string& name) -> std::string {
  if (!formats::is_disk_name(name)) return name;
  std::error_code status;
  const auto whole = fs::absolute(name, status).lexically_normal();
  return whole.has_filename() ? whole.string() : whole.parent_path().string();
}

auto sample_inputs(const fs::path& folder) -> base::Result<InputsRequest> {
  InputsRequest request;
  std::set<std::string> names;
  std::error_code status;
  for (const auto& entry : fs::directory_iterator(folder, status)) names.insert(entry.path().string());
  for (const auto& name : names) {
    const fs::path path(name);
    if (path.filename() == "reading.json") {
      const auto text = base::read_file(path);
      const auto json = text ? Json::parse(*text, nullptr, false) : Json(nullptr);
      if (!json.is_object())
        return base::error("server-sample", "the options of the sample must be a JSON object of strings", name);
      for (const auto& [key, value] : json.items())
        if (value.is_string()) request.reading[key] = value.get<std::string>();
    } else if (is_mesh(path)) {
      request.meshes.push_back(name);
    } else if (path.stem() == "footprints" && request.footprints.empty()) {
      request.footprints = name;
    }
  }
  if (request.meshes.empty() || request.footprints.empty())
    return base::error(
        "server-sample",
        "no sample is available: the server has none, or its folder has no meshes or no file 'footprints.*'",
        folder.string());
  return request;
}

auto requested_inputs(const InputsRequest& request, const std::optional<Inputs>& known) -> base::Result<Inputs> {
  Inputs inputs;
  for (const auto& mesh : request.meshes) inputs.meshes.push_back(absolute_name(mesh));
  if (!request.footprints.empty())
    inputs.footprints = formats::meant_by(absolute_name(request.footprints), known ? known->footprints : std::string());
  inputs.reading = request.reading;
  pipeline::Options tried;
  if (auto set = set_all(tried, inputs.reading); !set) return set.error();
  for (const auto& [key, value] : inputs.reading)
    if (!is_input_option(key))
      return base::error("option-value", "this option does not say how inputs are read; set it for a run instead", key);
  const auto terrain = inputs.reading.find(terrain_option);
  if (terrain != inputs.reading.end() && !terrain->second.empty()) terrain->second = absolute_name(terrain->second);
  if (auto checked = check(inputs); !checked) return checked.error();
  return inputs;
}

/// A scene lists the files of the meshes first, then the terrain, then the footprints.
auto with_files(Inputs inputs, const std::vector<model::InputFile>& read) -> Inputs {
  inputs.mesh_files.clear();
  inputs.terrain_files.clear();
  inputs.footprint_files.clear();
  const auto terrain = inputs.reading.find(terrain_option);
  auto* into = &inputs.mesh_files;
  for (const auto& file : read) {
    const bool of_mesh = std::ranges::find(inputs.meshes, file.path) != inputs.meshes.end();
    const bool of_terrain = terrain != inputs.reading.end() && file.path == terrain->second;
    if (of_terrain && into == &inputs.mesh_files && !of_mesh) into = &inputs.terrain_files;
    else if (into == &inputs.terrain_files) into = &inputs.footprint_files;
    else if (!inputs.footprints.empty() && !of_mesh && belongs_to(file.path, inputs.footprints))
      into = &inputs.footprint_files;
    const auto place = formats::disk_place_of(file.path);
    const auto stamp = place ? stamp_of(*place) : std::nullopt;
    into->push_back({file.path, file.bytes, file.sha256, stamp.value_or(Stamp{})});
  }
  return inputs;
}

auto key_of(const Inputs& inputs) -> std::string {
  const auto program = stamp_of("/proc/self/exe");
  if (!program) return {};
  Json all{{"version", MANSARD_VERSION},
           {"program", {program->bytes, program->modified}},
           {"meshes", inputs.meshes},
           {"footprints", inputs.footprints},
           {"reading", inputs.reading}};
  for (const auto files : {&Inputs::mesh_files, &Inputs::terrain_files, &Inputs::footprint_files}) {
    Json list = Json::array();
    for (const auto& file : inputs.*files) {
      if (file.sha256.empty() || !formats::disk_place_of(file.path)) return {};
      list.push_back({file.path, file.sha256});
    }
    all["files"].push_back(std::move(list));
  }
  return formats::sha256(text_of(all));
}

auto shown_json(const Inputs& inputs) -> Json {
  Json meshes = Json::array();
  for (const auto& mesh : inputs.meshes) meshes.push_back(formats::name_to_show(mesh));
  return {{"meshes", std::move(meshes)}, {"footprints", formats::name_to_show(inputs.footprints)}};
}

auto explained(base::Diagnostic why, const Inputs& inputs) -> base::Diagnostic {
  if (!formats::is_database_name(inputs.footprints)) return why;
  if (formats::name_to_show(inputs.footprints) == inputs.footprints && why.code == "file-read" &&
      why.subject == inputs.footprints)
    why.message +=
        "; projects do not store passwords: read the inputs again with the password, or put it into ~/.pgpass";
  return why;
}

}  // namespace mansard::server
