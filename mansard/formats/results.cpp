#include "mansard/formats/results.hpp"

#include <algorithm>
#include <iterator>

#include "mansard/base/stopped.hpp"

namespace mansard::formats {

namespace fs = std::filesystem;

auto name_in_folder(Format format) -> std::string {
  if (format == Format::plans) return "plans.json";
  const auto at = std::ranges::find(formats(), format, &FormatName::format);
  return "model" + std::string(at->ending);
}

auto targets_in(const fs::path& folder, const std::vector<Format>& formats) -> std::vector<Target> {
  std::vector<Target> out;
  for (const auto format : formats) out.push_back({format, folder / name_in_folder(format)});
  return out;
}

auto textures_beside(const fs::path& file) -> fs::path {
  std::string name = file.filename().string();
  for (char& c : name)  // blanks and '#' end names in OBJ, a dot would be taken for a file extension
    if (static_cast<unsigned char>(c) <= ' ' || c == '#' || c == '.' || c == '\\' || c == '"') c = '_';
  return file.parent_path() / (name + "_textures");
}

auto holds_textures_only(const fs::path& folder) -> bool {
  std::error_code status;
  if (fs::symlink_status(folder, status).type() != fs::file_type::directory) return false;
  for (const auto& entry : fs::directory_iterator(folder, status)) {
    const auto name = entry.path().filename().string();
    const bool texture = name.ends_with(".jpg") && name.find_first_not_of("0123456789") == name.size() - 4;
    if (!texture || entry.symlink_status(status).type() != fs::file_type::regular) return false;
  }
  return !status;
}

auto textures_of(const Target& target) -> std::optional<fs::path> {
  switch (target.format) {
    case Format::obj:
    case Format::cityjson:
    case Format::cityjsonseq:
    case Format::citygml: return textures_beside(target.path);
    default: return std::nullopt;
  }
}

auto places_of(const Target& target) -> std::vector<fs::path> {
  if (target.format == Format::obj)
    return {target.path, fs::path(target.path).replace_extension(".mtl"),
            fs::path(target.path).replace_extension(".plans.jsonl")};
  return {target.path};
}

auto write_each(const std::vector<Target>& targets, const Header& header, const WriteOptions& options,
                const std::vector<Layer>& more, const std::function<base::Result<void>(CityWriter&)>& fill,
                base::Outputs& outputs) -> base::Result<Written> {
  Written out;
  for (const auto& target : targets) {
    base::Outputs own;  // what was begun of it goes with it
    auto writer = open_writer(target.format, target.path, header, options, own, more);
    const auto filled = writer ? fill(**writer) : base::Result<void>(writer.error());
    if (filled) {
      std::ranges::move((*writer)->warnings(), std::back_inserter(out.warnings));
      writer->reset();
      outputs.take(std::move(own));
      continue;
    }
    if (filled.error().code == base::stopped().code) return filled.failure();
    out.missing.push_back({target, filled.error()});
  }
  if (!targets.empty() && out.missing.size() == targets.size()) return out.missing.front().why;
  return out;
}

auto write_models(const model::City& city, const std::vector<Target>& targets, const WriteOptions& options,
                  base::Outputs& outputs, const std::vector<Layer>& more) -> base::Result<Written> {
  return write_each(
      targets, {city.frame, city.made_by}, options, more,
      [&city](CityWriter& writer) { return write_city(city, writer); }, outputs);
}

}  // namespace mansard::formats
