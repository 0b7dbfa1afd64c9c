// The five kinds of block, each in its own frame: the street along x, the ground at 0.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mansard/geometry/angles.hpp"

#include "lab/simulate/detail/lots.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Point2;
using geometry::Ring;

/// Where a row stands: along u from the origin, deep along left_of(u).
struct Frame {
  Point2 origin, u;
  [[nodiscard]] auto at(double along, double deep) const -> Point2 { return origin + along * u + deep * left_of(u); }
  /// Counter-clockwise: front, right, back, left.
  [[nodiscard]] auto rectangle(double from, double near, double to, double far) const -> Ring {
    return {at(from, near), at(to, near), at(to, far), at(from, far)};
  }
};
enum Edge : std::size_t { front, right, back, left };

/// What neighbours in a row may have in common.
struct Style {
  int storeys = 3;
  double storey = 3.0;  // m
  Roof roof = Roof::pitched;
  bool across = false;  // ridge at right angles to the street
  double pitch = 0.7;   // rad
  bool gutter = false;
  double lift = 0;  // m; on sloping ground, for eaves in line with the neighbour's
  [[nodiscard]] auto eaves() const -> double { return 0.4 + lift + storeys * storey; }
};

auto chance(base::Random& random, double share) -> bool { return random.uniform() < share; }

auto whole(base::Random& random, int least, int most) -> int {
  return least + static_cast<int>(random.index(static_cast<std::size_t>(most - least + 1)));
}

auto drawn_style(base::Random& random, int least, int most) -> Style {
  Style style;
  style.storeys = whole(random, least, most);
  style.storey = random.uniform(2.8, 3.4);
  const double kind = random.uniform();
  style.roof = kind < 0.25 ? Roof::flat : kind < 0.42 ? Roof::mansard : kind < 0.5 ? Roof::mono : Roof::pitched;
  style.across = kind > 0.88;
  style.pitch = style.roof == Roof::mono      ? random.uniform(8, 20) * degree
                : style.roof == Roof::mansard ? random.uniform(20, 30) * degree
                                              : random.uniform(25, 55) * degree;
  style.gutter = chance(random, 0.25);
  return style;
}

auto word(const Style& style) -> std::string {
  switch (style.roof) {
    case Roof::flat: return "flat";
    case Roof::mansard: return "mansard";
    case Roof::mono: return "mono";
    case Roof::pitched: return style.across ? "gable across" : "gable along";
  }
  return {};
}

/// A lot in that style; `upright` as in Lot.
auto lot_of(Ring ring, const Style& style, std::vector<bool> upright) -> Lot {
  Lot lot;
  lot.polygon.outer = std::move(ring);
  lot.roof = style.roof;
  lot.eaves = style.eaves();
  lot.pitch = style.pitch;
  lot.upright = std::move(upright);
  lot.parapet = style.roof == Roof::flat;
  lot.gutter = style.gutter && style.roof != Roof::flat;
  return lot;
}

/// The sides of a row house that stand upright.
auto row_gables(const Style& style) -> std::vector<bool> {
  if (style.roof == Roof::mono) return {true, true, false, true};
  return style.across ? std::vector<bool>{true, false, true, false} : std::vector<bool>{false, true, false, true};
}

class Layout {
 public:
  Layout(const BlockOptions& options, base::Random& random) : options_(options), random_(random) {}

  auto take() && -> std::vector<House> { return std::move(houses_); }

  void terrace() {
    const double depth = random_.uniform(8.5, 11), gardens = random_.uniform(12, 18), half = options_.size / 2;
    const int storeys = whole(random_, 2, 4);
    row({{-half, 0}, {1, 0}}, options_.size, depth, random_.uniform(5, 7.5), storeys, 5);
    row({{half, 2 * depth + gardens}, {-1, 0}}, options_.size, depth, random_.uniform(5, 8), storeys, 5);
  }

