#include "planted.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "layout.hpp"
#include "scan.hpp"

namespace mansard::planted {
namespace {

using geometry::Point2;
using geometry::Segment2;

auto length(const Segment2& s) -> double { return geometry::length(s.end - s.start); }

/// Sees walls as a sweep does: beside where they are, in pieces, twice, or not at all.
class Sweep {
 public:
  Sweep(const Recipe& recipe, sweep::SweepEdges& edges) : recipe_(recipe), random_(recipe.seed, 3), edges_(edges) {}

  void see(const Visible& wall) {
    // Every wall draws the same numbers, whatever comes of it: one probability changed leaves the other walls alone.
    base::Random random(random_.next());
    const bool missing = random.uniform() < recipe_.missing, twice = random.uniform() < recipe_.twice;
    const bool broken = random.uniform() < recipe_.broken, shorter = random.uniform() < recipe_.shorter;
    if (wall.area < recipe_.gamma || missing) return;
    Visible seen = wall;
    if (shorter) seen.segment = trimmed(wall.segment, random.uniform(0, 1.5), random.uniform() < 0.5);
    if (broken && length(seen.segment) > 5) {
      const double middle = random.uniform(0.3, 0.7) * length(seen.segment), gap = random.uniform(0.8, 2);
      Visible first = seen, second = seen;
      first.segment = trimmed(seen.segment, length(seen.segment) - middle + gap / 2, true);
      second.segment = trimmed(seen.segment, middle + gap / 2, false);
      add(first, 0, random);
      add(second, 0, random);
    } else {
      add(seen, 0, random);
    }
    const double beside = random.uniform(0.2, 1) * (random.uniform() < 0.5 ? 1 : -1);
    Visible again = wall;
    again.segment = trimmed(wall.segment, random.uniform(0, 0.4) * length(wall.segment), random.uniform() < 0.5);
    if (twice) add(again, beside, random);
  }

  /// A line of something that is no wall of a house.
  void see_clutter(const Visible& line) { add(line, 0, random_); }

 private:
  [[nodiscard]] static auto trimmed(const Segment2& s, double by, bool at_end) -> Segment2 {
    const Point2 cut = std::min(1.0, by / length(s)) * (s.end - s.start);
    return at_end ? Segment2{s.start, s.end - cut} : Segment2{s.start + cut, s.end};
  }

  void add(const Visible& wall, double beside, base::Random& random) {
    const Point2 along = wall.segment.end - wall.segment.start;
    const double size = geometry::length(along);
    const double share = size / length(wall.segment) * wall.area;
    if (size < 1 || share < recipe_.gamma) return;
    const double off = beside + recipe_.lateral * normal(random);
    const double angle = recipe_.angle * std::min(1.0, 5 / size) * normal(random);
    const double from = 0.1 * normal(random), to = 0.1 * normal(random);
    const Point2 unit = (1 / size) * along, left = geometry::left_of(unit);
    const double tilt = angle * size / 2;
    edges_.edges.push_back(
        {{wall.segment.start + from * unit + (off - tilt) * left, wall.segment.end + to * unit + (off + tilt) * left},
         wall.area,
         wall.low,
         wall.high,
         0});
  }

