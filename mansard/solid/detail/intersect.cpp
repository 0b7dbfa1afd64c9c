#include "mansard/solid/detail/intersect.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mansard/geometry/predicates.hpp"
#include "mansard/solid/detail/flattening.hpp"
#include "mansard/solid/detail/measure.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

auto in_triangle(Point2 a, Point2 b, Point2 c, Point2 p) -> bool {
  const int x = turn(a, b, p), y = turn(b, c, p), z = turn(c, a, p);
  return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

/// Closed segment against closed triangle.
auto pierces(Point3 p, Point3 q, Point3 a, Point3 b, Point3 c) -> bool {
  const Flattening seen(a, b, c);
  const int sp = above(a, b, c, p), sq = above(a, b, c, q);
  if (sp * sq > 0) return false;
  if (sp == 0 && sq == 0) {
    const auto& flat = seen;
    const geometry::Segment2 s{flat(p), flat(q)};
    return in_triangle(flat(a), flat(b), flat(c), s.start) || in_triangle(flat(a), flat(b), flat(c), s.end) ||
           geometry::meet(s, {flat(a), flat(b)}) || geometry::meet(s, {flat(b), flat(c)}) ||
           geometry::meet(s, {flat(c), flat(a)});
  }
  const int x = above(p, q, a, b), y = above(p, q, b, c), z = above(p, q, c, a);
  return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

}  // namespace

auto intersect(const std::vector<Point3>& vertices, const Corners& s, const Corners& t) -> bool {
  std::vector<std::uint32_t> shared;
  for (const std::uint32_t v : s)
    if (std::ranges::find(t, v) != t.end()) shared.push_back(v);
  const auto at = [&](std::uint32_t v) { return vertices[v]; };

  if (shared.size() == 3) return true;
  if (shared.size() == 2) {
    // Along the common edge is as it should be, unless one lies flat on the other.
    const auto third = [&](const Corners& c) {
      return *std::ranges::find_if(c, [&](std::uint32_t v) { return v != shared[0] && v != shared[1]; });
    };
    const Point3 a = at(shared[0]), b = at(shared[1]), p = at(third(s)), q = at(third(t));
    if (above(a, b, p, q) != 0) return false;
    const Flattening flat(a, b, p);
    return turn(flat(a), flat(b), flat(p)) == turn(flat(a), flat(b), flat(q));
  }
  if (shared.size() == 1) {
    // Beyond the common corner the triangles meet if and only if the side across from it in one meets the other.
    const auto across = [&](const Corners& c) {
      const auto i = std::ranges::find(c, shared[0]) - c.begin();
      return std::array{at(c[(i + 1) % 3]), at(c[(i + 2) % 3])};
    };
    const auto a = across(s), b = across(t);
    return pierces(a[0], a[1], at(t[0]), at(t[1]), at(t[2])) || pierces(b[0], b[1], at(s[0]), at(s[1]), at(s[2]));
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (pierces(at(s[i]), at(s[(i + 1) % 3]), at(t[0]), at(t[1]), at(t[2])) ||
        pierces(at(t[i]), at(t[(i + 1) % 3]), at(s[0]), at(s[1]), at(s[2])))
      return true;
  return false;
}

namespace {

/// A triangle with what the cheap tests of its pairs ask for.
struct Triangle {
  std::array<Point3, 3> at;
  Corners corners;
  std::uint32_t face;
  std::uint32_t index;  ///< in the caller's list
  Point3 normal;        ///< rounded
  Point3 terms;         ///< the sizes of the products that the normal was rounded from
  Point3 least, most;
};

auto plate_of(const std::vector<Point3>& vertices, const Corners& corners, std::uint32_t face, std::uint32_t index)
    -> Triangle {
  Triangle t{{vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]}, corners, face, index, {}, {}, {}, {}};
  const auto [a, b, c] = t.at;
  const Point3 u = b - a, v = c - a;
  t.normal = cross(u, v);
  t.terms = {std::abs(u.y * v.z) + std::abs(u.z * v.y), std::abs(u.z * v.x) + std::abs(u.x * v.z),
             std::abs(u.x * v.y) + std::abs(u.y * v.x)};
  t.least = {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})};
  t.most = {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})};
  return t;
}

