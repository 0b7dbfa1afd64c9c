// What the stages see of a block: its mesh without the crowns of trees.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/geometry/mesh_part.hpp"
#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline::detail {

class Shown {
 public:
  Shown(const block::Block& block, const vegetation::Found& crowns)
      : mesh_(block.mesh, crowns.below), whole_block_(block) {
    if (crowns.below.empty()) return;
    cleared_ = block;
    cleared_->mesh = geometry::without(block.mesh, crowns.triangles);
    whole_.emplace(block.mesh);
  }
  Shown(const Shown&) = delete;
  auto operator=(const Shown&) -> Shown& = delete;

  /// With the walls below crowns, for slices.
  [[nodiscard]] auto block() const -> const block::Block& { return cleared_ ? *cleared_ : whole_block_; }
  /// Seen from above: nothing where a crown is, also not the large triangles of a coarse mesh that reach below it.
  [[nodiscard]] auto mesh() const -> const rays::Scene& { return mesh_; }
  /// As it was scanned.
  [[nodiscard]] auto whole() const -> const rays::Scene& { return whole_ ? *whole_ : mesh_; }
  /// The same; null where there are no crowns.
  [[nodiscard]] auto above() const -> const rays::Scene* { return whole_ ? &*whole_ : nullptr; }

 private:
  rays::Scene mesh_;
  const block::Block& whole_block_;
  std::optional<block::Block> cleared_;
  std::optional<rays::Scene> whole_;
};

/// Of the scan over the block, without the crowns of trees.
[[nodiscard]] inline auto accuracy_of(const block::Block& block, const Shown& shown, const Options& options)
    -> model::Accuracy {
  return accuracy::measure(shown.block().mesh, shown.mesh(), block.outline, options.accuracy);
}

/// Finds the crowns over the block, and says so among the warnings.
[[nodiscard]] inline auto crowns_over(const block::Block& block, const Options& options, const base::Run& run,
                                      const Tell& tell, report::BlockReport& report,
                                      std::vector<base::Diagnostic>& warnings) -> vegetation::Found {
  std::vector<std::vector<geometry::Polygon>> footprints;
  for (const auto& member : block.members) footprints.push_back(member.polygons);
  auto found = stage("vegetation", tell, report,
                     [&] { return vegetation::find(block.mesh, block.outline, footprints, options.vegetation, run); });
  double inside = 0;
  for (const auto& crown : found.crowns) inside += crown.inside;
  if (!found.crowns.empty())
    warnings.push_back(base::warning(
        "vegetation-crowns",
        base::to_text(inside, 1) + " m² of the footprints are below " + std::to_string(found.crowns.size()) +
            (found.crowns.size() == 1 ? " tree crown, which does" : " tree crowns, which do") +
            " not count as evidence of roofs",
        block.name));
  return found;
}

}  // namespace mansard::pipeline::detail
