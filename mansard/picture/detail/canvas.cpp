#include "mansard/picture/detail/canvas.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::picture::detail {
namespace {

auto light_table() -> const std::array<float, 256>& {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double v = static_cast<double>(i) / 255;
      light[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return light;
  }();
  return table;
}

/// The code whose light is nearest in the sRGB scale, of borders half-way between two codes' lights. A table says where
/// to begin; few codes share an entry, the darkest most.
auto code_of(float light) -> std::uint8_t {
  constexpr std::size_t entries = 4096;
  static const std::array<float, 255> borders = [] {
    std::array<float, 255> between{};
    for (std::size_t i = 0; i < between.size(); ++i) {
      const double v = (static_cast<double>(i) + 0.5) / 255;
      between[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return between;
  }();
  static const std::array<std::uint8_t, entries + 1> begin = [] {
    std::array<std::uint8_t, entries + 1> codes{};
    for (std::size_t i = 0; i < codes.size(); ++i)
      codes[i] = static_cast<std::uint8_t>(std::ranges::upper_bound(borders, static_cast<float>(i) / entries) -
                                           borders.begin());
    return codes;
  }();
  const float within = light > 0 ? std::min(light, 1.0F) : 0.0F;  // what is no number is 0
  std::size_t code = begin[static_cast<std::size_t>(within * entries)];
  while (code < borders.size() && borders[code] <= light) ++code;
  return static_cast<std::uint8_t>(code);
}

}  // namespace

auto to_light(Colour colour) -> Light {
  const auto& table = light_table();
  return {table[colour[0]], table[colour[1]], table[colour[2]]};
}

auto to_colour(const Light& light) -> Colour { return {code_of(light[0]), code_of(light[1]), code_of(light[2])}; }

auto blank(std::size_t width, std::size_t height, Colour paper) -> Image {
  Image image{width, height, std::vector<std::uint8_t>(3 * width * height)};
  for (std::size_t i = 0; i < width * height; ++i) set_colour(image, i, paper);
  return image;
}

void Ink::stroke(Spot a, Spot b, double width) {
  const double reach = width / 2 + 1;
  const auto first = [&](double v) { return static_cast<std::ptrdiff_t>(std::floor(std::max(v, 0.0))); };
  const auto last = [&](double v, std::size_t size) {
    return static_cast<std::ptrdiff_t>(std::floor(std::min(v, static_cast<double>(size) - 1)));
  };
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  for (auto y = first(std::min(a.y, b.y) - reach); y <= last(std::max(a.y, b.y) + reach, height_); ++y)
    for (auto x = first(std::min(a.x, b.x) - reach); x <= last(std::max(a.x, b.x) + reach, width_); ++x) {
      const double px = static_cast<double>(x) + 0.5 - a.x, py = static_cast<double>(y) + 0.5 - a.y;
      const double t = square > 0 ? std::clamp((px * dx + py * dy) / square, 0.0, 1.0) : 0.0;
      const double distance = std::hypot(px - t * dx, py - t * dy);
      float& cover = cover_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)];
      cover = std::max(cover, static_cast<float>(std::clamp(0.5 + width / 2 - distance, 0.0, 1.0)));
    }
}

void Ink::spread_on(Image& image, Colour colour) const {
  const Light light = to_light(colour);
  for (std::size_t i = 0; i < cover_.size(); ++i)
    if (cover_[i] > 0)
      set_colour(image, i, to_colour((1 - cover_[i]) * to_light(colour_at(image, i)) + cover_[i] * light));
}

}  // namespace mansard::picture::detail
