// The pictures of many faces in few images.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mansard/formats/image.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/model/texture.hpp"

namespace mansard::formats::detail {

/// Pictures begin at multiples of this, so that no block of pixels that JPEG codes together (16 × 16 with halved
/// colours), and none of the first four mip levels, has pixels of two pictures.
inline constexpr std::uint32_t atlas_cell = 16;
/// Pixels around each picture at least, which repeat its border: bilinear sampling takes one, of the first mip level
/// two.
inline constexpr std::uint32_t atlas_gutter = 2;

/// Of an image of that size, what a picture may have.
[[nodiscard]] inline auto usable_side(std::uint32_t atlas_size) -> std::uint32_t {
  return atlas_size / atlas_cell * atlas_cell - 2 * atlas_gutter;
}

/// Where a picture is: in which image, at which pixel.
struct AtlasPlace {
  std::uint32_t page = 0, x = 0, y = 0;
};

/// Fills images with pictures that are all known, in rows of falling height (next fit, decreasing height: E. Coffman et
/// al., Performance bounds for level-oriented two-dimensional packing algorithms, 1980): the same places for the same
/// sizes.
class Atlas {
 public:
  /// `side`: pixels along each side of an image, at most. The pictures must outlive this.
  explicit Atlas(std::uint32_t side) : side_(side / atlas_cell * atlas_cell) {}
  /// A picture no larger than usable_side. Returns its number; pictures of one pixel of the same colour have one.
  auto add(const model::Pixels& picture) -> std::size_t;
  /// After the last one.
  void settle();

  [[nodiscard]] auto pages() const -> std::size_t { return sizes_.size(); }
  [[nodiscard]] auto place(std::size_t number) const -> const AtlasPlace& { return places_[number]; }
  /// Coordinates in an image, from 0 to 1 from its top left corner, of a pixel of a picture.
  [[nodiscard]] auto uv(std::size_t number, const std::array<double, 2>& pixel) const -> std::array<double, 2>;
  /// An image, with the borders of pictures repeated around them.
  [[nodiscard]] auto page(std::size_t page) const -> model::Pixels;

 private:
  std::uint32_t side_;
  std::vector<const model::Pixels*> pictures_;
  std::map<std::vector<std::uint8_t>, std::size_t> plain_;  ///< pictures of one pixel by their colour
  std::vector<AtlasPlace> places_;
  std::vector<std::array<std::uint32_t, 2>> sizes_;  ///< width and height of every image
};

/// The textures of some solids in one atlas.
class SolidAtlas {
 public:
  explicit SolidAtlas(std::uint32_t side) : atlas_(side) {}
  /// The number of the solid; its textures must outlive this.
  auto add(const model::SolidTexture& solid) -> std::size_t;
  /// After the last one.
  void settle() { atlas_.settle(); }
  [[nodiscard]] auto pages() const -> std::size_t { return atlas_.pages(); }
  [[nodiscard]] auto page(std::size_t number) const -> model::Pixels { return atlas_.page(number); }
  [[nodiscard]] auto page_of(std::size_t solid, std::size_t face) const -> std::uint32_t;
  /// Of a point of a face, in the local frame: within its image, from the top left corner.
  [[nodiscard]] auto uv(std::size_t solid, std::size_t face, geometry::Point3 p) const -> std::array<double, 2>;

 private:
  Atlas atlas_;
  std::vector<const model::SolidTexture*> solids_;
  std::vector<std::vector<std::size_t>> numbers_;  ///< of the pictures of each, by face
};

/// Pixels that the pictures of a building take, with what is around them.
[[nodiscard]] auto area_in_atlas(const model::Building& building) -> std::uint64_t;

}  // namespace mansard::formats::detail
