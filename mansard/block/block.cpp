// The steps of a partition: footprints that touch, their outline, their ground, their piece of the mesh.
#include "mansard/block/block.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>
#include <tuple>

#include "mansard/base/statistics.hpp"
#include "mansard/block/detail/ground.hpp"
#include "mansard/block/detail/near.hpp"
#include "mansard/block/detail/neighbours.hpp"
#include "mansard/block/detail/walls.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/geometry/mesh_part.hpp"

namespace mansard::block {
namespace {

using detail::Polygons;
using geometry::Point2;
using geometry::Point3;

auto as_point(const std::array<std::int64_t, 3>& origin) -> Point3 {
  return {static_cast<double>(origin[0]), static_cast<double>(origin[1]), static_cast<double>(origin[2])};
}

void shift(Polygons& polygons, Point2 by) {
  for (auto& polygon : polygons) geometry::move(polygon, by);
}

auto shifted(Polygons polygons, Point2 by) -> Polygons {
  shift(polygons, by);
  return polygons;
}

/// The order of shapes by their coordinates: one that no file decides.
auto before(const Polygons& a, const Polygons& b) -> bool {
  const auto box_a = geometry::bounds(a), box_b = geometry::bounds(b);
  if (box_a.least != box_b.least) return box_a.least < box_b.least;
  return std::ranges::lexicographical_compare(
      a, b, [](const auto& p, const auto& q) { return std::tie(p.outer, p.holes) < std::tie(q.outer, q.holes); });
}

auto rounded(Point2 p) -> Point2 { return {model::rounded(p.x), model::rounded(p.y)}; }
auto rounded(Point3 p) -> Point3 { return {model::rounded(p.x), model::rounded(p.y), model::rounded(p.z)}; }

void round_all(Polygons& polygons) {
  for (auto& polygon : polygons) geometry::change_corners(polygon, [](Point2 p) { return rounded(p); });
}

/// The vertices that some triangles use, each once, and where each is among them. A table by their last digits
/// (D. E. Knuth, The Art of Computer Programming 3, 6.4, linear probing): a mesh has the vertices of a place anywhere.
class Places {
 public:
  Places(const geometry::Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
    // A surface has half as many vertices as triangles, one in pieces three for each: at most three quarters are full.
    table_.assign(std::bit_ceil(4 * triangles.size() + 2), nobody);
    for (const auto t : triangles)
      for (const auto v : mesh.triangles[t]) {
        auto& place = table_[slot(v)];
        if (place != nobody) continue;
        place = static_cast<std::uint32_t>(used_.size());
        used_.push_back(v);
      }
  }

  [[nodiscard]] auto used() const -> const std::vector<std::uint32_t>& { return used_; }
  [[nodiscard]] auto operator()(std::uint32_t vertex) const -> std::size_t { return table_[slot(vertex)]; }

 private:
  static constexpr std::uint32_t nobody = UINT32_MAX;

  /// Where a vertex is, or would be.
  [[nodiscard]] auto slot(std::uint32_t vertex) const -> std::size_t {
    std::size_t at = vertex & (table_.size() - 1);
    while (table_[at] != nobody && used_[table_[at]] != vertex) at = (at + 1) & (table_.size() - 1);
    return at;
  }