// Error bounds of the filters, relative to the same sums with absolute values; u = 2⁻⁵³, vertices are doubles and
// exact.
/// A component of the normal: 1 + 1 u of two differences, 1 u of their product, 1 u of the difference: 4 u. Times a
/// component of p − a (1 u) another 1 u, and 2 u of the sum of three: 8 u. Twice that.
constexpr double side_error = 16 * 0x1.0p-53;
/// Two differences, a product, a difference: 1 + 1 + 1 + 1 = 4 u (Shewchuk has a little over 3). Twice that.
constexpr double sure_turn_error = 8 * 0x1.0p-53;
/// Underflow takes 2⁻¹⁰⁷⁴ from a product at most, times 2⁸⁰ for coordinates below 1e24: far less than the bounds times
/// this.
constexpr double sure_no_underflow = 1e-280;

/// The side of the plane on which p surely lies; 0 when rounding leaves it open.
auto sure_side(const Triangle& t, Point3 p) -> int {
  const Point3 d = p - t.at[0];
  const double det = dot(t.normal, d);
  const double size = t.terms.x * std::abs(d.x) + t.terms.y * std::abs(d.y) + t.terms.z * std::abs(d.z);
  if (std::abs(det) <= side_error * size || std::abs(det) < sure_no_underflow) return 0;
  return det > 0 ? 1 : -1;
}

/// The side of the line from a to b on which c surely lies.
auto sure_turn(Point2 a, Point2 b, Point2 c) -> int {
  const double l = (b.x - a.x) * (c.y - a.y), r = (b.y - a.y) * (c.x - a.x), det = l - r;
  if (std::abs(det) <= sure_turn_error * (std::abs(l) + std::abs(r)) || std::abs(det) < sure_no_underflow) return 0;
  return det > 0 ? 1 : -1;
}

/// Which corners of s are no corners of t.
auto unshared(const Corners& s, const Corners& t) -> std::array<bool, 3> {
  std::array<bool, 3> own{};
  for (std::size_t i = 0; i < 3; ++i) own[i] = s[i] != t[0] && s[i] != t[1] && s[i] != t[2];
  return own;
}

auto all_on_one_side(const Triangle& s, const std::array<bool, 3>& own, const Triangle& t) -> bool {
  int side = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!own[i]) continue;
    const int here = sure_side(t, s.at[i]);
    if (here == 0 || here == -side) return false;
    side = here;
  }
  return true;
}

/// Whether the line through a side of `base` surely parts the two, seen along an axis: its third corner on one side,
/// everything of `other` that is not shared on the other. A shared corner must be on the line.
auto parted_by_a_side(const Triangle& base, const std::array<bool, 3>& own_base, const Triangle& other,
                      const std::array<bool, 3>& own_other, int axis) -> bool {
  const auto seen = [axis](Point3 p) {
    return axis == 2 ? Point2{p.x, p.y} : (axis == 0 ? Point2{p.y, p.z} : Point2{p.z, p.x});
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    if (!own_base[k]) continue;
    const Point2 a = seen(base.at[i]), b = seen(base.at[j]);
    const int inner = sure_turn(a, b, seen(base.at[k]));
    if (inner == 0) continue;
    bool parted = true;
    for (std::size_t v = 0; v < 3 && parted; ++v)
      if (own_other[v]) parted = sure_turn(a, b, seen(other.at[v])) == -inner;
    if (parted) return true;
  }
  return false;
}

auto main_axis(Point3 n) -> int {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  return z >= x && z >= y ? 2 : (x >= y ? 0 : 1);
}

/// Whether the two surely have nothing in common but the corners they share. Settles nearly every pair of a sound
/// solid; what it leaves open is decided exactly.
auto surely_apart(const Triangle& s, const Triangle& t) -> bool {
  const auto own_s = unshared(s.corners, t.corners), own_t = unshared(t.corners, s.corners);
  if (!own_s[0] && !own_s[1] && !own_s[2]) return false;
  if (all_on_one_side(s, own_s, t) || all_on_one_side(t, own_t, s)) return true;
  const int first = main_axis(t.normal), second = main_axis(s.normal);
  if (parted_by_a_side(t, own_t, s, own_s, first) || parted_by_a_side(s, own_s, t, own_t, first)) return true;
  return second != first &&
         (parted_by_a_side(t, own_t, s, own_s, second) || parted_by_a_side(s, own_s, t, own_t, second));
}

