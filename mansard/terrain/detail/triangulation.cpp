#include "mansard/terrain/detail/triangulation.hpp"

#include <algorithm>
#include <deque>

namespace mansard::terrain::detail {
namespace {

__extension__ typedef __int128 Int128;

constexpr auto next(int i) -> int { return i == 2 ? 0 : i + 1; }
constexpr auto before(int i) -> int { return i == 0 ? 2 : i - 1; }

auto corner_of(const Triangulation::Triangle& t, std::uint32_t v) -> int {
  for (int i = 0; i < 3; ++i)
    if (t.corner[i] == v) return i;
  return -1;
}

}  // namespace

Triangulation::Triangulation(Site least, Site most) {
  sites_ = {least, {most.x, least.y}, most, {least.x, most.y}};
  triangles_ = {{{0, 1, 2}, {none, 1, none}, {}}, {{0, 2, 3}, {none, none, 0}, {}}};
  at_ = {0, 0, 0, 1};
}

auto Triangulation::locate(Site p, std::uint32_t from) const -> Place {
  const auto look = [&](std::uint32_t t) -> Place {
    const auto& c = triangles_[t].corner;
    for (int i = 0; i < 3; ++i)
      if (sites_[c[i]] == p) return {Place::On::vertex, t, i};
    for (int i = 0; i < 3; ++i)
      if (twice_area(sites_[c[next(i)]], sites_[c[before(i)]], p) == 0) return {Place::On::edge, t, i};
    return {Place::On::inside, t, 0};
  };
  // Towards the site from triangle to triangle. With fixed edges that may go in circles, so the number of steps is
  // bounded, and then every triangle is tried.
  std::uint32_t t = from, last = none;
  for (std::size_t steps = 0; steps < triangles_.size() + 3; ++steps) {
    const auto& c = triangles_[t].corner;
    int out = -1;
    for (int k = 0; k < 3 && out < 0; ++k) {
      const int i = static_cast<int>((static_cast<std::size_t>(k) + steps) % 3);
      if (triangles_[t].beyond[i] != none && triangles_[t].beyond[i] != last &&
          twice_area(sites_[c[next(i)]], sites_[c[before(i)]], p) < 0)
        out = i;
    }
    if (out < 0) {
      bool here = true;
      for (int i = 0; i < 3; ++i) here = here && twice_area(sites_[c[next(i)]], sites_[c[before(i)]], p) >= 0;
      if (here) return look(t);
      break;
    }
    last = t;
    t = triangles_[t].beyond[out];
  }
  for (t = 0; t < triangles_.size(); ++t) {
    const auto& c = triangles_[t].corner;
    bool here = true;
    for (int i = 0; i < 3; ++i) here = here && twice_area(sites_[c[next(i)]], sites_[c[before(i)]], p) >= 0;
    if (here) return look(t);
  }
  return {Place::On::inside, none, 0};
}

/// On triangle t, what is beyond its edge `side` becomes `other`; and there, what was `instead_of` becomes t.
void Triangulation::link(std::uint32_t t, int side, std::uint32_t other, std::uint32_t instead_of) {
  triangles_[t].beyond[side] = other;
  if (other == none) return;
  for (auto& back : triangles_[other].beyond)
    if (back == instead_of) {
      back = t;
      return;
    }
}

auto Triangulation::in_circle(std::uint32_t t, std::uint32_t v) const -> bool {
  const auto& c = triangles_[t].corner;
  const Site d = sites_[v];
  const auto of = [&](int i) { return Site{sites_[c[i]].x - d.x, sites_[c[i]].y - d.y}; };
  const Site p = of(0), q = of(1), r = of(2);
  const auto lift = [](Site s) { return static_cast<Int128>(s.x) * s.x + static_cast<Int128>(s.y) * s.y; };
  const auto minor = [](Site s, Site u) { return static_cast<Int128>(s.x) * u.y - static_cast<Int128>(s.y) * u.x; };
  return lift(p) * minor(q, r) + lift(q) * minor(r, p) + lift(r) * minor(p, q) > 0;
}

/// Turns the diagonal of the two triangles at edge `side` of t. Afterwards t and its neighbour keep their numbers.
void Triangulation::flip(std::uint32_t t, int side) {
  const std::uint32_t u = triangles_[t].beyond[side];
  const Triangle a = triangles_[t], b = triangles_[u];
  int other = 0;
  while (b.beyond[other] != t) ++other;
  const std::uint32_t p = a.corner[side], q = a.corner[next(side)], r = a.corner[before(side)], s = b.corner[other];
  // a = p q r, b = s r q; now t = p q s and u = p s r.
  triangles_[t] = {{p, q, s}, {none, u, none}, {b.fixed[next(other)], false, a.fixed[before(side)]}};
  triangles_[u] = {{p, s, r}, {none, none, t}, {b.fixed[before(other)], a.fixed[next(side)], false}};
  link(t, 0, b.beyond[next(other)], u);
  link(t, 2, a.beyond[before(side)], t);
  link(u, 0, b.beyond[before(other)], u);
  link(u, 1, a.beyond[next(side)], t);
  at_[p] = t;
  at_[q] = t;
  at_[s] = t;
  at_[r] = u;
}

/// C. L. Lawson, Software for C1 surface interpolation, 1977: flips until no edge is illegal. `open` are edges by a
/// triangle and the corner opposite.
void Triangulation::legalise(const std::vector<std::pair<std::uint32_t, int>>& open, const Touch& touch) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  // by their ends
  for (const auto& [t, side] : open)
    edges.emplace_back(triangles_[t].corner[next(side)], triangles_[t].corner[before(side)]);
  while (!edges.empty()) {
    const auto [q, r] = edges.back();
    edges.pop_back();
    const auto found = left_of(q, r);
    if (!found) continue;
    const auto [t, side] = *found;
    const std::uint32_t u = triangles_[t].beyond[side];
    if (u == none || triangles_[t].fixed[side]) continue;
    int other = 0;
    while (triangles_[u].beyond[other] != t) ++other;
    const std::uint32_t p = triangles_[t].corner[side], s = triangles_[u].corner[other];
    if (!in_circle(t, s)) continue;
    // A corner in the circle makes the quadrilateral convex, but for what only touches it.
    if (twice_area(sites_[p], sites_[q], sites_[s]) <= 0 || twice_area(sites_[p], sites_[s], sites_[r]) <= 0) continue;
    if (touch) touch(t), touch(u);
    flip(t, side);
    edges.emplace_back(q, s);
    edges.emplace_back(s, r);
    edges.emplace_back(p, q);
    edges.emplace_back(r, p);
  }
}