  const Recipe& recipe_;
  base::Random random_;
  sweep::SweepEdges& edges_;
};

/// A box somewhere on a house, or beside it on the ground, and the side of it that a sweep would see.
struct Clutter {
  Box box;
  Visible side;
};
auto clutter_of(const House& house, const Recipe& recipe, base::Random& random) -> Clutter {
  const auto extent = geometry::bounds(house.polygon.outer);
  const bool on_roof = random.uniform() < 0.75;
  const double wide = random.uniform(2.5, 5.5), deep = random.uniform(1, 2);
  const double x = random.uniform(extent.least.x, extent.most.x), y = random.uniform(extent.least.y, extent.most.y);
  const double beyond = extent.least.y - random.uniform(1.5, 4);
  constexpr double quarter = 1.5707963267948966;
  const bool askew = random.uniform() < 0.2;
  const double turn = askew ? random.uniform(0, 4 * quarter) : quarter * static_cast<double>(random.index(4));
  const Point2 along{std::cos(turn), std::sin(turn)}, inwards = -1.0 * geometry::left_of(along);
  const Point2 a{x, on_roof ? y : beyond}, b = a + wide * along;
  const double base = on_roof ? top(house, a) : 0;
  const double rise = recipe.gamma / wide * random.uniform(1.1, 1.6);
  Clutter made;
  made.box = {geometry::oriented({{a, b, b + deep * inwards, a + deep * inwards}, {}}), base + rise};
  made.side = {{a, b}, base, base + rise, rise * wide};
  return made;
}

struct Turn {
  Point2 x, y;
  explicit Turn(double angle) : x{std::cos(angle), std::sin(angle)}, y(geometry::left_of(x)) {}
  [[nodiscard]] auto operator()(Point2 p) const -> Point2 { return p.x * x + p.y * y; }
  [[nodiscard]] auto operator()(const Segment2& s) const -> Segment2 { return {(*this)(s.start), (*this)(s.end)}; }
};

void move(geometry::Polygon& polygon, const auto& by) {
  for (Point2& p : polygon.outer) p = by(p);
  for (auto& hole : polygon.holes)
    for (Point2& p : hole) p = by(p);
}

auto united(const std::vector<House>& houses, std::size_t feature) -> std::vector<geometry::Polygon> {
  std::vector<geometry::Polygon> polygons;
  for (const House& h : houses)
    if (h.feature == feature) polygons.push_back(h.polygon);
  return geometry::unite(polygons).value();
}

/// The footprints: each feature's houses as one, drawn with an error. Corners in one place stay in one place.
auto footprints(const std::vector<House>& houses, const Recipe& recipe, const Turn& turn)
    -> std::vector<block::Member> {
  base::Random random(recipe.seed, 6);
  const double x = recipe.gis * normal(random), y = recipe.gis * normal(random);
  std::map<Point2, Point2> drawn;
  const auto draw = [&](Point2 p) {
    const auto [place, is_new] = drawn.try_emplace(p);
    if (is_new) {
      const double dx = recipe.gis / 3 * normal(random), dy = recipe.gis / 3 * normal(random);
      place->second = turn(p) + Point2{x + dx, y + dy};
    }
    return place->second;
  };
  std::vector<block::Member> members;
  for (std::size_t f = 0; f <= houses.back().feature; ++f) {
    members.push_back({f, united(houses, f), 0});
    for (auto& polygon : members.back().polygons) move(polygon, draw);
  }
  return members;
}

/// Their union, with the hairlines between them closed.
auto outline(const std::vector<block::Member>& members) -> std::vector<geometry::Polygon> {
  const auto all_grown = [](const std::vector<geometry::Polygon>& polygons, double by) {
    std::vector<geometry::Polygon> grown;
    for (const auto& p : polygons) {
      const auto pieces = geometry::buffer(p, by).value();
      grown.insert(grown.end(), pieces.begin(), pieces.end());
    }
    return grown;
  };
  std::vector<geometry::Polygon> polygons;
  for (const auto& m : members) polygons.insert(polygons.end(), m.polygons.begin(), m.polygons.end());
  return all_grown(geometry::unite(all_grown(polygons, 0.05)).value(), -0.05);
}

void sort_longest_first(sweep::SweepEdges& edges) {
  std::ranges::sort(edges.edges, [](const sweep::SweepEdge& a, const sweep::SweepEdge& b) {
    return std::tuple(-length(a.segment), a.segment) < std::tuple(-length(b.segment), b.segment);
  });
  edges.clusters.clear();
  for (std::size_t k = 0; k < edges.edges.size(); ++k) {
    edges.edges[k].cluster = k;
    edges.clusters.push_back({{}, edges.edges[k].area});
  }
}

}  // namespace

auto top(const House& house, Point2 at) -> double {
  const double t = (geometry::dot(house.across, at) - house.least) / (house.most - house.least);
  switch (house.roof) {
    case Roof::flat: return house.eaves;
    case Roof::mono: return house.eaves + house.rise * t;
    case Roof::gable_along:
    case Roof::gable_across: return house.eaves + house.rise * (1 - std::abs(2 * t - 1));
  }
  return house.eaves;
}

auto make(const Recipe& recipe) -> Block {
  Block made;
  made.name = made.block.name = recipe.name;
  made.houses = houses_of(recipe);
  made.walls = walls_between(made.houses);

  const Turn turn(recipe.turn);
  Sweep sweep(recipe, made.edges);
  for (Visible wall : visible_walls(made.houses, made.walls, recipe.seen_step)) {
    wall.segment = turn(wall.segment);
    sweep.see(wall);
  }
  base::Random random(recipe.seed, 4);
  std::vector<Box> boxes;
  const auto count = static_cast<std::size_t>(std::lround(recipe.clutter * static_cast<double>(recipe.houses)));
  for (std::size_t k = 0; k < count; ++k) {
    Clutter c = clutter_of(made.houses[random.index(made.houses.size())], recipe, random);
    move(c.box.polygon, turn);
    c.side.segment = turn(c.side.segment);
    boxes.push_back(c.box);
    sweep.see_clutter(c.side);
  }
  sort_longest_first(made.edges);

  made.block.members = footprints(made.houses, recipe, turn);
  made.block.outline = outline(made.block.members);
  for (House& h : made.houses) {
    move(h.polygon, turn);
    h.across = turn(h.across);
  }
  for (Wall& w : made.walls) w.segment = turn(w.segment);
  made.block.mesh = scan(made.houses, boxes, recipe);
  return made;
}

auto fractured(const Block& planted, const segment::Options& options) -> fracture::Arrangement {
  geometry::Box2 region;
  for (const auto& m : planted.block.members)
    for (const auto& p : m.polygons)
      for (const Point2 q : p.outer) region.add(q);
  return fracture::arrange(segment::cuts_of(planted.edges, planted.block, options), region, {}).value();
}

}  // namespace mansard::planted