  void perimeter() {
    const double wide = options_.size, deep = random_.uniform(0.7, 0.9) * options_.size;
    const double depth = random_.uniform(11, 13.5);
    std::array<Point2, 4> outer{{{-wide / 2, 0}, {wide / 2, 0}, {wide / 2, deep}, {-wide / 2, deep}}};
    for (auto& corner : outer)
      corner = corner + Point2{random_.uniform(-0.05, 0.05) * wide, random_.uniform(-0.05, 0.05) * deep};
    const int storeys = whole(random_, 4, 5);
    Frames sides{};
    for (std::size_t i = 0; i < 4; ++i) sides[i] = {outer[i], normalised(outer[(i + 1) % 4] - outer[i])};
    // How far along each side its corner houses reach.
    std::array<double, 4> from{}, to{};
    for (std::size_t i = 0; i < 4; ++i) {
      const Point2 inner = inner_corner(sides, i, depth);
      from[i] = dot(inner - outer[i], sides[i].u) + random_.uniform(4.5, 7);
      const std::size_t before = (i + 3) % 4;
      to[before] = dot(inner - outer[before], sides[before].u) - random_.uniform(4.5, 7);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      corner_house(sides, i, to[(i + 3) % 4], from[i], depth, storeys);
      row({sides[i].at(from[i], 0), sides[i].u}, to[i] - from[i], depth, random_.uniform(8, 13), storeys, 4);
    }
  }

  void courtyard() {
    double at = -options_.size / 2;
    const double deep = random_.uniform(26, 32);
    int count = std::max(2, static_cast<int>(std::lround(options_.size / 25)));
    const double wide = options_.size / count;
    for (; count > 0; --count, at += wide) palazzo({{at, 0}, {1, 0}}, wide, deep - random_.uniform(0, 3));
  }

  void towers() {
    double at = -options_.size / 2;
    for (bool slab = false; at < options_.size / 2 - 15; slab = chance(random_, 0.3)) {
      const double wide = random_.uniform(20, 28), deep = random_.uniform(20, 27);
      const Frame frame{{at, random_.uniform(0, 3)}, {1, 0}};
      if (slab) at += this->slab(frame);
      else podium(frame, wide, deep), at += wide;
      at += random_.uniform(7, 14);
    }
  }

