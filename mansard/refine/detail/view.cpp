#include "mansard/refine/detail/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::refine::detail {
namespace {

using geometry::Point3;

/// The rows [first, last) of the grid whose centres lie between two y.
struct Rows {
  std::size_t first = 0, last = 0;
};
auto rows_between(const Heights& grid, double least, double most) -> Rows {
  const auto index = [&grid](double y) {
    return static_cast<std::size_t>(
        std::clamp(std::ceil((y - grid.origin.y) / grid.spacing), 0.0, static_cast<double>(grid.rows)));
  };
  return {index(least), index(most)};
}

class Painter {
 public:
  Painter(const model::Solid& solid, const Heights& grid, double base) : solid_(solid), grid_(grid), base_(base) {
    view_.z.assign(grid.z.size(), std::numeric_limits<double>::quiet_NaN());
    view_.face.assign(grid.z.size(), 0);
    x_.reserve(grid.columns);
    for (std::size_t column = 0; column < grid.columns; ++column) x_.push_back(grid.centre(column, 0).x);
  }

  void paint(std::uint32_t f) {
    const auto& face = solid_.faces[f];
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const auto v : face.loops.front()) {
      least = std::min(least, solid_.vertices[v].y);
      most = std::max(most, solid_.vertices[v].y);
    }
    const auto rows = rows_between(grid_, least, most);
    const Point3 at = solid_.vertices[face.loops.front().front()];
    const double dx = -face.normal.x / face.normal.z, dy = -face.normal.y / face.normal.z;
    for (std::size_t row = rows.first; row < rows.last; ++row) {
      const double y = grid_.centre(0, row).y;
      cross(face, y);
      double* z = &view_.z[row * grid_.columns];
      std::uint32_t* faces = &view_.face[row * grid_.columns];
      const double up = dy * (y - at.y), base = base_;
      each_span(grid_, crossings_, [&](std::size_t first, std::size_t last) {
        for (std::size_t column = first; column < last; ++column)
          z[column] = at.z + dx * (x_[column] - at.x) + up - base;
        std::fill(faces + first, faces + last, f);
      });
    }
  }

  [[nodiscard]] auto view() && -> View { return std::move(view_); }

 private:
  /// Where the face's edges cross the line of that y.
  void cross(const model::Face& face, double y) {
    crossings_.clear();
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        add_crossing(xy(solid_.vertices[loop[i]]), xy(solid_.vertices[loop[(i + 1) % loop.size()]]), y, crossings_);
  }

  const model::Solid& solid_;
  const Heights& grid_;
  double base_;
  std::vector<double> x_;  // m, of the columns' centres
  std::vector<double> crossings_;
  View view_;
};

/// Whether the point is within the face's loops, by the even-odd rule.
auto is_over(const model::Solid& solid, const model::Face& face, geometry::Point2 at) -> bool {
  bool inside = false;
  for (const auto& loop : face.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3 &a = solid.vertices[loop[i]], &b = solid.vertices[loop[(i + 1) % loop.size()]];
      if ((a.y <= at.y) == (b.y <= at.y)) continue;
      if (at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  return inside;
}

/// Beside the edge of a face a point may be over another face than the centre of its cell: one that is seen at a cell
/// around it. Where it is over none of these, it is taken to be over that of its own cell.
void see_samples(View& view, const model::Solid& solid, const Site& site) {
  const auto& grid = site.measured;
  view.z_at.assign(site.cells.size(), std::numeric_limits<double>::quiet_NaN());
  view.face_at.assign(site.cells.size(), 0);
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  const auto seen = [&](std::size_t cell) { return std::isnan(view.z[cell]) ? none : view.face[cell]; };
  std::vector<std::uint32_t> others;
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    const std::size_t cell = site.cells[i], column = cell % grid.columns, row = cell / grid.columns;
    std::uint32_t face = seen(cell);
    others.clear();
    for (std::size_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, grid.rows - 1); ++r)
      for (std::size_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 1, grid.columns - 1); ++c)
        if (const auto other = seen(r * grid.columns + c);
            other != face && other != none && std::ranges::find(others, other) == others.end())
          others.push_back(other);
    const auto place = site.places[i];
    if (!others.empty() && (face == none || !is_over(solid, solid.faces[face], place))) {
      const auto over =
          std::ranges::find_if(others, [&](std::uint32_t f) { return is_over(solid, solid.faces[f], place); });
      if (over != others.end()) face = *over;
      else if (face == none) face = others.front();
    }
    if (face == none) continue;
    const auto& normal = solid.faces[face].normal;
    const Point3 at = solid.vertices[solid.faces[face].loops.front().front()];
    view.face_at[i] = face;
    view.z_at[i] = at.z - (normal.x * (place.x - at.x) + normal.y * (place.y - at.y)) / normal.z - site.base;
  }
}

}  // namespace

auto view_of(const model::Solid& solid, const Site& site) -> View {
  Painter painter(solid, site.measured, site.base);
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
    if (solid.faces[f].normal.z > wall_normal) painter.paint(f);
  View view = std::move(painter).view();
  if (site.of_points) see_samples(view, solid, site);
  return view;
}

}  // namespace mansard::refine::detail
