#include "mansard/solid/detail/disjoint.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/solid/detail/interiors.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;
using model::FaceClass;
using model::LabelledSolid;

/// Units of files. Halves go up everywhere, as in sheets_of().
auto units(double metres) -> double { return std::floor(metres * model::quanta_per_metre + 0.5); }
auto units(Point3 p) -> Point3 { return {units(p.x), units(p.y), units(p.z)}; }

/// A face as it is seen from above: its loops turn to the right where it looks down.
auto seen_from_above(const LabelledSolid& solid, const model::Face& face) -> Polygon {
  return geometry::polygon_of(face.loops,
                              [&](std::uint32_t v) { return geometry::xy(units(solid.solid.vertices[v])); });
}

auto polygon_of(const LabelledSolid& solid, const model::Face& face) -> Polygon {
  return geometry::oriented(seen_from_above(solid, face));
}

auto ground_of(const LabelledSolid& solid) -> std::vector<Polygon> {
  std::vector<Polygon> out;
  for (std::size_t f = 0; f < solid.classes.size(); ++f)
    if (solid.classes[f] == FaceClass::ground) out.push_back(polygon_of(solid, solid.solid.faces[f]));
  return out;
}

auto box_of(const LabelledSolid& solid) -> geometry::Box3 { return geometry::Box3::of(solid.solid.vertices); }

/// Units of files: its corners are there when they are written.
auto written_plan(const geometry::Box3& box) -> geometry::Box2 {
  return {geometry::xy(units(box.least)), geometry::xy(units(box.most))};
}

auto has_eaves(const LabelledSolid& solid) -> bool {
  return std::ranges::find(solid.classes, FaceClass::soffit) != solid.classes.end();
}

/// Whether two solids have a common height, and boxes that meet.
auto may_meet(const LabelledSolid& a, const LabelledSolid& b) -> bool {
  const auto own = box_of(a), other = box_of(b);
  return std::min(own.most.z, other.most.z) > std::max(own.least.z, other.least.z) &&
         written_plan(own).overlaps(written_plan(other));
}

/// What of a solid's plan is outside of its ground: roofs that look down by rounding.
auto overhang_of(const LabelledSolid& solid) -> std::vector<Polygon> {
  std::vector<Polygon> out;
  for (std::size_t f = 0; f < solid.classes.size(); ++f) {
    if (solid.classes[f] != FaceClass::roof) continue;
    const auto seen = seen_from_above(solid, solid.solid.faces[f]);
    if (geometry::signed_area(seen.outer) < 0) out.push_back(geometry::oriented(seen));
  }
  return out;
}

/// Whether anything that polygons share passes a test, or what they share cannot be computed.
template <class Test>
auto any_shared(const std::vector<Polygon>& some, const std::vector<Polygon>& others, Test test) -> bool {
  for (const Polygon& p : some)
    for (const Polygon& q : others) {
      if (!geometry::bounds(p.outer).overlaps(geometry::bounds(q.outer))) continue;
      const auto shared = geometry::intersect(p, q);
      if (!shared || std::ranges::any_of(*shared, test)) return true;
    }
  return false;
}

auto meet(const std::vector<Polygon>& some, const std::vector<Polygon>& others) -> bool {
  return any_shared(some, others, [](const Polygon& polygon) { return geometry::area(polygon) > 0; });
}

/// Whether anything is left of a polygon without a margin, or that cannot be computed.
auto is_wider(const Polygon& polygon, double margin) -> bool {
  const auto core = geometry::buffer(polygon, -margin);
  return !core || !core->empty();
}

/// None where the library fails.
auto taken_off(std::vector<Polygon> from, const Polygon& other) -> std::optional<std::vector<Polygon>> {
  std::vector<Polygon> out;
  const auto box = geometry::bounds(other.outer);
  for (auto& polygon : from) {
    if (!geometry::bounds(polygon.outer).overlaps(box)) {
      out.push_back(std::move(polygon));
      continue;
    }
    auto rest = geometry::subtract(polygon, other);
    if (!rest) return std::nullopt;
    for (auto& one : *rest) {
      // What is as narrow as what becomes one point is rounding.
      const auto core = geometry::buffer(one, -0.5 * model::least_apart);
      if (core && !core->empty()) out.push_back(std::move(one));
    }
  }
  return out;
}

