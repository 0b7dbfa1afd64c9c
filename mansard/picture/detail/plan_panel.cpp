#include "mansard/picture/detail/plan_panel.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/picture/detail/lettering.hpp"

namespace mansard::picture::detail {
namespace {

constexpr Colour panel_paper{249, 249, 250}, outline_colour{60, 62, 68}, text_colour{20, 20, 24};
constexpr double line_width = 1.3, letters = 9, line_height = 14;  // px
constexpr double border = 14;                                      // px around the areas
constexpr std::size_t pixels = panel_width * panel_height;

using Rings = std::vector<std::vector<Spot>>;

auto rings_of(const PlanArea& area, const PlanFrame& frame) -> Rings {
  Rings out;
  const auto add = [&](const geometry::Ring& ring) {
    auto& spots = out.emplace_back();
    for (const auto p : ring)
      spots.push_back({panel_width / 2.0 + (p.x - frame.centre.x) * frame.pixels_per_metre,
                       panel_height / 2.0 - (p.y - frame.centre.y) * frame.pixels_per_metre});
  };
  for (const auto& polygon : area.polygons) {
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
  }
  return out;
}

/// Where the rings cross a horizontal line, from left to right.
auto crossings(const Rings& rings, double y) -> std::vector<double> {
  std::vector<double> out;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Spot a = ring[i], b = ring[(i + 1) % ring.size()];
      if ((a.y <= y) != (b.y <= y)) out.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  std::ranges::sort(out);
  return out;
}

/// The share of each pixel inside the rings, by the even-odd rule: exact along x, on four lines along y.
auto cover_of(const Rings& rings) -> std::vector<float> {
  constexpr int lines = 4;
  std::vector<float> cover(pixels, 0.0F);
  for (std::size_t row = 0; row < panel_height; ++row)
    for (int k = 0; k < lines; ++k) {
      const auto at = crossings(rings, static_cast<double>(row) + (k + 0.5) / lines);
      for (std::size_t i = 0; i + 1 < at.size(); i += 2) {
        const double from = std::max(at[i], 0.0), to = std::min(at[i + 1], static_cast<double>(panel_width));
        for (auto x = static_cast<std::size_t>(from); static_cast<double>(x) < to; ++x) {
          const auto left = static_cast<double>(x);
          cover[row * panel_width + x] += static_cast<float>((std::min(to, left + 1) - std::max(from, left)) / lines);
        }
      }
    }
  return cover;
}

void paint(Image& image, const std::vector<float>& cover, Colour colour) {
  const Light light = to_light(colour);
  for (std::size_t i = 0; i < pixels; ++i) {
    const float share = std::min(cover[i], 1.0F);
    if (share > 0) set_colour(image, i, to_colour((1 - share) * to_light(colour_at(image, i)) + share * light));
  }
}

constexpr std::uint32_t ground = ~0U, taken = ground - 1;  ///< in place of an area

auto squared_distance(Spot a, Spot b) -> double { return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y); }

/// Where text may be: per pixel the area that is visible there, or the ground around them.
class Visible {
 public:
  Visible() : area_(pixels, ground) {}
  void add(std::uint32_t area, const std::vector<float>& cover) {
    for (std::size_t i = 0; i < pixels; ++i)
      if (cover[i] > 0) area_[i] = cover[i] > 0.99F ? area : taken;
  }
  /// The pixel of an area that is nearest to the middle of what is visible of it.
  [[nodiscard]] auto middle_of(std::uint32_t area) const -> std::optional<Spot> {
    Spot sum;
    double count = 0;
    const auto each = [&](const auto& visit) {
      for (std::size_t i = 0; i < pixels; ++i)
        if (area_[i] == area)
          visit({static_cast<double>(i % panel_width) + 0.5, static_cast<double>(i / panel_width) + 0.5});
    };
    each([&](Spot at) { sum.x += at.x, sum.y += at.y, ++count; });
    std::optional<Spot> best;
    each([&](Spot at) {
      const Spot middle{sum.x / count, sum.y / count};
      if (!best || squared_distance(at, middle) < squared_distance(*best, middle)) best = at;
    });
    return best;
  }
  /// The middle of the place of this size that is on the area only and nearest to a spot.
  [[nodiscard]] auto place_for(std::uint32_t area, double width, double height, Spot near) const
      -> std::optional<Spot> {
    const auto w = static_cast<std::size_t>(std::ceil(width)), h = static_cast<std::size_t>(std::ceil(height));
    if (w > panel_width || h > panel_height) return std::nullopt;
    constexpr std::size_t stride = panel_width + 1;
    std::vector<std::uint32_t> sums(stride * (panel_height + 1), 0);
    for (std::size_t y = 0; y < panel_height; ++y)
      for (std::size_t x = 0; x < panel_width; ++x)
        sums[(y + 1) * stride + x + 1] = (area_[y * panel_width + x] == area ? 1 : 0) + sums[y * stride + x + 1] +
                                         sums[(y + 1) * stride + x] - sums[y * stride + x];
    std::optional<Spot> best;
    for (std::size_t y = 0; y + h <= panel_height; ++y)
      for (std::size_t x = 0; x + w <= panel_width; ++x) {
        const std::size_t above = y * stride + x, below = (y + h) * stride + x;
        if (sums[below + w] - sums[above + w] - sums[below] + sums[above] != w * h) continue;
        const Spot at{static_cast<double>(x) + width / 2, static_cast<double>(y) + height / 2};
        if (!best || squared_distance(at, near) < squared_distance(*best, near)) best = at;
      }
    return best;
  }
  void take(Spot middle, double width, double height) {
    const auto index = [](double at, std::size_t size) {
      return static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(size)));
    };
    for (std::size_t y = index(middle.y - height / 2, panel_height); y < index(middle.y + height / 2 + 1, panel_height);
         ++y)
      for (std::size_t x = index(middle.x - width / 2, panel_width); x < index(middle.x + width / 2 + 1, panel_width);
           ++x)
        area_[y * panel_width + x] = taken;
  }

  void take_line(Spot from, Spot to) {
    const auto steps = static_cast<int>(std::ceil(std::sqrt(squared_distance(from, to))));
    for (int k = 0; k <= steps; ++k) {
      const double t = steps > 0 ? static_cast<double>(k) / steps : 0;
      take({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)}, 2, 2);
    }
  }

 private:
  std::vector<std::uint32_t> area_;
};

