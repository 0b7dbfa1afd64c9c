#include "mansard/solid/triangulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "mansard/geometry/polygon.hpp"
#include "mansard/geometry/predicates.hpp"
#include "mansard/solid/detail/measure.hpp"

namespace mansard::solid {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr std::uint32_t none = UINT32_MAX;

/// Error bound on a comparison of two qualities: a dozen products and a quotient of numbers exact to 2⁻⁵³ are within
/// 1e-14. Without it two diagonals that are as good would be flipped to and fro; 1e-9 of a squared sine is no better
/// triangle.
constexpr double clearly_better = 1 + 1e-9;

auto along(Point2 p, int axis) -> double { return axis == 0 ? p.x : p.y; }

auto in_triangle(Point2 a, Point2 b, Point2 c, Point2 p) -> bool {
  return detail::turn(a, b, p) >= 0 && detail::turn(b, c, p) >= 0 && detail::turn(c, a, p) >= 0;
}

}  // namespace

auto Triangulator::append(const model::Face& face, Point3 area, std::vector<Corners>& out) -> bool {
  lay_out(face, area);
  if (face.loops.size() == 1 && corners_.size() <= 4 && halve(out)) return true;
  if (face.loops.size() > 1 || !is_convex()) {
    if (!is_simple()) return false;
    if (face.loops.size() > 1 && !(holes_lie_inside() && bridge_holes())) return false;
  }
  if (!clip_ears()) return false;
  flip_diagonals();
  for (const Triangle& t : triangles_)
    out.push_back({corners_[t.corner[0]].vertex, corners_[t.corner[1]].vertex, corners_[t.corner[2]].vertex});
  return true;
}

void Triangulator::lay_out(const model::Face& face, Point3 n) {
  corners_.clear();
  first_.clear();
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const int axis = z >= x && z >= y ? 2 : (x >= y ? 0 : 1);
  const bool away = (axis == 2 ? n.z : (axis == 0 ? n.x : n.y)) > 0;
  for (const auto& loop : face.loops) {
    const auto first = static_cast<std::uint32_t>(corners_.size()), size = static_cast<std::uint32_t>(loop.size());
    first_.push_back(first);
    for (std::uint32_t i = 0; i < size; ++i) {
      const Point3 p = solid_.vertices[loop[i]];
      const Point2 q = axis == 2 ? Point2{p.x, p.y} : (axis == 0 ? Point2{p.y, p.z} : Point2{p.z, p.x});
      corners_.push_back(
          {away ? q : Point2{q.y, q.x}, loop[i], first + (i + size - 1) % size, first + (i + 1) % size, none, false});
    }
  }
  first_.push_back(static_cast<std::uint32_t>(corners_.size()));
}

auto Triangulator::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const -> int {
  return detail::turn(corners_[a].at, corners_[b].at, corners_[c].at);
}

/// Three or four corners; of the two diagonals the one whose lesser triangle is larger, so that corners on a straight
/// side make no slivers.
auto Triangulator::halve(std::vector<Corners>& out) const -> bool {
  const auto& c = corners_;
  if (c.size() == 3) {
    if (turn(0, 1, 2) <= 0) return false;
    out.push_back({c[0].vertex, c[1].vertex, c[2].vertex});
    return true;
  }
  const auto lesser = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
    if (turn(p, q, r) <= 0 || turn(p, r, s) <= 0) return 0.0;
    return std::min(cross(c[q].at - c[p].at, c[r].at - c[p].at), cross(c[r].at - c[p].at, c[s].at - c[p].at));
  };
  const double first = lesser(0, 1, 2, 3), second = lesser(1, 2, 3, 0);
  if (first > 0 && first >= second) {
    out.push_back({c[0].vertex, c[1].vertex, c[2].vertex});
    out.push_back({c[0].vertex, c[2].vertex, c[3].vertex});
  } else if (second > 0) {
    out.push_back({c[1].vertex, c[2].vertex, c[3].vertex});
    out.push_back({c[1].vertex, c[3].vertex, c[0].vertex});
  }
  return first > 0 || second > 0;
}

