#include "mansard/pipeline/detail/scan_sample.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <set>

#include "mansard/base/statistics.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/geometry/mesh_part.hpp"
#include "mansard/pipeline/detail/city_tasks.hpp"

namespace mansard::pipeline::detail {
namespace {

using block::GroundSource;
using geometry::Box2;
using geometry::Point2;
using geometry::Polygon;

constexpr std::size_t most_blocks = 48;
constexpr double most_ground = 150'000;  // m²; of the scan that is looked at
constexpr double around = 25;            // m; beyond the ring in which the ground is looked for

auto area_of(const Box2& box) -> double { return (box.most.x - box.least.x) * (box.most.y - box.least.y); }

/// Of groups by place, some that are spread evenly and take no more ground than is looked at; at least one.
auto spread(const std::vector<const block::Group*>& groups, double reach) -> std::vector<const block::Group*> {
  double all = 0;
  for (const auto* group : groups) all += area_of(group->box.grown(reach));
  const auto count = static_cast<double>(groups.size());
  const double every = std::max({1.0, count / static_cast<double>(most_blocks), std::ceil(all / most_ground)});
  std::vector<const block::Group*> out;
  double ground = 0;
  for (double at = std::floor(every / 2); at < count; at += every) {
    const auto* group = groups[static_cast<std::size_t>(at)];
    const double own = area_of(group->box.grown(reach));
    if (!out.empty() && ground + own > most_ground) continue;
    ground += own;
    out.push_back(group);
  }
  return out;
}

/// The scene's mesh in each box.
auto meshes_in(const model::Scene& scene, const ingest::MeshCells* cells, const std::vector<Box2>& boxes)
    -> base::Result<std::vector<geometry::Mesh>> {
  std::vector<geometry::Mesh> out(boxes.size());
  if (cells == nullptr) {
    const auto triangles = geometry::triangles_near(scene.mesh, boxes);
    const auto points = geometry::points_near(scene.mesh.points, boxes);
    base::parallel_for(boxes.size(), [&](std::size_t i) {
      out[i] = geometry::part_of(scene.mesh, triangles[i]);
      for (const auto p : points[i]) out[i].points.push_back(scene.mesh.points[p]);
    });
    return out;
  }
  std::mutex mutex;
  std::optional<base::Failure> failure;
  base::parallel_for(boxes.size(), [&](std::size_t i) {
    const auto near = cells->cells_in(boxes[i]);
    auto mesh = cells->load({near.begin(), near.end()});
    if (!mesh) {
      const std::scoped_lock lock(mutex);
      failure = mesh.failure();
      return;
    }
    const std::vector box{boxes[i]};
    const auto triangles = geometry::triangles_near(*mesh, box);
    const auto points = geometry::points_near(mesh->points, box);  // named: it must outlive the loop
    out[i] = geometry::part_of(*mesh, triangles.front());
    for (const auto p : points.front()) out[i].points.push_back(mesh->points[p]);
  });
  if (failure) return *failure;
  return out;
}

/// Places in a polygon, about so many, evenly and not beside its outline where it is wide enough.
auto places_in(const Polygon& polygon, double many) -> std::vector<Point2> {
  constexpr double beside = 0.75;  // m; beyond what a scan rounds
  const auto box = geometry::bounds(polygon.outer);
  const double apart = std::max(0.5, std::sqrt(geometry::area(polygon) / many));
  std::vector<Point2> inside, deep;
  for (double y = std::floor(box.least.y) + apart / 2; y < box.most.y; y += apart)
    for (double x = std::floor(box.least.x) + apart / 2; x < box.most.x; x += apart)
      if (const Point2 at{x, y}; geometry::contains(polygon, at)) {
        inside.push_back(at);
        if (geometry::boundary_distance(polygon, at) > beside) deep.push_back(at);
      }
  return deep.empty() ? inside : deep;
}

/// Whether the scan lacks ground beside the outlines, too: at a quarter of the places or more.
auto ends_beside(const std::vector<Polygon>& polygons, const std::vector<Polygon>& outline, const rays::Scene& rays)
    -> bool {
  constexpr double outside = 2, apart = 2, share = 0.25;
  double all = 0, none = 0;
  for (const auto& polygon : polygons)
    for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
      const Point2 a = polygon.outer[i], along = polygon.outer[(i + 1) % polygon.outer.size()] - a;
      const double far = length(along), count = std::ceil(far / apart);
      const Point2 outward = -1.0 * geometry::left_of(normalised(along));
      for (double k = 0; k < count; ++k) {
        const Point2 at = a + ((k + 0.5) / count) * along + outside * outward;
        if (geometry::contains(std::span(outline), at)) continue;
        ++all;
        if (!rays.top(at)) ++none;
      }
    }
  return all > 0 && none >= share * all;
}

/// `features`: the scene's numbers by those of the block.
auto sampled(const block::OwnFrame& own, const std::vector<std::size_t>& features, const model::Scene& scene)
    -> SampledBlock {
  constexpr double most_places = 36;
  SampledBlock out;
  out.origin = own.block.origin;
  out.mesh = own.block.mesh;
  out.rays = std::make_unique<rays::Scene>(out.mesh);
  out.outline = own.block.outline;
  const double lowest = geometry::Box3::of(out.mesh.vertices).least.z;
  for (const auto& member : own.block.members) {
    SampledFootprint one;
    one.feature = features[own.features[member.feature]];
    if (one.feature >= scene.footprints.size()) continue;
    one.ground = member.ground_source;
    std::vector<double> heights;
    double places = 0;
    for (const auto& polygon : member.polygons) {
      one.area += geometry::area(polygon);
      for (const auto at : places_in(polygon, most_places)) {
        ++places;
        if (const auto z = out.rays->top(at)) heights.push_back(*z);
      }
    }
    if (places == 0) continue;
    one.covered = static_cast<double>(heights.size()) / places;
    if (one.covered < 1) one.at_end = ends_beside(member.polygons, out.outline, *out.rays);
    const bool known = one.ground == GroundSource::attribute || one.ground == GroundSource::terrain ||
                       one.ground == GroundSource::scan || one.ground == GroundSource::neighbours;
    if (!heights.empty()) {
      const double middle = base::median(std::move(heights));
      one.above_lowest = middle - lowest;
      if (known) one.height = middle - member.ground;
    }
    out.footprints.push_back(one);
  }
  return out;
}

}  // namespace

