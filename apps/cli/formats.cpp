#include "apps/cli/formats.hpp"

#include <algorithm>

#include "apps/cli/output.hpp"
#include "apps/cli/shell_word.hpp"
#include "mansard/formats/input_name.hpp"

namespace mansard::cli {

namespace fs = std::filesystem;
using formats::Format;

namespace {

auto split(const std::string& list) -> std::vector<std::string> {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= list.size();) {
    const auto end = std::min(list.find(',', at), list.size());
    words.push_back(list.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

auto format_names() -> std::string {
  std::string all;
  for (const auto& format : formats::formats()) all += (all.empty() ? "" : ", ") + std::string(format.name);
  return all;
}

auto holds_a_tileset(const fs::path& folder) -> bool {
  std::error_code status;
  return fs::is_regular_file(folder / "tileset.json", status);
}

/// A folder of textures of an earlier run has nothing but these.
auto texture_folder_free(const fs::path& folder, bool overwrite) -> base::Result<void> {
  std::error_code status;
  if (!fs::exists(folder, status)) return {};
  if (!fs::is_directory(folder, status))
    return base::error("output-exists", "is a file, and the textures are in a folder; choose another path",
                       folder.string());
  if (!overwrite && !fs::is_empty(folder, status))
    return base::error("output-exists", "the folder is not empty; choose another, or add --overwrite", folder.string());
  if (!formats::holds_textures_only(folder))
    return base::error("output-exists",
                       "the folder holds other files than textures, which would be lost; choose "
                       "another path",
                       folder.string());
  return {};
}

auto folder_free(const fs::path& folder, bool overwrite) -> base::Result<void> {
  std::error_code status;
  if (fs::exists(folder, status) && !fs::is_directory(folder, status))
    return base::error("output-exists", "is a file, and a tileset is a folder; choose another path", folder.string());
  const bool taken = fs::exists(folder, status) && !fs::is_empty(folder, status);
  if (taken && !overwrite)
    return base::error("output-exists", "the folder is not empty; choose another, or add --overwrite", folder.string());
  if (taken && !holds_a_tileset(folder))
    return base::error("output-exists",
                       "the folder holds other files than a tileset, which would be lost; choose another path",
                       folder.string());
  const auto above = fs::absolute(folder, status).lexically_normal();
  const auto parent = (above.has_filename() ? above : above.parent_path()).parent_path();
  return can_be_made_in(parent, folder);
}

}  // namespace

auto readable_formats() -> const ReadableFormats& {
  using formats::Reads;
  static const ReadableFormats all = [] {
    std::string only_own;
    for (const auto& driver : formats::drivers())
      if (driver.reads.results && !driver.reads.models)
        only_own += (only_own.empty() ? "" : ", ") + std::string(driver.title);
    return ReadableFormats{
        formats::titles(&Reads::mesh) + ", rasters of heights (" + formats::titles(&Reads::raster) +
            "), folders, .zip and .gz of these",
        formats::titles(&Reads::footprints) + ", any other vector format of GDAL, or a database (PG:...)",
        formats::titles(&Reads::models) + " of any producer, or what mansard wrote (" + only_own + ")",
        formats::titles(&Reads::results)};
  }();
  return all;
}

auto extensions() -> std::string {
  std::string all;
  for (const auto& format : formats::formats()) all += (all.empty() ? "" : ", ") + std::string(format.ending);
  return all;
}

auto format_named(const std::string& name) -> base::Result<Format> {
  std::vector<std::string> known;
  for (const auto& format : formats::formats()) {
    if (format.name == name) return format.format;
    known.emplace_back(format.name);
  }
  return base::error(
      "option-value",
      "unknown format '" + name + "'; expected " + format_names() + base::did_you_mean(base::nearest_word(name, known)),
      name);
}

auto formats_in(const std::string& list) -> base::Result<std::vector<Format>> {
  std::vector<Format> asked;
  for (const auto& word : split(list)) {
    if (word == "all") {
      for (const auto& format : formats::formats()) asked.push_back(format.format);
    } else if (word == "default") {
      for (const auto& name : split(default_formats)) asked.push_back(*format_named(name));
    } else {
      const auto format = format_named(word);
      if (!format) return format.failure();
      asked.push_back(*format);
    }
  }
  std::vector<Format> out;
  for (const auto& format : formats::formats())
    if (std::ranges::find(asked, format.format) != asked.end()) out.push_back(format.format);
  return out;
}

auto all_results() -> const std::vector<std::string>& {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names{"run.json", run_report_name};
    names.insert(names.end(), picture_names.begin(), picture_names.end());
    for (const auto& format : formats::formats()) {
      const Target target{format.format, name_in_folder(format.format)};
      for (const auto& place : places_of(target)) names.push_back(place.string());
      if (const auto folder = formats::textures_of(target)) names.push_back(folder->string());
    }
    return names;
  }();
  return all;
}

auto target_at(const fs::path& path) -> base::Result<Target> {
  if (formats::is_database_name(path)) return Target{Format::geopackage, path};  // the same tables' writer
  const auto format = formats::format_of(path);
  if (!format)
    return base::error("usage", "unknown file extension; expected " + extensions() + ", or a database (PG:...)",
                       path.string());
  // Of a tileset the folder is written, not the one file that names the others.
  return Target{*format, path.filename() == "tileset.json" ? path.parent_path() : path};
}

auto check_model_place(const fs::path& model, const fs::path& other, const std::string& call) -> base::Result<void> {
  using formats::has_extension;
  using formats::Reads;
  const auto is_model = [](const fs::path& path) {
    return has_extension(path, &Reads::models) || has_extension(path, &Reads::results);
  };
  const auto is_mesh = [](const fs::path& path) { return has_extension(path, &Reads::mesh); };
  if (is_model(model) || !is_mesh(model) || !is_model(other) || is_mesh(other)) return {};
  return base::error("usage", "this is a mesh where the model is expected; call it as: " + call, model.string());
}

auto open_city(const fs::path& path) -> base::Result<std::unique_ptr<formats::CityReader>> {
  std::error_code status;
  if (!path.string().starts_with("/vsi") && !fs::exists(path, status))
    return base::error("file-missing", "the file does not exist; check the path", path.string());
  return formats::read_city(path);
}

auto layers_beside(formats::CityReader& reader, const std::string& input, const std::vector<Target>& targets)
    -> base::Result<formats::Beside> {
  auto beside = reader.beside();
  if (!beside || std::ranges::find(targets, Format::geopackage, &Target::format) != targets.end()) return beside;
  std::string names;
  for (const auto& layer : beside->layers) names += (names.empty() ? "" : ", ") + layer.name;
  for (const auto& left : beside->warnings) names += (names.empty() ? "" : ", ") + left.subject;
  *beside = {};
  if (!names.empty())
    beside->warnings.push_back(base::warning(
        "write-layer-left", "only a GeoPackage can hold these layers, so they are left out: " + names, input));
  return beside;
}

auto target_free(const Target& target, bool overwrite) -> base::Result<void> {
  if (formats::is_database_name(target.path)) return {};  // rows are updated, and nothing is replaced
  if (target.format == Format::tiles) return folder_free(target.path, overwrite);
  for (const auto& path : places_of(target))
    if (auto usable = file_free(path, overwrite); !usable) return usable;
  if (const auto folder = formats::textures_of(target)) return texture_folder_free(*folder, overwrite);
  return {};
}

auto reasons_of(const Missing& missing, const std::vector<Target>& sources) -> std::vector<base::Diagnostic> {
  const auto is_missing = [&](const Target& target) {
    return std::ranges::any_of(missing, [&](const auto& one) { return one.target.path == target.path; });
  };
  const auto source = std::ranges::find_if(
      sources, [&](const Target& target) { return target.format != formats::Format::stl && !is_missing(target); });
  std::vector<base::Diagnostic> out;
  for (const auto& [target, why] : missing) {
    auto& told = out.emplace_back(why);
    told.message += "; there is no " + target.path.filename().string() + ", and the other results are complete";
    if (source != sources.end())
      told.message += "; once this is corrected, run: mansard convert " + quoted(source->path.string()) + " -o " +
                      quoted(target.path.string());
  }
  return out;
}

auto write_bytes(const fs::path& path, std::string_view bytes, base::Outputs& outputs) -> base::Result<void> {
  auto sink = outputs.file(path);
  if (!sink) return sink.failure();
  (*sink)->append(bytes);
  return {};
}

}  // namespace mansard::cli
