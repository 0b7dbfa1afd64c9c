// Small cities made by hand.
#pragma once

#include <array>
#include <cmath>
#include <set>
#include <string>

#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/model/city.hpp"

namespace cities {

using mansard::geometry::Point2;
using mansard::geometry::Point3;
using mansard::geometry::Polygon;
using mansard::geometry::Ring;
using mansard::model::Building;
using mansard::model::City;
using mansard::model::Face;
using mansard::model::FaceClass;
using mansard::model::FaceKind;
using mansard::model::LabelledSolid;
using mansard::model::Part;
using mansard::model::Plan;
using mansard::model::Solid;

/// Adds a face and finds its normal (Newell).
inline void add_face(LabelledSolid& model, std::vector<std::vector<std::uint32_t>> loops, FaceClass c) {
  Point3 n;
  const auto& outer = loops.front();
  for (std::size_t i = 0; i < outer.size(); ++i)
    n = n +
        mansard::geometry::cross(model.solid.vertices[outer[i]], model.solid.vertices[outer[(i + 1) % outer.size()]]);
  Face face;
  face.loops = std::move(loops);
  face.normal = mansard::geometry::normalised(n);
  face.kind = c == FaceClass::ground ? FaceKind::base : c == FaceClass::roof ? FaceKind::cap : FaceKind::side;
  model.solid.faces.push_back(std::move(face));
  model.classes.push_back(c);
}

/// A flat-roofed prism of a polygon with holes.
inline auto prism(const Polygon& polygon, double base, double top) -> LabelledSolid {
  LabelledSolid model;
  std::vector<std::vector<std::uint32_t>> below, above;
  std::vector<const Ring*> rings{&polygon.outer};
  for (const auto& hole : polygon.holes) rings.push_back(&hole);
  for (const Ring* ring : rings) {
    const auto first = static_cast<std::uint32_t>(model.solid.vertices.size());
    const auto n = static_cast<std::uint32_t>(ring->size());
    for (const auto& p : *ring) model.solid.vertices.push_back({p.x, p.y, base});
    for (const auto& p : *ring) model.solid.vertices.push_back({p.x, p.y, top});
    auto& down = below.emplace_back();
    auto& up = above.emplace_back();
    for (std::uint32_t i = 0; i < n; ++i) {
      down.push_back(first + n - 1 - i);
      up.push_back(first + n + i);
      const std::uint32_t j = (i + 1) % n;
      add_face(model, {{first + i, first + j, first + n + j, first + n + i}}, FaceClass::wall);
    }
  }
  add_face(model, below, FaceClass::ground);
  add_face(model, above, FaceClass::roof);
  return model;
}

inline auto rectangle(double x, double y, double width, double depth) -> Polygon {
  return {{{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}}, {}};
}

/// A house with its ridge along x: eaves in the south and north, gables in the west and east.
inline auto gable(double x, double y, double width, double depth, double base, double eaves, double ridge)
    -> LabelledSolid {
  LabelledSolid model;
  const double middle = y + depth / 2;
  model.solid.vertices = {
      {x, y, base},       {x + width, y, base},      {x + width, y + depth, base},  {x, y + depth, base},
      {x, y, eaves},      {x + width, y, eaves},     {x + width, y + depth, eaves}, {x, y + depth, eaves},
      {x, middle, ridge}, {x + width, middle, ridge}};
  add_face(model, {{3, 2, 1, 0}}, FaceClass::ground);
  add_face(model, {{0, 1, 5, 4}}, FaceClass::wall);
  add_face(model, {{1, 2, 6, 9, 5}}, FaceClass::wall);
  add_face(model, {{2, 3, 7, 6}}, FaceClass::wall);
  add_face(model, {{3, 0, 4, 8, 7}}, FaceClass::wall);
  add_face(model, {{4, 5, 9, 8}}, FaceClass::roof);
  add_face(model, {{6, 7, 8, 9}}, FaceClass::roof);
  return model;
}

inline auto plan_of(const Polygon& polygon, double base, double height) -> Plan {
  Plan plan;
  plan.outer = {polygon.outer, std::vector<std::uint32_t>(polygon.outer.size(), 0)};
  for (const auto& hole : polygon.holes) plan.holes.push_back({hole, std::vector<std::uint32_t>(hole.size(), 1)});
  plan.profiles = {{{0, 0}, {0, 6}, {3, 9}}, {{0, 0}, {0, height}}};
  plan.base = base;
  plan.cap = height;
  return plan;
}

/// A gabled house of one part; a block with a courtyard and an annex with a party wall as two parts of one feature.
inline auto street() -> City {
  City city;
  city.frame = {{84800, 447400, 0}, "EPSG:28992"};
  city.made_by = {"0.1.0", {{"slice.interval", "0.2"}, {"segment.alpha", "40"}}, {{"mesh.ply", 123, "abc0"}}, {}};

  Building house;
  house.id = "house";
  house.attributes = {{"name", std::string("Haus \"Zur Rose\"")},
                      {"year", std::int64_t{1893}},
                      {"listed", true},
                      {"height", 12.0},
                      {"none", std::monostate{}}};
  house.ground = 1.25;
  house.footprint = {rectangle(1.0625, 2.125, 10, 8)};
  Part gabled{"house-1", plan_of(house.footprint[0], 1.25, 10), gable(1.0625, 2.125, 10, 8, 1.25, 7.25, 11.25), {}};
  gabled.attributes = {{"ms_roof_type", std::string("gabled")}};
  house.parts = {gabled};

  Building block;
  block.id = "block";
  block.ground = 0.5;
  Polygon court = rectangle(20, 0, 20, 20);
  court.holes = {{{25, 5}, {25, 15}, {35, 15}, {35, 5}}};
  const Polygon annex = rectangle(40, 0, 5, 20);
  block.footprint = {court, annex};
  Part ring{"block-1", plan_of(court, 0.5, 12), prism(court, 0.5, 12.5), {{"ms_h_roof_70p", 12.4}}};
  Part side{"block-2", plan_of(annex, 0.5, 4), prism(annex, 0.5, 4.5), {}};
  side.model.classes[3] = FaceClass::party_wall;  // the west side, towards the block
  block.parts = {ring, side};
  city.buildings = {house, block};
  return city;
}

}  // namespace cities