  std::vector<std::uint32_t> used_, table_;
};

/// The triangles asked for, moved by −origin and rounded, in an order that their coordinates alone decide: vertices by
/// x, y, z, every triangle from its first vertex on, triangles by their vertices. What has become one in rounding is
/// one, and triangles without three corners are gone.
auto part_of(const geometry::Mesh& mesh, const std::vector<std::uint32_t>& triangles, Point3 origin) -> geometry::Mesh {
  const Places place_of(mesh, triangles);
  struct Placed {
    Point3 at;
    std::uint32_t place = 0;
  };
  std::vector<Placed> placed;
  placed.reserve(place_of.used().size());
  for (const auto v : place_of.used())
    placed.push_back({rounded(mesh.vertices[v] - origin), static_cast<std::uint32_t>(placed.size())});
  // As points compare, but not by way of partial orders, which cost half of the time.
  std::ranges::sort(placed, [](const Placed& p, const Placed& q) {
    if (p.at.x != q.at.x) return p.at.x < q.at.x;
    return p.at.y != q.at.y ? p.at.y < q.at.y : p.at.z < q.at.z;
  });
  geometry::Mesh out;
  std::vector<std::uint32_t> rank(placed.size());
  for (const auto& [at, place] : placed) {
    if (out.vertices.empty() || out.vertices.back() != at) out.vertices.push_back(at);
    rank[place] = static_cast<std::uint32_t>(out.vertices.size() - 1);
  }
  out.triangles.reserve(triangles.size());
  for (const auto t : triangles) {
    geometry::Triangle triangle = mesh.triangles[t];
    for (auto& v : triangle) v = rank[place_of(v)];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    std::ranges::rotate(triangle, std::ranges::min_element(triangle));
    out.triangles.push_back(triangle);
  }
  std::ranges::sort(out.triangles);
  out.triangles.erase(std::unique(out.triangles.begin(), out.triangles.end()), out.triangles.end());
  return out;
}

/// Heights are rounded to this, so that the last digits of sums over samples do not reach the models. 1 mm: ground is
/// not known better.
constexpr double ground_unit = 0x1p-10;

/// All that the ground of a block is found in, in the block's frame.
struct Surroundings {
  geometry::Mesh mesh;           ///< as far as the ring around the footprints
  std::vector<Polygons> shapes;  ///< the members', then those of others nearby
};

/// Where the ground of a member is, and how that is known. Everything is in the block's frame but the terrain.
class Grounds {
 public:
  Grounds(const Block& block, const model::Scene& scene, const Surroundings& around,
          const std::vector<std::uint32_t>& within_reach, const Options& options)
      : block_(block),
        scene_(scene),
        around_(around),
        within_reach_(within_reach),
        options_(options),
        origin_(as_point(block.origin)) {
    if (!scene.roofs_only) samples_ = detail::ground_samples(around.mesh, around.shapes, block.members.size(), options);
  }

  struct Found {
    double z = 0;
    GroundSource source = GroundSource::unknown;
    std::optional<AtWalls> at_walls{};
    std::optional<double> around{};  ///< z of the ground somewhat farther off, where that is another
    [[nodiscard]] auto of_block() const -> double { return around.value_or(z); }
  };
  [[nodiscard]] auto of(std::size_t member) -> Found {
    const auto& footprint = scene_.feature(block_.members[member].feature);
    // Heights of files are above sea level, those here above the frames of scene and block.
    const auto here = [&](double z) { return z - static_cast<double>(scene_.frame.origin[2]) - origin_.z; };
    if (footprint.ground) return {here(*footprint.ground), GroundSource::attribute};
    if (scene_.terrain)
      if (const auto found = detail::terrain_at_walls(around_.shapes[member], *scene_.terrain, origin_, options_))
        return {found->lowest, GroundSource::terrain, found->walls, found->walls.mean};
    const double share = options_.ground_percentile / 100;
    if (!samples_.empty())
      if (const auto z = detail::percentile(samples_[member], share, options_.ground_area)) {
        if (const auto found = detail::terrain_at_walls(around_.shapes[member], samples_[member], options_))
          return {found->lowest, GroundSource::scan, found->walls, *z};
        return {*z, GroundSource::scan};
      }
    if (const auto z = of_neighbours()) return {*z, GroundSource::neighbours};
    if (options_.ground_height) return {here(*options_.ground_height), GroundSource::option};
    const auto low = lowest();
    // An outline may be drawn at the eaves. The ground is not above what is seen beside the building, nor near the
    // roof.
    const auto is_ground = [&](double z) {
      if (low.source == GroundSource::unknown) return true;
      return z <= (low.source == GroundSource::assumed ? low.z + options_.storey / 2 : low.z);
    };
    if (const auto& z = footprint.outline_z; z && is_ground(here(*z))) return {here(*z), GroundSource::outline};
    return low;
  }

 private:
  [[nodiscard]] auto of_neighbours() -> std::optional<double> {
    if (!neighbours_) {
      std::vector<detail::Sample> all;
      for (const auto& some : samples_) all.insert(all.end(), some.begin(), some.end());
      neighbours_ = detail::percentile(std::move(all), options_.ground_percentile / 100, options_.ground_area);
    }
    return *neighbours_;
  }