/// Once round to the left without a fold: then the boundary crosses nowhere.
auto Triangulator::is_convex() const -> bool {
  std::size_t lowest = 0;
  for (std::uint32_t v = 0; v < corners_.size(); ++v) {
    const Corner& c = corners_[v];
    const Point2 a = corners_[c.prev].at, b = corners_[c.next].at;
    const int left = turn(c.prev, v, c.next);
    if (left < 0 || (left == 0 && dot(c.at - a, b - c.at) <= 0)) return false;
    if (c.at < a && c.at < b) ++lowest;
  }
  return lowest == 1;
}

/// Whether no two edges of all loops meet but at a vertex they share by its number, nor lie on each other there.
auto Triangulator::is_simple() -> bool {
  geometry::Box2 box;
  for (const Corner& c : corners_) box.add(c.at);
  long_axis_ = box.most.x - box.least.x >= box.most.y - box.least.y ? 0 : 1;
  const auto low = [&](std::uint32_t e, int axis) {
    return std::min(along(corners_[e].at, axis), along(corners_[corners_[e].next].at, axis));
  };
  const auto high = [&](std::uint32_t e, int axis) {
    return std::max(along(corners_[e].at, axis), along(corners_[corners_[e].next].at, axis));
  };
  order_.resize(corners_.size());
  for (std::uint32_t e = 0; e < order_.size(); ++e) order_[e] = e;
  std::ranges::sort(order_, [&](std::uint32_t a, std::uint32_t b) {
    const double p = low(a, long_axis_), q = low(b, long_axis_);
    return p != q ? p < q : a < b;
  });
  const auto apart = [&](std::uint32_t e, std::uint32_t f) {
    const Corner &a = corners_[e], &b = corners_[a.next], &c = corners_[f], &d = corners_[c.next];
    if (a.vertex == d.vertex && b.vertex == c.vertex) return false;
    if (a.vertex == c.vertex && b.vertex == d.vertex) return false;
    // From a common vertex they must not leave in one direction.
    const auto fan = [](const Corner& from, const Corner& to, const Corner& other) {
      return detail::turn(from.at, to.at, other.at) != 0 || dot(to.at - from.at, other.at - from.at) < 0;
    };
    if (a.vertex == c.vertex) return fan(a, b, d);
    if (a.vertex == d.vertex) return fan(a, b, c);
    if (b.vertex == c.vertex) return fan(b, a, d);
    if (b.vertex == d.vertex) return fan(b, a, c);
    return !geometry::meet({a.at, b.at}, {c.at, d.at});
  };
  const int across = 1 - long_axis_;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const std::uint32_t e = order_[i];
    if (corners_[e].at == corners_[corners_[e].next].at) return false;
    const double end = high(e, long_axis_), least = low(e, across), most = high(e, across);
    for (std::size_t j = i + 1; j < order_.size() && low(order_[j], long_axis_) <= end; ++j) {
      const std::uint32_t f = order_[j];
      if (low(f, across) <= most && high(f, across) >= least && !apart(e, f)) return false;
    }
  }
  return true;
}

