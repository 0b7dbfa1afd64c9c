// What a run made, wherever it is, and how it is written.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/cli/formats.hpp"
#include "apps/cli/progress.hpp"
#include "mansard/evaluate/merged.hpp"
#include "mansard/pipeline/city.hpp"
#include "mansard/texture/texture.hpp"

namespace mansard::cli {

/// In memory where layers are made of all of it, else put aside. What it was made of must outlive it.
struct Made {
  const report::Summary& summary;
  report::Outcomes outcomes;
  const model::Frame& frame;
  const model::MadeBy& made_by;
  using Visit = std::function<base::Result<void>(const model::Building&, const report::BuildingReport&)>;
  std::function<base::Result<void>(const Visit&)> each;  ///< in the source's order; ends with the first failure
  evaluate::EachMap each_error_map;                      ///< where they were kept
  const report::Reconstruction* whole = nullptr;         ///< where it is in memory
};
[[nodiscard]] auto made_of(const report::Reconstruction& reconstruction) -> Made;
[[nodiscard]] auto made_of(const pipeline::PutAside& city) -> Made;

/// "87 of 87 buildings with a full model, 2 with a simpler one": what became of the buildings; `remarks` of those with
/// a full model have some.
[[nodiscard]] auto in_words(const report::Outcomes& outcomes, std::size_t remarks = 0) -> std::string;

/// "35 of 36 blocks were taken over from an earlier run; made again because of what changed: 1 (footprints)"; empty
/// where there was none. `units` are what is kept, `all` of them the run has.
[[nodiscard]] auto in_words(const report::Reuse& reuse, std::size_t all, const std::string& units) -> std::string;

/// The models; the files are there after Outputs::commit. What could not be written as it was meant is said. Returns
/// what there is no file of, as formats::write_each does, and fails as that.
[[nodiscard]] auto write_targets(const Made& made, const std::vector<Target>& targets,
                                 const formats::WriteOptions& options, const std::vector<formats::Layer>& layers,
                                 base::Outputs& outputs, const base::Run& run, Progress& progress)
    -> base::Result<Missing>;

/// The buildings with their textures, and without them where these are not asked for; `meshes` are those that the scene
/// was read from. What could not be read of them is said. Fails as texture::bake_all.
[[nodiscard]] auto textures_of(const Made& made, const std::vector<std::filesystem::path>& meshes,
                               const pipeline::Options& options, const base::Run& run, Progress& progress)
    -> base::Result<texture::Baked>;
/// The same with the textures; both must outlive it.
[[nodiscard]] auto with_textures(const Made& made, const texture::PutAside& textures) -> Made;

/// run.json, there after Outputs::commit.
[[nodiscard]] auto write_report(const Made& made, const model::Scene& scene, const std::filesystem::path& path,
                                base::Outputs& outputs) -> base::Result<void>;

}  // namespace mansard::cli