auto sample_scan(const model::Scene& scene, const ingest::MeshCells* cells, const Options& options,
                 const base::Run& run) -> base::Result<ScanSample> {
  auto wide = options.block;
  wide.padding = std::max(wide.padding, accuracy::most_displaced + 2);
  const double reach = std::max({around, wide.padding, wide.ground_ring});
  ScanSample out;
  for (const auto& footprint : scene.footprints) out.all += footprint.defect ? 0 : 1;
  const auto groups = block::groups(scene, wide);
  const auto chosen = spread(by_place(groups, scene.frame), reach);
  if (chosen.empty()) return out;
  out.blocks.resize(chosen.size());
  const auto finish = [&]() -> base::Result<ScanSample> {
    if (run.cancelled()) return base::stopped();
    std::erase_if(out.blocks, [](const SampledBlock& block) { return block.rays == nullptr; });
    for (const auto& block : out.blocks) out.footprints += block.footprints.size();
    return std::move(out);
  };
  if (cells == nullptr && chosen.size() == groups.size()) {  // all of it: nothing to take out
    std::vector<std::size_t> features(scene.footprints.size() + scene.surroundings.size());
    std::iota(features.begin(), features.end(), std::size_t{0});
    const block::Partition partition(scene, wide, run);
    base::parallel_for(partition.size(), [&](std::size_t i) {
      if (!run.cancelled()) out.blocks[i] = sampled(block::in_own_frame(partition.make(i)), features, scene);
    });
    // In the order by place, as those that are taken out.
    std::map<std::size_t, std::size_t> place;
    for (std::size_t i = 0; i < chosen.size(); ++i) place[chosen[i]->features.front()] = i;
    std::vector<SampledBlock> sorted(chosen.size());
    for (std::size_t i = 0; i < partition.size(); ++i)
      sorted[place.at(partition.outlined(i).members.front().feature)] = std::move(out.blocks[i]);
    out.blocks = std::move(sorted);
    return finish();
  }
  std::vector<Box2> boxes;
  for (const auto* group : chosen) boxes.push_back(group->box.grown(reach));
  auto meshes = meshes_in(scene, cells, boxes);
  if (!meshes) return meshes.failure();
  const auto index = index_of(scene);
  base::parallel_for(chosen.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    auto part = part_of(scene, std::span(chosen).subspan(i, 1), index, false);
    part.scene.mesh = std::move((*meshes)[i]);
    const block::Partition partition(part.scene, wide);
    if (partition.size() == 0) return;
    out.blocks[i] = sampled(block::in_own_frame(partition.make(0)), part.features, scene);
  });
  return finish();
}

}  // namespace mansard::pipeline::detail
