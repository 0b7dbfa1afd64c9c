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

}  // namespace

SampleViews::SampleViews(const model::Solid& solid, const Site& site, View& view)
    : solid_(solid), site_(site), view_(view) {
  view.z_at.assign(site.cells.size(), std::numeric_limits<double>::quiet_NaN());
  view.face_at.assign(site.cells.size(), 0);
  seen_.resize(view.z.size());
  for (std::size_t cell = 0; cell < seen_.size(); ++cell)
    seen_[cell] = std::isnan(view.z[cell]) ? none : view.face[cell];
}

auto SampleViews::is_seen_around(std::uint32_t cell, std::uint32_t column, std::uint32_t row) const -> bool {
  const auto columns = static_cast<std::uint32_t>(site_.measured.columns),
             rows = static_cast<std::uint32_t>(site_.measured.rows);
  if (column == 0 || row == 0 || column + 1 == columns || row + 1 == rows) return false;
  const std::uint32_t *here = &seen_[cell], *before = here - columns, *after = here + columns, face = *here;
  return face != none && ((here[-1] ^ face) | (here[1] ^ face) | (before[-1] ^ face) | (before[0] ^ face) |
                          (before[1] ^ face) | (after[-1] ^ face) | (after[0] ^ face) | (after[1] ^ face)) == 0;
}

auto SampleViews::face_beside(std::uint32_t cell, std::size_t column, std::size_t row, geometry::Point2 place)
    -> std::uint32_t {
  const auto& grid = site_.measured;
  const std::uint32_t face = seen_[cell];
  others_.clear();
  for (std::size_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, grid.rows - 1); ++r)
    for (std::size_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 1, grid.columns - 1); ++c)
      if (const auto other = seen_[r * grid.columns + c];
          other != face && other != none && std::ranges::find(others_, other) == others_.end())
        others_.push_back(other);
  if (others_.empty() || (face != none && is_over(solid_, solid_.faces[face], place))) return face;
  const auto over =
      std::ranges::find_if(others_, [&](std::uint32_t f) { return is_over(solid_, solid_.faces[f], place); });
  if (over != others_.end()) return *over;
  return face == none ? others_.front() : face;
}

void SampleViews::see(std::size_t first, std::size_t last) {
  const auto columns = static_cast<std::uint32_t>(site_.measured.columns);
  for (std::size_t i = first; i < last; ++i) {
    const std::uint32_t cell = site_.cells[i], row = cell / columns, column = cell - row * columns;
    const auto place = site_.places[i];
    const auto face = is_seen_around(cell, column, row) ? seen_[cell] : face_beside(cell, column, row, place);
    if (face == none) continue;
    const auto& normal = solid_.faces[face].normal;
    const Point3 at = solid_.vertices[solid_.faces[face].loops.front().front()];
    view_.face_at[i] = face;
    view_.z_at[i] = at.z - (normal.x * (place.x - at.x) + normal.y * (place.y - at.y)) / normal.z - site_.base;
  }
}

auto cells_of(const model::Solid& solid, const Site& site) -> View {
  Painter painter(solid, site.measured, site.base);
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
    if (solid.faces[f].normal.z > wall_normal) painter.paint(f);
  return std::move(painter).view();
}

auto view_of(const model::Solid& solid, const Site& site) -> View {
  View view = cells_of(solid, site);
  if (site.of_points) SampleViews(solid, site, view).see(0, site.cells.size());
  return view;
}

}  // namespace mansard::refine::detail