/// Every hole clockwise, in the outer loop and in no other hole, decided at a corner that it does not share.
auto Triangulator::holes_lie_inside() const -> bool {
  std::vector<geometry::Ring> rings;
  std::vector<std::vector<std::uint32_t>> vertices;
  std::vector<geometry::Box2> boxes;
  for (std::size_t l = 0; l + 1 < first_.size(); ++l) {
    rings.emplace_back();
    vertices.emplace_back();
    for (std::uint32_t v = first_[l]; v < first_[l + 1]; ++v) {
      rings.back().push_back(corners_[v].at);
      vertices.back().push_back(corners_[v].vertex);
    }
    if ((geometry::signed_area(rings.back()) > 0) != (l == 0)) return false;
    std::ranges::sort(vertices.back());
    boxes.push_back(geometry::Box2::of(rings.back()));
  }
  const auto within = [&](std::size_t inner, std::size_t outer) {
    if (!boxes[outer].contains(rings[inner].front())) return false;  // nor is it shared
    for (std::uint32_t v = first_[inner]; v < first_[inner + 1]; ++v)
      if (!std::ranges::binary_search(vertices[outer], corners_[v].vertex))
        return geometry::contains(rings[outer], corners_[v].at);
    return outer == 0;  // all corners shared
  };
  for (std::size_t h = 1; h < rings.size(); ++h) {
    if (!within(h, 0)) return false;
    for (std::size_t k = 1; k < rings.size(); ++k)
      if (k != h && within(h, k)) return false;
  }
  return true;
}

/// Corners and edges of a face in square cells, about as many as corners, so that what is near is found without going
/// through all.
class Triangulator::Near {
 public:
  Near(const geometry::Box2& box, std::size_t corners) : least_(box.least) {
    const double width = box.most.x - box.least.x, height = box.most.y - box.least.y;
    side_ = std::max(std::sqrt(width * height / static_cast<double>(corners)),
                     std::max(width, height) / static_cast<double>(corners));
    columns_ = static_cast<std::size_t>(width / side_) + 1;
    rows_ = static_cast<std::size_t>(height / side_) + 1;
    corners_.resize(columns_ * rows_);
    edges_.resize(columns_ * rows_);
    farthest_ = 2 * (width + height);
  }

  void add_corner(Point2 at, std::uint32_t corner) {
    corners_[column(at.x) + row(at.y) * columns_].push_back({at, corner});
  }
  /// From the vertex `a` to `b`.
  void add_edge(const geometry::Segment2& edge, std::uint32_t a, std::uint32_t b) {
    constexpr std::size_t many = 64;  // cells: the few that are longer are looked at always
    const auto box = geometry::Box2::of(edge);
    const std::size_t x0 = column(box.least.x), x1 = column(box.most.x), y0 = row(box.least.y), y1 = row(box.most.y);
    if ((x1 - x0 + 1) * (y1 - y0 + 1) > many) return long_.push_back({edge, box, a, b});
    for (std::size_t y = y0; y <= y1; ++y)
      for (std::size_t x = x0; x <= x1; ++x) edges_[x + y * columns_].push_back({edge, box, a, b});
  }

  /// The nearest corner that is wanted, of those equally near the one with the smallest number; `none` for none.
  template <class Wanted>
  [[nodiscard]] auto nearest(Point2 at, const Wanted& wanted) const -> std::uint32_t {
    std::vector<std::pair<double, std::uint32_t>> found;
    double before = -1;
    for (double reach = side_; before < farthest_; before = reach, reach *= 2) {
      found.clear();
      const double with_rounding = 1.001 * reach;
      for (std::size_t y = row(at.y - with_rounding); y <= row(at.y + with_rounding); ++y)
        for (std::size_t x = column(at.x - with_rounding); x <= column(at.x + with_rounding); ++x)
          for (const auto& [place, corner] : corners_[x + y * columns_])
            if (const double d = length(place - at); d > before && d <= reach) found.emplace_back(d, corner);
      std::ranges::sort(found);
      for (const auto& [d, corner] : found)
        if (wanted(corner)) return corner;
    }
    return none;
  }

  /// Whether an edge that ends at neither vertex meets the sight.
  [[nodiscard]] auto blocks(const geometry::Segment2& sight, std::uint32_t a, std::uint32_t b) const -> bool {
    const auto box = geometry::Box2::of(sight);
    const auto meets = [&](const Edge& edge) {
      if (edge.a == a || edge.a == b || edge.b == a || edge.b == b) return false;
      return box.overlaps(edge.box) && geometry::meet(sight, edge.edge);
    };
    if (std::ranges::any_of(long_, meets)) return true;
    for (std::size_t y = row(box.least.y); y <= row(box.most.y); ++y)
      for (std::size_t x = column(box.least.x); x <= column(box.most.x); ++x)
        if (std::ranges::any_of(edges_[x + y * columns_], meets)) return true;
    return false;
  }

