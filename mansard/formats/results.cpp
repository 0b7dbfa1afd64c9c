#include "mansard/formats/results.hpp"

#include <algorithm>

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

auto places_of(const Target& target) -> std::vector<fs::path> {
  if (target.format == Format::obj) return {target.path, fs::path(target.path).replace_extension(".mtl")};
  return {target.path};
}

auto write_models(const model::City& city, const std::vector<Target>& targets, const WriteOptions& options,
                  base::Outputs& outputs, const std::vector<Layer>& more)
    -> base::Result<std::vector<base::Diagnostic>> {
  const Header header{city.frame, city.made_by};
  std::vector<base::Diagnostic> warnings;
  for (const auto& target : targets) {  // one after the other: each may put bytes aside
    auto writer = open_writer(target.format, target.path, header, options, outputs, more);
    if (!writer) return writer.error();
    if (auto written = write_city(city, **writer); !written) return written.error();
    const auto own = (*writer)->warnings();
    warnings.insert(warnings.end(), own.begin(), own.end());
  }
  return warnings;
}

}  // namespace mansard::formats
