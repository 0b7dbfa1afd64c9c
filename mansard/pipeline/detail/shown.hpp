// What the stages see of a block: its mesh without the crowns of trees.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mansard/geometry/mesh_part.hpp"
#include "mansard/pipeline/detail/block_run.hpp"
#include "mansard/vegetation/law.hpp"

namespace mansard::pipeline::detail {

class Shown {
 public:
  /// `whole` is of the block's mesh.
  Shown(const block::Block& block, rays::Scene whole, const vegetation::Found& crowns) : whole_block_(block) {
    if (crowns.below.empty()) {
      mesh_.emplace(std::move(whole));
      return;
    }
    mesh_.emplace(block.mesh, crowns.below);
    cleared_ = block;
    cleared_->mesh = geometry::without(block.mesh, crowns.triangles);
    whole_.emplace(std::move(whole));
  }
  Shown(const Shown&) = delete;
  auto operator=(const Shown&) -> Shown& = delete;

  /// Vertices are the points of its scenes from now on.
  void take_vertices_as_points() {
    mesh_->take_vertices_as_points();
    if (whole_) whole_->take_vertices_as_points();
  }

  /// With the walls below crowns, for slices.
  [[nodiscard]] auto block() const -> const block::Block& { return cleared_ ? *cleared_ : whole_block_; }
  /// Seen from above: nothing where a crown is, also not the large triangles of a coarse mesh that reach below it.
  [[nodiscard]] auto mesh() const -> const rays::Scene& { return *mesh_; }
  /// As it was scanned.
  [[nodiscard]] auto whole() const -> const rays::Scene& { return whole_ ? *whole_ : *mesh_; }
  /// The same; null where there are no crowns.
  [[nodiscard]] auto above() const -> const rays::Scene* { return whole_ ? &*whole_ : nullptr; }

 private:
  const block::Block& whole_block_;
  std::optional<block::Block> cleared_;
  std::optional<rays::Scene> mesh_, whole_;
};

/// Finds the crowns over the block, and says so among the warnings.
[[nodiscard]] inline auto crowns_over(const block::Block& block, const Options& options, const base::Run& run,
                                      const Tell& tell, report::BlockReport& report,
                                      std::vector<base::Diagnostic>& warnings) -> vegetation::Found {
  std::vector<std::vector<geometry::Polygon>> footprints;
  for (const auto& member : block.members) footprints.push_back(member.polygons);
  auto found = stage("vegetation", tell, report, [&] {
    return vegetation::find(block.mesh, block.outline, footprints,
                            vegetation::decided_by(options.vegetation, report.accuracy), run);
  });
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

/// Measures the scan over the block, finds crowns by its noise, and measures without them what is seen along the
/// outline.
[[nodiscard]] inline auto shown_of(const block::Block& block, const Options& options, const base::Run& run,
                                   const Tell& tell, report::BlockReport& report,
                                   std::vector<base::Diagnostic>& warnings) -> std::unique_ptr<const Shown> {
  rays::Scene whole(block.mesh);
  report.accuracy = stage("accuracy", tell, report,
                          [&] { return accuracy::measure_noise(block.mesh, block.outline, options.accuracy); });
  const auto crowns = crowns_over(block, options, run, tell, report, warnings);
  auto shown = std::make_unique<Shown>(block, std::move(whole), crowns);
  report.accuracy = stage("accuracy", tell, report, [&] {
    return accuracy::with_edges(report.accuracy, shown->block().mesh, shown->mesh(), block.outline, options.accuracy);
  });
  if (report.accuracy.point_area > 0 && block.mesh.points.empty()) shown->take_vertices_as_points();
  return shown;
}

}  // namespace mansard::pipeline::detail
