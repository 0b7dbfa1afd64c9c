#include "lab/simulate/detail/columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "mansard/geometry/angles.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr std::size_t lines = 16;
constexpr double endless = 1e6;  // m; how far down the ground goes

/// Where line s of a node stands, as a share of the step: all x and all y differ.
auto offset(std::size_t s) -> Point2 {
  const auto a = static_cast<double>(s % 4), b = static_cast<double>(s / 4);
  return {(4 * a + b + 0.5) / lines - 0.5, (4 * b + a + 0.5) / lines - 0.5};
}

/// Which side of the line from a to b; its ends are put in order, so that two triangles at an edge agree.
auto lies_left(Point2 a, Point2 b, Point2 p) -> bool {
  if (a < b) return cross(b - a, p - a) >= 0;
  return cross(a - b, p - b) < 0;
}

struct Span {
  double from = 0, to = 0;
  friend auto operator<=>(const Span&, const Span&) = default;
};

/// A surface crossed by a vertical line: +1 into a solid on the way up, −1 out of it.
struct Crossing {
  std::uint32_t line = 0, building = 0;
  int into = 0;
  double z = 0;
};

class Lines {
 public:
  Lines(const World& world, const Lattice& lattice, std::int64_t i0, std::int64_t j0, std::int64_t ni, std::int64_t nj)
      : world_(world), lattice_(lattice), i0_(i0), j0_(j0), ni_(ni), nj_(nj) {}

  void cross_all(const std::vector<std::uint32_t>& triangles) {
    for (const auto t : triangles) cross_one(t);
    std::ranges::sort(crossings_, [](const Crossing& a, const Crossing& b) {
      return std::tuple(a.line, a.building, a.z, -a.into) < std::tuple(b.line, b.building, b.z, -b.into);
    });
  }

  /// What is solid along every line, in order, without overlaps.
  template <class Take>
  void each(const std::vector<std::uint32_t>& objects, Take take) {
    std::vector<Span> spans;
    std::size_t next = 0;
    for (std::int64_t j = 0; j < nj_; ++j)
      for (std::int64_t i = 0; i < ni_; ++i)
        for (std::size_t s = 0; s < lines; ++s) {
          const Point2 p = place(i, j, s);
          const double ground = world_.terrain.at(p);
          spans.assign(1, {-endless, ground});
          add_buildings(line_of(i, j, s), ground, next, spans);
          for (const auto o : objects)
            if (const auto span = world_.objects[o].span(p)) spans.push_back({span->first, span->second});
          unite(spans);
          take(i, j, spans);
        }
  }

 private:
  [[nodiscard]] auto line_of(std::int64_t i, std::int64_t j, std::size_t s) const -> std::uint32_t {
    return static_cast<std::uint32_t>(static_cast<std::size_t>(j * ni_ + i) * lines + s);
  }
  [[nodiscard]] auto place(std::int64_t i, std::int64_t j, std::size_t s) const -> Point2 {
    return xy(lattice_.at(i0_ + i, j0_ + j, 0)) + lattice_.step * offset(s);
  }

  void cross_one(std::uint32_t triangle) {
    const auto& corners = world_.surface.mesh.triangles[triangle];
    std::array<Point3, 3> v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = world_.surface.mesh.vertices[corners[i]];
    const double doubled = cross(xy(v[1]) - xy(v[0]), xy(v[2]) - xy(v[0]));
    if (doubled == 0) return;
    const auto box = geometry::Box2::of(v);
    const auto nodes = [&](double least, double most, double origin, std::int64_t first, std::int64_t count) {
      const auto from = static_cast<std::int64_t>(std::floor((least - origin) / lattice_.step - 0.5)) - first;
      const auto to = static_cast<std::int64_t>(std::ceil((most - origin) / lattice_.step + 0.5)) - first;
      return std::pair(std::max<std::int64_t>(from, 0), std::min(to, count - 1));
    };
    const auto [left, right] = nodes(box.least.x, box.most.x, lattice_.origin.x, i0_, ni_);
    const auto [low, high] = nodes(box.least.y, box.most.y, lattice_.origin.y, j0_, nj_);
    const Point3 normal = cross(v[1] - v[0], v[2] - v[0]);
    const bool up = doubled > 0;
    for (auto j = low; j <= high; ++j)
      for (auto i = left; i <= right; ++i)
        for (std::size_t s = 0; s < lines; ++s) {
          const Point2 p = place(i, j, s);
          if (lies_left(xy(v[0]), xy(v[1]), p) != up || lies_left(xy(v[1]), xy(v[2]), p) != up ||
              lies_left(xy(v[2]), xy(v[0]), p) != up)
            continue;
          const double z = v[0].z - (normal.x * (p.x - v[0].x) + normal.y * (p.y - v[0].y)) / normal.z;
          crossings_.push_back({line_of(i, j, s), world_.surface.buildings[triangle], up ? -1 : 1, z});
        }
  }

  void add_buildings(std::uint32_t line, double ground, std::size_t& next, std::vector<Span>& spans) const {
    while (next < crossings_.size() && crossings_[next].line == line) {
      const std::size_t first = next;
      const auto same = [&](const Crossing& c) { return c.line == line && c.building == crossings_[first].building; };
      while (next < crossings_.size() && same(crossings_[next])) ++next;
      add_building({crossings_.begin() + static_cast<std::ptrdiff_t>(first), next - first}, ground, spans);
    }
  }