  /// The same for all members: where nothing shows the ground of any.
  [[nodiscard]] auto lowest() -> const Found& {
    if (lowest_) return *lowest_;
    const double rest = options_.ground_rest_percentile / 100;
    const auto low_of = [&](std::vector<detail::Sample> samples) {
      return detail::percentile(std::move(samples), rest, 0);
    };
    auto& found = lowest_.emplace();
    std::optional<double> z;
    if (!scene_.roofs_only) z = low_of(detail::beside_samples(block_.mesh, around_.shapes, block_.outline, options_));
    if (z) return found = {*z, GroundSource::lowest};
    if (const auto roof = low_of(detail::surface_samples(block_.mesh)))
      return found = {*roof - options_.storey, GroundSource::assumed};
    z = low_of(detail::surface_samples(around_.mesh));
    if (!z) z = low_of(detail::surface_samples(part_of(scene_.mesh, within_reach_, origin_)));
    if (z) found = {*z, GroundSource::lowest};
    return found;
  }

  const Block& block_;
  const model::Scene& scene_;
  const Surroundings& around_;
  const std::vector<std::uint32_t>& within_reach_;
  const Options& options_;
  Point3 origin_;
  std::vector<std::vector<detail::Sample>> samples_;  ///< of each member; empty where nothing can be ground
  std::optional<std::optional<double>> neighbours_;
  std::optional<Found> lowest_;
};

void set_ground(Block& block, const model::Scene& scene, const Surroundings& around,
                const std::vector<std::uint32_t>& within_reach, const Options& options) {
  std::vector<double> heights;
  Grounds grounds(block, scene, around, within_reach, options);
  for (std::size_t i = 0; i < block.members.size(); ++i) {
    const auto found = grounds.of(i);
    auto& member = block.members[i];
    member.ground_source = found.source;
    if (found.source == GroundSource::unknown) block.ground_known = false;
    else member.ground = model::rounded(found.z, ground_unit);
    member.at_walls = found.at_walls;
    // Sections are cut from the ground of the block upward: not from that at the walls of one house.
    heights.push_back(found.source == GroundSource::unknown ? member.ground
                                                            : model::rounded(found.of_block(), ground_unit));
  }
  block.ground = heights.empty() ? 0 : base::mean_median(std::move(heights));
}

/// Moves everything by whole metres.
void move(Block& block, Point3 by) {
  for (auto& member : block.members) {
    shift(member.polygons, xy(by));
    member.ground += by.z;
    if (member.at_walls) member.at_walls->mean += by.z, member.at_walls->highest += by.z;
  }
  shift(block.outline, xy(by));
  shift(block.beside, xy(by));
  for (auto* places : {&block.mesh.vertices, &block.mesh.points})
    for (Point3& v : *places) v = v + by;
  block.ground += by.z;
}

/// Characters that mean something in a path or an address become "~" and their number.
auto name_of(const std::vector<Member>& members, const model::Scene& scene) -> std::string {
  const std::string* first = nullptr;
  for (const auto& member : members) {
    const std::string& id = scene.feature(member.feature).id;
    if (first == nullptr ||
        std::pair(id.size(), std::string_view(id)) < std::pair(first->size(), std::string_view(*first)))
      first = &id;
  }
  std::string name = "block-";
  for (const char c : *first) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte >= 0x80 || std::isalnum(byte) != 0 || c == '-' || c == '_' || c == '.';
    constexpr std::string_view digits = "0123456789abcdef";
    if (plain) name += c;
    else name += {'~', digits[byte / 16], digits[byte % 16]};
  }
  return name;
}

auto round_polygons(Polygons polygons) -> Polygons {
  round_all(polygons);
  return polygons;
}

/// The footprints of a scene and its surroundings that can be used, and their boxes, rounded.
struct Boxes {
  std::vector<std::size_t> features;  ///< ascending
  std::vector<geometry::Box2> boxes;

  explicit Boxes(const model::Scene& scene) {
    for (std::size_t f = 0; f < scene.footprints.size() + scene.surroundings.size(); ++f) {
      const auto& footprint = scene.feature(f);
      if (footprint.defect || footprint.polygons.empty()) continue;
      features.push_back(f);
      boxes.push_back(geometry::bounds(round_polygons(footprint.polygons)));
    }
  }
};

/// The same with the shapes themselves.
struct Shapes : Boxes {
  std::vector<Polygons> polygons;

