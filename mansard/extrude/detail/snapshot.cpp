// The snapshot: everything that happens at one critical moment, resolved at once by one rule.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/extrude/detail/wavefront.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

/// Error bound of a place along an edge at t, beside the errors of the vertex itself (aim.cpp): x0 + x1 t and its
/// product with a direction have 5 u (|x0| + |y0|) and 5 u |t| (|x1| + |y1|), of which the factor 2 on |t| error1 has
/// the second; the ends of the interval 1 u (|w| + …). t is the middle of an interval of at least two units in the last
/// place, so that the moment is within its width of t, rounding included.
constexpr double place_error = 8 * unit_roundoff;

/// Error bounds of the comparison of areas, quanta and relative. A site is the double nearest to a point below 2³⁸
/// quanta: 2³⁸ · u = 3e-5. A quiet vertex is off by half of its edge's `span_error0` + |t| `span_error1` at most. Two
/// ends off by d change a cross product by d (|a| + |b|) + d²; its own rounding is 4 u |a| |b|. Both bounds are some
/// thirty times larger and more: an edge joined wrongly changes the area by much more (1 mm · 1 mm is 4300 square
/// quanta).
constexpr double site_error = 1e-3;
constexpr double area_error = 1e-9;

/// A stretch of an edge between two sites, or a site and a quiet vertex.
struct Piece {
  std::uint32_t edge;
  std::uint32_t from, to;  ///< sites; none at a quiet vertex
  bool alive = true;
  std::uint32_t next = none, prev = none;  ///< pieces
  std::uint32_t slot = none;
};

}  // namespace

/// Sites are the points where something happens. Only edges at a site are looked at; a vertex that nothing touches is
/// quiet, and stays as it is.
struct Wavefront::Meeting {
  struct Site {
    Triple planes{};
    std::uint32_t point = 0;
    Point2 place;
  };
  struct Stop {
    std::uint32_t vertex, site;
  };

  Wavefront& wave;
  const double t;
  std::vector<std::uint32_t> vertices;                          ///< involved, sorted
  std::vector<Triple> planes;                                   ///< that meet at them
  base::DisjointSets equals;                                    ///< of vertices at one place
  std::vector<std::uint32_t> site_of;                           ///< by place in `vertices`
  std::vector<std::pair<std::uint32_t, std::uint32_t>> inside;  ///< edge, vertex that touches it between its ends
  std::vector<Site> sites;
  std::vector<std::uint32_t> touched;  ///< edges at a site, sorted
  std::vector<Piece> pieces;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> range;  ///< pieces of touched edge i: [first, second)

  explicit Meeting(Wavefront& w) : wave(w), t((w.now.lo + w.now.hi) / 2) {}

  [[nodiscard]] auto index_of(std::uint32_t vertex) const -> std::uint32_t {
    const auto at = std::ranges::lower_bound(vertices, vertex);
    if (at == vertices.end() || *at != vertex) return none;
    return static_cast<std::uint32_t>(at - vertices.begin());
  }

  /// Which vertices are involved, which of them are at one place, and which lie inside an edge.
  void gather(const std::vector<Contact>& contacts) {
    struct Involved {
      std::uint32_t vertex, contact;
    };
    std::vector<Involved> involved;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> equal;  // vertices
    for (std::uint32_t k = 0; k < contacts.size(); ++k) {
      const Contact& c = contacts[k];
      const std::uint32_t end = wave.edges[c.edge].next;
      involved.push_back({c.vertex, k});
      if (c.vertex == c.edge) {
        involved.push_back({end, k});
        equal.emplace_back(c.vertex, end);
        continue;
      }
      const int place = c.inside ? 0 : wave.place_on(c);
      if (place == 0) {
        inside.emplace_back(c.edge, c.vertex);
        continue;
      }
      const std::uint32_t other = place < 0 ? c.edge : end;
      involved.push_back({other, k});
      equal.emplace_back(c.vertex, other);
    }
    std::ranges::sort(involved, {}, [](const Involved& i) { return std::tuple(i.vertex, i.contact); });
    for (const Involved& i : involved)
      if (vertices.empty() || vertices.back() != i.vertex) {
        vertices.push_back(i.vertex);
        planes.push_back(wave.triple_of(contacts[i.contact]));
      }
    equals = base::DisjointSets(vertices.size());
    for (const auto& [v, w] : equal) equals.join(index_of(v), index_of(w));
    std::ranges::sort(inside);
    inside.erase(std::ranges::unique(inside).begin(), inside.end());
  }