 private:
  struct Edge {
    geometry::Segment2 edge;
    geometry::Box2 box;
    std::uint32_t a, b;
  };
  [[nodiscard]] auto index(double off, std::size_t count) const -> std::size_t {
    return static_cast<std::size_t>(std::clamp(off / side_, 0.0, static_cast<double>(count - 1)));
  }
  [[nodiscard]] auto column(double x) const -> std::size_t { return index(x - least_.x, columns_); }
  [[nodiscard]] auto row(double y) const -> std::size_t { return index(y - least_.y, rows_); }

  Point2 least_;
  double side_ = 1, farthest_ = 0;
  std::size_t columns_ = 1, rows_ = 1;
  std::vector<std::vector<std::pair<Point2, std::uint32_t>>> corners_;
  std::vector<std::vector<Edge>> edges_;
  std::vector<Edge> long_;
};

/// Makes one loop of all: each hole, from the left, is tied by a double edge from its leftmost corner to the nearest
/// corner that it sees of what is already tied. A hole that shares a vertex is tied there.
auto Triangulator::bridge_holes() -> bool {
  struct Hole {
    Point2 at;
    std::uint32_t corner, loop;
  };
  std::vector<Hole> holes;
  for (std::uint32_t l = 1; l + 1 < first_.size(); ++l) {
    std::uint32_t least = first_[l];
    for (std::uint32_t v = first_[l]; v < first_[l + 1]; ++v)
      if (corners_[v].at < corners_[least].at) least = v;
    holes.push_back({corners_[least].at, least, l});
  }
  std::ranges::sort(holes, [](const Hole& a, const Hole& b) { return a.at != b.at ? a.at < b.at : a.loop < b.loop; });

  geometry::Box2 box;
  for (const Corner& c : corners_) box.add(c.at);
  Near near(box, corners_.size());
  for (const Corner& c : corners_) near.add_edge({c.at, corners_[c.next].at}, c.vertex, corners_[c.next].vertex);
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> tied;  // corners of the one loop, by vertex
  const auto tie = [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t v = from; v < to; ++v) {
      tied[corners_[v].vertex].push_back(v);
      near.add_corner(corners_[v].at, v);
    }
  };
  tie(0, first_[1]);
  for (const Hole& hole : holes) {
    std::uint32_t from = none, to = none;
    for (std::uint32_t v = first_[hole.loop]; v < first_[hole.loop + 1] && to == none; ++v)
      if (const auto same = tied.find(corners_[v].vertex); same != tied.end())
        for (const std::uint32_t t : same->second)
          if (opens_towards(t, corners_[corners_[v].next].at)) {
            from = v;
            to = t;
            break;
          }
    if (to == none) {
      from = hole.corner;
      to = near.nearest(corners_[from].at, [&](std::uint32_t t) { return sees(from, t, near); });
    }
    if (to == none) return false;
    const auto before = static_cast<std::uint32_t>(corners_.size());
    bridge(from, to);
    tie(first_[hole.loop], first_[hole.loop + 1]);
    tie(before, static_cast<std::uint32_t>(corners_.size()));
    if (corners_[from].vertex != corners_[to].vertex)
      near.add_edge({corners_[from].at, corners_[to].at}, corners_[from].vertex, corners_[to].vertex);
  }
  return true;
}

/// Whether corner b lies in the wedge of the interior at a, and no edge of any loop lies between.
auto Triangulator::sees(std::uint32_t a, std::uint32_t b, const Near& near) const -> bool {
  if (!opens_towards(a, corners_[b].at) || !opens_towards(b, corners_[a].at)) return false;
  return !near.blocks({corners_[a].at, corners_[b].at}, corners_[a].vertex, corners_[b].vertex);
}