  explicit Shapes(const model::Scene& scene) : Boxes(scene) {
    polygons.reserve(features.size());
    for (const auto f : features) polygons.push_back(round_polygons(scene.feature(f).polygons));
  }
  [[nodiscard]] auto groups(double touch) const -> std::vector<std::vector<std::size_t>> {
    return detail::groups_of(
        boxes, [this](std::size_t i) -> const Polygons& { return polygons[i]; }, touch);
  }
};

/// Members, outline and the plan of the frame, from what was grouped.
auto outlined_block(const std::vector<std::size_t>& group, const Shapes& shapes, const model::Scene& scene,
                    const Options& options) -> Block {
  Block block;
  geometry::Box2 box;
  for (const auto m : group) {
    box.include(shapes.boxes[m]);
    block.members.push_back({shapes.features[m], shapes.polygons[m], 0});
  }
  block.name = name_of(block.members, scene);
  block.origin = {static_cast<std::int64_t>(std::floor(box.least.x)),
                  static_cast<std::int64_t>(std::floor(box.least.y)), 0};
  const Point2 to_own = -1.0 * xy(as_point(block.origin));
  std::vector<Polygons> own;
  for (auto& member : block.members) {
    shift(member.polygons, to_own);
    own.push_back(member.polygons);
  }
  std::ranges::sort(own, before);
  Polygons all;
  for (const auto& shape : own) all.insert(all.end(), shape.begin(), shape.end());
  block.outline = detail::outline_of(all, options.touch, options.gap_area, block.warnings);
  round_all(block.outline);
  return block;
}

/// The foot of its frame: whole metres, not above any of these triangles.
auto foot_of(const geometry::Mesh& mesh, const std::vector<std::uint32_t>& triangles) -> std::int64_t {
  double low = std::numeric_limits<double>::infinity();
  for (const auto t : triangles)
    for (const auto v : mesh.triangles[t]) low = std::min(low, mesh.vertices[v].z);
  return std::isfinite(low) ? static_cast<std::int64_t>(std::floor(low)) : 0;
}

/// Of the shapes near a block, those of others, in the block's frame and in an order of their own.
auto others_of(const std::vector<std::uint32_t>& near, const std::vector<std::size_t>& group, const Shapes& shapes,
               Point2 to_own) -> std::vector<Polygons> {
  std::vector<Polygons> out;
  for (const auto i : near)
    if (!std::ranges::binary_search(group, std::size_t{i})) out.push_back(shifted(shapes.polygons[i], to_own));
  std::ranges::sort(out, before);
  return out;
}

/// The boxes as a mesh of flat triangles: each its diagonal, so that geometry::triangles_near finds them too.
auto as_mesh(const std::vector<geometry::Box2>& boxes) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (const auto& box : boxes) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({box.least.x, box.least.y, 0});
    mesh.vertices.push_back({box.most.x, box.most.y, 0});
    mesh.triangles.push_back({first, first + 1, first});
  }
  return mesh;
}