  /// Where its surfaces do not close, a building is solid from the highest one down.
  static void add_building(std::span<const Crossing> crossings, double ground, std::vector<Span>& spans) {
    constexpr double passage = 2.0;  // m; what starts lower stands on the ground, however that falls
    const std::size_t before = spans.size();
    int inside = 0;
    double from = 0;
    for (const Crossing& crossing : crossings) {
      if (inside == 0) from = crossing.z < ground + passage ? -endless : crossing.z;
      inside += crossing.into;
      if (inside == 0) spans.push_back({from, crossing.z});
    }
    if (inside == 0) return;
    spans.resize(before);
    spans.push_back({-endless, crossings.back().z});
  }

  static void unite(std::vector<Span>& spans) {
    std::ranges::sort(spans);
    std::size_t kept = 0;
    for (std::size_t i = 1; i < spans.size(); ++i) {
      if (spans[i].from <= spans[kept].to) spans[kept].to = std::max(spans[kept].to, spans[i].to);
      else spans[++kept] = spans[i];
    }
    spans.resize(kept + 1);
  }

  const World& world_;
  const Lattice& lattice_;
  std::int64_t i0_, j0_, ni_, nj_;
  std::vector<Crossing> crossings_;
};

/// Along one direction: `stride` apart, `count` of them, ends repeated.
void blur_line(float* values, std::size_t stride, std::int64_t count, const std::vector<float>& weights,
               std::vector<float>& scratch) {
  const auto reach = static_cast<std::int64_t>(weights.size() / 2);
  scratch.resize(static_cast<std::size_t>(count + 2 * reach));
  for (std::int64_t i = -reach; i < count + reach; ++i)
    scratch[static_cast<std::size_t>(i + reach)] =
        values[static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, count - 1)) * stride];
  for (std::int64_t i = 0; i < count; ++i) {
    float sum = 0;
    for (std::size_t w = 0; w < weights.size(); ++w) sum += weights[w] * scratch[static_cast<std::size_t>(i) + w];
    values[static_cast<std::size_t>(i) * stride] = sum;
  }
}

}  // namespace

auto solid_share(const World& world, const Lattice& lattice, std::int64_t i0, std::int64_t j0, std::int64_t ni,
                 std::int64_t nj, std::int64_t spare, const std::vector<std::uint32_t>& triangles,
                 const std::vector<std::uint32_t>& objects) -> Cells {
  Lines lines_of(world, lattice, i0, j0, ni, nj);
  lines_of.cross_all(triangles);
  struct Of {
    std::int64_t i, j;
    Span span;
  };
  std::vector<Of> all;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  lines_of.each(objects, [&](std::int64_t i, std::int64_t j, const std::vector<Span>& spans) {
    for (const Span& span : spans) {
      all.push_back({i, j, span});
      low = std::min(low, span.to);  // the lowest air, or a roof
      high = std::max(high, span.to);
    }
  });

  Cells cells{i0, j0, 0, ni, nj, 0, {}};
  const auto level = [&](double z) { return (z - lattice.origin.z) / lattice.step; };
  cells.k0 = static_cast<std::int64_t>(std::floor(level(low))) - spare - 1;
  cells.nk = static_cast<std::int64_t>(std::ceil(level(high))) + spare + 2 - cells.k0;
  // Whole cells are written as steps at their ends and summed up afterwards.
  std::vector<float> steps(static_cast<std::size_t>(ni * nj * cells.nk), 0.0F);
  cells.share = steps;
  constexpr float one = 1.0F / lines;
  for (const auto& [i, j, span] : all) {
    // In cells from the bottom: node k0 is the cell from 0 to 1.
    const auto clamped = [&](double z) {
      return std::clamp(level(z) - static_cast<double>(cells.k0) + 0.5, 0.0, static_cast<double>(cells.nk) - 1e-9);
    };
    const double from = clamped(span.from), to = clamped(span.to);
    const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to);
    const std::size_t column = cells.index(i0 + i, j0 + j, cells.k0);
    const auto part = [](double share) { return one * static_cast<float>(share); };
    steps[column + a] += one;
    steps[column + b] -= one;
    cells.share[column + a] -= part(from - static_cast<double>(a));
    cells.share[column + b] += part(to - static_cast<double>(b));
  }
  for (std::size_t column = 0; column < steps.size(); column += static_cast<std::size_t>(cells.nk)) {
    float sum = 0;
    for (std::size_t k = column; k < column + static_cast<std::size_t>(cells.nk); ++k) {
      sum += steps[k];
      cells.share[k] += sum;
    }
  }
  return cells;
}

auto blur_reach(double deviation) -> std::int64_t {
  constexpr double least = 0.2;  // steps; less moves nothing
  return deviation < least ? 0 : static_cast<std::int64_t>(std::ceil(3 * deviation));
}

void blur(Cells& cells, double deviation) {
  const auto reach = blur_reach(deviation);
  if (reach == 0) return;
  std::vector<double> exact;
  double sum = 0;
  for (auto i = -reach; i <= reach; ++i) {
    const double x = static_cast<double>(i) / deviation;
    exact.push_back(geometry::exponential(-x * x / 2));
    sum += exact.back();
  }
  std::vector<float> weights, scratch;
  for (const double w : exact) weights.push_back(static_cast<float>(w / sum));

  const auto nk = static_cast<std::size_t>(cells.nk), row = nk * static_cast<std::size_t>(cells.ni);
  for (std::size_t at = 0; at < cells.share.size(); at += nk)
    blur_line(&cells.share[at], 1, cells.nk, weights, scratch);
  for (std::size_t at = 0; at < cells.share.size(); at += row)
    for (std::size_t k = 0; k < nk; ++k) blur_line(&cells.share[at + k], nk, cells.ni, weights, scratch);
  for (std::size_t at = 0; at < row; ++at) blur_line(&cells.share[at], row, cells.nj, weights, scratch);
}

}  // namespace mansard::simulate::detail
