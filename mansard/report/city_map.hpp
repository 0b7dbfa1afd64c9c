// A map of a city of any size as SVG: outlines in a few colours, and marks on some of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/geometry/points.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::report {

/// Outlines are put on a grid of a ten-thousandth of the map, so that a building has a few bytes in a city of any size
/// and one element of the page holds all of a colour. Memory: 8 bytes for each corner.
class CityMap {
 public:
  void add(const std::vector<geometry::Polygon>& outline, std::uint8_t kind);
  /// A number on the map, in the order of the calls.
  void mark(geometry::Point2 at, std::string text) { marks_.push_back({at, std::move(text)}); }

  struct Kind {
    std::string_view name, colour;
  };
  [[nodiscard]] auto empty() const -> bool { return corners_.empty(); }
  /// North up, with a scale bar. `label` is read out in place of it. Kinds are drawn in their order, the last on top.
  [[nodiscard]] auto svg(const std::vector<Kind>& kinds, std::string_view label) const -> std::string;

 private:
  struct Corner {
    float x = 0, y = 0;
  };
  struct Ring {
    std::size_t first = 0;
    std::uint8_t kind = 0;
  };
  struct Mark {
    geometry::Point2 at;
    std::string text;
  };
  std::vector<Corner> corners_;  ///< m from `origin_`; to a centimetre in a city of 100 km
  std::vector<Ring> rings_;
  std::vector<Mark> marks_;
  geometry::Point2 origin_;
  geometry::Box2 box_;
  std::size_t buildings_ = 0;
};

}  // namespace mansard::report
