#include "wave.hpp"

#include <algorithm>
#include <stdexcept>

namespace oracle {
namespace {

auto turn_of(const Direction& p, const Direction& q) -> Rational { return Rational(p.a) * q.b - Rational(p.b) * q.a; }

/// Counter-clockwise from the positive x axis.
auto comes_before(const Direction& p, const Direction& q) -> bool {
  const auto lower = [](const Direction& d) { return d.b < 0 || (d.b == 0 && d.a < 0); };
  return lower(p) != lower(q) ? lower(q) : turn_of(p, q) > 0;
}

/// Where the lines a y − b x = r of two directions meet.
auto meeting(const Line& p, const Rational& r, const Line& q, const Rational& s) -> Point {
  const Rational turn = turn_of(p.direction, q.direction);
  if (turn == 0) throw std::logic_error("parallel neighbours in the wavefront");
  return {(r * q.direction.a - s * p.direction.a) / turn, (r * q.direction.b - s * p.direction.b) / turn};
}

}  // namespace

auto Wave::one_wall(std::size_t p, std::size_t q) const -> bool {
  const Line &a = lines[p], &b = lines[q];
  if (a.direction != b.direction || (a.edge == nullptr) != (b.edge == nullptr)) return false;
  if (a.edge == nullptr) return a.offset == b.offset;
  return a.edge->offset == b.edge->offset && a.edge->track == b.edge->track;
}

auto Wave::connector(const Line& before, const Line& after, const Point& at) -> std::size_t {
  Line line;
  // Where the edge before runs ahead inwards, the step back to the one after goes outwards.
  line.direction = before.direction.left();
  if (before.speed > after.speed) line.direction = line.direction.reversed();
  line.offset = line.across(at);
  lines.push_back(line);
  return lines.size() - 1;
}

void Wave::connect(const Rational& t) {
  for (Loop& loop : loops) {
    for (std::size_t i = 0; i < loop.size();) {
      const std::size_t j = (i + 1) % loop.size();
      if (!one_wall(loop[i].line, loop[j].line)) {
        ++i;
        continue;
      }
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(j));
      if (j < i) --i;
    }
    if (loop.size() < 3) throw std::logic_error("a loop of fewer than three edges");
    Loop linked;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::size_t before = loop[(i + loop.size() - 1) % loop.size()].line;
      if (lines[before].direction == lines[loop[i].line].direction)
        linked.push_back({connector(lines[before], lines[loop[i].line], loop[i].start), loop[i].start, {}, {}});
      linked.push_back(loop[i]);
    }
    for (std::size_t i = 0; i < linked.size(); ++i) {
      WaveEdge& e = linked[i];
      const Line &p = lines[linked[(i + linked.size() - 1) % linked.size()].line], &q = lines[e.line];
      e.from = meeting(p, p.offset, q, q.offset);
      e.speed = meeting(p, p.speed, q, q.speed);
      if (!(e.at(t) == e.start)) throw std::logic_error("a vertex jumps");
    }
    loop = std::move(linked);
  }
}

auto Wave::next_event(const Rational& now, const Rational& limit) const -> std::optional<Rational> {
  std::optional<Rational> first;
  const auto sooner = [&](const Rational& t) { return t > now && t <= limit && (!first || t < *first); };
  for_each_edge(loops, [&](const WaveEdge& e, const WaveEdge& end) {
    const Line& line = lines[e.line];
    const Rational growth = line.along(end.speed) - line.along(e.speed);
    if (growth < 0) {
      const Rational t = (line.along(e.from) - line.along(end.from)) / growth;
      if (sooner(t)) first = t;
    }
    for_each_edge(loops, [&](const WaveEdge& v, const WaveEdge&) {
      if (&v == &e || &v == &end) return;
      const Rational approach = line.across(v.speed) - line.speed;
      if (approach >= 0) return;
      const Rational t = (line.offset - line.across(v.from)) / approach;
      if (!sooner(t)) return;
      const Rational w = line.along(v.at(t));
      if (w >= line.along(e.at(t)) && w <= line.along(end.at(t))) first = t;
    });
  });
  return first;
}

void Wave::move(const Rational& t) {
  for (Loop& loop : loops)
    for (WaveEdge& e : loop) e.start = e.at(t);
}

auto Wave::twice_area() const -> Rational {
  Rational sum = 0;
  for_each_edge(
      loops, [&](const WaveEdge& e, const WaveEdge& end) { sum += e.start.x * end.start.y - e.start.y * end.start.x; });
  return sum;
}

void Wave::relink() {
  const Rational before = twice_area();
  std::vector<Point> sites;
  for (const Loop& loop : loops)
    for (const WaveEdge& e : loop) sites.push_back(e.start);
  std::ranges::sort(sites, std::less<>());
  sites.erase(std::unique(sites.begin(), sites.end()), sites.end());

  // Pieces of edges between neighbouring sites; opposite ones annihilate.
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> pieces;  // (from, to) → line
  for_each_edge(loops, [&](const WaveEdge& e, const WaveEdge& end) {
    const Line& line = lines[e.line];
    const Rational from = line.along(e.start), to = line.along(end.start), offset = line.across(e.start);
    if (to < from) throw std::logic_error("an edge has turned round");
    std::vector<std::pair<Rational, std::size_t>> on;
    for (std::size_t s = 0; s < sites.size(); ++s) {
      if (line.across(sites[s]) != offset) continue;
      Rational w = line.along(sites[s]);
      if (w >= from && w <= to) on.emplace_back(std::move(w), s);
    }
    std::ranges::sort(on);
    for (std::size_t i = 0; i + 1 < on.size(); ++i)
      if (!pieces.emplace(std::pair(on[i].second, on[i + 1].second), e.line).second)
        throw std::logic_error("two edges lie on each other");
  });
  std::erase_if(pieces, [all = pieces](const auto& piece) {
    return all.contains({piece.first.second, piece.first.first});
  });

  struct Ray {
    Direction direction;  // away from the site
    std::pair<std::size_t, std::size_t> piece;
    bool incoming;
  };
  std::vector<std::vector<Ray>> rays(sites.size());
  for (const auto& [ends, line] : pieces) {
    rays[ends.first].push_back({lines[line].direction, ends, false});
    rays[ends.second].push_back({lines[line].direction.reversed(), ends, true});
  }
  std::map<std::pair<std::size_t, std::size_t>, std::pair<std::size_t, std::size_t>> next;
  for (auto& around : rays) {
    std::ranges::sort(around, [](const Ray& p, const Ray& q) { return comes_before(p.direction, q.direction); });
    for (std::size_t i = 0; i < around.size(); ++i) {
      const Ray& clockwise = around[(i + around.size() - 1) % around.size()];
      if (around[i].incoming == clockwise.incoming) throw std::logic_error("the wavefront crosses itself");
      if (around[i].incoming) next[around[i].piece] = clockwise.piece;
    }
  }
  loops.clear();
  while (!next.empty()) {
    Loop loop;
    for (auto at = next.begin(); at != next.end();) {
      loop.push_back({pieces.at(at->first), sites[at->first.first], {}, {}});
      const auto then = at->second;
      next.erase(at);
      at = next.find(then);
    }
    loops.push_back(std::move(loop));
  }
  if (twice_area() != before) throw std::logic_error("a snapshot changed the area");
}

}  // namespace oracle
