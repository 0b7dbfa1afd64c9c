#include "mansard/picture/plans.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/picture/detail/lettering.hpp"
#include "mansard/picture/detail/plan_panel.hpp"

namespace mansard::picture {
namespace {

using detail::Ink;
using detail::Spot;

constexpr Colour paper{255, 255, 255}, ink_colour{34, 36, 40}, line_colour{206, 208, 212};
constexpr double big = 15, middle = 11, small = 9;  // px; heights of capitals
constexpr std::size_t margin = 24, panel_gap = 12, group_gap = 28;
constexpr std::size_t head = 44, panel_head = 16, foot = 28;  // px; above the panels of a group, and below them

/// As much of a text as fits.
auto cut(std::string text, double height, double width) -> std::string {
  if (detail::text_width(text, height) <= width) return text;
  while (!text.empty() && detail::text_width(text + "...", height) > width) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) text.pop_back();
    if (!text.empty()) text.pop_back();
  }
  return text + "...";
}

auto group_width(const PlanSheet& sheet) -> std::size_t {
  std::size_t panels = 2;
  for (const auto& group : sheet.groups) panels = std::max(panels, group.panels.size());
  return panels * (detail::panel_width + panel_gap) - panel_gap;
}

constexpr auto group_height = head + panel_head + detail::panel_height + foot;

struct Corner {
  std::size_t x = 0, y = 0;
};

void paste(Image& image, const Image& piece, Corner at) {
  for (std::size_t row = 0; row < piece.height; ++row)
    std::copy_n(piece.pixels.begin() + static_cast<std::ptrdiff_t>(3 * row * piece.width), 3 * piece.width,
                image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * ((at.y + row) * image.width + at.x)));
}

auto spot(Corner at, std::size_t right, std::size_t down) -> Spot {
  return {static_cast<double>(at.x + right), static_cast<double>(at.y + down)};
}

/// m; the longest of 1, 2, 5, 10, … that is at most this many pixels long, otherwise 1.
auto bar_length(double pixels_per_metre, double most) -> double {
  double length = 1;
  for (double power = 1; power < 1e9; power *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (step * power * pixels_per_metre <= most) length = step * power;
  return length;
}

void draw_bar(Ink& ink, Spot at, double pixels_per_metre) {
  const double length = bar_length(pixels_per_metre, 110), end = at.x + length * pixels_per_metre;
  ink.stroke(at, {end, at.y}, 1.5);
  for (const double x : {at.x, end}) ink.stroke({x, at.y - 3}, {x, at.y + 3}, 1.5);
  detail::write_text(ink, base::to_text(length, 0) + " m", {end + 7, at.y + small / 2}, small);
}

void draw(Image& image, Ink& ink, Ink& lines, const PlanGroup& group, Corner at, std::size_t width) {
  const auto most = static_cast<double>(width);
  const Spot rule = spot(at, 0, 0);
  lines.stroke(rule, {rule.x + most, rule.y}, 1);
  detail::write_text(ink, cut(group.title, middle, most), spot(at, 0, 20), middle);
  detail::write_text(ink, cut(group.subtitle, small, most), spot(at, 0, 38), small);
  const auto frame = detail::frame_of(group);
  Corner place{at.x, at.y + head + panel_head};
  for (const auto& panel : group.panels) {
    detail::write_text(ink, cut(panel.title, small, detail::panel_width), spot({place.x, at.y + head}, 0, 12), small);
    paste(image, detail::draw_panel(panel, frame), place);
    place.x += detail::panel_width + panel_gap;
  }
  draw_bar(ink, spot({at.x, place.y + detail::panel_height}, 4, 14), frame.pixels_per_metre);
}

}  // namespace

auto plan_sheet(const PlanSheet& sheet) -> Image {
  const std::size_t columns = std::max<std::size_t>(1, std::min(sheet.columns, sheet.groups.size()));
  const std::size_t rows = (sheet.groups.size() + columns - 1) / columns, wide = group_width(sheet);
  constexpr std::size_t line = 24, key_size = 14;
  const std::size_t top = margin + 64 + line * sheet.keys.size() + 16;
  const auto needed = static_cast<std::size_t>(
      std::ceil(std::max(detail::text_width(sheet.title, big), detail::text_width(sheet.subtitle, middle))));
  std::size_t width = columns * (wide + group_gap) - group_gap;
  for (const auto& key : sheet.keys)
    width = std::max(width, static_cast<std::size_t>(std::ceil(detail::text_width(key.meaning, middle))) + 2 * line);
  width = 2 * margin + std::max(width, needed);
  Image image = detail::blank(width, top + rows * (group_height + group_gap) + margin, paper);

  Ink ink(image.width, image.height), lines(image.width, image.height);
  detail::write_text(ink, sheet.title, spot({margin, margin}, 0, 18), big);
  detail::write_text(ink, sheet.subtitle, spot({margin, margin}, 0, 44), middle);
  Corner at{margin, margin + 64};
  for (const auto& key : sheet.keys) {
    for (std::size_t y = 0; y < key_size; ++y)
      for (std::size_t x = 0; x < key_size; ++x)
        detail::set_colour(image, (at.y + y) * image.width + at.x + x, key.colour);
    const Spot first = spot(at, 0, 0), last = spot(at, key_size, key_size);
    for (const auto& [a, b] : {std::pair{first, Spot{last.x, first.y}},
                               {Spot{last.x, first.y}, last},
                               {last, Spot{first.x, last.y}},
                               {Spot{first.x, last.y}, first}})
      ink.stroke(a, b, 1);
    detail::write_text(ink, key.meaning, spot(at, line, 12), middle);
    at.y += line;
  }
  for (std::size_t g = 0; g < sheet.groups.size(); ++g)
    draw(image, ink, lines, sheet.groups[g],
         {margin + (g % columns) * (wide + group_gap), top + (g / columns) * (group_height + group_gap)}, wide);
  lines.spread_on(image, line_colour);
  ink.spread_on(image, ink_colour);
  return image;
}

}  // namespace mansard::picture
