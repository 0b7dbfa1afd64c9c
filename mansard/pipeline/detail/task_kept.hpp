// Tasks of footprints without a mesh as they are kept: what block_kept.hpp is to blocks. A block without a mesh takes a
// millisecond, less than a file of its own would.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/city_tasks.hpp"
#include "mansard/pipeline/kept.hpp"

namespace mansard::pipeline::detail {

/// The part of a task's key that all tasks of a run share.
[[nodiscard]] auto key_of_footprints(const Options& options) -> BlockKey;
/// The whole key: also the features of the task, what is around them, and the terrain below. The same for every frame
/// that begins at whole metres.
[[nodiscard]] auto key_of(const Task& task, const Part& part, BlockKey shared) -> BlockKey;

/// The features of the task as they are kept: in a frame that stays the same where a city grows, and without what the
/// part has of them. Takes them back as they were.
[[nodiscard]] auto bytes_of(std::vector<Finished>& features, const model::Frame& frame) -> std::string;
/// None where the bytes are of something else.
[[nodiscard]] auto features_of(std::string_view bytes, const Part& part) -> std::optional<std::vector<Finished>>;

/// The tasks of one run, one after the other: as they were kept, or else made and kept.
class TaskKeeper {
 public:
  /// Keeps nothing, and takes nothing over, where all is one task: it would be lost as a whole all the same.
  TaskKeeper(const Options& options, const Schedule& schedule, const std::vector<Task>& tasks, std::size_t footprints);

  /// As it was kept; none where it has to be made.
  [[nodiscard]] auto find(const Task& task, const Part& part) -> std::optional<std::vector<Finished>>;
  /// The features of the task that `find` did not find. Fails with "file-write".
  [[nodiscard]] auto keep(std::vector<Finished>& features, const model::Frame& frame) -> base::Result<void>;
  /// After each task.
  void count(const Task& task, std::size_t footprints);
  [[nodiscard]] auto keeps() const -> bool { return kept_ != nullptr; }
  /// After the last one. Fails with "file-write".
  [[nodiscard]] auto finish() -> base::Result<report::Reuse>;

 private:
  KeptBlocks* kept_ = nullptr;
  Tally* tally_ = nullptr;
  BlockKey shared_, key_;
  bool taken_over_ = false;  ///< the last one that was asked for
  std::map<std::string, BlockKey> keys_;
  report::Reuse reuse_;
};

}  // namespace mansard::pipeline::detail
