// Outlines and what is extruded over them.
#pragma once

#include <gmock/gmock.h>
#include <cmath>
#include <numbers>

#include "mansard/extrude/extrude.hpp"
#include "mansard/roof/roof.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::roof::test {

using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;

inline auto box(double w, double d) -> Polygon { return {{{0, 0}, {w, 0}, {w, d}, {0, d}}, {}}; }
/// Two wings of 5 m, 12 m long.
inline auto ell() -> Polygon { return {{{0, 0}, {12, 0}, {12, 5}, {5, 5}, {5, 12}, {0, 12}}, {}}; }
/// A bar of 16 × 6 m and a stem of 4 × 8 m.
inline auto tee() -> Polygon { return {{{0, 8}, {6, 8}, {6, 0}, {10, 0}, {10, 8}, {16, 8}, {16, 14}, {0, 14}}, {}}; }
/// Legs of 4 m on a back of 5 m.
inline auto you() -> Polygon { return {{{0, 0}, {4, 0}, {4, 9}, {10, 9}, {10, 0}, {14, 0}, {14, 14}, {0, 14}}, {}}; }
/// Wings of 6 m around a yard of 8 × 8 m.
inline auto courtyard() -> Polygon {
  return {{{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {{{6, 6}, {6, 14}, {14, 14}, {14, 6}}}};
}
inline auto tower(std::size_t corners, double radius) -> Polygon {
  Polygon polygon;
  for (std::size_t i = 0; i < corners; ++i) {
    const double a = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    polygon.outer.push_back({radius * std::cos(a), radius * std::sin(a)});
  }
  return polygon;
}

inline auto moved(Polygon polygon, double turn, Point2 by) -> Polygon {
  const auto move = [&](geometry::Ring& ring) {
    for (Point2& p : ring)
      p = Point2{std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y} + by;
  };
  move(polygon.outer);
  for (auto& hole : polygon.holes) move(hole);
  return polygon;
}

/// 9 m high, of which the roof takes 3 m.
inline auto form(Shape shape) -> Form {
  Form f;
  f.shape = shape;
  f.height = 9;
  f.rise = 3;
  return f;
}

struct Built {
  Planned planned;
  model::Solid solid;
  double volume = 0, top = 0;
  std::size_t faces = 0;
};
/// Planned and raised; both in full unless `as_asked` is false.
inline auto built(const Polygon& polygon, const Form& f, bool as_asked = true) -> Built {
  auto planned = plan_of(polygon, f);
  if (!planned) {
    ADD_FAILURE() << base::to_string(planned.error());
    return {};
  }
  EXPECT_EQ(planned->as_asked, as_asked) << (planned->warnings.empty() ? "" : planned->warnings[0].message);
  auto raised = extrude::raise(planned->plan);
  if (!raised) {
    ADD_FAILURE() << base::to_string(raised.error());
    return {};
  }
  EXPECT_EQ(raised->outcome, extrude::Outcome::full) << (raised->warnings.empty() ? "" : raised->warnings[0].message);
  Built out{std::move(*planned), std::move(raised->solid), 0, -1e9, 0};
  EXPECT_THAT(solid::check(out.solid), testing::IsEmpty());
  out.volume = solid::volume(out.solid);
  out.faces = out.solid.faces.size();
  for (const Point3 p : out.solid.vertices) out.top = std::max(out.top, p.z);
  EXPECT_NEAR(out.top, out.planned.plan.base + out.planned.top, 1e-3);
  return out;
}

/// Faces that look up, sloped or flat.
inline auto roofs(const model::Solid& solid) -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count_if(solid.faces, [](const auto& f) { return f.normal.z > 1e-3; }));
}
inline auto codes_of(const std::vector<base::Diagnostic>& warnings) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& warning : warnings) out.push_back(warning.code);
  return out;
}

}  // namespace mansard::roof::test
