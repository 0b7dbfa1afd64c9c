#include "lab/explore/detail/svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/base/utf8.hpp"

namespace mansard::explore::detail {
namespace {

using geometry::Point2;

auto pixels(double value) -> std::string { return base::to_text(value, 2); }

auto path_of(const geometry::Ring& ring) -> std::string {
  std::string path;
  for (const auto& p : ring) path += (path.empty() ? "M" : "L") + pixels(p.x) + " " + pixels(p.y);
  return path + "Z";
}

}  // namespace

auto escape(std::string_view text) -> std::string { return base::markup_escaped(base::on_one_line(std::string(text))); }

Svg::Svg(double width, double height, std::string_view label) {
  out_ = "<svg viewBox=\"0 0 " + pixels(width) + " " + pixels(height) + "\" width=\"" + pixels(width) +
         "\" role=\"img\" aria-label=\"" + escape(label) + "\">\n";
}

void Svg::element(std::string_view name, const Attributes& geometry, const Attributes& attributes,
                  std::string_view words) {
  out_ += "<" + std::string(name);
  for (const auto* part : {&geometry, &attributes})
    for (const auto& [key, value] : *part) out_ += " " + key + "=\"" + escape(value) + "\"";
  out_ += words.empty() ? "/>\n" : ">" + escape(words) + "</" + std::string(name) + ">\n";
}

void Svg::line(Point2 a, Point2 b, const Attributes& attributes) {
  element("line", {{"x1", pixels(a.x)}, {"y1", pixels(a.y)}, {"x2", pixels(b.x)}, {"y2", pixels(b.y)}}, attributes);
}

void Svg::polyline(const std::vector<Point2>& points, const Attributes& attributes) {
  std::string all;
  for (const auto& p : points) all += (all.empty() ? "" : " ") + pixels(p.x) + "," + pixels(p.y);
  element("polyline", {{"points", all}, {"fill", "none"}}, attributes);
}

void Svg::polygon(const geometry::Polygon& polygon, const Attributes& attributes) {
  std::string path = path_of(polygon.outer);
  for (const auto& hole : polygon.holes) path += path_of(hole);
  element("path", {{"d", path}, {"fill-rule", "evenodd"}}, attributes);
}

void Svg::rect(Point2 corner, double width, double height, const Attributes& attributes) {
  element("rect",
          {{"x", pixels(corner.x)}, {"y", pixels(corner.y)}, {"width", pixels(width)}, {"height", pixels(height)}},
          attributes);
}

void Svg::circle(Point2 centre, double radius, const Attributes& attributes) {
  element("circle", {{"cx", pixels(centre.x)}, {"cy", pixels(centre.y)}, {"r", pixels(radius)}}, attributes);
}

void Svg::text(Point2 at, std::string_view words, const Attributes& attributes) {
  element("text", {{"x", pixels(at.x)}, {"y", pixels(at.y)}}, attributes, words.empty() ? " " : words);
}

Frame::Frame(const geometry::Box2& box, double width, double height) : middle_{width / 2, height / 2} {
  if (box.empty()) return;
  const Point2 extent = box.most - box.least;
  centre_ = 0.5 * (box.least + box.most);
  scale_ = std::min(width / std::max(extent.x, 1e-9), height / std::max(extent.y, 1e-9));
}

auto Frame::operator()(Point2 p) const -> Point2 {
  return {middle_.x + scale_ * (p.x - centre_.x), middle_.y - scale_ * (p.y - centre_.y)};
}

auto Frame::operator()(const geometry::Polygon& polygon) const -> geometry::Polygon {
  geometry::Polygon out = polygon;
  for (auto& p : out.outer) p = (*this)(p);
  for (auto& hole : out.holes)
    for (auto& p : hole) p = (*this)(p);
  return out;
}

auto series_colour(std::size_t i) -> std::string {
  static constexpr std::array colours{"#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#8a8a8a"};
  return colours[i % colours.size()];
}

auto scale_colour(double share) -> std::string {
  if (std::isnan(share)) return "none";
  static constexpr std::array<std::array<int, 3>, 5> stops{
      {{0, 34, 78}, {64, 77, 107}, {123, 122, 119}, {187, 174, 108}, {254, 232, 56}}};
  const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  std::string colour = "#";
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = stops[low][c] + (at - static_cast<double>(low)) * (stops[low + 1][c] - stops[low][c]);
    const auto level = static_cast<unsigned>(std::lround(value));
    constexpr std::string_view digits = "0123456789abcdef";
    colour += digits[level / 16];
    colour += digits[level % 16];
  }
  return colour;
}

}  // namespace mansard::explore::detail