/// Whether what solids share is wider than what becomes one point, or that cannot be computed.
auto share_wide(const LabelledSolid& a, const LabelledSolid& b) -> bool {
  return any_shared(ground_of(a), ground_of(b),
                    [](const Polygon& one) { return is_wider(one, 0.5 * model::least_apart); });
}

/// One face of a solid over a polygon: heights on its edges are those between their ends, so that faces beside each
/// other have the same.
class Heights {
 public:
  Heights(const LabelledSolid& solid, const model::Face& face) {
    Point3 area;
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point3 a = units(solid.solid.vertices[loop[i]]),
                     b = units(solid.solid.vertices[loop[(i + 1) % loop.size()]]);
        edges_.push_back({a, b});
        area = area + cross(a - edges_.front()[0], b - edges_.front()[0]);
      }
    normal_ = area;
  }

  [[nodiscard]] auto at(Point2 p) const -> double {
    for (const auto& [a, b] : edges_)
      if (geometry::xy(a) == p) return a.z;
    for (const auto& [a, b] : edges_) {
      const Point2 along = geometry::xy(b) - geometry::xy(a), to = p - geometry::xy(a);
      const double length2 = dot(along, along), t = dot(to, along) / length2, off = cross(along, to);
      if (t > 0 && t < 1 && off * off <= length2) return std::round(a.z + t * (b.z - a.z));
    }
    const Point3 a = edges_.front()[0];
    const Point2 to = p - geometry::xy(a);
    return std::round(a.z - (normal_.x * to.x + normal_.y * to.y) / normal_.z);
  }

 private:
  std::vector<std::array<Point3, 2>> edges_;
  Point3 normal_;
};

class Clipping {
 public:
  Clipping(const LabelledSolid& solid, std::span<const Polygon> over) : solid_(solid), over_(over) {}

  auto run() -> std::optional<LabelledSolid> {
    constexpr double level = 1e-5;  // what looks up or down less than that is a wall
    for (const bool roofs : {true, false})
      for (std::size_t f = 0; f < solid_.solid.faces.size(); ++f)
        if (const double up = solid_.solid.faces[f].normal.z; roofs ? up > level : up < -level)
          if (!add_over(f)) return std::nullopt;
    if (out_.solid.faces.empty()) return std::nullopt;
    for (std::size_t f = 0; f < solid_.solid.faces.size(); ++f)
      if (std::abs(solid_.solid.faces[f].normal.z) <= level) add_wall(f);
    return std::move(out_);
  }

 private:
  auto add_over(std::size_t f) -> bool {
    const model::Face& face = solid_.solid.faces[f];
    const Heights heights(solid_, face);
    const Polygon own = polygon_of(solid_, face);
    for (const Polygon& polygon : over_) {
      if (!geometry::bounds(own.outer).overlaps(geometry::bounds(polygon.outer))) continue;
      const auto pieces = geometry::intersect(own, polygon);
      if (!pieces) return false;
      for (const Polygon& piece : *pieces) {
        model::Face one{{}, face.kind, face.provenance, face.normal};
        add_loop(one, piece.outer, heights, face.normal.z < 0);
        if (one.loops.empty()) continue;
        for (const auto& hole : piece.holes) add_loop(one, hole, heights, face.normal.z < 0);
        out_.solid.faces.push_back(std::move(one));
        out_.classes.push_back(solid_.classes[f]);
      }
    }
    return true;
  }