auto Triangulator::opens_towards(std::uint32_t v, Point2 q) const -> bool {
  const Point2 at = corners_[v].at, out = corners_[corners_[v].next].at, in = corners_[corners_[v].prev].at;
  if (detail::turn(in, at, out) > 0) return detail::turn(at, out, q) > 0 && detail::turn(at, q, in) > 0;
  return !(detail::turn(at, in, q) >= 0 && detail::turn(at, q, out) >= 0);
}

/// Ties the loop of `from` to that of `to`: along a double edge, or in the vertex that both share.
void Triangulator::bridge(std::uint32_t from, std::uint32_t to) {
  const std::uint32_t last = corners_[from].prev, after = corners_[to].next;
  if (corners_[from].vertex == corners_[to].vertex) {
    const std::uint32_t second = corners_[from].next;
    corners_[to].next = second;
    corners_[second].prev = to;
    corners_[from].next = after;
    corners_[after].prev = from;
    return;
  }
  const auto back = static_cast<std::uint32_t>(corners_.size()), home = back + 1;
  corners_.push_back({corners_[from].at, corners_[from].vertex, last, home, none, false});
  corners_.push_back({corners_[to].at, corners_[to].vertex, back, after, none, false});
  corners_[to].next = from;
  corners_[from].prev = to;
  corners_[last].next = back;
  corners_[after].prev = home;
}

/// Corners that are not convex are the only ones that can lie in an ear.
void Triangulator::gather_reflex() {
  reflex_.clear();
  dead_ = 0;
  for (std::uint32_t v = 0; v < corners_.size(); ++v) {
    corners_[v].reflex = turn(corners_[v].prev, v, corners_[v].next) <= 0;
    if (corners_[v].reflex) reflex_.push_back(v);
  }
  std::ranges::sort(reflex_, [&](std::uint32_t a, std::uint32_t b) {
    const double p = along(corners_[a].at, long_axis_), q = along(corners_[b].at, long_axis_);
    return p != q ? p < q : a < b;
  });
}

auto Triangulator::is_ear(std::uint32_t v) const -> bool {
  const Corner &b = corners_[v], &a = corners_[b.prev], &c = corners_[b.next];
  if (b.reflex) return false;
  const auto box = geometry::Box2::of(std::array{a.at, b.at, c.at});
  const auto from = std::ranges::lower_bound(reflex_, along(box.least, long_axis_), {},
                                             [&](std::uint32_t u) { return along(corners_[u].at, long_axis_); });
  const double end = along(box.most, long_axis_);
  for (auto i = from; i != reflex_.end() && along(corners_[*i].at, long_axis_) <= end; ++i) {
    const Corner& u = corners_[*i];
    if (!u.reflex || !box.contains(u.at)) continue;
    if (u.vertex == a.vertex || u.vertex == b.vertex || u.vertex == c.vertex) continue;
    if (in_triangle(a.at, b.at, c.at, u.at)) return false;
  }
  return true;
}

/// The squared sine of the least angle.
auto Triangulator::quality(std::uint32_t a, std::uint32_t b, std::uint32_t c) const -> double {
  const Point2 p = corners_[b].at - corners_[a].at, q = corners_[c].at - corners_[b].at,
               r = corners_[a].at - corners_[c].at;
  const double l = dot(p, p), m = dot(q, q), n = dot(r, r), twice = cross(p, q);
  return twice * twice * std::min({l, m, n}) / (l * m * n);
}