  /// Where vertex v lies along the edge relative to vertex w, both on it.
  [[nodiscard]] auto order_along(std::uint32_t edge, std::uint32_t v, std::uint32_t w) -> int {
    if (equals.of(index_of(v)) == equals.of(index_of(w))) return 0;
    const PlaneId line = wave.plane_at(edge);
    // A line through v that is not along the edge; where w lies beside it.
    PlaneId through = wave.start_plane(v);
    if (wave.turn(through, line) == 0) through = wave.plane_at(v);
    return -wave.planes_.side(through, {wave.start_plane(w), wave.plane_at(w), line}) * wave.turn(through, line);
  }

  void sort_inside() {
    for (auto first = inside.begin(); first != inside.end();) {
      auto last = first;
      while (last != inside.end() && last->first == first->first) ++last;
      const std::uint32_t edge = first->first;
      const Plane& line = wave.planes_[wave.plane_at(edge)];
      const Point2 along{line.ny, -line.nx};
      struct Along {
        double least, most;
        std::uint32_t vertex;
      };
      std::vector<Along> order;
      for (auto i = first; i != last; ++i) {
        const WaveEdge& v = wave.edges[i->second];
        const double w = dot(along, wave.position(i->second, t));
        const double span = wave.now.hi - wave.now.lo;
        const double unsure = 2 * (v.error0 + std::abs(t) * v.error1 + v.pace * span) +
                              place_error * (std::abs(w) + std::abs(v.x0) + std::abs(v.y0));
        order.push_back({w - unsure, w + unsure, i->second});
      }
      std::ranges::sort(order, [&](const Along& p, const Along& q) {
        if (p.most < q.least || q.most < p.least) return p.most < q.least;
        const int exactly = p.vertex == q.vertex ? 0 : order_along(edge, p.vertex, q.vertex);
        return exactly != 0 ? exactly < 0 : p.vertex < q.vertex;
      });
      for (std::size_t i = 0; i < order.size(); ++i, ++first) {
        first->second = order[i].vertex;
        if (i > 0 && order[i - 1].most >= order[i].least &&
            order_along(edge, order[i - 1].vertex, order[i].vertex) == 0)
          equals.join(index_of(order[i - 1].vertex), index_of(order[i].vertex));
      }
    }
  }

