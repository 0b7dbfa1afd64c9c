// Solids of a file, compared with each other as those of a run are.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/model/city.hpp"

namespace mansard::pipeline {

/// Takes buildings one after the other, and puts the ground of their solids aside on disk. Guarantee: what it finds is
/// what a run says of the same solids. Memory: 64 bytes for each solid. Cost: O(n log n) for n solids.
class ComparedSolids {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open() -> base::Result<ComparedSolids>;
  ComparedSolids(ComparedSolids&&) noexcept;
  auto operator=(ComparedSolids&&) noexcept -> ComparedSolids&;
  ~ComparedSolids();

  /// Its solids, or those of its parts where it has none.
  void add(const model::Building& building);

  struct Overlapping {
    std::vector<base::Diagnostic> of_each;  ///< "pipeline-overlap" of a solid, which is the subject
    std::vector<base::Diagnostic> in_all;   ///< the number of pairs and the largest; "pipeline-overlap-unchecked"
  };
  /// After the last one. Fails with "file-write", "cancelled".
  [[nodiscard]] auto overlapping(const base::Run& run) -> base::Result<Overlapping>;

 private:
  struct Kept;
  explicit ComparedSolids(std::unique_ptr<Kept> kept);
  std::unique_ptr<Kept> kept_;
};

}  // namespace mansard::pipeline
