#include "mansard/picture/detail/plan_panel.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/picture/detail/lettering.hpp"

namespace mansard::picture::detail {
namespace {

constexpr Colour panel_paper{249, 249, 250}, outline_colour{60, 62, 68}, text_colour{20, 20, 24};
constexpr double line_width = 1.3, letters = 9, line_height = 14;  // px
constexpr double border = 8;                                       // px around the areas
constexpr std::size_t pixels = panel_width * panel_height;
constexpr std::uint32_t nothing = ~0U;

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

/// Where text may be: per pixel the area that is visible there, nothing on outlines.
class Visible {
 public:
  Visible() : area_(pixels, nothing) {}
  void add(std::uint32_t area, const std::vector<float>& cover) {
    for (std::size_t i = 0; i < pixels; ++i)
      if (cover[i] > 0) area_[i] = cover[i] > 0.99F ? area : nothing;
  }
  /// The middle of a place of this size on the area: the one that is nearest to the middle of what is visible of it.
  [[nodiscard]] auto room_for(std::uint32_t area, double width, double height) const -> std::optional<Spot> {
    const auto w = static_cast<std::size_t>(std::ceil(width)), h = static_cast<std::size_t>(std::ceil(height));
    if (w > panel_width || h > panel_height) return std::nullopt;
    constexpr std::size_t stride = panel_width + 1;
    std::vector<std::uint32_t> sums(stride * (panel_height + 1), 0);
    double x_sum = 0, y_sum = 0, count = 0;
    for (std::size_t y = 0; y < panel_height; ++y)
      for (std::size_t x = 0; x < panel_width; ++x) {
        const std::uint32_t here = area_[y * panel_width + x] == area ? 1 : 0;
        sums[(y + 1) * stride + x + 1] =
            here + sums[y * stride + x + 1] + sums[(y + 1) * stride + x] - sums[y * stride + x];
        if (here == 0) continue;
        x_sum += static_cast<double>(x) + 0.5, y_sum += static_cast<double>(y) + 0.5, ++count;
      }
    if (count == 0) return std::nullopt;
    std::optional<Spot> best;
    double nearest = 0;
    for (std::size_t y = 0; y + h <= panel_height; ++y)
      for (std::size_t x = 0; x + w <= panel_width; ++x) {
        if (sums[(y + h) * stride + x + w] - sums[y * stride + x + w] - sums[(y + h) * stride + x] +
                sums[y * stride + x] !=
            w * h)
          continue;
        const Spot at{static_cast<double>(x) + width / 2, static_cast<double>(y) + height / 2};
        const double dx = at.x - x_sum / count, dy = at.y - y_sum / count, distance = dx * dx + dy * dy;
        if (!best || distance < nearest) best = at, nearest = distance;
      }
    return best;
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

void write_label(Ink& ink, const PlanArea& area, std::uint32_t number, const Visible& visible) {
  constexpr double clear = 2;  // px between text and outline
  for (const auto& lines : area.labels) {
    double width = 0;
    for (const auto& line : lines) width = std::max(width, text_width(line, letters));
    const double height = letters + line_height * (static_cast<double>(lines.size()) - 1);
    const auto at = visible.room_for(number, width + 2 * clear, height + 2 * clear);
    if (!at) continue;
    write_lines(ink, lines, *at);
    return;
  }
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
  for (std::uint32_t a = 0; a < panel.areas.size(); ++a) write_label(ink, panel.areas[a], a, visible);
  if (panel.areas.empty() && !panel.note.empty())
    write_lines(ink, {panel.note}, {panel_width / 2.0, panel_height / 2.0});
  ink.spread_on(image, text_colour);
  return image;
}

}  // namespace mansard::picture::detail
