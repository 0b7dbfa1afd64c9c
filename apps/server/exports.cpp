#include "apps/server/exports.hpp"

#include <algorithm>

#include "apps/server/disk.hpp"
#include "apps/server/zip.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view work_name = ".work-";

/// Every name that an export may write.
auto own_names() -> std::vector<std::string> {
  std::vector<std::string> names{run_layers};
  for (const auto format : written_formats())
    for (const auto& place : formats::places_of({format, formats::name_in_folder(format)}))
      names.push_back(place.string());
  return names;
}

}  // namespace

auto work_folder(const fs::path& exports, std::uint64_t number) -> fs::path {
  return exports / (std::string(work_name) + std::to_string(number));
}

void remove_work_folders(const fs::path& exports) {
  std::error_code status;
  for (const auto& left : fs::directory_iterator(exports, status))
    if (left.path().filename().string().starts_with(work_name)) fs::remove_all(left.path(), status);
}

auto exported(const model::City& city, const formats::WriteOptions& options, std::string_view file,
              const fs::path& work) -> base::Result<std::string> {
  for (const auto format : written_formats()) {
    const auto own = files_of(format);
    // Files that name each other can be had as one ZIP, in which they keep their names.
    const bool together = own.size() > 1 && file == own.front() + ".zip";
    if (!together && std::ranges::find(own, file) == own.end()) continue;
    const WorkFolder folder(work);
    if (auto made = make_folder(folder.path()); !made) return made.error();
    const auto targets = formats::targets_in(folder.path(), {format});
    base::Outputs outputs;
    if (auto written = formats::write_models(city, targets, options, outputs); !written) return written.error();
    if (auto committed = outputs.commit(); !committed) return committed.error();
    if (together) return zip_of(folder.path());
    return format == formats::Format::tiles ? zip_of(targets.front().path) : base::read_file(folder.path() / file);
  }
  return base::error("server-unknown", "unknown export file; /api/options lists the files of each format",
                     base::on_one_line(std::string(file)));
}

auto export_to(const fs::path& folder, const model::City& city, const formats::WriteOptions& options,
               const std::vector<formats::Format>& formats, const std::optional<std::string>& layers)
    -> base::Result<Exported> {
  const auto targets = formats::targets_in(folder, formats);
  Exported out;
  base::Outputs outputs;
  auto written = formats::write_models(city, targets, options, outputs);
  if (!written) return written.error();
  out.warnings = std::move(written->warnings);
  for (const auto& [target, why] : written->missing) {
    out.warnings.push_back(why);
    out.warnings.back().message += "; there is no " + target.path.filename().string();
  }
  const auto is_missing = [&](const formats::Target& target) {
    return std::ranges::any_of(written->missing, [&](const auto& one) { return one.target.path == target.path; });
  };
  for (const auto& target : targets) {
    if (is_missing(target)) continue;
    for (const auto& place : formats::places_of(target)) out.files.push_back(place.filename().string());
  }
  if (layers) {
    auto sink = outputs.file(folder / run_layers);
    if (!sink) return sink.error();
    (*sink)->append(*layers);
    out.files.emplace_back(run_layers);
  }
  if (auto committed = outputs.commit(); !committed) return committed.error();
  for (const auto& name : own_names()) {
    std::error_code status;
    if (std::ranges::find(out.files, name) == out.files.end()) fs::remove_all(folder / name, status);
  }
  return out;
}

}  // namespace mansard::server
