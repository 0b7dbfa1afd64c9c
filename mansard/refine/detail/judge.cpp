#include "mansard/refine/detail/judge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mansard/refine/detail/blur.hpp"

namespace mansard::refine::detail {
namespace {

/// Working memory that a thread keeps: heights, and their sums along rows.
struct Scratch {
  std::vector<double> heights, sums;  // m above the base, in rows with two cells of nothing on every side
};
auto scratch() -> Scratch& {
  thread_local Scratch one;
  return one;
}

}  // namespace

auto Judge::misfit_of(const std::vector<double>& z, double cap) const -> double {
  // The heights as a scan would have them, whose corners are round: smoothed with a standard deviation of one cell, the
  // 0.25 m by which photogrammetry melts a block. Else a slope would suit the scan of a step better than the step. A
  // sample past the solid (its outline is rounded by some millimetres) falls to its base.
  const auto& grid = site_.measured;
  const std::size_t stride = grid.columns + 2 * blur_reach;
  auto& [heights, sums] = scratch();
  heights.assign(stride * (grid.rows + 2 * blur_reach), 0);
  sums.assign(heights.size(), 0);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    double* to = &heights[(row + blur_reach) * stride + blur_reach];
    const double* from = &z[row * grid.columns];
    const double* inside = &site_.unblurred[row * grid.columns];
    for (std::size_t column = 0; column < grid.columns; ++column)
      if (inside[column] > 0 && !std::isnan(from[column])) to[column] = std::min(from[column], cap);
  }
  blur_rows(heights, sums);
  double sum = 0;
  for (std::size_t i = 0; i < site_.cells.size(); ++i) {
    const auto cell = site_.cells[i];
    const std::size_t at = (cell / grid.columns + blur_reach) * stride + cell % grid.columns + blur_reach;
    const double shown = site_.unblurred[cell] * blurred(sums, at, stride);
    sum += site_.weight[i] * loss(shown - grid.z[cell], options_.robust);
  }
  // A roof is under the crown that hides it.
  for (const auto& [cell, ceiling] : site_.ceilings)
    if (const double above = std::min(z[cell], cap) - ceiling; above > 0) sum += loss(above, options_.robust);
  return sum * site_.cell_area;
}

auto Judge::operator()(const model::Plan& plan) const -> base::Result<Judged> {
  auto sketch = extrude::sketch(plan, raising_, run_);
  if (!sketch) return sketch.error();
  Judged out{plan, std::move(*sketch), {}, 0, {}, 0, 0};
  out.view = view_of(out.sketch, site_.measured, site_.base);
  out.misfit = misfit_of(out.view.z);
  out.bare = bare_faces(out.sketch, out.view, site_, options_);
  // Evidence would have to come from elsewhere: as dear as a part.
  out.unsupported = options_.part_price * static_cast<double>(out.bare.size());
  out.cost = out.unsupported + out.misfit + options_.face_price * static_cast<double>(out.sketch.faces.size());
  return out;
}

}  // namespace mansard::refine::detail