  void detached() {
    constexpr double plot = 20;
    const int columns = std::max(1, static_cast<int>(std::lround(options_.size / plot)));
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < columns; ++column) {
        const double turn = random_.uniform(-0.1, 0.1) + (row == 0 ? 0 : chance(random_, 0.3) ? 1.5707963267948966 : 0);
        const Point2 middle{plot * (column - 0.5 * (columns - 1)) + random_.uniform(-1, 1),
                            plot * row + random_.uniform(-1, 1)};
        cottage(middle, {geometry::cosine(turn), geometry::sine(turn)});
      }
  }

 private:
  using Frames = std::array<Frame, 4>;

  [[nodiscard]] auto ground(Point2 p) const -> double { return options_.slope * p.x; }

  /// A new building, its entrance there.
  auto house(const std::string& roof, int storeys, Point2 entrance) -> House& {
    auto& fresh = houses_.emplace_back();
    fresh.ground = ground(entrance);
    fresh.id = "house-" + std::to_string(houses_.size());
    fresh.roof = roof;
    fresh.storeys = storeys;
    return fresh;
  }

  /// Houses wall to wall, with something lower at the back of some.
  void row(const Frame& frame, double length, double depth, double width, int storeys, double annex_depth) {
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(length / width)));
    std::vector<double> widths;
    const bool alike = options_.alike > 0 && chance(random_, options_.alike);
    for (std::size_t i = 0; i < count; ++i) widths.push_back(alike ? 1 : random_.uniform(0.8, 1.2));
    const double scale = length / std::accumulate(widths.begin(), widths.end(), 0.0);
    Style style = drawn_style(random_, std::max(1, storeys - 1), storeys + 1);
    double at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double to = i + 1 == count ? length : at + scale * widths[i];
      const Point2 entrance = frame.at((at + to) / 2, 0);
      if (i > 0 && !alike && !chance(random_, options_.equal_heights))
        style = drawn_style(random_, std::max(1, storeys - 1), storeys + 1);
      else if (i > 0) style.lift += houses_.back().ground - ground(entrance);
      const double near = !alike && chance(random_, 0.15) ? random_.uniform(0.3, 0.8) : 0;
      const double far = depth - (!alike && chance(random_, 0.4) ? random_.uniform(0.3, 1.5) : 0);
      auto& fresh = house(word(style), style.storeys, entrance);
      fresh.lots.push_back(lot_of(frame.rectangle(at, near, to, far), style, row_gables(style)));
      if (style.storeys > 1 && chance(random_, options_.annexes))
        fresh.lots.push_back(annex(frame, at, to, far, annex_depth, style, i % 2 == 0));
      at = to;
    }
  }

  auto annex(const Frame& frame, double from, double to, double near, double most_deep, const Style& of, bool at_left)
      -> Lot {
    const double wide = random_.uniform(0.4, 0.6) * (to - from), deep = random_.uniform(0.55, 0.95) * most_deep;
    Style style = of;
    style.storeys = whole(random_, 1, of.storeys - 1);
    const double kind = random_.uniform();
    style.roof = kind < 0.5 ? Roof::mono : kind < 0.75 ? Roof::pitched : Roof::flat;
    style.pitch = random_.uniform(15, 30) * degree;
    style.gutter = false;
    const double start = at_left ? from : to - wide;
    std::vector<bool> upright{true, false, true, false};
    if (style.roof == Roof::mono) upright = {true, !at_left, true, at_left};
    auto lot = lot_of(frame.rectangle(start, near, start + wide, near + deep), style, upright);
    lot.role = "annex";
    lot.parapet = false;
    return lot;
  }

  static auto inner_corner(const Frames& sides, std::size_t i, double depth) -> Point2 {
    const Frame& before = sides[(i + 3) % 4];
    const Frame& after = sides[i];
    // On the line `depth` inside of both sides.
    const Point2 p = before.at(0, depth), q = after.at(0, depth);
    return p + (cross(q - p, after.u) / cross(before.u, after.u)) * before.u;
  }

  void corner_house(const Frames& sides, std::size_t i, double start, double end, double depth, int storeys) {
    const Frame& before = sides[(i + 3) % 4];
    Style style = drawn_style(random_, storeys, storeys + 1);
    if (style.roof == Roof::mono) style.roof = Roof::pitched, style.pitch = 0.6;
    style.across = false;
    const Ring ring{before.at(start, 0),           sides[i].origin,        sides[i].at(end, 0), sides[i].at(end, depth),
                    inner_corner(sides, i, depth), before.at(start, depth)};
    house(style.roof == Roof::pitched ? "corner" : word(style), style.storeys, sides[i].origin)
        .lots.push_back(lot_of(ring, style, {false, false, true, false, false, true}));
  }

  /// A building around a courtyard, or with one behind its front.
  void palazzo(const Frame& frame, double wide, double deep) {
    Style style = drawn_style(random_, 3, 5);
    if (style.roof == Roof::mono || style.across) style.roof = Roof::pitched, style.pitch = 0.6, style.across = false;
    const double ring = random_.uniform(6.5, 8), kind = random_.uniform();
    auto& fresh = house(kind < 0.35 ? "front and wings" : word(style), style.storeys, frame.at(wide / 2, 0));
    if (kind < 0.35) return front_and_wings(fresh, frame, wide, deep, ring, style);
    auto lot = lot_of(frame.rectangle(0, 0, wide, deep), style, {false, true, false, true});
    const auto add_court = [&](double from, double near, double to, double far) {
      auto court = frame.rectangle(from, near, to, far);
      std::ranges::reverse(court);
      lot.polygon.holes.push_back(court);
    };
    if (kind < 0.6 && deep > 3 * ring) {
      const double middle = deep / 2, half = ring / 2 - 0.5;
      add_court(ring, ring, wide - ring, middle - half);
      add_court(ring, middle + half, wide - ring, deep - ring);
    } else {
      add_court(ring, ring, wide - ring, deep - ring);
    }
    if (style.roof == Roof::flat) {  // light wells beside the stairs
      const double well = random_.uniform(1.8, 2.6), at = random_.uniform(0.3, 0.6) * deep;
      add_court(1.5, at, 1.5 + well, at + 1.4 * well);
    }
    fresh.lots.push_back(std::move(lot));
  }

  void front_and_wings(House& fresh, const Frame& frame, double wide, double deep, double ring, const Style& style) {
    const double near = ring + 2.5;
    fresh.lots.push_back(lot_of(frame.rectangle(0, 0, wide, near), style, {false, true, false, true}));
    Style lower = style;
    lower.storeys = whole(random_, 1, style.storeys - 1);
    lower.gutter = false;
    const Ring u{frame.at(0, near),           frame.at(ring, near),
                 frame.at(ring, deep - ring), frame.at(wide - ring, deep - ring),
                 frame.at(wide - ring, near), frame.at(wide, near),
                 frame.at(wide, deep),        frame.at(0, deep)};
    auto wings = lot_of(u, lower, {true, false, false, false, true, true, false, true});
    wings.role = "wing";
    fresh.lots.push_back(std::move(wings));
  }

  /// A low, broad building with a tower in it, or on its front.
  void podium(const Frame& frame, double wide, double deep) {
    const double tower = random_.uniform(11, 15), low = random_.uniform(5, 8);
    const int storeys = whole(random_, 7, 14);
    const double x = random_.uniform(3, wide - tower - 3), y = random_.uniform(3, deep - tower - 3);
    const bool flush = chance(random_, 0.4);
    auto& fresh = house("podium and tower", storeys, frame.at(wide / 2, 0));
    Lot base;
    base.role = "podium";
    base.eaves = low;
    if (flush) {
      base.polygon.outer = {frame.at(0, 0),         frame.at(x, 0),    frame.at(x, tower),   frame.at(x + tower, tower),
                            frame.at(x + tower, 0), frame.at(wide, 0), frame.at(wide, deep), frame.at(0, deep)};
    } else {
      base.polygon.outer = frame.rectangle(0, 0, wide, deep);
      auto hole = frame.rectangle(x, y, x + tower, y + tower);
      std::ranges::reverse(hole);
      base.polygon.holes.push_back(hole);
    }
    fresh.lots.push_back(std::move(base));
    const double y0 = flush ? 0 : y;
    Lot high;
    high.role = "tower";
    high.polygon.outer = frame.rectangle(x, y0, x + tower, y0 + tower);
    high.eaves = 0.4 + storeys * random_.uniform(2.8, 3.4);
    high.roof = chance(random_, 0.7) ? Roof::flat : Roof::pitched;
    high.pitch = random_.uniform(20, 40) * degree;
    high.upright.assign(4, false);
    high.parapet = high.roof == Roof::flat;
    fresh.lots.push_back(std::move(high));
  }

  /// A long building, its end to the street; how wide it is.
  auto slab(const Frame& frame) -> double {
    const double wide = random_.uniform(11, 14);
    Style style = drawn_style(random_, 5, 6);
    style.roof = Roof::flat;
    house("flat", style.storeys, frame.origin)
        .lots.push_back(lot_of(frame.rectangle(0, 0, wide, random_.uniform(26, 40)), style, {}));
    return wide;
  }

  void cottage(Point2 middle, Point2 u) {
    const double wide = random_.uniform(8.5, 11.5), deep = random_.uniform(7, 9);
    Style style;
    style.storeys = whole(random_, 1, 2);
    style.storey = random_.uniform(2.8, 3.4);
    style.pitch = random_.uniform(25, 50) * degree;
    const Frame frame{middle - 0.5 * wide * u - 0.5 * deep * left_of(u), u};
    const double kind = random_.uniform();
    const double wing = random_.uniform(0.4, 0.5) * wide, out = random_.uniform(2, 3.5);
    if (kind < 0.3) {
      house("gable along", style.storeys, middle)
          .lots.push_back(lot_of(frame.rectangle(0, 0, wide, deep), style, {false, true, false, true}));
    } else if (kind < 0.5) {
      house("hip", style.storeys, middle)
          .lots.push_back(lot_of(frame.rectangle(0, 0, wide, deep), style, std::vector(4, false)));
    } else if (kind < 0.8) {
      const Ring ring{frame.at(0, 0),       frame.at(wide - wing, 0), frame.at(wide - wing, -out),
                      frame.at(wide, -out), frame.at(wide, deep),     frame.at(0, deep)};
      house("gable with wing", style.storeys, middle)
          .lots.push_back(lot_of(ring, style, {false, false, true, false, false, true}));
    } else {
      style.roof = Roof::flat;
      house("flat", style.storeys, middle).lots.push_back(lot_of(frame.rectangle(0, 0, wide, deep), style, {}));
    }
    if (chance(random_, 0.5)) garage(frame, deep);
  }

  /// At the left of a house: a part of it, or a building of its own.
  void garage(const Frame& frame, double deep) {
    Lot lot;
    lot.role = "garage";
    const double wide = random_.uniform(3, 4), back = random_.uniform(0, 0.8);
    lot.polygon.outer = frame.rectangle(-wide, deep - 6.2, 0, deep - back);
    lot.eaves = random_.uniform(2.5, 3);
    if (chance(random_, 0.5)) house("garage", 1, frame.origin).lots.push_back(std::move(lot));
    else houses_.back().lots.push_back(std::move(lot));
  }

  const BlockOptions& options_;
  base::Random& random_;
  std::vector<House> houses_;
};

}  // namespace

auto houses_of(Kind kind, const BlockOptions& options, base::Random& random) -> std::vector<House> {
  Layout layout(options, random);
  switch (kind) {
    case Kind::terrace: layout.terrace(); break;
    case Kind::perimeter: layout.perimeter(); break;
    case Kind::courtyard: layout.courtyard(); break;
    case Kind::towers: layout.towers(); break;
    case Kind::detached: layout.detached(); break;
  }
  return std::move(layout).take();
}

}  // namespace mansard::simulate::detail