  void add_loop(model::Face& face, const geometry::Ring& ring, const Heights& heights, bool downward) {
    std::vector<std::uint32_t> loop;
    const auto add = [&](Point2 p) {
      const std::uint32_t v = vertex({p.x, p.y, heights.at(p)});
      if (loop.empty() || loop.back() != v) loop.push_back(v);
      (downward ? ground_ : roofs_).insert(p);
    };
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 from = rounded(ring[i]), to = rounded(ring[(i + 1) % ring.size()]);
      add(from);
      if (downward)
        for (const Point2 p : corners_between(from, to)) add(p);
    }
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    if (loop.size() < 3) return;
    if (downward) std::ranges::reverse(loop);
    face.loops.push_back(std::move(loop));
  }

  static auto rounded(Point2 p) -> Point2 { return {std::round(p.x), std::round(p.y)}; }

  /// Corners of the roofs on an edge of the ground, which walls would have: a union breaks the ground there, as it
  /// breaks the walls.
  [[nodiscard]] auto corners_between(Point2 from, Point2 to) const -> std::vector<Point2> {
    constexpr double off = 2;  // units: rounding of both
    std::vector<std::pair<double, Point2>> found;
    const Point2 along = to - from;
    const double length2 = dot(along, along), least = std::min(from.x, to.x) - off, most = std::max(from.x, to.x) + off;
    for (auto p = roofs_.lower_bound({least, -1e300}); p != roofs_.end() && p->x <= most; ++p) {
      const double t = dot(*p - from, along), across = cross(along, *p - from);
      if (t > 0 && t < length2 && across * across <= off * off * length2) found.emplace_back(t, *p);
    }
    std::ranges::sort(found);
    std::vector<Point2> out;
    for (const auto& [t, p] : found) out.push_back(p);
    return out;
  }

  /// Where both ends of its foot are corners of the ground still.
  void add_wall(std::size_t f) {
    model::Face face = solid_.solid.faces[f];
    for (const auto& loop : face.loops)
      for (const auto v : loop)
        if (!ground_.contains(geometry::xy(units(solid_.solid.vertices[v])))) return;
    for (auto& loop : face.loops)
      for (auto& v : loop) v = vertex(units(solid_.solid.vertices[v]));
    out_.solid.faces.push_back(std::move(face));
    out_.classes.push_back(solid_.classes[f]);
  }

  auto vertex(Point3 p) -> std::uint32_t {
    auto& vertices = out_.solid.vertices;
    const auto [entry, added] = numbers_.try_emplace(p, static_cast<std::uint32_t>(vertices.size()));
    if (added) vertices.push_back((1 / model::quanta_per_metre) * p);
    return entry->second;
  }

  const LabelledSolid& solid_;
  std::span<const Polygon> over_;
  LabelledSolid out_;
  std::map<Point3, std::uint32_t> numbers_;
  std::set<Point2> roofs_, ground_;
};

}  // namespace

namespace {

/// Whether the roof of a solid is above z anywhere over a polygon, or that cannot be computed. z in units of files.
auto rises_above(const LabelledSolid& solid, double z, const Polygon& over) -> bool {
  const auto box = geometry::bounds(over.outer);
  for (std::size_t f = 0; f < solid.solid.faces.size(); ++f) {
    const auto& face = solid.solid.faces[f];
    if (solid.classes[f] != FaceClass::roof) continue;
    const bool high =
        std::ranges::any_of(face.loops.front(), [&](std::uint32_t v) { return units(solid.solid.vertices[v]).z > z; });
    const Polygon own = polygon_of(solid, face);
    if (!high || !geometry::bounds(own.outer).overlaps(box)) continue;
    const auto pieces = geometry::intersect(own, over);
    if (!pieces) return true;
    const Heights heights(solid, face);
    for (const Polygon& piece : *pieces)
      if (std::ranges::any_of(piece.outer, [&](Point2 p) { return heights.at(p) > z; })) return true;
  }
  return false;
}

/// The ground of a solid whose ground is at several heights, by height.
auto grounds_of(const LabelledSolid& solid) -> std::map<double, std::vector<Polygon>> {
  std::map<double, std::vector<Polygon>> out;
  for (std::size_t f = 0; f < solid.classes.size(); ++f) {
    if (solid.classes[f] != FaceClass::ground) continue;
    const auto& face = solid.solid.faces[f];
    out[units(solid.solid.vertices[face.loops.front().front()]).z].push_back(polygon_of(solid, face));
  }
  return out;
}

/// Solids above each other: whether what stands on the lower ground reaches to the higher one where they share it.
auto meet_in_height(const LabelledSolid& a, const LabelledSolid& b) -> bool {
  const auto of_a = grounds_of(a), of_b = grounds_of(b);
  for (const auto& [za, ground_a] : of_a)
    for (const auto& [zb, ground_b] : of_b) {
      const auto& [lower, z] = za < zb ? std::pair(&a, zb) : std::pair(&b, za);
      const bool same = za == zb;
      if (any_shared(ground_a, ground_b, [&](const Polygon& over) {
            return geometry::area(over) > 0 && (same || rises_above(*lower, z, over));
          }))
        return true;
    }
  return false;
}

}  // namespace

