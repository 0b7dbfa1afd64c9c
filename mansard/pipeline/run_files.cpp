#include "mansard/pipeline/detail/run_files.hpp"

#include "mansard/formats/results.hpp"
#include "mansard/pipeline/inputs.hpp"

namespace mansard::pipeline::detail {
namespace {

namespace fs = std::filesystem;

/// Where a file of a run is now: as it was named, or beside the run; empty where it is gone or another one.
auto place_of(const model::InputFile& input, const fs::path& folder) -> fs::path {
  std::error_code status;
  for (const auto& path : {fs::path(input.path), folder / input.path, folder.parent_path() / input.path})
    if (fs::is_regular_file(path, status) && fs::file_size(path, status) == input.bytes) return path;
  return {};
}

}  // namespace

auto models_in(const fs::path& folder) -> fs::path {
  using enum formats::Format;
  std::error_code missing;
  for (const auto format : {cityjson, cityjsonseq, geopackage, plans, glb, obj, flatgeobuf}) {
    auto path = folder / formats::name_in_folder(format);
    if (fs::exists(path, missing)) return path;
  }
  return {};
}

void take_reading(const report::EarlierRun& earlier, Options& options) {
  auto lists = option_lists(options);
  for (const auto& [name, value] : earlier.options)
    if (name.starts_with("ingest.") || name.starts_with("cloud.")) (void)set_option(lists, name, value);
}

auto kind_of(const model::InputFile& input, const Options& options) -> InputKind {
  if (input.path == options.ingest.terrain) return InputKind::terrain;
  if (is_footprints_name(input.path)) return InputKind::footprints;
  return is_mesh_name(input.path) ? InputKind::scan : InputKind::other;
}

auto scan_of(const report::EarlierRun& earlier, const fs::path& folder, const Options& options) -> FoundScan {
  FoundScan found;
  for (const auto& input : earlier.inputs) {
    if (kind_of(input, options) != InputKind::scan) continue;
    auto path = place_of(input, folder);
    if (path.empty()) return {{}, input.path};
    // A tileset is read by its first file.
    if (path.filename() == "tileset.json") return {{path}, {}};
    found.files.push_back(std::move(path));
  }
  return found;
}

}  // namespace mansard::pipeline::detail
