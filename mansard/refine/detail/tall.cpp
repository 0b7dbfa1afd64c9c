#include "mansard/refine/detail/tall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::refine::detail {
namespace {

using geometry::Point2;

/// m above the base in the cell that contains the point; NaN outside the grid.
auto height_at(const View& view, const Heights& grid, Point2 at) -> double {
  const Point2 cell = (1 / grid.spacing) * (at - grid.origin);
  const double column = std::round(cell.x), row = std::round(cell.y);
  if (!(column >= 0 && row >= 0 && column < static_cast<double>(grid.columns) && row < static_cast<double>(grid.rows)))
    return std::numeric_limits<double>::quiet_NaN();
  return view.z[static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column)];
}

class Asking {
 public:
  Asking(const Site& site, const View& view, const rays::Scene& mesh, const Options::Tall& options)
      : site_(site), view_(view), mesh_(mesh), options_(options) {}

  void along(const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], edge = ring[(i + 1) % ring.size()] - a;
      const auto places = static_cast<std::size_t>(std::floor(length(edge) / options_.spacing));
      const Point2 inward = left_of(normalised(edge));
      for (std::size_t k = 0; k < places; ++k)
        at(a + ((static_cast<double>(k) + 0.5) / static_cast<double>(places)) * edge, inward);
    }
  }
  [[nodiscard]] auto walls() const -> Walls { return walls_; }

 private:
  /// Over the height by which the part is above what is beside it, or that above the part; either is a wall.
  void at(Point2 place, Point2 inward) {
    const double own = height_at(view_, site_.measured, place + options_.inside * inward) + site_.base;
    const auto beside = mesh_.top(place - options_.beside * inward);
    if (!beside || std::isnan(own)) return;
    const auto [low, high] = std::minmax(own, *beside);
    // Between the two surfaces and far enough from both: only a wall is there.
    const double least = low + options_.clear, most = high - options_.clear;
    for (double z = least; z <= most; z += options_.spacing) {
      ++walls_.asked;
      if (mesh_.nearest({place.x, place.y, z}, options_.reach)) ++walls_.seen;
    }
  }

  const Site& site_;
  const View& view_;
  const rays::Scene& mesh_;
  const Options::Tall& options_;
  Walls walls_;
};

auto height_of(const model::Solid& solid, double base) -> double {
  double top = base;
  for (const auto& v : solid.vertices) top = std::max(top, v.z);
  return top - base;
}

}  // namespace

auto walls_of(const Site& site, const View& view, const rays::Scene& mesh, const Options& options) -> Walls {
  Asking asking(site, view, mesh, options.tall);
  asking.along(site.polygon.outer);
  for (const auto& hole : site.polygon.holes) asking.along(hole);
  return asking.walls();
}

auto is_needle(const Site& site, const Judged& roof, const rays::Scene& mesh, const Options& options) -> bool {
  const double height = height_of(roof.sketch, site.base);
  if (options.tall.ratio == 0 || height <= options.tall.ratio * std::sqrt(geometry::area(site.polygon))) return false;
  const auto [asked, seen] = walls_of(site, roof.view, mesh, options);
  return asked == 0 || static_cast<double>(seen) < options.tall.walls * static_cast<double>(asked);
}

}  // namespace mansard::refine::detail