auto share_ground(const LabelledSolid& a, const LabelledSolid& b) -> bool {
  if (has_eaves(a) || has_eaves(b) || !may_meet(a, b)) return false;
  const auto ground_a = ground_of(a), ground_b = ground_of(b);
  if (box_of(a).least.z != box_of(b).least.z && !meet_in_height(a, b)) return false;
  return meet(ground_a, ground_b) || meet(overhang_of(a), ground_b) || meet(ground_a, overhang_of(b));
}

auto overlap(const LabelledSolid& a, const LabelledSolid& b) -> bool {
  return !has_eaves(a) && !has_eaves(b) && may_meet(a, b) &&
         (share_ground(a, b) || meet_or_touch_by_chance(a.solid, b.solid));
}

auto near_each(std::span<const LabelledSolid* const> solids) -> std::vector<std::vector<std::uint32_t>> {
  std::vector<geometry::Box2> boxes;
  boxes.reserve(solids.size());
  for (const auto* solid : solids) boxes.push_back(written_plan(box_of(*solid)));
  const geometry::BoxIndex index(boxes);
  std::vector<std::vector<std::uint32_t>> out(solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) {
    out[i] = index.overlapping(boxes[i]);
    std::erase(out[i], i);
  }
  return out;
}

auto wider_than_points(const LabelledSolid& solid, double near) -> bool {
  return std::ranges::any_of(ground_of(solid), [&](const Polygon& ground) { return is_wider(ground, near); });
}

auto clipped(const LabelledSolid& solid, std::span<const Polygon> over) -> std::optional<LabelledSolid> {
  return Clipping(solid, over).run();
}

auto without(const LabelledSolid& solid, std::span<const LabelledSolid* const> others, double gap) -> Rest {
  std::vector<Polygon> rest = ground_of(solid);
  for (const LabelledSolid* other : others) {
    if (!may_meet(solid, *other)) continue;
    for (const Polygon& ground : ground_of(*other)) {
      std::vector<Polygon> wide{ground};
      if (gap > 0) {
        auto grown = geometry::buffer(ground, gap);
        if (!grown) return {{}, true};
        wide = std::move(*grown);
      }
      for (const Polygon& one : wide) {
        auto left = taken_off(std::move(rest), one);
        if (!left) return {{}, true};
        rest = std::move(*left);
      }
    }
  }
  if (rest.empty()) return {};
  auto out = clipped(solid, rest);
  const bool failed = !out;
  return {std::move(out), failed};
}

auto parted(std::span<const LabelledSolid* const> solids, const std::vector<bool>& firm, Shared shared) -> Parted {
  const std::size_t count = solids.size();
  Parted out{std::vector<std::optional<LabelledSolid>>(count), std::vector<bool>(count), std::vector<bool>(count)};
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(),
                           [&](std::size_t i) { return std::pair(bool{firm[i]}, box_of(*solids[i]).most.z); });
  std::vector<std::size_t> place(count);
  for (std::size_t i = 0; i < count; ++i) place[order[i]] = i;
  auto near = near_each(solids);
  for (const std::size_t i : order) {
    if (has_eaves(*solids[i])) continue;
    std::vector<const LabelledSolid*> in_its_way;
    std::ranges::sort(near[i], {}, [&](std::uint32_t k) { return place[k]; });
    for (const std::uint32_t k : near[i]) {
      if (place[k] > place[i]) break;
      if (share_ground(*solids[k], *solids[i]) && (shared == Shared::any || share_wide(*solids[k], *solids[i])))
        in_its_way.push_back(solids[k]);
    }
    if (in_its_way.empty()) continue;
    auto rest = without(*solids[i], in_its_way, 0);
    out.changed[i] = std::move(rest.solid);
    out.failed[i] = rest.failed;
    out.covered[i] = !out.changed[i] && !rest.failed;
    out.any = true;
  }
  return out;
}

}  // namespace mansard::solid::detail
