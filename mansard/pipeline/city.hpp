// A city of any size: what is made of it is put aside building by building, and read back in the source's order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline {

namespace detail {
class CityBuilder;
}

/// What is put aside beside the models.
enum class Aside : std::uint8_t { models, models_and_error_maps };

/// Everything of a report::Reconstruction but the segmentations, and the error maps where they are asked for. Its
/// buildings are in a file without a name in the folder for temporary files (TMPDIR), so that memory holds only what is
/// listed here, and what is needed to see solids that overlap: about 8 kB a building.
class PutAside {
 public:
  model::Frame frame;
  model::MadeBy made_by;
  report::Summary summary;
  report::Outcomes outcomes;
  std::size_t tasks = 0;  ///< those that were kept, or taken over from an earlier run; 0 where blocks were

  [[nodiscard]] auto size() const -> std::size_t { return places_.size(); }
  using Visit = std::function<base::Result<void>(model::Building, report::BuildingReport)>;
  /// Every input feature, in the source's order; ends with the first failure of `visit`. Fails with "file-write" where
  /// something could not be put aside.
  [[nodiscard]] auto each(const Visit& visit) const -> base::Result<void>;
  /// The error map of every block, in the order of summary.blocks; none with Aside::models. Fails as `each`.
  [[nodiscard]] auto each_error_map(const std::function<void(const evaluate::ErrorMap&)>& visit) const
      -> base::Result<void>;

 private:
  friend class detail::CityBuilder;
  struct Place {
    std::uint64_t offset = 0;
    std::uint32_t bytes = 0;
  };
  std::unique_ptr<base::Spool> spool_;
  std::vector<Place> places_;                                        ///< by feature
  std::vector<Place> error_maps_;                                    ///< by block
  std::map<std::size_t, std::vector<base::Diagnostic>> afterwards_;  ///< reasons that were found when all was made
};

/// As reconstruct, in memory that does not grow with the models, nor, where it is in cells, with the mesh. Fails as
/// that does.
[[nodiscard]] auto reconstruct_aside(const ingest::CityScene& city, const Options& options, const base::Run& run = {},
                                     const Schedule& schedule = {}, Aside aside = Aside::models)
    -> base::Result<PutAside>;

/// As raise_footprints, in memory that does not grow with the models. What `schedule` keeps are tasks, of at most
/// `ingest.task_footprints` footprints; nothing where all is one task. Fails as that does, and as KeptBlocks does.
[[nodiscard]] auto raise_footprints_aside(const model::Scene& scene, const Options& options, const base::Run& run = {},
                                          const Schedule& schedule = {}) -> base::Result<PutAside>;

/// One of `shares` of the work: makes the blocks of share number `share`, from 0, and keeps them, so that a
/// reconstruction with the same blocks kept finds them made. The shares are of about the same number of triangles, and
/// of blocks that are near each other. Fails as reconstruct does; `schedule.kept` must be there.
[[nodiscard]] auto make_share(const ingest::CityScene& city, const Options& options, const base::Run& run, Keep keep,
                              const Schedule& schedule, std::size_t share, std::size_t shares) -> base::Result<void>;

}  // namespace mansard::pipeline