/// Those of the points that are within reach of a block, moved by −origin and rounded, in order.
auto points_of(const std::vector<Point3>& points, const std::vector<std::uint32_t>& candidates, Point3 origin,
               const detail::Nearness& near) -> std::vector<Point3> {
  std::vector<Point3> out;
  for (const auto i : candidates)
    if (const Point3 p = rounded(points[i] - origin); near(xy(p))) out.push_back(p);
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

auto to_string(GroundSource source) -> std::string_view {
  switch (source) {
    case GroundSource::attribute: return "attribute";
    case GroundSource::terrain: return "terrain";
    case GroundSource::scan: return "scan";
    case GroundSource::neighbours: return "neighbours";
    case GroundSource::option: return "option";
    case GroundSource::outline: return "outline";
    case GroundSource::lowest: return "lowest";
    case GroundSource::assumed: return "assumed";
    case GroundSource::unknown: break;
  }
  return "unknown";
}

auto in_own_frame(Block block) -> OwnFrame {
  OwnFrame out;
  move(block, -1.0 * as_point(block.origin));
  std::ranges::stable_sort(block.members,
                           [](const Member& a, const Member& b) { return before(a.polygons, b.polygons); });
  for (std::size_t i = 0; i < block.members.size(); ++i) {
    out.features.push_back(block.members[i].feature);
    block.members[i].feature = i;
  }
  out.block = std::move(block);
  return out;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"block-outline", "The union of a block's footprints, or of the gaps between them, could not be computed.",
       "The outline of the block keeps its gaps, or consists of the single footprints; repair the footprints there.",
       0},
      {"block-ground-unseen", "No level ground is visible in the scan around a building, nor is there a terrain model.",
       "Its base is as high as the lowest surface beside it, which may be too high. Give a terrain model (--dtm), "
       "--ground-height, or a scan with ground.",
       0},
      {"block-ground-assumed", "Nothing shows the ground at a building: the scan has roofs only.",
       "Its base is assumed to be a storey below the lowest roof of its block, so that its height above ground and its "
       "volume are not measured. Give a terrain model (--dtm), --ground-attribute, or --ground-height.",
       0}};
}

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("block");
  list.number("touch", o.touch, "m", {0, 1}, "Footprints closer to each other than this belong to one block.")
      .source("chosen by hand; not measured");
  list.number("padding", o.padding, "m", {0, 1000}, "The mesh is kept up to this distance from the footprints.")
      .source("reference implementation chordatlas: 5 m");
  list.number("ground_ring", o.ground_ring, "m", {0, 1000},
              "Width of the ring outside the footprints in which the ground height is measured.")
      .source("chosen by hand; not measured");
  list.number("ground_percentile", o.ground_percentile, "%", {0, 100},
              "Percentile of the mesh's heights in that ring that is the ground height; low, because of trees and cars "
              "on the ground.")
      .source("chosen by hand; not measured");
  list.number("ground_area", o.ground_area, "m²", {0, 10000},
              "Minimum area of level mesh around a building for its ground height to be measured there.")
      .advanced("chosen by hand; not measured");
  list.number("ground_cosine", o.ground_cosine, "", {0, 1}, "Cosine of the maximum slope of mesh that may be ground.")
      .advanced("45°; not measured");
  list.number("ground_height", o.ground_height, "m", {-1e4, 1e5},
              "Height of the ground in the heights of the files, where neither a terrain model nor the scan shows any.")
      .alias("ground_height")
      .source("none by default");
  list.number("overhang", o.overhang, "m", {0, 100},
              "Distance around a footprint within which a level surface may be its roof, and is not taken for ground.")
      .advanced("wide eaves; not measured");
  list.number("storey", o.storey, "m", {0.5, 100},
              "Distance of an assumed ground below the lowest roof, where nothing shows the ground.")
      .advanced("the height of a storey");
  list.number("ground_piece", o.ground_piece, "m", {0.05, 100},
              "Maximum length in plan of the piece of a triangle that one sample of the ground represents.")
      .advanced("chosen by hand; not measured");
  list.number("ground_rest_percentile", o.ground_rest_percentile, "%", {0, 100},
              "Percentile of all of the mesh's heights that is the ground height where no ground is visible.")
      .advanced("chosen by hand; not measured");
  list.number("ground_reach", o.ground_reach, "m", {0, 1000},
              "Maximum distance from a block at which the mesh is still used for its ground height where there is none "
              "nearer; a block without mesh within it is refused.")
      .advanced("chosen by hand; not measured");
  list.number("terrain_step", o.terrain_step, "m", {0.05, 100},
              "Spacing along an outline at which a terrain model is sampled.")
      .advanced("chosen by hand; not measured");
  list.number("terrain_share", o.terrain_share, "", {0, 1},
              "Minimum share of an outline on which a terrain model is known for it to be used.")
      .advanced("chosen by hand; not measured");
  return list;
}

auto groups(const model::Scene& scene, const Options& options) -> std::vector<Group> {
  const Boxes shapes(scene);
  const double reach = std::max({options.padding, options.ground_ring, options.ground_reach});
  std::vector<Group> out;
  // Shapes are rounded for the pairs that come near each other: those of a city are in memory once, in the scene.
  std::array<Polygons, 2> rounded_ones;
  std::size_t turn = 0;
  const auto shape_of = [&](std::size_t i) -> const Polygons& {
    turn = 1 - turn;
    return rounded_ones[turn] = round_polygons(scene.feature(shapes.features[i]).polygons);
  };
  for (const auto& group : detail::groups_of(shapes.boxes, shape_of, options.touch)) {
    if (shapes.features[group.front()] >= scene.footprints.size()) continue;
    Group one;
    for (const auto m : group) {
      one.features.push_back(shapes.features[m]);
      one.box.include(shapes.boxes[m]);
    }
    one.reach = one.box.grown(reach + options.touch);
    out.push_back(std::move(one));
  }
  return out;
}

struct Partition::Prepared {
  const model::Scene& scene;
  Options options;
  Shapes shapes;
  std::vector<std::vector<std::size_t>> groups;
  std::vector<Block> blocks;  ///< outlined
  std::vector<std::vector<std::uint32_t>> near_by, shapes_near, within_reach, points_near;
};