void Triangulation::split_triangle(std::uint32_t t, std::uint32_t v, const Touch& touch) {
  if (touch) touch(t);
  const Triangle old = triangles_[t];
  const auto u = static_cast<std::uint32_t>(triangles_.size()), w = u + 1;
  triangles_.resize(triangles_.size() + 2);
  const auto [a, b, c] = old.corner;
  triangles_[t] = {{v, b, c}, {old.beyond[0], u, w}, {old.fixed[0], false, false}};
  triangles_[u] = {{v, c, a}, {none, w, t}, {old.fixed[1], false, false}};
  triangles_[w] = {{v, a, b}, {none, t, u}, {old.fixed[2], false, false}};
  link(u, 0, old.beyond[1], t);
  link(w, 0, old.beyond[2], t);
  at_[v] = at_[b] = at_[c] = t;
  at_[a] = u;
  legalise({{t, 0}, {u, 0}, {w, 0}}, touch);
}

void Triangulation::split_edge(std::uint32_t t, int side, std::uint32_t v, const Touch& touch) {
  const std::uint32_t u = triangles_[t].beyond[side];
  if (touch) {
    touch(t);
    if (u != none) touch(u);
  }
  const Triangle a = triangles_[t];
  const bool fixed = a.fixed[side];
  const std::uint32_t p = a.corner[side], q = a.corner[next(side)], r = a.corner[before(side)];
  const auto t2 = static_cast<std::uint32_t>(triangles_.size());
  triangles_.emplace_back();
  // p q v stays t; p v r is new.
  triangles_[t] = {{p, q, v}, {none, t2, a.beyond[before(side)]}, {fixed, false, a.fixed[before(side)]}};
  triangles_[t2] = {{p, v, r}, {none, none, t}, {fixed, a.fixed[next(side)], false}};
  link(t2, 1, a.beyond[next(side)], t);
  at_[p] = at_[q] = at_[v] = t;
  at_[r] = t2;
  std::vector<std::pair<std::uint32_t, int>> open{{t, 2}, {t2, 1}};
  if (u != none) {
    const Triangle b = triangles_[u];
    int other = 0;
    while (b.beyond[other] != t) ++other;
    const std::uint32_t s = b.corner[other];  // b = s r q
    const auto u2 = static_cast<std::uint32_t>(triangles_.size());
    triangles_.emplace_back();
    // s r v stays u; s v q is new.
    triangles_[u] = {{s, r, v}, {t2, u2, b.beyond[before(other)]}, {fixed, false, b.fixed[before(other)]}};
    triangles_[u2] = {{s, v, q}, {t, none, u}, {fixed, b.fixed[next(other)], false}};
    link(u2, 1, b.beyond[next(other)], u);
    triangles_[t].beyond[0] = u2;
    triangles_[t2].beyond[0] = u;
    at_[s] = u;
    open.insert(open.end(), {{u, 2}, {u2, 1}});
  }
  legalise(open, touch);
}