  void name_sites() {
    site_of.assign(vertices.size(), none);
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      const std::uint32_t r = equals.of(i);
      if (site_of[r] == none) {
        site_of[r] = static_cast<std::uint32_t>(sites.size());
        const std::uint32_t point = wave.trace_.point(wave.traced(planes[r]));
        const geometry::Point3 place = wave.trace_.place(point);
        sites.push_back({planes[r], point, {place.x / quantum, place.y / quantum}});
      }
      site_of[i] = site_of[r];
    }
    join_equal_sites();
  }

  /// Contacts say which vertices meet, but not that two meetings are at one point.
  void join_equal_sites() {
    std::vector<std::uint32_t> order(sites.size()), merged(sites.size());
    std::iota(order.begin(), order.end(), 0U);
    std::iota(merged.begin(), merged.end(), 0U);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
      return std::tuple(sites[a].place.x, sites[a].place.y, a) < std::tuple(sites[b].place.x, sites[b].place.y, b);
    });
    // Places are the nearest doubles: equal points have equal ones.
    for (std::size_t i = 1; i < order.size(); ++i)
      for (std::size_t j = i; j-- > 0 && sites[order[j]].place == sites[order[i]].place;) {
        const auto& p = sites[order[j]].planes;
        const auto& q = sites[order[i]].planes;
        if (!std::ranges::all_of(p, [&](PlaneId plane) { return wave.planes_.side(plane, q) == 0; })) continue;
        merged[order[i]] = merged[order[j]];
        break;
      }
    for (std::uint32_t& site : site_of) site = merged[site];
  }

  [[nodiscard]] auto site_at(std::uint32_t vertex) const -> std::uint32_t {
    const std::uint32_t i = index_of(vertex);
    return i == none ? none : site_of[i];
  }

  void end_arcs() {
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      const WaveEdge& e = wave.edges[vertices[i]];
      wave.trace_.arc(e.origin, sites[site_of[i]].point, wave.edges[e.prev].node, e.node);
    }
  }

  void cut_pieces() {
    for (const std::uint32_t v : vertices) {
      touched.push_back(v);
      touched.push_back(wave.edges[v].prev);
    }
    for (const auto& [edge, vertex] : inside) touched.push_back(edge);
    std::ranges::sort(touched);
    touched.erase(std::ranges::unique(touched).begin(), touched.end());
    auto stop = inside.begin();
    for (const std::uint32_t e : touched) {
      const auto first = static_cast<std::uint32_t>(pieces.size());
      std::uint32_t here = site_at(e);
      const auto go = [&](std::uint32_t to) {
        if (to != here || to == none) pieces.push_back({e, here, to});
        here = to;
      };
      for (; stop != inside.end() && stop->first == e; ++stop) go(site_at(stop->second));
      go(site_at(wave.edges[e].next));
      range.emplace_back(first, static_cast<std::uint32_t>(pieces.size()));
    }
  }

  /// Two pieces that lie on each other in opposite directions enclose nothing any more: a ridge between their faces.
  void cancel() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
      if (pieces[i].from != none && pieces[i].to != none) order.push_back(i);
    const auto key = [&](std::uint32_t i) {
      return std::pair(std::min(pieces[i].from, pieces[i].to), std::max(pieces[i].from, pieces[i].to));
    };
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(key(i), i); });
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      Piece &p = pieces[order[i]], &q = pieces[order[i + 1]];
      if (!p.alive || p.from != q.to || p.to != q.from) continue;
      p.alive = q.alive = false;
      wave.trace_.arc(sites[p.to].point, sites[p.from].point, wave.edges[p.edge].node, wave.edges[q.edge].node);
    }
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
      if (pieces[order[i]].alive && pieces[order[i + 1]].alive && key(order[i]) == key(order[i + 1]))
        throw Broken("two edges of the wavefront lie on each other");
  }

  /// At every site each incoming piece goes on with the next outgoing one clockwise: the one that bounds the same wedge
  /// of interior.
  void join() {
    struct Ray {
      std::uint32_t site;
      Direction direction;  // away from the site
      std::uint32_t piece;
      bool incoming;
    };
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
      const Piece& p = pieces[i];
      if (!p.alive) continue;
      const Direction& d = wave.lines[wave.edges[p.edge].line].direction;
      if (p.from != none) rays.push_back({p.from, d, i, false});
      if (p.to != none) rays.push_back({p.to, d.reversed(), i, true});
    }
    std::ranges::sort(rays, [](const Ray& p, const Ray& q) {
      if (p.site != q.site) return p.site < q.site;
      if (p.direction == q.direction) return p.piece < q.piece;
      return angle_less(p.direction, q.direction);
    });
    for (std::size_t first = 0; first < rays.size();) {
      std::size_t last = first;
      while (last < rays.size() && rays[last].site == rays[first].site) ++last;
      if ((last - first) % 2 != 0) throw Broken("a site with more ways in than out");
      for (std::size_t i = first; i < last; ++i) {
        const Ray& in = rays[i];
        if (!in.incoming) continue;
        const Ray& out = rays[i == first ? last - 1 : i - 1];
        if (out.incoming) throw Broken("the wavefront crosses itself");
        pieces[in.piece].next = out.piece;
        pieces[out.piece].prev = in.piece;
      }
      first = last;
    }
    // At a quiet vertex between two touched edges their pieces go on as before.
    for (std::uint32_t k = 0; k < touched.size(); ++k) {
      if (range[k].first == range[k].second) continue;
      const std::uint32_t last = range[k].second - 1, after = wave.edges[touched[k]].next;
      if (pieces[last].to != none) continue;
      const auto at = std::ranges::lower_bound(touched, after);
      if (at == touched.end() || *at != after) continue;
      const std::uint32_t first = range[static_cast<std::size_t>(at - touched.begin())].first;
      pieces[last].next = first;
      pieces[first].prev = last;
    }
    for (const Piece& p : pieces)
      if (p.alive && ((p.to != none && p.next == none) || (p.from != none && p.prev == none)))
        throw Broken("a site with more ways in than out");
  }

  /// Undoes cuts that changed nothing.
  void mend() {
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
      if (!pieces[i].alive) continue;
      while (pieces[i].next != none && pieces[i].to != none && pieces[pieces[i].next].edge == pieces[i].edge) {
        const std::uint32_t j = pieces[i].next;
        if (j == i) throw Broken("a loop of one edge");
        pieces[j].alive = false;
        pieces[i].to = pieces[j].to;
        pieces[i].next = pieces[j].next;
        if (pieces[i].next != none) pieces[pieces[i].next].prev = i;
      }
    }
  }

  /// Always-on invariant: a snapshot changes how pieces are joined, never the area they enclose.
  void compare_areas() const {
    double sum = 0, unsure = 0;
    const Point2 o = sites.front().place;
    const auto place = [&](std::uint32_t site, std::uint32_t vertex) {
      return (site == none ? wave.position(vertex, t) : sites[site].place) - o;
    };
    const auto add = [&](std::uint32_t edge, Point2 a, Point2 b, double sign) {
      const WaveEdge& e = wave.edges[edge];
      sum += sign * cross(a, b);
      const double size = std::abs(a.x) + std::abs(a.y) + std::abs(b.x) + std::abs(b.y);
      const double off = site_error + e.span_error0 + std::abs(t) * e.span_error1 + area_error * size;
      unsure += off * (size + 1);
    };
    for (const std::uint32_t e : touched)
      add(e, place(site_at(e), e), place(site_at(wave.edges[e].next), wave.edges[e].next), 1);
    for (const Piece& p : pieces)
      if (p.alive) add(p.edge, place(p.from, p.edge), place(p.to, wave.edges[p.edge].next), -1);
    if (std::abs(sum) > unsure) throw Broken("a snapshot changed the area");
  }

  void rebuild() {
    struct Was {
      std::uint32_t line, node, prev, next, joint, origin, next_joint;
      std::uint64_t origin_moment, origin_level;
    };
    std::vector<Was> was;
    for (const std::uint32_t i : touched) {
      const WaveEdge& e = wave.edges[i];
      was.push_back({e.line, e.node, e.prev, e.next, e.joint, e.origin, 0, e.origin_moment, e.origin_level});
    }
    for (const std::uint32_t i : touched) wave.release(i);
    std::vector<std::uint32_t> born;
    std::size_t k = 0;
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
      Piece& p = pieces[i];
      if (!p.alive) continue;
      while (touched[k] != p.edge) ++k;
      p.slot = wave.create(was[k].line, was[k].node);
      WaveEdge& e = wave.edges[p.slot];
      if (p.from != none) {
        e.origin = sites[p.from].point;
        e.origin_moment = wave.moment;
        e.origin_level = wave.level;
      } else {
        e.joint = was[k].joint;
        e.origin = was[k].origin;
        e.origin_moment = was[k].origin_moment;
        e.origin_level = was[k].origin_level;
        e.prev = was[k].prev;  // unless it is a piece, see below
      }
      if (p.to == none) e.next = was[k].next;
      born.push_back(i);
    }
    for (const std::uint32_t i : born) {
      const Piece& p = pieces[i];
      WaveEdge& e = wave.edges[p.slot];
      if (p.prev != none) e.prev = pieces[p.prev].slot;
      else wave.edges[e.prev].next = p.slot;
      if (p.next != none) e.next = pieces[p.next].slot;
      else wave.edges[e.next].prev = p.slot;
    }
    for (const std::uint32_t i : born) {
      const Piece& p = pieces[i];
      const WaveEdge& e = wave.edges[p.slot];
      if (e.next == p.slot || wave.edges[e.next].next == p.slot) throw Broken("a loop of two edges");
      wave.changed(p.slot);
      if (p.from != none && wave.lines[wave.edges[e.prev].line].direction == wave.lines[e.line].direction)
        wave.edges[p.slot].joint = wave.joint_through(e.line, sites[p.from].planes);
    }
    wave.pending_.clear();
    for (const std::uint32_t i : born) wave.pending_.push_back(pieces[i].slot);
  }
};

