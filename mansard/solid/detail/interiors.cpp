#include "mansard/solid/detail/interiors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "mansard/model/file_grid.hpp"
#include "mansard/solid/detail/delaunay.hpp"
#include "mansard/solid/detail/fitted_plane.hpp"
#include "mansard/solid/detail/flattening.hpp"
#include "mansard/solid/detail/measure.hpp"
#include "mansard/solid/triangulator.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

/// Halves go up everywhere, as in sheets_of().
auto whole_units(Point3 p) -> Point3 {
  const auto whole = [](double metres) { return std::floor(metres * model::quanta_per_metre + 0.5); };
  return {whole(p.x), whole(p.y), whole(p.z)};
}

/// A triangle, counter-clockwise from outside, and the third corners of the triangles across its edges: of the one
/// across the edge from corner i to i + 1, beyond[i].
struct Plate {
  std::array<Point3, 3> at, beyond;
  geometry::Box3 box;
};

/// The triangles of a solid, or none where a face cannot be cut.
auto plates_of(const model::Solid& solid) -> std::optional<std::vector<Plate>> {
  model::Solid whole;
  whole.vertices.reserve(solid.vertices.size());
  for (const Point3 p : solid.vertices) whole.vertices.push_back(whole_units(p));
  Triangulator triangulator(whole);
  std::vector<Corners> all, own;
  for (const model::Face& face : solid.faces) {
    own.clear();
    const Point3 normal = fitted_plane(whole, face).normal;
    if (!triangulator.append(face, normal, own)) return std::nullopt;
    make_delaunay(whole, normal, own);
    all.insert(all.end(), own.begin(), own.end());
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> third;
  for (const Corners& t : all)
    for (std::size_t i = 0; i < 3; ++i) third[{t[i], t[(i + 1) % 3]}] = t[(i + 2) % 3];
  std::vector<Plate> out;
  out.reserve(all.size());
  for (const Corners& t : all) {
    Plate& plate = out.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      plate.at[i] = whole.vertices[t[i]];
      plate.box.add(plate.at[i]);
      const auto found = third.find({t[(i + 1) % 3], t[i]});
      if (found == third.end()) return std::nullopt;
      plate.beyond[i] = whole.vertices[found->second];
    }
  }
  return out;
}

/// The sides of a triangle's plane on which the corners of another one lie: +1 outside.
using Signs = std::array<int, 3>;
auto sides(const Plate& of, const Plate& other) -> Signs {
  Signs out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = above(of.at[0], of.at[1], of.at[2], other.at[i]);
  return out;
}
auto on_both_sides(const Signs& signs) -> bool {
  return std::ranges::find(signs, 1) != signs.end() && std::ranges::find(signs, -1) != signs.end();
}

/// The corner that is on one side by itself, and the others.
auto lone_first(const Plate& t, const Signs& signs) -> std::array<Point3, 3> {
  for (const int side : {1, -1})
    if (std::ranges::count(signs, side) == 1) {
      const auto i = static_cast<std::size_t>(std::ranges::find(signs, side) - signs.begin());
      return {t.at[i], t.at[(i + 1) % 3], t.at[(i + 2) % 3]};
    }
  return t.at;
}

/// Whether two triangles whose corners are on both sides of each other's planes pass through each other. Each cuts a
/// piece out of the line that the planes have in common; which of two ends comes first is the sign of the volume that
/// the two edges span on which they lie (P. Guigue, O. Devillers, Fast and robust triangle-triangle overlap test,
/// 2003).
auto cross_each_other(const Plate& s, const Signs& of_s, const Plate& t, const Signs& of_t) -> bool {
  const auto a = lone_first(s, of_s), b = lone_first(t, of_t);
  bool before = false, after = false;
  for (const std::size_t i : {1, 2})
    for (const std::size_t k : {1, 2}) {
      const int order = above(a[0], a[i], b[0], b[k]);
      before = before || order < 0;
      after = after || order > 0;
    }
  return before && after;
}

/// Angles around the line from `from` to `to`, which points to the eye, counter-clockwise from `zero`. A corner stands
/// for the half-plane that it is in.
class Around {
 public:
  Around(Point3 from, Point3 to, Point3 zero) : from_(from), to_(to), zero_(zero) {}

