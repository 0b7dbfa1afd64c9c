// Light on an image: linear, in single precision.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mansard/picture/picture.hpp"

namespace mansard::picture::detail {

/// Linear light, 0 … 1.
using Light = std::array<float, 3>;

[[nodiscard]] constexpr auto operator+(const Light& a, const Light& b) -> Light {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] constexpr auto operator*(float k, const Light& a) -> Light { return {k * a[0], k * a[1], k * a[2]}; }
[[nodiscard]] constexpr auto operator*(const Light& a, const Light& b) -> Light {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}

/// sRGB (IEC 61966-2-1) to light and back, rounded to the nearest.
[[nodiscard]] auto to_light(Colour colour) -> Light;
[[nodiscard]] auto to_colour(const Light& light) -> Colour;

[[nodiscard]] auto blank(std::size_t width, std::size_t height, Colour paper) -> Image;
/// A pixel by its number.
[[nodiscard]] inline auto colour_at(const Image& image, std::size_t pixel) -> Colour {
  return {image.pixels[3 * pixel], image.pixels[3 * pixel + 1], image.pixels[3 * pixel + 2]};
}
inline void set_colour(Image& image, std::size_t pixel, Colour colour) {
  for (std::size_t c = 0; c < colour.size(); ++c) image.pixels[3 * pixel + c] = colour[c];
}

/// A point on an image: pixels from its top left corner.
struct Spot {
  double x = 0, y = 0;
};

/// How much of each pixel is covered by strokes with round ends; overlapping strokes cover once.
class Ink {
 public:
  Ink(std::size_t width, std::size_t height) : width_(width), height_(height), cover_(width * height, 0.0F) {}
  void stroke(Spot a, Spot b, double width);
  void spread_on(Image& image, Colour colour) const;

 private:
  std::size_t width_, height_;
  std::vector<float> cover_;
};

}  // namespace mansard::picture::detail
