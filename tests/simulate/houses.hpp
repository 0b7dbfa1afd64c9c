// Small models to scan.
#pragma once

#include <gtest/gtest.h>

#include "lab/simulate/simulate.hpp"

namespace mansard::test {

/// A rectangle raised to `height`, with a roof of that rise over its middle along x when `rise` > 0.
inline auto house(const std::string& id, double x0, double y0, double x1, double y1, double height, double rise = 0)
    -> model::Building {
  model::Plan plan;
  plan.outer.points = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  plan.profiles = {{{0, 0}, {0, height}}};
  plan.outer.profile_of_edge = {0, 0, 0, 0};
  plan.cap = height;
  if (rise > 0) {
    plan.profiles.push_back({{0, 0}, {0, height}, {(y1 - y0) / 2, height + rise}});
    plan.outer.profile_of_edge = {1, 0, 1, 0};
    plan.cap = height + rise + 0.01;
  }
  model::Building building;
  building.id = id;
  building.parts.push_back({id + "-1", plan, {}, {}});
  return building;
}

inline auto truth_of(std::vector<model::Building> buildings) -> simulate::Truth {
  model::City city;
  city.buildings = std::move(buildings);
  auto truth = simulate::truth_of(std::move(city));
  EXPECT_TRUE(truth) << base::to_string(truth.error());
  return std::move(*truth);
}

/// Two flat-roofed houses wall to wall at x = 12, 6 and 9 m high.
inline auto pair_of_houses() -> simulate::Truth {
  return truth_of({house("low", 0, 0, 12, 10, 6), house("high", 12, 0, 24, 10, 9)});
}

/// No noise, no losses, no melt, nothing but buildings and level ground, sampled.
inline auto clean() -> simulate::ScanOptions {
  simulate::Options options;
  auto list = simulate::option_list(options);
  for (const auto& [key, value] : simulate::presets().front().values) {
    const auto* option = list.find(key.substr(key.find('.') + 1));
    EXPECT_TRUE(option != nullptr && option->set(value)) << key;
  }
  options.scan.exact = false;
  return options.scan;
}

inline auto scanned(const simulate::Truth& truth, const simulate::ScanOptions& options, std::uint64_t seed = 1)
    -> simulate::Scan {
  const auto surface = simulate::surface_of(truth.city);
  EXPECT_TRUE(surface);
  auto scan = simulate::scan(*surface, options, seed);
  EXPECT_TRUE(scan) << base::to_string(scan.error());
  return std::move(*scan);
}

inline auto centre(const geometry::Mesh& mesh, const geometry::Triangle& t) -> geometry::Point3 {
  return (1.0 / 3) * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
}
/// Twice the area, along the normal.
inline auto across(const geometry::Mesh& mesh, const geometry::Triangle& t) -> geometry::Point3 {
  return cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}
/// m² of the triangles of that class whose centres pass.
template <class Pass>
auto area_of(const simulate::Scan& scan, simulate::Class kind, Pass pass) -> double {
  double sum = 0;
  for (std::size_t t = 0; t < scan.classes.size(); ++t)
    if (scan.classes[t] == kind && pass(centre(scan.mesh, scan.mesh.triangles[t])))
      sum += length(across(scan.mesh, scan.mesh.triangles[t])) / 2;
  return sum;
}
inline auto area_of(const simulate::Scan& scan, simulate::Class kind) -> double {
  return area_of(scan, kind, [](geometry::Point3) { return true; });
}

}  // namespace mansard::test
