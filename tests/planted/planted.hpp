// Planted blocks: a truth of houses and walls, and what a scan, a sweep and a GIS would know of it, with their errors.
// From here the real modules go on: fracture::arrange, segment::choose. Metres, radians, z up, ground at 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/fracture/fracture.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/segment/segment.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::planted {

enum class Kind : std::uint8_t {
  terrace,    ///< houses in a row
  perimeter,  ///< houses around a courtyard
  courtyard,  ///< one building around a courtyard, of wings
  towers,     ///< slabs across a podium in both directions, with towers where they cross; `houses` masses or a few more
  detached,   ///< houses apart from each other, in rows
  grid,       ///< rows of houses back to back
};
enum class Roof { flat, gable_along, gable_across, mono };  ///< the ridge along or across the street
enum class Features : std::uint8_t { per_house, per_block };

/// What to plant, and how badly it is seen.
struct Recipe {
  Kind kind = Kind::terrace;
  std::size_t houses = 8;
  std::uint64_t seed = 1;
  std::string name = "block-0";

  // the houses
  double width_least = 5.5, width_most = 9;  ///< m along the street, in quarters of a metre
  double depth = 11;                         ///< m, likewise
  double setback = 0.25;                     ///< share of houses set back from the street, by 0.25 … 1.25 m
  double wings = 0.25;                       ///< share of houses with a low wing behind (terrace, perimeter, detached)
  double eaves_least = 5, eaves_most = 24;   ///< m; heights of eaves stay within
  double equal = 0.25;                       ///< share of neighbours of equal height and roof
  double step_least = 0.5, step_most = 6;    ///< m; height steps between the others
  std::vector<Roof> roofs{Roof::flat, Roof::gable_along, Roof::mono};  ///< drawn from for every house
  double turn = 0.3;                                                   ///< rad; of the whole block, away from the axes

  // the scan
  double pitch = 0.5;         ///< m between the vertices of the 2.5-D mesh
  double height_sigma = 0.1;  ///< m; error of heights …
  double correlation = 2;     ///< m; … whose bumps are this wide
  double melt = 0.5;          ///< m; width over which walls are smeared

  // the sweep
  double seen_step = 2;   ///< m; lower steps between houses leave no sweep-edge
  double gamma = 10;      ///< m²; nor do walls with less surface
  double lateral = 0.08;  ///< m; standard deviation of a sweep-edge's distance from its wall
  double angle = 0.01;    ///< rad; of its direction at 5 m of length; longer ones are seen better
  double missing = 0.03;  ///< probability that a wall is not found at all,
  double twice = 0.08;    ///< … is found a second time, 0.2 … 1 m beside,
  double broken = 0.08;   ///< … is found in two pieces,
  double shorter = 0.15;  ///< … lacks up to 1.5 m at an end
  double clutter = 1;     ///< sweep-edges per house of dormers, chimneys, vans

  // the footprints
  double gis = 0.1;  ///< m; standard deviation of the footprints' displacement; a third of it from corner to corner
  Features features = Features::per_house;
};

/// A mass under one roof: what a segmentation should give as one part.
struct House {
  geometry::Polygon polygon;
  std::size_t feature = 0;  ///< index into Block::members
  Roof roof = Roof::flat;
  double eaves = 0, rise = 0;     ///< m above ground; from eaves to ridge
  geometry::Point2 across{0, 1};  ///< unit direction in which the roof slopes …
  double least = 0, most = 1;     ///< … and the extent of the house in it
};
/// z of the roof's surface, whether or not the point is in the house.
[[nodiscard]] auto top(const House& house, geometry::Point2 at) -> double;

/// Where two houses touch.
struct Wall {
  geometry::Segment2 segment;       ///< `left` on its left
  std::size_t left = 0, right = 0;  ///< houses
  double step = 0;                  ///< m; mean height of the left house over the right one along the wall
};

struct Block {
  std::string name;
  block::Block block;       ///< mesh and footprints as they are given to the modules, with their errors
  sweep::SweepEdges edges;  ///< as find_edges promises them; `clusters` have areas but no lines
  std::vector<House> houses;
  std::vector<Wall> walls;
};

/// The same recipe gives the same block, whatever the thread count.
[[nodiscard]] auto make(const Recipe& recipe) -> Block;

/// Recipes of the sizes of the paper's table 1, by its names: glasgow_small, madrid, copenhagen, glasgow, london,
/// new_york.
[[nodiscard]] auto presets() -> std::vector<Recipe>;
[[nodiscard]] auto preset(std::string_view name, std::uint64_t seed) -> Recipe;
/// A district in a single feature, so that the program has one component; about that many inside faces.
[[nodiscard]] auto large(std::size_t faces, std::uint64_t seed) -> Recipe;

/// The ground fractured by what was seen, as the pipeline does it.
[[nodiscard]] auto fractured(const Block& planted, const segment::Options& options = {}) -> fracture::Arrangement;

}  // namespace mansard::planted
