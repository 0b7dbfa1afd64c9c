#include "mansard/report/city_map.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/base/utf8.hpp"

namespace mansard::report {
namespace {

// Units of the drawing, a tenth of a pixel of a map that is a thousand wide.
constexpr double map_size = 10'000, map_border = 150, mark_radius = 130;
constexpr double least_map_height = 2'500, most_map_height = 12'000;

}  // namespace

void CityMap::add(const std::vector<geometry::Polygon>& outline, std::uint8_t kind) {
  if (outline.empty()) return;
  if (corners_.empty() && !outline.front().outer.empty()) origin_ = outline.front().outer.front();
  ++buildings_;
  const auto add_ring = [&](const geometry::Ring& ring) {
    if (ring.empty()) return;
    rings_.push_back({corners_.size(), kind});
    for (const auto& p : ring)
      corners_.push_back({static_cast<float>(p.x - origin_.x), static_cast<float>(p.y - origin_.y)});
    box_.include(geometry::bounds(ring));
  };
  for (const auto& polygon : outline) {
    add_ring(polygon.outer);
    std::ranges::for_each(polygon.holes, add_ring);
  }
}

auto CityMap::svg(const std::vector<Kind>& kinds, std::string_view label) const -> std::string {
  if (empty()) return {};
  const double across = std::max(box_.most.x - box_.least.x, 1.0), along = std::max(box_.most.y - box_.least.y, 1.0);
  const double scale = std::min((map_size - 2 * map_border) / across, (most_map_height - 2 * map_border) / along);
  const double height = std::max(2 * map_border + along * scale, least_map_height);
  const double left = 0.5 * (map_size - across * scale), top = 0.5 * (height - along * scale);
  const auto x = [&](double m) { return std::lround(left + (m - box_.least.x) * scale); };
  const auto y = [&](double m) { return std::lround(top + (box_.most.y - m) * scale); };
  // A line is a twentieth of a building of the usual size, so that it never hides what it is around.
  const double usual = std::sqrt(across * along / static_cast<double>(std::max<std::size_t>(buildings_, 1))) * scale;
  const auto line = std::clamp(std::lround(usual / 20), 0L, 8L);

  std::string out = "<svg viewBox=\"0 0 " + base::to_text(map_size, 0) + " " + base::to_text(height, 0) +
                    "\" role=\"img\" aria-label=\"" + base::markup_escaped(label) +
                    "\">\n<g fill-rule=\"evenodd\" stroke=\"#33363c\" stroke-linejoin=\"round\" stroke-width=\"" +
                    std::to_string(line) + "\">\n";
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    std::string path;
    for (std::size_t r = 0; r < rings_.size(); ++r) {
      if (rings_[r].kind != k) continue;
      const std::size_t end = r + 1 < rings_.size() ? rings_[r + 1].first : corners_.size();
      long last_x = 0, last_y = 0;
      std::size_t written = 0;
      for (std::size_t c = rings_[r].first; c < end; ++c) {
        const long to_x = x(origin_.x + corners_[c].x), to_y = y(origin_.y + corners_[c].y);
        if (written > 0 && to_x == last_x && to_y == last_y) continue;
        if (written == 0) path += "M" + std::to_string(to_x) + " " + std::to_string(to_y);
        else path += (written == 1 ? "l" : " ") + std::to_string(to_x - last_x) + " " + std::to_string(to_y - last_y);
        last_x = to_x, last_y = to_y;
        ++written;
      }
      // What is smaller than the grid is a speck, and no hole.
      path += written < 3 ? "h3v3h-3z" : "z";
    }
    if (path.empty()) continue;
    ((out += "<path fill=\"") += kinds[k].colour) += "\" d=\"" + path + "\"/>\n";
  }
  out += "</g>\n<g font-family=\"sans-serif\" font-size=\"170\" font-weight=\"bold\" text-anchor=\"middle\">\n";
  for (const auto& mark : marks_) {
    const std::string at_x = std::to_string(x(mark.at.x)), at_y = std::to_string(y(mark.at.y));
    out += "<circle cx=\"" + at_x + "\" cy=\"" + at_y + "\" r=\"" + base::to_text(mark_radius, 0) +
           "\" fill=\"#ffffff\" stroke=\"#141418\" stroke-width=\"20\"/><text x=\"" + at_x + "\" y=\"" + at_y +
           "\" dy=\"60\" fill=\"#141418\">" + base::markup_escaped(mark.text) + "</text>\n";
  }
  out += "</g>\n</svg>\n";
  double bar = 1;  // m
  for (double power = 1; power < 1e7; power *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (step * power * scale <= 0.25 * map_size) bar = step * power;
  const double percent = 100 * bar * scale / map_size;
  out += "<p class=\"scale\"><span class=\"bar\" style=\"width:" + base::to_text(percent, 2) + "%\"></span> " +
         (bar < 1000 ? base::to_text(bar, 0) + " m" : base::to_text(bar / 1000, 0) + " km") + ", north up</p>\n";
  return out;
}

}  // namespace mansard::report