  /// Whether the angle of p is less than that of q, which is taken for a full turn where it is none.
  [[nodiscard]] auto is_less(Point3 p, Point3 q) const -> bool {
    const int at_p = quarter(p), at_q = quarter(q);
    const int full = at_q == 0 ? 4 : at_q;
    if (at_p != full) return at_p < full;
    return (at_p == 1 || at_p == 3) && above(from_, to_, p, q) > 0;
  }

 private:
  /// 0 at zero, 2 across from it, 1 and 3 in between.
  [[nodiscard]] auto quarter(Point3 p) const -> int {
    const int side = above(from_, to_, zero_, p);
    if (side != 0) return side > 0 ? 1 : 3;
    const Flattening flat(from_, to_, zero_);
    return turn(flat(from_), flat(to_), flat(zero_)) == turn(flat(from_), flat(to_), flat(p)) ? 0 : 2;
  }

  Point3 from_, to_, zero_;
};

/// The inside of a solid beside an edge that runs to the eye: counter-clockwise between two half-planes.
struct Wedge {
  Point3 first, last;
};
auto wedge(const Plate& t, std::size_t edge) -> Wedge { return {t.beyond[edge], t.at[(edge + 2) % 3]}; }

auto have_common(Point3 from, Point3 to, const Wedge& a, const Wedge& b) -> bool {
  return Around(from, to, a.first).is_less(b.first, a.last) || Around(from, to, b.first).is_less(a.first, b.last);
}

/// Whether a piece of an edge that lies in the plane of a triangle is inside of it.
auto runs_inside(const Flattening& flat, Point3 from, Point3 to, const std::array<Point3, 3>& t) -> bool {
  const Point2 p = flat(from), q = flat(to);
  const std::array<Point2, 3> c{flat(t[0]), flat(t[1]), flat(t[2])};
  const int inner = turn(c[0], c[1], c[2]);
  bool left = false, right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = turn(p, q, c[i]);
    left = left || side > 0;
    right = right || side < 0;
    const Point2 from_here = c[i], to_there = c[(i + 1) % 3];
    if (turn(from_here, to_there, p) != inner && turn(from_here, to_there, q) != inner) return false;
  }
  return left && right;
}

/// Beside an edge of s that runs through t, in its plane.
auto meet_on_a_face(const Plate& s, const Signs& of_s, const Plate& t) -> bool {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    if (of_s[i] != 0 || of_s[k] != 0) continue;
    const Flattening flat(t.at[0], t.at[1], t.at[2]);
    const Point3 from = s.at[i], to = s.at[k];
    if (!runs_inside(flat, from, to, t.at)) continue;
    // Seen from outside, as the triangle's corners run: what is on the left of the edge, and on its right.
    const int inner = turn(flat(t.at[0]), flat(t.at[1]), flat(t.at[2]));
    Wedge half{};
    for (const Point3 c : t.at)
      if (const int side = turn(flat(from), flat(to), flat(c)) * inner; side != 0)
        (side > 0 ? half.last : half.first) = c;
    if (have_common(from, to, wedge(s, i), half)) return true;
  }
  return false;
}