Partition::Partition(Partition&&) noexcept = default;
auto Partition::operator=(Partition&&) noexcept -> Partition& = default;
Partition::~Partition() = default;

Partition::Partition(const model::Scene& scene, const Options& options, const base::Run& run)
    : prepared_(new Prepared{scene, options, Shapes(scene), {}, {}, {}, {}, {}, {}}) {
  run.report("block", "", 0);
  auto& shapes = prepared_->shapes;
  auto& groups = prepared_->groups;
  auto& near_by = prepared_->near_by;
  auto& points_near = prepared_->points_near;
  groups = shapes.groups(options.touch);
  std::erase_if(groups, [&](const auto& group) { return shapes.features[group.front()] >= scene.footprints.size(); });
  if (run.cancelled()) return;

  std::vector<Block> outlines(groups.size());
  base::parallel_for(groups.size(),
                     [&](std::size_t b) { outlines[b] = outlined_block(groups[b], shapes, scene, options); });
  run.report("block", "", 0.2);
  if (run.cancelled()) return;

  std::vector<geometry::Box2> regions, reaches;
  for (const auto& block : outlines) {
    const auto box = geometry::bounds(shifted(block.outline, xy(as_point(block.origin))));
    regions.push_back(box.grown(std::max(options.padding, options.ground_ring)));
    reaches.push_back(box.grown(options.ground_reach));
  }
  near_by = geometry::triangles_near(scene.mesh, regions);
  if (!scene.mesh.points.empty()) points_near = geometry::points_near(scene.mesh.points, regions);
  if (run.cancelled()) return;
  prepared_->shapes_near = geometry::triangles_near(as_mesh(shapes.boxes), regions);
  // Only where nothing is nearer does the mesh farther away matter.
  for (std::size_t b = 0; b < outlines.size(); ++b)
    if (!near_by[b].empty()) reaches[b] = {};
  prepared_->within_reach = geometry::triangles_near(scene.mesh, reaches);
  run.report("block", "", 0.4);
  if (!run.cancelled()) prepared_->blocks = std::move(outlines);
}

auto Partition::size() const -> std::size_t { return prepared_->blocks.size(); }
auto Partition::outlined(std::size_t i) const -> const Block& { return prepared_->blocks[i]; }
auto Partition::triangles_near(std::size_t i) const -> std::size_t { return prepared_->near_by[i].size(); }

auto Partition::make(std::size_t i) const -> Block {
  const auto& [scene, options, shapes, groups, blocks, near_by, shapes_near, within_reach, points_near] = *prepared_;
  Block block = blocks[i];
  block.origin[2] = foot_of(scene.mesh, near_by[i].empty() ? within_reach[i] : near_by[i]);
  const Point3 origin = as_point(block.origin);
  Surroundings around{part_of(scene.mesh, near_by[i], origin), {}};
  const detail::Nearness near(block.outline, options.padding);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t t = 0; t < around.mesh.triangles.size(); ++t)
    if (near(detail::plan_of(around.mesh, around.mesh.triangles[t]))) kept.push_back(t);
  block.mesh = part_of(around.mesh, kept, {});
  if (!points_near.empty()) block.mesh.points = points_of(scene.mesh.points, points_near[i], origin, near);
  for (const auto& member : block.members) around.shapes.push_back(member.polygons);
  const auto beside = others_of(shapes_near[i], groups[i], shapes, -1.0 * xy(origin));
  around.shapes.insert(around.shapes.end(), beside.begin(), beside.end());
  const auto reach = geometry::bounds(block.outline).grown(beside_reach);
  for (const auto& shape : beside)
    for (const auto& polygon : shape)
      if (reach.overlaps(geometry::bounds(polygon.outer))) block.beside.push_back(polygon);
  set_ground(block, scene, around, within_reach[i], options);
  move(block, origin);
  return block;
}

auto partition(const model::Scene& scene, const Options& options, const base::Run& run) -> std::vector<Block> {
  const Partition prepared(scene, options, run);
  std::vector<Block> blocks(prepared.size());
  base::parallel_for(blocks.size(), [&](std::size_t b) {
    if (!run.cancelled()) blocks[b] = prepared.make(b);
  });
  run.report("block", "", 1);
  return blocks;
}

}  // namespace mansard::block
