#include "mansard/picture/detail/error_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/picture/detail/lettering.hpp"

namespace mansard::picture::detail {
namespace {

constexpr Colour no_value{206, 206, 206}, ink_colour{46, 48, 52}, frame_colour{120, 122, 126};

struct Rectangle {
  std::size_t x = 0, y = 0, width = 0, height = 0;
};

void fill(Image& image, const Rectangle& r, Colour colour) {
  for (std::size_t y = r.y; y < std::min(r.y + r.height, image.height); ++y)
    for (std::size_t x = r.x; x < std::min(r.x + r.width, image.width); ++x)
      std::copy(colour.begin(), colour.end(),
                image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * (y * image.width + x)));
}

void outline(Image& image, const Rectangle& r, std::size_t thick, Colour colour) {
  fill(image, {r.x - thick, r.y - thick, r.width + 2 * thick, thick}, colour);
  fill(image, {r.x - thick, r.y + r.height, r.width + 2 * thick, thick}, colour);
  fill(image, {r.x - thick, r.y, thick, r.height}, colour);
  fill(image, {r.x + r.width, r.y, thick, r.height}, colour);
}

/// "+0.5", "0", "−1": with as few decimals as tell the ticks apart.
auto tick_label(double value) -> std::string {
  std::string digits = base::to_text(std::abs(value), 3);
  while (digits.back() == '0') digits.pop_back();
  if (digits.back() == '.') digits.pop_back();
  return (value < 0 ? "−" : value > 0 ? "+" : "") + digits;
}

}  // namespace

auto diverging(double value) -> Colour {
  if (std::isnan(value)) return no_value;
  // Lightness falls evenly to both sides.
  constexpr std::array<Colour, 7> stops{{{20, 60, 140},
                                         {67, 125, 196},
                                         {165, 202, 235},
                                         {255, 255, 255},
                                         {246, 190, 165},
                                         {217, 101, 80},
                                         {150, 16, 38}}};
  const double at = (std::clamp(value, -1.0, 1.0) + 1) / 2 * (stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double t = at - static_cast<double>(below);
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<std::uint8_t>(std::lround((1 - t) * stops[below][c] + t * stops[below + 1][c]));
  return colour;
}

auto map_image(std::span<const float> values, std::size_t columns, std::size_t rows, double limit,
               const std::string& title) -> Image {
  constexpr std::size_t wanted = 800;  // pixels on the long side, so that a small map can be read
  const std::size_t longest = std::max({columns, rows, std::size_t{1}});
  const std::size_t cell = (wanted + longest - 1) / longest;
  const std::size_t unit = std::max<std::size_t>(12, cell * longest / 60);  // height of the lettering's capitals

  const Rectangle map{2 * unit, 4 * unit, cell * columns, cell * rows};
  const Rectangle bar{map.x + map.width + 2 * unit, map.y, unit + unit / 2, std::max(map.height, 12 * unit)};
  const double small = 0.85 * static_cast<double>(unit), big = 1.15 * static_cast<double>(unit);
  double labels = text_width("NaN", small);
  for (const double part : {-1.0, -0.5, 0.5, 1.0})
    labels = std::max(labels, text_width(tick_label(part * limit) + " m", small));
  const std::size_t bar_end = bar.x + bar.width + 2 * unit + static_cast<std::size_t>(std::ceil(labels)) + unit;
  const std::size_t title_end = 4 * unit + static_cast<std::size_t>(std::ceil(text_width(title, big)));
  const std::size_t width = std::max(bar_end, title_end), height = bar.y + bar.height + 2 * unit;

  Image image{width, height, std::vector<std::uint8_t>(3 * width * height, 255)};
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
      fill(image, {map.x + column * cell, map.y + (rows - 1 - row) * cell, cell, cell},
           diverging(static_cast<double>(values[row * columns + column]) / limit));
  for (std::size_t y = 0; y < bar.height; ++y) {
    const double part = 1 - 2 * static_cast<double>(y) / static_cast<double>(bar.height - 1);
    fill(image, {bar.x, bar.y + y, bar.width, 1}, diverging(part));
  }
  const std::size_t thick = std::max<std::size_t>(1, unit / 12);
  outline(image, map, thick, frame_colour);
  outline(image, bar, thick, frame_colour);

  Ink ink(width, height);
  write_text(ink, title, {static_cast<double>(map.x), 2.6 * static_cast<double>(unit)}, big);
  for (const double part : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const double y = static_cast<double>(bar.y) + (1 - part) / 2 * static_cast<double>(bar.height);
    const auto x = static_cast<double>(bar.x + bar.width);
    ink.stroke({x, y}, {x + 0.5 * static_cast<double>(unit), y}, static_cast<double>(thick));
    write_text(ink, tick_label(part * limit) + (part == 1 ? " m" : ""), {x + static_cast<double>(unit), y + small / 2},
               small);
  }
  ink.spread_on(image, ink_colour);
  return image;
}

}  // namespace mansard::picture::detail