auto Triangulation::insert(Site p, const Touch& touch) -> std::uint32_t {
  return insert(p, locate(p, at_.back()), touch);
}

auto Triangulation::insert(Site p, const Place& place, const Touch& touch) -> std::uint32_t {
  if (place.triangle == none) return none;
  if (place.on == Place::On::vertex) return triangles_[place.triangle].corner[place.index];
  const auto v = static_cast<std::uint32_t>(sites_.size());
  sites_.push_back(p);
  at_.push_back(place.triangle);
  if (place.on == Place::On::edge) split_edge(place.triangle, place.index, v, touch);
  else split_triangle(place.triangle, v, touch);
  return v;
}

auto Triangulation::around(std::uint32_t v) const -> std::vector<std::uint32_t> {
  // Clockwise to the border, or once round; then counter-clockwise.
  const std::uint32_t start = at_[v];
  std::uint32_t first = start;
  for (;;) {
    const int i = corner_of(triangles_[first], v);
    const std::uint32_t back = triangles_[first].beyond[before(i)];  // across the edge from v to the next corner
    if (back == none) break;
    first = back;
    if (first == start) break;
  }
  std::vector<std::uint32_t> out;
  for (std::uint32_t t = first; t != none;) {
    out.push_back(t);
    t = triangles_[t].beyond[next(corner_of(triangles_[t], v))];
    if (t == first) break;
  }
  return out;
}

auto Triangulation::left_of(std::uint32_t a, std::uint32_t b) const -> std::optional<std::pair<std::uint32_t, int>> {
  const auto is = [&](std::uint32_t t) { return triangles_[t].corner[next(corner_of(triangles_[t], a))] == b; };
  const std::uint32_t start = at_[a];
  // Both ways round, without a list: this is called for every edge that is looked at.
  for (std::uint32_t t = start; t != none;) {
    const int i = corner_of(triangles_[t], a);
    if (is(t)) return std::pair{t, before(i)};
    t = triangles_[t].beyond[next(i)];
    if (t == start) return std::nullopt;
  }
  for (std::uint32_t t = start; t != none;) {
    const int i = corner_of(triangles_[t], a);
    if (is(t)) return std::pair{t, before(i)};
    t = triangles_[t].beyond[before(i)];
  }
  return std::nullopt;
}

void Triangulation::set_fixed(std::uint32_t t, int side) {
  triangles_[t].fixed[side] = true;
  const std::uint32_t u = triangles_[t].beyond[side];
  if (u == none) return;
  for (int i = 0; i < 3; ++i)
    if (triangles_[u].beyond[i] == t) triangles_[u].fixed[i] = true;
}