/// Finds pairs with overlapping boxes through a tree of boxes.
class Pairs {
 public:
  Pairs(const std::vector<Point3>& vertices, std::vector<Triangle> plates)
      : vertices_(vertices), plates_(std::move(plates)) {
    nodes_.reserve(plates_.size());
    if (!plates_.empty()) build(0, static_cast<std::uint32_t>(plates_.size()));
  }

  using Found = std::optional<std::pair<const Triangle*, const Triangle*>>;

  auto first() -> Found {
    if (!plates_.empty()) within(0);
    return found_;
  }

  /// Calls `visit` with every triangle whose box meets that from `least` to `most`, until it says that is enough.
  template <class Visit>
  auto each_in(Point3 least, Point3 most, Visit visit) const -> bool {
    std::vector<std::uint32_t> open;
    if (!plates_.empty()) open.push_back(0);
    const Span box{least, most};
    while (!open.empty()) {
      const std::uint32_t n = open.back();
      open.pop_back();
      const Node& node = nodes_[n];
      if (!overlap(node, box)) continue;
      if (node.right != 0) {
        open.push_back(node.right);
        open.push_back(n + 1);
        continue;
      }
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        if (overlap(plates_[i], box) && visit(plates_[i])) return true;
    }
    return false;
  }
  [[nodiscard]] auto bounds() const -> std::pair<Point3, Point3> { return {nodes_[0].least, nodes_[0].most}; }

 private:
  struct Span {
    Point3 least, most;
  };
  struct Node {
    Point3 least, most;
    std::uint32_t begin, end;
    std::uint32_t right;  ///< child; the left one comes next; 0 for a leaf
  };

  auto build(std::uint32_t begin, std::uint32_t end) -> std::uint32_t {
    constexpr std::uint32_t leaf = 4;
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node node{plates_[begin].least, plates_[begin].most, begin, end, 0};
    for (std::uint32_t i = begin + 1; i < end; ++i) {
      const Triangle& p = plates_[i];
      node.least = {std::min(node.least.x, p.least.x), std::min(node.least.y, p.least.y),
                    std::min(node.least.z, p.least.z)};
      node.most = {std::max(node.most.x, p.most.x), std::max(node.most.y, p.most.y), std::max(node.most.z, p.most.z)};
    }
    nodes_.push_back(node);
    if (end - begin <= leaf) return index;
    const Point3 size = node.most - node.least;
    const auto middle = [&](const Triangle& p) {
      const Point3 m = p.least + p.most;
      return size.x >= size.y && size.x >= size.z ? m.x : (size.y >= size.z ? m.y : m.z);
    };
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(plates_.begin() + begin, plates_.begin() + half, plates_.begin() + end,
                     [&](const Triangle& a, const Triangle& b) {
                       const double p = middle(a), q = middle(b);
                       return p != q ? p < q : a.index < b.index;
                     });
    build(begin, half);
    const std::uint32_t right = build(half, end);
    nodes_[index].right = right;
    return index;
  }

  template <class Box, class Other>
  static auto overlap(const Box& p, const Other& q) -> bool {
    return p.least.x <= q.most.x && q.least.x <= p.most.x && p.least.y <= q.most.y && q.least.y <= p.most.y &&
           p.least.z <= q.most.z && q.least.z <= p.most.z;
  }

  void ask(const Triangle& s, const Triangle& t) {
    if (s.face == t.face || !overlap(s, t) || surely_apart(s, t)) return;
    if (intersect(vertices_, s.corners, t.corners)) found_ = std::pair(&s, &t);
  }

  void within(std::uint32_t n) {
    const Node& node = nodes_[n];
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end && !found_; ++i)
        for (std::uint32_t j = i + 1; j < node.end && !found_; ++j) ask(plates_[i], plates_[j]);
      return;
    }
    within(n + 1);
    if (!found_) within(node.right);
    if (!found_) between(n + 1, node.right);
  }

  void between(std::uint32_t a, std::uint32_t b) {
    const Node &p = nodes_[a], &q = nodes_[b];
    if (found_ || !overlap(p, q)) return;
    if (p.right == 0 && q.right == 0) {
      for (std::uint32_t i = p.begin; i < p.end; ++i)
        if (overlap(plates_[i], q))
          for (std::uint32_t j = q.begin; j < q.end && !found_; ++j) ask(plates_[i], plates_[j]);
      return;
    }
    const bool split_first = q.right == 0 || (p.right != 0 && p.end - p.begin >= q.end - q.begin);
    if (split_first) {
      between(a + 1, b);
      between(p.right, b);
    } else {
      between(a, b + 1);
      between(a, q.right);
    }
  }

  const std::vector<Point3>& vertices_;
  std::vector<Triangle> plates_;
  std::vector<Node> nodes_;
  Found found_;
};