/// Takes corner v off the loop, and what it cuts off becomes a triangle.
void Triangulator::cut(std::uint32_t v) {
  const std::uint32_t a = corners_[v].prev, c = corners_[v].next;
  const auto t = static_cast<std::uint32_t>(triangles_.size());
  triangles_.push_back({{a, v, c}, {corners_[a].beyond, corners_[v].beyond, none}});
  for (std::uint32_t i = 0; i < 2; ++i)
    if (const std::uint32_t other = triangles_[t].beyond[i]; other != none)
      triangles_[other / 3].beyond[other % 3] = 3 * t + i;
  corners_[a].next = c;
  corners_[a].beyond = 3 * t + 2;
  corners_[c].prev = a;
  for (const std::uint32_t u : {a, c})
    if (corners_[u].reflex && turn(corners_[u].prev, u, corners_[u].next) > 0) {
      corners_[u].reflex = false;
      ++dead_;
    }
  if (2 * dead_ > reflex_.size()) {
    std::erase_if(reflex_, [&](std::uint32_t u) { return !corners_[u].reflex; });
    dead_ = 0;
  }
}

/// Ears off one after the other all round; needles only when there is nothing else.
auto Triangulator::clip_ears() -> bool {
  constexpr double needle = 1e-12;  // a millionth of a radian, squared
  triangles_.clear();
  gather_reflex();
  std::size_t left = corners_.size(), tried = 0;
  for (std::uint32_t v = 0; left > 3;) {
    const bool last_resort = tried >= left;
    const Corner& c = corners_[v];
    if (!c.reflex && (last_resort || quality(c.prev, v, c.next) > needle) && is_ear(v)) {
      const std::uint32_t next = c.next;
      cut(v);
      v = next;
      --left;
      tried = 0;
    } else if (++tried >= 2 * left) {
      return false;
    }
    at_ = v;
    v = corners_[v].next;
  }
  const std::uint32_t v = corners_[at_].next, a = corners_[v].prev, c = corners_[v].next;
  if (turn(a, v, c) <= 0) return false;
  cut(v);
  if (const std::uint32_t other = corners_[c].beyond; other != none) {
    const auto t = static_cast<std::uint32_t>(triangles_.size() - 1);
    triangles_[t].beyond[2] = other;
    triangles_[other / 3].beyond[other % 3] = 3 * t + 2;
  }
  return true;
}

/// Turns a diagonal where that makes the least angle on its two sides larger (a Delaunay triangulation, but for the
/// face's own edges).
void Triangulator::flip_diagonals() {
  open_.clear();
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i)
      if (const std::uint32_t other = triangles_[t].beyond[i]; other != none && 3 * t + i < other)
        open_.push_back(3 * t + i);
  const auto link = [&](std::uint32_t half, std::uint32_t other) {
    triangles_[half / 3].beyond[half % 3] = other;
    if (other != none) triangles_[other / 3].beyond[other % 3] = half;
  };
  for (std::size_t flips = 0, most = 32 * triangles_.size(); !open_.empty() && flips < most;) {
    const std::uint32_t half = open_.back();
    open_.pop_back();
    const std::uint32_t t = half / 3, i = half % 3;
    const std::uint32_t other = triangles_[t].beyond[i];
    if (other == none) continue;
    const std::uint32_t u = other / 3, j = other % 3;
    const Triangle p = triangles_[t], q = triangles_[u];
    const std::uint32_t a = p.corner[i], b = p.corner[(i + 1) % 3], c = p.corner[(i + 2) % 3],
                        d = q.corner[(j + 2) % 3];
    const double before = std::min(quality(a, b, c), quality(b, a, d));
    const double after = std::min(quality(c, a, d), quality(d, b, c));
    if (after <= before * clearly_better || turn(c, a, d) <= 0 || turn(d, b, c) <= 0) continue;
    triangles_[t].corner = {c, a, d};
    triangles_[u].corner = {d, b, c};
    link(3 * t, p.beyond[(i + 2) % 3]);
    link(3 * t + 1, q.beyond[(j + 1) % 3]);
    link(3 * u, q.beyond[(j + 2) % 3]);
    link(3 * u + 1, p.beyond[(i + 1) % 3]);
    link(3 * t + 2, 3 * u + 2);
    for (const std::uint32_t next : {3 * t, 3 * t + 1, 3 * u, 3 * u + 1}) open_.push_back(next);
    ++flips;
  }
}

}  // namespace mansard::solid
