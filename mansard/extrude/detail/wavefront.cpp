#include "mansard/extrude/detail/wavefront.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace mansard::extrude::detail {

auto Wavefront::add(Line line) -> std::uint32_t {
  const auto number = [&](const Direction& d) {
    return directions_.try_emplace(d, static_cast<std::uint32_t>(directions_.size())).first->second;
  };
  line.towards = number(line.direction);
  line.away = number(line.direction.reversed());
  lines.push_back(std::move(line));
  return static_cast<std::uint32_t>(lines.size() - 1);
}

auto Wavefront::alive() const -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> all;
  all.reserve(fronts_.size());
  for (const Front& front : fronts_) all.push_back(front.edge);
  std::ranges::sort(all);
  return all;
}

auto Wavefront::create(std::uint32_t line, std::uint32_t node) -> std::uint32_t {
  auto slot = static_cast<std::uint32_t>(edges.size());
  if (free_.empty()) {
    edges.emplace_back();
  } else {
    slot = free_.back();
    free_.pop_back();
  }
  WaveEdge fresh;
  fresh.vertex_stamp = edges[slot].vertex_stamp;
  fresh.edge_stamp = edges[slot].edge_stamp;
  fresh.line = line;
  fresh.node = node;
  fresh.place = static_cast<std::uint32_t>(fronts_.size());
  fronts_.emplace_back().edge = slot;
  edges[slot] = fresh;
  return slot;
}

void Wavefront::release(std::uint32_t edge) {
  set_pointed(edge, false);
  WaveEdge& e = edges[edge];
  fronts_[e.place] = fronts_.back();
  edges[fronts_[e.place].edge].place = e.place;
  fronts_.pop_back();
  e.line = none;
  e.vertex_dirty = e.edge_dirty = false;
  ++e.vertex_stamp;
  ++e.edge_stamp;
  free_.push_back(edge);
}

void Wavefront::set_pointed(std::uint32_t edge, bool pointed) {
  WaveEdge& e = edges[edge];
  if (pointed) {
    if (!e.pointed) {
      e.pointed_place = static_cast<std::uint32_t>(tips_.size());
      tips_.emplace_back();
    }
    tips_[e.pointed_place] = {e.x0, e.x1, e.y0, e.y1, e.error0, e.error1, e.pace, edge};
  } else if (e.pointed) {
    tips_[e.pointed_place] = tips_.back();
    edges[tips_[e.pointed_place].edge].pointed_place = e.pointed_place;
    tips_.pop_back();
  }
  e.pointed = pointed;
}

void Wavefront::start_changed(std::uint32_t edge) {
  edges[edge].vertex_dirty = true;
  dirty_.push_back(edge);
}

void Wavefront::changed(std::uint32_t edge) {
  edges[edge].edge_dirty = true;
  start_changed(edge);
  start_changed(edges[edge].next);
}

auto Wavefront::speed_of(std::uint32_t line) const -> const Rational& {
  static const Rational rest = 0;
  if (!terraces_) return lines[line].speed;
  const TerraceMotion* motion = terraces_->motion_of(line);
  return motion != nullptr ? motion->run : rest;
}

auto Wavefront::plane_at(std::uint32_t edge) -> PlaneId {
  const std::uint32_t line = edges[edge].line;
  const PlaneId rising = lines[line].plane;
  if (!terraces_) return rising;
  if (const TerraceMotion* motion = terraces_->motion_of(line)) return motion->plane;
  if (planes_[rising].is_static()) return rising;
  if (line >= terraces_->motions.size()) terraces_->motions.resize(lines.size());
  return terraces_->motions[line].plane = planes_.add(at_rest(planes_[rising], height));
}

auto Wavefront::start_plane(std::uint32_t edge) -> PlaneId {
  const WaveEdge& e = edges[edge];
  return e.joint != none ? e.joint : plane_at(e.prev);
}
auto Wavefront::end_plane(std::uint32_t edge) -> PlaneId {
  const std::uint32_t after = edges[edge].next;
  return edges[after].joint != none ? edges[after].joint : plane_at(after);
}

