#include "oracle.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

#include "strips.hpp"
#include "wave.hpp"

namespace oracle {

auto Slab::at(const Rational& z) const -> std::vector<std::array<Point, 2>> {
  const Rational s = (z - from) / (to - from);
  const auto between = [&](const Point& p, const Point& q) -> Point {
    return {p.x + s * (q.x - p.x), p.y + s * (q.y - p.y)};
  };
  std::vector<std::array<Point, 2>> out;
  for (const Edge& e : edges) out.push_back({between(e.start, e.start_above), between(e.end, e.end_above)});
  return out;
}

auto Slab::area(const Rational& z) const -> Rational {
  Rational sum = 0;
  for (const auto& [p, q] : at(z)) sum += p.x * q.y - p.y * q.x;
  return sum / 2;
}

namespace {

class Extrusion {
 public:
  Extrusion(const Footprint& footprint, const Rational& cap) : footprint_(footprint), cap_(cap) {}

  auto run() -> Solid {
    for (std::size_t r = 0; r < footprint_.rings.size(); ++r) lay_out(r);
    set_speeds();
    pass_terraces();
    strips_ = {};  // a setback at the ground has no thickness
    solid_.events.clear();
    if (wave_.loops.empty()) throw std::logic_error("the setback at the ground leaves nothing");
    level(FaceKind::base);
    wave_.connect(z_);
    while (rise()) {
    }
    for (const Slab& slab : solid_.slabs)  // the area is a square function of the height: Simpson's rule is exact
      solid_.volume += (slab.to - slab.from) / 6 *
                       (slab.area(slab.from) + 4 * slab.area((slab.from + slab.to) / 2) + slab.area(slab.to));
    solid_.faces = strips_.faces();
    return std::move(solid_);
  }

 private:
  void lay_out(std::size_t r) {
    Loop loop;
    for (std::size_t i = 0; i < footprint_.rings[r].size(); ++i) {
      const CanonicalEdge& edge = footprint_.rings[r][i];
      loop.push_back({wave_.lines.size(), {footprint_.corners[r][i].x, footprint_.corners[r][i].y}, {}, {}});
      wave_.lines.push_back({edge.direction, {}, {}, &edge, 0});
    }
    wave_.loops.push_back(std::move(loop));
  }

  [[nodiscard]] auto track(const Line& line) const -> const mansard::extrude::detail::Track& {
    return footprint_.tracks[line.edge->track];
  }
  [[nodiscard]] auto is_terrace(const Line& line) const -> bool {
    return line.edge != nullptr && track(line)[line.part].horizontal;
  }
  /// Where the line's part ends; the last never does.
  [[nodiscard]] auto knot(const Line& line) const -> std::optional<Rational> {
    if (line.edge == nullptr || line.part + 1 == track(line).size()) return std::nullopt;
    return track(line)[line.part + 1].height;
  }

  /// Every edge's motion over the height on its present part.
  void set_speeds() {
    for (Line& line : wave_.lines) {
      if (line.edge == nullptr) continue;
      const auto& part = track(line)[line.part];
      const Rational l(line.direction.l);
      line.speed = l * part.slope;
      line.offset = l * (line.edge->offset + part.inward - part.slope * part.height);
    }
  }

  /// Everything in the wavefront moves on to t, drawn from this height to that.
  void sweep(const Rational& t, const Rational& z) {
    Slab slab{z_, z, {}};
    for_each_edge(wave_.loops, [&](const WaveEdge& e, const WaveEdge& end) {
      const Line& line = wave_.lines[e.line];
      const Slab::Edge swept{e.start, end.start, e.at(t), end.at(t)};
      if (z > z_ || is_terrace(line)) strips_.add(plane_of(line, z), swept, z_, z);
      if (z > z_) slab.edges.push_back(swept);
    });
    if (z > z_) solid_.slabs.push_back(std::move(slab));
    z_ = z;
    wave_.move(t);
    wave_.relink();
  }

  [[nodiscard]] auto plane_of(const Line& line, const Rational& z) const -> Plane {
    if (line.edge == nullptr) return {FaceKind::connector, line.direction, line.offset, 0, 0, {}};
    Provenance from = line.edge->provenance;
    from.part = track(line)[line.part].part;
    if (is_terrace(line)) return {FaceKind::terrace, {}, z, 0, 0, from};
    return {FaceKind::side, line.direction, line.edge->offset, line.edge->track, line.part, from};
  }

  /// The wavefront as the ground floor or as the flat roof at the cap.
  void level(FaceKind kind) {
    for_each_edge(wave_.loops, [&](const WaveEdge& e, const WaveEdge& end) {
      if (kind == FaceKind::cap) strips_.border({kind, {}, z_, 0, 0, {}}, e.start, end.start, z_);
      else strips_.border({kind, {}, z_, 0, 0, {}}, end.start, e.start, z_);
    });
  }

  /// On to the next critical height; false when nothing is left to raise.
  auto rise() -> bool {
    Rational limit = cap_;
    for_each_edge(wave_.loops, [&](const WaveEdge& e, const WaveEdge&) {
      if (const auto z = knot(wave_.lines[e.line]); z && *z < limit) limit = *z;
    });
    const auto event = wave_.next_event(z_, limit);
    if (event) solid_.events.push_back(*event);
    sweep(event ? *event : limit, event ? *event : limit);
    if (wave_.loops.empty()) return false;
    if (z_ == cap_) {
      level(FaceKind::cap);
      return false;
    }
    // Geometric events came first; then terraces, then new speeds.
    for (Line& line : wave_.lines)
      if (knot(line) == z_) ++line.part;
    pass_terraces();
    if (wave_.loops.empty()) return false;
    set_speeds();
    wave_.connect(z_);
    return true;
  }

  /// All terraces that begin at this height run in a second time from 0 to 1, while everything else stands still.
  void pass_terraces() {
    bool any = false;
    for_each_edge(wave_.loops,
                  [&](const WaveEdge& e, const WaveEdge&) { any = any || is_terrace(wave_.lines[e.line]); });
    if (!any) return;
    for_each_edge(wave_.loops, [&](const WaveEdge& e, const WaveEdge&) {
      Line& line = wave_.lines[e.line];
      line.offset = line.across(e.start);
      line.speed = is_terrace(line) ? Rational(track(line)[line.part].run * line.direction.l) : Rational(0);
    });
    for (Rational t = 0; t < 1 && !wave_.loops.empty();) {
      wave_.connect(t);
      const auto event = wave_.next_event(t, 1);
      if (event) solid_.events.push_back(z_);
      t = event ? *event : Rational(1);
      sweep(t, z_);
    }
    for (Line& line : wave_.lines)
      if (is_terrace(line)) ++line.part;
    set_speeds();
  }

  const Footprint& footprint_;
  const Rational cap_;
  Rational z_ = 0;
  Wave wave_;
  Strips strips_;
  Solid solid_;
};

}  // namespace

auto raise(const Footprint& footprint, const Rational& cap) -> Solid { return Extrusion(footprint, cap).run(); }

}  // namespace oracle
