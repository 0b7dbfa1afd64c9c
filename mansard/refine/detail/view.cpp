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

}  // namespace

auto view_of(const model::Solid& solid, const Heights& grid, double base) -> View {
  Painter painter(solid, grid, base);
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
    if (solid.faces[f].normal.z > wall_normal) painter.paint(f);
  return std::move(painter).view();
}

}  // namespace mansard::refine::detail