void Wavefront::connect(std::uint32_t edge) {
  const std::uint32_t before = edges[edge].prev;
  const Line &behind = lines[edges[before].line], &line = lines[edges[edge].line];
  if (before == edge) throw Broken("a loop of one edge");
  if (behind.direction != line.direction) throw Broken("a joint between lines of two directions");
  // Two connectors in line never move: they are one wall.
  if (behind.motions == line.motions) {
    trace_.unite(edges[before].node, edges[edge].node);
    const std::uint32_t after = edges[edge].next;
    edges[before].next = after;
    edges[after].prev = before;
    release(edge);
    changed(before);
    return;
  }
  const Rational &speed_behind = speed_of(edges[before].line), &speed = speed_of(edges[edge].line);
  if (speed_behind == speed) return;

  Line connector;
  connector.motions = none;
  const bool steps_out = speed_behind > speed;     // the edge before runs ahead: step back outwards to this
  const Plane joint = planes_[edges[edge].joint];  // of the direction turned left
  connector.plane = steps_out ? planes_.add(flipped(joint)) : edges[edge].joint;
  connector.direction = planes_[connector.plane].direction;
  const std::uint32_t node = trace_.node({model::FaceKind::connector, {}, connector.direction, 0});
  const std::uint32_t between = create(add(std::move(connector)), node);
  WaveEdge &e = edges[edge], &c = edges[between];
  c.prev = before;
  c.next = edge;
  c.origin = e.origin;
  c.origin_moment = e.origin_moment;
  c.origin_level = e.origin_level;
  edges[before].next = e.prev = between;
  e.joint = none;
  changed(before);
  changed(between);
  changed(edge);
}

void Wavefront::connect_pending() {
  for (const std::uint32_t i : std::exchange(pending_, {}))
    if (edges[i].line != none && edges[i].joint != none) connect(i);
}

void Wavefront::connect_all() {
  pending_ = alive();
  connect_pending();
}

void Wavefront::enter_terraces(const std::map<std::uint32_t, TerraceMotion>& moving) {
  refresh();
  Terraces& terraces = terraces_.emplace();
  terraces.motions.resize(lines.size());
  for (const auto& [line, motion] : moving) terraces.motions[line] = motion;
  terraces.waiting = std::exchange(queue_, {});
  terraces.rise_horizon = std::exchange(horizon, 1);
  now = fraction_of(0);
  aim_all();
  ++refreshes_;
  const auto moves = [&](std::uint32_t line) { return speed_of(line) != 0; };
  for (const Tip& tip : tips_) {
    WaveEdge& v = edges[tip.edge];
    if (!moves(v.line) && !moves(edges[v.prev].line)) continue;
    v.scanned = refreshes_;
    for (const Front& front : fronts_) try_hit(tip, front);
  }
  for (const Front& front : fronts_) {
    try_collapse(front.edge);
    if (!moves(edges[front.edge].line)) continue;
    for (const Tip& tip : tips_)
      if (edges[tip.edge].scanned != refreshes_) try_hit(tip, front);
  }
}

void Wavefront::leave_terraces() {
  refresh();
  Terraces over = std::move(*terraces_);
  terraces_.reset();
  horizon = over.rise_horizon;
  now = fraction_of(height);
  queue_ = std::move(over.waiting);
  aim_all();
  for (const std::uint32_t i : over.touched)
    if (edges[i].line != none) changed(i);
}

void Wavefront::refresh() {
  if (dirty_.empty()) return;
  ++refreshes_;
  std::vector<std::uint32_t> vertices, stretched;
  const auto stretch = [&](std::uint32_t i) {
    edges[i].edge_dirty = true;
    stretched.push_back(i);
  };
  for (const std::uint32_t i : dirty_) {
    WaveEdge& e = edges[i];
    if (e.line == none) continue;
    if (e.vertex_dirty) {
      e.vertex_dirty = false;
      ++e.vertex_stamp;
      aim_vertex(i);
      vertices.push_back(i);
      stretch(i);
      stretch(e.prev);
    }
    if (e.edge_dirty) stretched.push_back(i);
  }
  dirty_.clear();
  std::erase_if(stretched, [&](std::uint32_t i) { return !std::exchange(edges[i].edge_dirty, false); });
  for (const std::uint32_t i : stretched) {
    ++edges[i].edge_stamp;
    aim_edge(i);
    if (terraces_) terraces_->touched.push_back(i);
  }
  for (const std::uint32_t i : stretched) try_collapse(i);
  for (const std::uint32_t v : vertices) {
    if (!edges[v].pointed) continue;
    edges[v].scanned = refreshes_;
    const Tip tip = tips_[edges[v].pointed_place];
    for (const Front& front : fronts_) try_hit(tip, front);
  }
  for (const std::uint32_t i : stretched) {
    const Front front = fronts_[edges[i].place];
    for (const Tip& tip : tips_)
      if (edges[tip.edge].scanned != refreshes_) try_hit(tip, front);
  }
}

// ---- the queue

