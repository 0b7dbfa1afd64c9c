#include "apps/cli/made.hpp"

#include <array>
#include <map>
#include <utility>

#include "mansard/base/stopped.hpp"

namespace mansard::cli {

namespace fs = std::filesystem;

auto made_of(const report::Reconstruction& r) -> Made {
  return {r,
          report::outcomes(r),
          r.city.frame,
          r.city.made_by,
          [&r](const Made::Visit& visit) -> base::Result<void> {
            for (std::size_t i = 0; i < r.buildings.size(); ++i)
              if (auto visited = visit(r.city.buildings[i], r.buildings[i]); !visited) return visited;
            return {};
          },
          [&r](const auto& visit) -> base::Result<void> {
            for (const auto& map : r.error_maps) visit(map);
            return {};
          },
          &r};
}

auto made_of(const pipeline::PutAside& city) -> Made {
  return {city.summary,
          city.outcomes,
          city.frame,
          city.made_by,
          [&city](const Made::Visit& visit) { return city.each(visit); },
          [&city](const auto& visit) { return city.each_error_map(visit); }};
}

auto in_words(const report::Outcomes& outcomes, std::size_t remarks) -> std::string {
  std::string words =
      std::to_string(outcomes.full) + " of " + std::to_string(outcomes.all()) + " buildings with a full model";
  if (remarks > 0) words += " (" + std::to_string(remarks) + " of them with remarks)";
  const std::array others{std::pair{outcomes.fallback, " with a simpler one"},
                          std::pair{outcomes.covered, " covered by neighbours"},
                          std::pair{outcomes.refused, " not usable"}};
  for (const auto& [count, what] : others)
    if (count > 0) words += ", " + std::to_string(count) + what;
  return words;
}

auto in_words(const report::Reuse& reuse, std::size_t all, const std::string& units) -> std::string {
  std::map<std::string, std::size_t> made;
  for (const auto& [name, why] : reuse.made) ++made[why];
  std::string again;
  for (const auto& [why, count] : made) again += (again.empty() ? "" : ", ") + std::to_string(count) + " (" + why + ")";
  if (reuse.blocks == 0 && again.empty()) return {};
  return std::to_string(reuse.blocks) + " of " + std::to_string(all) + " " + units +
         " were taken over from an earlier run" +
         (again.empty() ? "" : "; made again because of what changed: " + again);
}

auto write_targets(const Made& made, const std::vector<Target>& targets, const formats::WriteOptions& options,
                   const std::vector<formats::Layer>& layers, base::Outputs& outputs, const base::Run& run,
                   Progress& progress) -> base::Result<Missing> {
  auto written = formats::write_each(
      targets, {made.frame, made.made_by}, options, layers,
      [&](formats::CityWriter& writer) -> base::Result<void> {
        auto added = made.each([&](const model::Building& building, const auto&) -> base::Result<void> {
          if (run.cancelled()) return base::stopped();
          return writer.add(building);
        });
        return added ? writer.finish() : added;
      },
      outputs);
  if (!written) return written.failure();
  for (const auto& warning : written->warnings) progress.say(base::to_string(warning));
  return std::move(written->missing);
}

auto textures_of(const Made& made, const std::vector<std::filesystem::path>& meshes, const pipeline::Options& options,
                 const base::Run& run, Progress& progress) -> base::Result<texture::Baked> {
  auto baked = texture::bake_all(
      [&](const auto& visit) {
        return made.each([&](const model::Building& building, const auto&) { return visit(building); });
      },
      meshes, options.ingest, made.frame, options.texture, options.write, run);
  if (baked)
    for (const auto& warning : baked->warnings) progress.say(base::to_string(warning));
  return baked;
}

auto with_textures(const Made& made, const texture::PutAside& textures) -> Made {
  return {made.summary,
          made.outcomes,
          made.frame,
          made.made_by,
          [&made, &textures](const Made::Visit& visit) {
            std::size_t number = 0;
            return made.each([&](model::Building building, const report::BuildingReport& report) -> base::Result<void> {
              if (auto applied = textures.apply(number++, building); !applied) return applied;
              return visit(building, report);
            });
          },
          made.each_error_map,
          made.whole};
}

auto write_report(const Made& made, const model::Scene& scene, const std::filesystem::path& path,
                  base::Outputs& outputs) -> base::Result<void> {
  auto sink = outputs.file(path);
  if (!sink) return sink.failure();
  report::RunJson report(made.summary, made.outcomes, made.made_by, scene, **sink);
  auto told = made.each([&](const auto&, const report::BuildingReport& building) -> base::Result<void> {
    report.add(building);
    return {};
  });
  if (told) report.finish();
  return told;
}

}  // namespace mansard::cli