/// A large face at one height exactly, such as the ground floor: what stands on it or hangs below it meets it in its
/// own corners and edges, and no triangle of it needs to be looked at.
class Level {
 public:
  Level(const std::vector<Point3>& vertices, const model::Face& face, std::vector<Triangle> plates)
      : vertices_(vertices), pairs_(vertices, std::move(plates)) {
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) edges_.emplace_back(loop[i], loop[(i + 1) % loop.size()]);
    std::ranges::sort(edges_);
  }

  static auto is_level(const std::vector<Point3>& vertices, const model::Face& face) -> bool {
    const double z = vertices[face.loops[0][0]].z;
    return std::ranges::all_of(face.loops, [&](const auto& loop) {
      return std::ranges::all_of(loop, [&](std::uint32_t v) { return vertices[v].z == z; });
    });
  }

  auto first_with(const Pairs& others) -> Pairs::Found {
    const auto [least, most] = pairs_.bounds();
    others.each_in(least, most, [&](const Triangle& t) { return !stands_on(t) && meets(t); });
    return found_;
  }
  auto first_with(const Level& other) -> Pairs::Found {
    const auto [least, most] = pairs_.bounds();
    other.pairs_.each_in(least, most, [&](const Triangle& t) { return meets(t); });
    return found_;
  }

 private:
  /// On one side of the height, but for a corner or an edge of this face.
  [[nodiscard]] auto stands_on(const Triangle& t) const -> bool {
    const double z = pairs_.bounds().first.z;
    if (t.least.z < z && t.most.z > z) return false;
    std::array<std::uint32_t, 3> here{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (t.at[i].z == z) here[count++] = t.corners[i];
    const auto has = [&](std::uint32_t a, std::uint32_t b) {
      return std::ranges::binary_search(edges_, std::pair(a, b));
    };
    if (count == 1) {
      const auto found = std::ranges::lower_bound(edges_, std::pair(here[0], 0U));
      return found != edges_.end() && found->first == here[0];
    }
    return count == 2 && (has(here[0], here[1]) || has(here[1], here[0]));
  }

  auto meets(const Triangle& t) -> bool {
    return pairs_.each_in(t.least, t.most, [&](const Triangle& own) {
      if (surely_apart(own, t) || !intersect(vertices_, own.corners, t.corners)) return false;
      found_ = std::pair(&own, &t);
      return true;
    });
  }

  const std::vector<Point3>& vertices_;
  Pairs pairs_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
  Pairs::Found found_;
};

}  // namespace

auto first_intersection(const model::Solid& solid, const std::vector<Corners>& triangles,
                        const std::vector<std::uint32_t>& face_of) -> std::array<std::size_t, 2> {
  constexpr std::size_t large = 64;
  std::vector<Triangle> plates;
  std::vector<Level> levels;
  plates.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size();) {
    const std::uint32_t face = face_of[i];
    std::uint32_t end = i;
    while (end < triangles.size() && face_of[end] == face) ++end;
    const bool apart = end - i >= large && Level::is_level(solid.vertices, solid.faces[face]);
    std::vector<Triangle> own;
    for (auto& list = apart ? own : plates; i < end; ++i)
      list.push_back(plate_of(solid.vertices, triangles[i], face, i));
    if (apart) levels.emplace_back(solid.vertices, solid.faces[face], std::move(own));
  }
  Pairs pairs(solid.vertices, std::move(plates));
  auto found = pairs.first();
  for (std::size_t i = 0; i < levels.size() && !found; ++i) {
    found = levels[i].first_with(pairs);
    for (std::size_t j = i + 1; j < levels.size() && !found; ++j) found = levels[i].first_with(levels[j]);
  }
  if (!found) return {triangles.size(), triangles.size()};
  return {std::min(found->first->index, found->second->index), std::max(found->first->index, found->second->index)};
}

}  // namespace mansard::solid::detail