auto Wavefront::Later::operator()(const Candidate& a, const Candidate& b) const -> bool {
  return std::tuple(a.lo, a.contact.vertex, a.contact.edge, a.hi) >
         std::tuple(b.lo, b.contact.vertex, b.contact.edge, b.hi);
}

void Wavefront::put(const Candidate& candidate) {
  queue_.push_back(candidate);
  std::ranges::push_heap(queue_, Later());
}

void Wavefront::push(double lo, double hi, Contact contact, bool sure) {
  if (hi < now.lo || lo > horizon) return;
  put({lo, hi, contact, edges[contact.vertex].vertex_stamp, edges[contact.edge].edge_stamp, sure});
}

auto Wavefront::is_current(const Candidate& c) const -> bool {
  return edges[c.contact.edge].edge_stamp == c.edge_stamp &&
         (c.contact.vertex == c.contact.edge || edges[c.contact.vertex].vertex_stamp == c.vertex_stamp);
}

auto Wavefront::triple_of(const Contact& c) -> Triple {
  if (c.vertex == c.edge) return {start_plane(c.edge), plane_at(c.edge), end_plane(c.edge)};
  return {start_plane(c.vertex), plane_at(c.vertex), plane_at(c.edge)};
}

auto Wavefront::place_on(const Contact& c) -> int {
  const Triple at = triple_of(c);
  const PlaneId line = plane_at(c.edge), start = start_plane(c.edge), end = end_plane(c.edge);
  // n_k · p − r_k is (w − w_k) times the sine from plane k to the edge.
  const int from = planes_.side(start, at) * turn(start, line), to = planes_.side(end, at) * turn(end, line);
  if (from < 0) return -2;
  if (to > 0) return 2;
  return from == 0 ? -1 : (to == 0 ? 1 : 0);
}

auto Wavefront::happens(const Contact& c) -> bool {
  const Triple at = triple_of(c);
  const int convergence = planes_.convergence(at);
  if (convergence == 0) return false;
  // The sum of both products' signs follows from where two of the lines cut the third: the length of an edge changes by
  // −W / ((p × e) (e × n)), the gap before a vertex by −W / (p × m), up to positive factors.
  if (c.vertex == c.edge) {
    if (convergence * turn(at[0], at[1]) * turn(at[1], at[2]) <= 0) return false;
    return planes_.compare(planes_.time(at), now) > 0;
  }
  if (convergence * turn(at[0], at[1]) <= 0) return false;
  if (planes_.compare(planes_.time(at), now) <= 0) return false;
  return c.inside || std::abs(place_on(c)) < 2;
}

auto Wavefront::next_contacts(const Fraction& limit, Fraction& when) -> std::vector<Contact> {
  refresh();
  std::vector<Candidate> group, later;
  Fraction first;
  bool known = false;  // whether `first` is
  const auto time_of = [&](const Candidate& c) { return planes_.time(triple_of(c.contact)); };
  while (!queue_.empty()) {
    Candidate c = queue_.front();
    if (c.lo > (group.empty() ? limit.hi : group.front().hi)) break;
    std::ranges::pop_heap(queue_, Later());
    queue_.pop_back();
    if (!is_current(c)) continue;
    if (!c.sure) {
      if (!happens(c.contact)) continue;
      const Fraction t = time_of(c);
      c.lo = t.lo;
      c.hi = t.hi;
      c.sure = true;
    }
    if (c.hi >= limit.lo && planes_.compare(time_of(c), limit) > 0) {
      later.push_back(c);
      continue;
    }
    if (group.empty()) {
      group.push_back(c);
      known = false;
      continue;
    }
    int order = c.hi < group.front().lo ? -1 : (c.lo > group.front().hi ? 1 : 0);
    if (order == 0) {
      if (!known) first = time_of(group.front());
      known = true;
      Fraction t = time_of(c);
      order = planes_.compare(t, first);
      if (order < 0) {
        first = std::move(t);
      } else {  // the tightest interval known: fewer candidates overlap it
        group.front().lo = first.lo;
        group.front().hi = first.hi;
      }
    } else if (order < 0) {
      known = false;
    }
    if (order < 0) {
      later.insert(later.end(), group.begin(), group.end());
      group.clear();
    }
    if (order <= 0) group.push_back(c);
    else later.push_back(c);
  }
  for (const Candidate& c : later) put(c);
  std::vector<Contact> contacts;
  if (group.empty()) return contacts;
  when = known ? first : time_of(group.front());
  for (const Candidate& c : group) contacts.push_back(c.contact);
  std::ranges::sort(contacts, {}, [](const Contact& c) { return std::tuple(c.vertex, c.edge); });
  return contacts;
}

}  // namespace mansard::extrude::detail
