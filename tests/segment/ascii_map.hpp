// Small plans drawn in ASCII: every letter is a face, '.' is outside the arrangement.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/fracture/fracture.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::segment::testing {

/// Rows from north to south, each character a square cell; the south-west corner of the map is at (0, 0). Letters must
/// form simply connected faces. Edges run from cell corner to cell corner, so long walls have collinear vertices.
struct AsciiMap {
  std::vector<std::string> rows;
  double cell = 5;
  fracture::Arrangement arrangement;
  std::map<char, std::uint32_t> face;  ///< numbered in alphabetical order

  explicit AsciiMap(std::vector<std::string> drawing, double cell_size = 5);

  /// ' ' beyond the drawing.
  [[nodiscard]] auto at(int column, int row_from_south) const -> char;

  /// A wall as the sweep finds it, from cell corner to cell corner, its outside on the left.
  void wall(geometry::Point2 start, geometry::Point2 end, std::uint32_t source,
            fracture::Kind kind = fracture::Kind::hard);

  /// A flat roof over every cell, at that height over its letter; letters without one stay open.
  [[nodiscard]] auto roofs(const std::map<char, double>& height) const -> geometry::Mesh;

  /// The features' footprints, made of cells, and ground at 0.
  [[nodiscard]] auto block(const std::vector<std::string>& letters_of_feature) const -> block::Block;
};

/// So many sweep-edges, of no particular place.
[[nodiscard]] auto sweep_edges(std::size_t count) -> sweep::SweepEdges;

}  // namespace mansard::segment::testing