auto Triangulation::fix(std::uint32_t a, std::uint32_t b) -> bool {
  while (a != b) {
    if (const auto there = left_of(a, b)) {
      set_fixed(there->first, there->second);
      return true;
    }
    if (const auto there = left_of(b, a)) {
      set_fixed(there->first, there->second);
      return true;
    }
    // The triangle at a that the segment leaves through, or a vertex on the segment beside a.
    const Site from = sites_[a], to = sites_[b];
    std::uint32_t t = none, stop = none;
    int side = 0;
    for (const std::uint32_t candidate : around(a)) {
      const int i = corner_of(triangles_[candidate], a);
      const std::uint32_t q = triangles_[candidate].corner[next(i)], r = triangles_[candidate].corner[before(i)];
      const auto right = twice_area(from, to, sites_[q]), left = twice_area(from, to, sites_[r]);
      for (const auto& [v, turn] : {std::pair{q, right}, std::pair{r, left}})
        if (turn == 0 && (sites_[v].x - from.x) * (to.x - from.x) + (sites_[v].y - from.y) * (to.y - from.y) > 0)
          stop = v;
      if (stop != none) break;
      if (right < 0 && left > 0) {
        t = candidate;
        side = i;
        break;
      }
    }
    if (stop != none) {
      const auto there = left_of(a, stop);
      if (there) set_fixed(there->first, there->second);
      else if (const auto other = left_of(stop, a)) set_fixed(other->first, other->second);
      a = stop;
      continue;
    }
    if (t == none) return false;
    // The edges that the segment crosses, up to b or the first vertex on it.
    std::deque<std::pair<std::uint32_t, std::uint32_t>> crossed;
    std::uint32_t end = b;
    for (;;) {
      if (triangles_[t].fixed[side] || triangles_[t].beyond[side] == none) return false;
      crossed.emplace_back(triangles_[t].corner[next(side)], triangles_[t].corner[before(side)]);
      const std::uint32_t u = triangles_[t].beyond[side];
      int other = 0;
      while (triangles_[u].beyond[other] != t) ++other;
      const std::uint32_t s = triangles_[u].corner[other];
      if (s == b) break;
      const auto turn = twice_area(from, to, sites_[s]);
      if (turn == 0) {
        end = s;
        break;
      }
      // u = s r q: on from the edge opposite the corner on s's side.
      side = turn > 0 ? next(other) : before(other);
      t = u;
    }
    // S. W. Sloan, A fast algorithm for generating constrained Delaunay triangulations, 1993.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> made;
    const Site stop_at = sites_[end];
    while (!crossed.empty()) {
      const auto [q, r] = crossed.front();
      crossed.pop_front();
      const auto found = left_of(q, r);
      if (!found) return false;
      const auto [one, corner] = *found;
      const std::uint32_t two = triangles_[one].beyond[corner];
      int other = 0;
      while (triangles_[two].beyond[other] != one) ++other;
      const std::uint32_t p = triangles_[one].corner[corner], s = triangles_[two].corner[other];
      const Site q_at = sites_[triangles_[one].corner[next(corner)]],
                 r_at = sites_[triangles_[one].corner[before(corner)]];
      if (twice_area(sites_[p], q_at, sites_[s]) <= 0 || twice_area(sites_[p], sites_[s], r_at) <= 0) {
        crossed.emplace_back(q, r);
        continue;
      }
      flip(one, corner);
      const auto left = twice_area(from, stop_at, sites_[p]), right = twice_area(from, stop_at, sites_[s]);
      const bool ends = p == a || p == end || s == a || s == end;
      if (!ends && ((left > 0 && right < 0) || (left < 0 && right > 0))) crossed.emplace_back(p, s);
      else made.emplace_back(p, s);
    }
    const auto there = left_of(a, end);
    const auto back = left_of(end, a);
    if (!there && !back) return false;
    if (there) set_fixed(there->first, there->second);
    else set_fixed(back->first, back->second);
    std::vector<std::pair<std::uint32_t, int>> open;
    for (const auto& [p, s] : made)
      if (const auto edge = left_of(p, s)) open.push_back(*edge);
    legalise(open, {});
    a = end;
  }
  return true;
}

}  // namespace mansard::terrain::detail