auto on_a_line(Point3 a, Point3 b, Point3 c) -> bool {
  return turn({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 && turn({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         turn({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

/// Beside an edge, or a piece of one, that both have.
auto meet_on_an_edge(const Plate& s, const Signs& of_s, const Plate& t, const Signs& of_t) -> bool {
  for (std::size_t i = 0; i < 3; ++i) {
    if (of_s[i] != 0 || of_s[(i + 1) % 3] != 0) continue;
    const Point3 a = s.at[i], b = s.at[(i + 1) % 3];
    for (std::size_t k = 0; k < 3; ++k) {
      if (of_t[k] != 0 || of_t[(k + 1) % 3] != 0) continue;
      const Point3 c = t.at[k], d = t.at[(k + 1) % 3];
      if (!on_a_line(a, b, c) || !on_a_line(a, b, d)) continue;
      if (!(std::max(std::min(a, b), std::min(c, d)) < std::min(std::max(a, b), std::max(c, d)))) continue;
      Wedge other = wedge(t, k);
      if ((a < b) != (c < d)) std::swap(other.first, other.last);
      if (have_common(a, b, wedge(s, i), other)) return true;
    }
  }
  return false;
}

auto plates_meet(const Plate& s, const Plate& t) -> bool {
  const Signs of_s = sides(t, s), of_t = sides(s, t);
  if (on_both_sides(of_s) && on_both_sides(of_t)) return cross_each_other(s, of_s, t, of_t);
  return meet_on_a_face(s, of_s, t) || meet_on_a_face(t, of_t, s) || meet_on_an_edge(s, of_s, t, of_t);
}

/// Whether a corner of s lies on t by the decimals of a file only.
auto lies_on_by_chance(const Plate& s, const Plate& t) -> bool {
  for (const auto axis : {&Point3::x, &Point3::y, &Point3::z})
    if (t.at[0].*axis == t.at[1].*axis && t.at[1].*axis == t.at[2].*axis) return false;
  const Flattening flat(t.at[0], t.at[1], t.at[2]);
  for (const Point3 p : s.at) {
    const auto is_exact = [&](Point3 corner) { return corner == p || (corner.x == p.x && corner.y == p.y); };
    const bool upright = turn({t.at[0].x, t.at[0].y}, {t.at[1].x, t.at[1].y}, {t.at[2].x, t.at[2].y}) == 0;
    if (std::ranges::any_of(t.at, [&](Point3 corner) { return upright ? is_exact(corner) : corner == p; })) continue;
    if (above(t.at[0], t.at[1], t.at[2], p) != 0) continue;
    const int inner = turn(flat(t.at[0]), flat(t.at[1]), flat(t.at[2]));
    bool outside = false;
    for (std::size_t i = 0; i < 3; ++i)
      outside = outside || turn(flat(t.at[i]), flat(t.at[(i + 1) % 3]), flat(p)) == -inner;
    if (!outside) return true;
  }
  return false;
}

auto near_by_chance(const Plate& s, const Plate& t) -> bool {
  return lies_on_by_chance(s, t) || lies_on_by_chance(t, s);
}

auto box_of(const std::vector<Plate>& plates) -> geometry::Box3 {
  geometry::Box3 out;
  for (const Plate& plate : plates) out.include(plate.box);
  return out;
}

/// Whether two triangles whose boxes meet, one of each solid, pass a test; and where a solid cannot be cut.
template <class Test>
auto any_two(const model::Solid& a, const model::Solid& b, Test test) -> bool {
  auto of_a = plates_of(a), of_b = plates_of(b);
  if (!of_a || !of_b) return true;
  const geometry::Box3 box_a = box_of(*of_a), box_b = box_of(*of_b);
  if (!box_a.overlaps(box_b)) return false;
  std::erase_if(*of_a, [&](const Plate& plate) { return !plate.box.overlaps(box_b); });
  std::erase_if(*of_b, [&](const Plate& plate) { return !plate.box.overlaps(box_a); });
  std::ranges::sort(*of_a, {}, [](const Plate& plate) { return plate.box.least.x; });
  std::ranges::sort(*of_b, {}, [](const Plate& plate) { return plate.box.least.x; });
  // Both in the order of their beginning; those of b that have ended are left behind.
  std::vector<const Plate*> open;
  auto next = of_b->begin();
  for (const Plate& s : *of_a) {
    while (next != of_b->end() && next->box.least.x <= s.box.most.x) open.push_back(&*next++);
    std::erase_if(open, [&](const Plate* t) { return t->box.most.x < s.box.least.x; });
    for (const Plate* t : open)
      if (s.box.overlaps(t->box) && test(s, *t)) return true;
  }
  return false;
}

}  // namespace

auto insides_meet(const model::Solid& a, const model::Solid& b) -> bool { return any_two(a, b, plates_meet); }

auto touch_by_chance(const model::Solid& a, const model::Solid& b) -> bool { return any_two(a, b, near_by_chance); }

auto meet_or_touch_by_chance(const model::Solid& a, const model::Solid& b) -> bool {
  return any_two(a, b, [](const Plate& s, const Plate& t) { return plates_meet(s, t) || near_by_chance(s, t); });
}

}  // namespace mansard::solid::detail
