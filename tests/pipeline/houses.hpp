// Small synthetic streets: meshes as a scan would show them, with the footprints that go with them.
#pragma once

#include "mansard/ingest/ingest.hpp"

namespace mansard::test {

inline void add_quad(geometry::Mesh& mesh, geometry::Point3 a, geometry::Point3 b, geometry::Point3 c,
                     geometry::Point3 d) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& p : {a, b, c, d}) mesh.vertices.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

inline void add_triangle(geometry::Mesh& mesh, geometry::Point3 a, geometry::Point3 b, geometry::Point3 c) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& p : {a, b, c}) mesh.vertices.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// An axis-parallel house from (x0, y0) to (x1, y1), ridge along x in the middle; a flat roof when ridge == eaves.
inline void add_house(geometry::Mesh& mesh, double x0, double y0, double x1, double y1, double eaves, double ridge) {
  const double ym = (y0 + y1) / 2;
  add_quad(mesh, {x0, y0, 0}, {x1, y0, 0}, {x1, y0, eaves}, {x0, y0, eaves});
  add_quad(mesh, {x1, y1, 0}, {x0, y1, 0}, {x0, y1, eaves}, {x1, y1, eaves});
  add_quad(mesh, {x1, y0, 0}, {x1, y1, 0}, {x1, y1, eaves}, {x1, y0, eaves});
  add_quad(mesh, {x0, y1, 0}, {x0, y0, 0}, {x0, y0, eaves}, {x0, y1, eaves});
  if (ridge > eaves) {
    add_triangle(mesh, {x1, y0, eaves}, {x1, y1, eaves}, {x1, ym, ridge});
    add_triangle(mesh, {x0, y1, eaves}, {x0, y0, eaves}, {x0, ym, ridge});
  }
  add_quad(mesh, {x0, y0, eaves}, {x1, y0, eaves}, {x1, ym, ridge}, {x0, ym, ridge});
  add_quad(mesh, {x1, y1, eaves}, {x0, y1, eaves}, {x0, ym, ridge}, {x1, ym, ridge});
}

inline auto rectangle(double x0, double y0, double x1, double y1) -> geometry::Polygon {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

inline auto footprint(std::string id, geometry::Polygon polygon) -> model::Footprint {
  model::Footprint f;
  f.id = std::move(id);
  f.polygons = {std::move(polygon)};
  f.attributes = {{"use", std::string("home")}};
  return f;
}

/// A gabled house of 12 × 8 m, 5 m to the eaves and 8 m to the ridge, on a level field.
inline auto lone_house() -> model::Scene {
  model::Scene scene;
  add_quad(scene.mesh, {-20, -20, 0}, {40, -20, 0}, {40, 40, 0}, {-20, 40, 0});
  add_house(scene.mesh, 0, 0, 12, 8, 5, 8);
  scene.footprints.push_back(footprint("house", rectangle(0, 0, 12, 8)));
  return scene;
}

/// Two flat-roofed houses wall to wall, 6 and 9 m high.
inline auto terrace() -> model::Scene {
  model::Scene scene;
  add_quad(scene.mesh, {-20, -20, 0}, {50, -20, 0}, {50, 40, 0}, {-20, 40, 0});
  add_house(scene.mesh, 0, 0, 12, 10, 6, 6);
  add_house(scene.mesh, 12, 0, 24, 10, 9, 9);
  scene.footprints.push_back(footprint("low", rectangle(0, 0, 12, 10)));
  scene.footprints.push_back(footprint("high", rectangle(12, 0, 24, 10)));
  return scene;
}

/// An L of two wings of 6 and 9 m under one footprint, beside the terrace of two footprints, 100 m above the datum.
inline auto town() -> model::Scene {
  auto scene = terrace();
  add_house(scene.mesh, 30, 0, 42, 10, 6, 6);
  add_house(scene.mesh, 30, 10, 36, 24, 9, 9);
  scene.footprints.push_back(footprint("wings", {{{30, 0}, {42, 0}, {42, 10}, {36, 10}, {36, 24}, {30, 24}}, {}}));
  scene.frame = {{84800, 447400, 100}, "EPSG:28992"};
  return scene;
}

/// A footprint so far away that its ground is not known.
inline auto with_a_bad_block(model::Scene scene) -> model::Scene {
  scene.footprints.push_back(footprint("far", rectangle(2e7, 0, 2e7 + 12, 8)));
  return scene;
}

}  // namespace mansard::test