void Wavefront::snapshot(const std::vector<Contact>& contacts) {
  Meeting meeting(*this);
  meeting.gather(contacts);
  meeting.sort_inside();
  meeting.name_sites();
  meeting.end_arcs();
  meeting.cut_pieces();
  meeting.cancel();
  meeting.join();
  meeting.mend();
  meeting.compare_areas();
  meeting.rebuild();
}

auto Wavefront::joint_through(std::uint32_t line, const Triple& at) -> PlaneId {
  const Direction across = lines[line].direction.left();
  const Planes::Exact p = planes_.exact(at);
  // The direction turned left twice looks back along the line.
  const Rational along = -(Rational(lines[line].direction.a) * p.x + Rational(lines[line].direction.b) * p.y);
  return planes_.add(plane_of(across, along / lines[line].direction.l, 0));
}

void Wavefront::close_arc(std::uint32_t edge, PlaneId moment_plane) {
  WaveEdge& e = edges[edge];
  const bool stands = terraces_ && e.origin_level == level && planes_[start_plane(edge)].is_static() &&
                      planes_[plane_at(edge)].is_static();
  if (e.origin_moment == moment || stands) return;
  const std::uint32_t here = trace_.point(traced({start_plane(edge), plane_at(edge), moment_plane}));
  trace_.arc(e.origin, here, edges[e.prev].node, e.node);
  e.origin = here;
  e.origin_moment = moment;
  e.origin_level = level;
}

}  // namespace mansard::extrude::detail