/// Lines of text around their middle.
void write_lines(Ink& ink, const std::vector<std::string>& lines, Spot middle) {
  double y = middle.y - line_height * (static_cast<double>(lines.size()) - 1) / 2 + letters / 2;
  for (const auto& line : lines) {
    write_text(ink, line, {middle.x - text_width(line, letters) / 2, y}, letters);
    y += line_height;
  }
}

constexpr double clear = 2;  // px between text and outline

struct Size {
  double width = 0, height = 0;
};
auto size_of(const std::vector<std::string>& lines) -> Size {
  Size size{0, letters + line_height * (static_cast<double>(lines.size()) - 1) + 2 * clear};
  for (const auto& line : lines) size.width = std::max(size.width, text_width(line, letters) + 2 * clear);
  return size;
}

/// Whether a label fits on the area.
auto write_inside(Ink& ink, const PlanArea& area, std::uint32_t number, Visible& visible) -> bool {
  const auto middle = visible.middle_of(number);
  if (!middle) return false;
  for (const auto& lines : area.labels) {
    const Size size = size_of(lines);
    const auto at = visible.place_for(number, size.width, size.height, *middle);
    if (!at) continue;
    write_lines(ink, lines, *at);
    visible.take(*at, size.width, size.height);
    return true;
  }
  return false;
}

/// Beside all areas, with a line to its own.
void write_beside(Ink& ink, const PlanArea& area, std::uint32_t number, Visible& visible) {
  constexpr double farthest = 160, dot = 4;  // px
  const auto from = visible.middle_of(number);
  if (!from) return;
  for (const auto& lines : area.labels) {
    Size size = size_of(lines);
    size.width += 2 * clear, size.height += 2 * clear;  // the line ends a little before the text
    const auto at = visible.place_for(ground, size.width, size.height, *from);
    if (!at || squared_distance(*at, *from) > farthest * farthest) continue;
    write_lines(ink, lines, *at);
    visible.take(*at, size.width, size.height);
    ink.stroke(*from, *from, dot);
    const Spot end{std::clamp(from->x, at->x - size.width / 2, at->x + size.width / 2),
                   std::clamp(from->y, at->y - size.height / 2, at->y + size.height / 2)};
    ink.stroke(*from, end, 1);
    visible.take_line(*from, end);
    return;
  }
}

void write_labels(Ink& ink, const std::vector<PlanArea>& areas, Visible& visible) {
  std::vector<std::uint32_t> left;
  for (std::uint32_t a = 0; a < areas.size(); ++a)
    if (!areas[a].labels.empty() && !write_inside(ink, areas[a], a, visible)) left.push_back(a);
  for (const auto a : left) write_beside(ink, areas[a], a, visible);
}

}  // namespace

auto frame_of(const PlanGroup& group) -> PlanFrame {
  constexpr double empty = 10;    // m
  constexpr double least = 1e-3;  // m, of an extent: a point can be drawn too
  constexpr double most = 100;    // pixels per metre: what is tiny is drawn small
  geometry::Box2 box;
  for (const auto& panel : group.panels)
    for (const auto& area : panel.areas) box.include(geometry::bounds(area.polygons));
  if (box.empty()) return {{}, (panel_height - 2 * border) / empty};
  const auto size = [&](double extent) { return std::max(extent, least); };
  const double across = (panel_width - 2 * border) / size(box.most.x - box.least.x),
               along = (panel_height - 2 * border) / size(box.most.y - box.least.y);
  return {0.5 * (box.least + box.most), std::min({across, along, most})};
}

auto draw_panel(const PlanPanel& panel, const PlanFrame& frame) -> Image {
  Image image = blank(panel_width, panel_height, panel_paper);
  Visible visible;
  for (std::uint32_t a = 0; a < panel.areas.size(); ++a) {
    const auto rings = rings_of(panel.areas[a], frame);
    const auto cover = cover_of(rings);
    paint(image, cover, panel.areas[a].colour);
    visible.add(a, cover);
    Ink outline(panel_width, panel_height);
    for (const auto& ring : rings)
      for (std::size_t i = 0; i < ring.size(); ++i) outline.stroke(ring[i], ring[(i + 1) % ring.size()], line_width);
    outline.spread_on(image, outline_colour);
  }
  Ink ink(panel_width, panel_height);
  write_labels(ink, panel.areas, visible);
  if (panel.areas.empty() && !panel.note.empty())
    write_lines(ink, {panel.note}, {panel_width / 2.0, panel_height / 2.0});
  ink.spread_on(image, text_colour);
  return image;
}

}  // namespace mansard::picture::detail
