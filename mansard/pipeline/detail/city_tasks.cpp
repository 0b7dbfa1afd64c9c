#include "mansard/pipeline/detail/city_tasks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "mansard/geometry/curve.hpp"
#include "mansard/model/frame.hpp"
#include "mansard/pipeline/detail/every_block.hpp"

namespace mansard::pipeline::detail {

namespace {

/// A group's place along the curve. Rounded like the blocks' coordinates, so that the frame does not matter.
auto place_of(const block::Group& group, const model::Frame& frame) -> std::uint64_t {
  const auto metres = [](double local, std::int64_t origin) {
    return static_cast<std::int64_t>(std::floor(model::rounded(local))) + origin;
  };
  return geometry::along_curve(metres(group.box.least.x, frame.origin[0]), metres(group.box.least.y, frame.origin[1]));
}

/// The cell of all places whose bits from `free_bits` on are those of `place`.
auto cell_name(std::uint64_t place, unsigned free_bits) -> std::string {
  if (free_bits >= 64) return "all";
  const auto corner = geometry::from_curve(place >> free_bits << free_bits);
  const auto side = [](unsigned bits) { return std::to_string(std::uint64_t{1} << bits); };
  return std::to_string(corner[0]) + "," + std::to_string(corner[1]) + " " + side((free_bits + 1) / 2) + "x" +
         side(free_bits / 2);
}

/// Halves what is too much for one task.
struct Halving {
  std::span<const block::Group* const> groups;
  std::vector<std::uint64_t> places;  ///< of the groups, rising
  std::vector<std::size_t> before;    ///< features of all groups before each, and of all
  std::size_t most_features;
  std::vector<Task> out{};
  std::string last_name{};
  std::size_t of_that_name = 0;

  /// Several tasks of one cell have names of their own.
  void add(std::size_t first, std::size_t last, std::string name) {
    of_that_name = name == last_name ? of_that_name + 1 : 1;
    last_name = name;
    if (of_that_name > 1) name += " (" + std::to_string(of_that_name) + ")";
    out.push_back({groups.subspan(first, last - first), std::move(name)});
  }

  void halve(std::size_t first, std::size_t last, unsigned free_bits) {
    if (last - first == 1 || before[last] - before[first] <= most_features) {
      add(first, last, cell_name(places[first], free_bits));
      return;
    }
    const auto differing = static_cast<unsigned>(std::bit_width(places[first] ^ places[last - 1]));
    if (differing == 0) {  // all in one square metre, as stacked features are
      const std::size_t middle = first + (last - first) / 2;
      halve(first, middle, 0);
      halve(middle, last, 0);
      return;
    }
    const auto begin = places.begin() + static_cast<std::ptrdiff_t>(first);
    const auto upper = std::partition_point(begin, places.begin() + static_cast<std::ptrdiff_t>(last),
                                            [&](std::uint64_t p) { return (p >> (differing - 1) & 1U) == 0; });
    const auto middle = static_cast<std::size_t>(upper - places.begin());
    halve(first, middle, differing - 1);
    halve(middle, last, differing - 1);
  }
};

}  // namespace

auto by_place(const std::vector<block::Group>& groups, const model::Frame& frame) -> std::vector<const block::Group*> {
  std::vector<const block::Group*> out;
  for (const auto& group : groups) out.push_back(&group);
  std::ranges::stable_sort(out, {}, [&](const block::Group* group) { return place_of(*group, frame); });
  return out;
}

auto in_tasks(std::span<const block::Group* const> groups, std::size_t most_features, const model::Frame& frame)
    -> std::vector<Task> {
  if (groups.empty()) return {};
  Halving halving{groups, {}, {0}, most_features};
  for (const auto* group : groups) {
    halving.places.push_back(place_of(*group, frame));
    halving.before.push_back(halving.before.back() + group->features.size());
  }
  halving.halve(0, groups.size(), 64);
  return std::move(halving.out);
}

auto index_of(const model::Scene& scene) -> geometry::BoxIndex {
  std::vector<geometry::Box2> boxes;
  boxes.reserve(scene.footprints.size() + scene.surroundings.size());
  for (std::size_t f = 0; f < scene.footprints.size() + scene.surroundings.size(); ++f)
    boxes.push_back(geometry::bounds(scene.feature(f).polygons));
  return geometry::BoxIndex(boxes);
}

auto part_of(const model::Scene& scene, std::span<const block::Group* const> groups, const geometry::BoxIndex& index,
             bool attributes_around) -> Part {
  Part out;
  out.scene.frame = scene.frame;
  out.scene.terrain = scene.terrain;
  out.scene.roofs_only = scene.roofs_only;
  // Group by group: the box of several may span the city where the order by place jumps.
  std::vector<std::size_t> own, near;
  for (const auto* group : groups) {
    own.insert(own.end(), group->features.begin(), group->features.end());
    const auto found = index.overlapping(group->reach);
    near.insert(near.end(), found.begin(), found.end());
  }
  std::ranges::sort(own);
  std::ranges::sort(near);
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (const std::size_t f : own) {
    if (f >= scene.footprints.size()) continue;
    out.features.push_back(f);
    out.scene.footprints.push_back(scene.footprints[f]);
  }
  for (const std::size_t f : near) {
    if (f < scene.footprints.size() && std::ranges::binary_search(own, f)) continue;
    const auto& feature = scene.feature(f);
    model::Footprint shape;
    shape.id = feature.id;
    shape.polygons = feature.polygons;
    shape.defect = feature.defect;
    if (attributes_around) {
      shape.attributes = feature.attributes;
      shape.parts = feature.parts;
    }
    out.features.push_back(f);
    out.scene.surroundings.push_back(std::move(shape));
  }
  return out;
}

}  // namespace mansard::pipeline::detail
