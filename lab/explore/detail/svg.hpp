// A small writer of SVG that stands in an HTML page: text and axes take the page's colours.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/geometry/points.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::explore::detail {

/// For text and attribute values of HTML and XML. Control characters, which XML cannot hold, become spaces.
[[nodiscard]] auto escape(std::string_view text) -> std::string;

/// Name and value of attributes, written as given but escaped.
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// Coordinates are pixels, y down, written with two decimals.
class Svg {
 public:
  /// `label` is read out in place of the picture.
  Svg(double width, double height, std::string_view label);

  void line(geometry::Point2 a, geometry::Point2 b, const Attributes& attributes);
  void polyline(const std::vector<geometry::Point2>& points, const Attributes& attributes);
  /// A path with holes, by the even-odd rule.
  void polygon(const geometry::Polygon& polygon, const Attributes& attributes);
  void rect(geometry::Point2 corner, double width, double height, const Attributes& attributes);
  void circle(geometry::Point2 centre, double radius, const Attributes& attributes);
  void text(geometry::Point2 at, std::string_view words, const Attributes& attributes = {});

  [[nodiscard]] auto done() && -> std::string { return std::move(out_) + "</svg>\n"; }

 private:
  void element(std::string_view name, const Attributes& geometry, const Attributes& attributes,
               std::string_view words = {});
  std::string out_;
};

/// From plan to pixels: scaled alike in both directions, north up, in the middle of the picture.
class Frame {
 public:
  Frame(const geometry::Box2& box, double width, double height);
  [[nodiscard]] auto operator()(geometry::Point2 p) const -> geometry::Point2;
  [[nodiscard]] auto operator()(const geometry::Polygon& polygon) const -> geometry::Polygon;

 private:
  geometry::Point2 centre_, middle_;
  double scale_ = 1;
};

/// Told apart by people who see fewer colours too (Okabe and Ito), on light and dark ground. Repeats after seven.
[[nodiscard]] auto series_colour(std::size_t i) -> std::string;
/// From dark blue (0) over grey to yellow (1), rising in lightness; NaN is transparent.
[[nodiscard]] auto scale_colour(double share) -> std::string;

}  // namespace mansard::explore::detail
