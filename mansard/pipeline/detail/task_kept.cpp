#include "mansard/pipeline/detail/task_kept.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mansard/base/pack.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/pipeline/detail/block_kept.hpp"
#include "mansard/pipeline/detail/place.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

/// What is to be added to local coordinates for those of a frame that begins at whole multiples of 65,536 m, so that a
/// city that grows keeps it: a scene's own frame begins in the middle of all footprints. Coordinates stay small enough
/// for the digits that a plan has.
auto to_kept(const model::Frame& frame) -> Point3 {
  constexpr unsigned bits = 16;
  const auto along = [&](std::size_t axis) {
    const std::int64_t half = std::int64_t{1} << (bits - 1);
    return static_cast<double>(frame.origin[axis] - ((frame.origin[axis] + half) >> bits << bits));
  };
  return {along(0), along(1), 0};
}

void move_all(std::vector<Finished>& features, Point3 by) {
  for (auto& [building, report] : features) {
    for (auto& part : building.parts) {
      move(part.plan, by);
      move(part.model.solid, by);
    }
    for (auto& solid : building.solids) move(solid.model.solid, by);
  }
}

/// Everything of a feature that its model may depend on. Blocks begin with coordinates that are rounded like this.
void pack_feature(model::Footprint footprint, Point2 by, std::string& out) {
  const auto move = [&](std::vector<geometry::Polygon>& polygons) {
    for (auto& polygon : polygons)
      geometry::change_corners(polygon, [&](Point2 p) {
        return Point2{model::rounded(p.x), model::rounded(p.y)} + by;
      });
  };
  move(footprint.polygons);
  for (auto& part : footprint.parts) move(part.polygons);
  base::pack(footprint, out);
}

/// The cells between which the ground is looked up in a box, and where they are.
void pack_ground(const model::HeightGrid& terrain, const geometry::Box2& box, Point2 by, std::string& out) {
  const auto range = [&](double least, double most, double centre, std::size_t count) {
    const auto cell = [&](double at, double more) {
      const double number = std::floor((at - centre) / terrain.cell) + more;
      return static_cast<std::size_t>(std::clamp(number, 0.0, static_cast<double>(count)));
    };
    return std::pair(cell(least, -1), cell(most, 3));
  };
  const auto [left, right] = range(box.least.x, box.most.x, terrain.centre.x, terrain.columns);
  const auto [low, high] = range(box.least.y, box.most.y, terrain.centre.y, terrain.rows);
  const auto at = [&](double centre, std::size_t number) {
    return model::rounded(centre + terrain.cell * static_cast<double>(number));
  };
  base::pack(at(terrain.centre.x, left) + by.x, out);
  base::pack(at(terrain.centre.y, low) + by.y, out);
  base::pack(terrain.cell, out);
  base::pack(terrain.base, out);
  for (std::size_t row = low; row < high; ++row)
    for (std::size_t column = left; column < right; ++column)
      base::pack(terrain.values[row * terrain.columns + column], out);
}

/// The reasons of KeptBlocks::why_made, for what has no mesh.
auto why_in_words(const std::string& why) -> std::string { return why == "mesh" ? "terrain" : why; }

}  // namespace

auto key_of_footprints(const Options& options) -> BlockKey {
  // What is read shows in the features; how it is written does not matter to them.
  return {program_hash(),
          formats::sha256(options_but(options, {"ingest", "cloud", "derive", "write", "texture", "terrain"}) +
                          "footprints"),
          {},
          {}};
}

auto key_of(const Task& task, const Part& part, BlockKey shared) -> BlockKey {
  const auto& scene = part.scene;
  const auto by = to_kept(scene.frame);
  std::string footprints;
  base::pack(scene.frame.origin[2], footprints);
  base::pack(scene.footprints.size(), footprints);
  for (std::size_t f = 0; f < part.features.size(); ++f) pack_feature(scene.feature(f), xy(by), footprints);
  std::string ground;
  if (scene.terrain != nullptr)
    for (const auto* group : task.groups) pack_ground(*scene.terrain, group->reach, xy(by), ground);
  shared.footprints = formats::sha256(footprints);
  shared.mesh = formats::sha256(ground);
  return shared;
}

auto bytes_of(std::vector<Finished>& features, const model::Frame& frame) -> std::string {
  const auto by = to_kept(frame);
  std::string out;
  move_all(features, by);
  base::pack(features.size(), out);  // a vector of them
  for (auto& one : features) {
    auto footprint = std::exchange(one.building.footprint, {});
    base::pack(one, out);
    one.building.footprint = std::move(footprint);
  }
  move_all(features, -1 * by);
  return out;
}

auto features_of(std::string_view bytes, const Part& part) -> std::optional<std::vector<Finished>> {
  const auto& footprints = part.scene.footprints;
  std::vector<Finished> out;
  base::Unpacker from(bytes);
  if (!from.take(out) || !from.done() || out.size() != footprints.size()) return std::nullopt;
  move_all(out, -1 * to_kept(part.scene.frame));
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].building.id != footprints[i].id) return std::nullopt;
    out[i].building.footprint = footprints[i].polygons;
  }
  return out;
}

TaskKeeper::TaskKeeper(const Options& options, const Schedule& schedule, const std::vector<Task>& tasks,
                       std::size_t footprints)
    : tally_(schedule.tally) {
  if (tally_ != nullptr) {
    std::size_t groups = 0;
    for (const auto& task : tasks) groups += task.groups.size();
    tally_->buildings = footprints;
    tally_->blocks = groups;
  }
  if (tasks.size() <= 1) return;
  kept_ = schedule.kept;
  shared_ = key_of_footprints(options);
}

auto TaskKeeper::find(const Task& task, const Part& part) -> std::optional<std::vector<Finished>> {
  taken_over_ = false;
  if (kept_ == nullptr) return std::nullopt;
  key_ = key_of(task, part, shared_);
  keys_.emplace(task.name, key_);
  if (const auto bytes = kept_->find(key_))
    if (auto features = features_of(*bytes, part)) {
      ++reuse_.blocks;
      taken_over_ = true;
      return features;
    }
  if (const auto why = kept_->why_made(task.name, key_); !why.empty())
    reuse_.made.emplace_back(task.name, why_in_words(why));
  return std::nullopt;
}

auto TaskKeeper::keep(std::vector<Finished>& features, const model::Frame& frame) -> base::Result<void> {
  if (kept_ == nullptr) return {};
  return kept_->keep(key_, bytes_of(features, frame));
}

void TaskKeeper::count(const Task& task, std::size_t footprints) {
  if (tally_ == nullptr) return;
  tally_->blocks_done += task.groups.size();
  tally_->buildings_done += footprints;
  if (!taken_over_) return;
  tally_->blocks_kept += task.groups.size();
  tally_->buildings_kept += footprints;
}

auto TaskKeeper::finish() -> base::Result<report::Reuse> {
  if (kept_ != nullptr)
    if (auto settled = kept_->settle(keys_); !settled) return settled.failure();
  std::ranges::sort(reuse_.made);
  return std::move(reuse_);
}

}  // namespace mansard::pipeline::detail
