#include "mansard/refine/detail/judge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mansard::refine::detail {
namespace {

/// Squared up to `robust`, linear beyond (P. Huber, Robust estimation of a location parameter, 1964).
auto loss(double difference, double robust) -> double {
  const double d = std::abs(difference);
  return d <= robust ? d * d : robust * (2 * d - robust);
}

/// A look past the solid (its outline is rounded by some millimetres) falls to its base.
auto height_of(const std::vector<double>& z, std::uint32_t cell) -> double { return std::isnan(z[cell]) ? 0 : z[cell]; }

/// Every `step`th of the heights, `count` of them from `first`, smoothed by a binomial of five; NaN counts nowhere.
void smooth(const std::vector<double>& from, std::vector<double>& to, std::size_t first, std::size_t step,
            std::size_t count) {
  constexpr double weights[]{6, 4, 1};  // of the five binomials of 4, whose variance is one cell squared
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t cell = first + i * step;
    to[cell] = from[cell];
    if (std::isnan(from[cell])) continue;
    double sum = weights[0] * from[cell], all = weights[0];
    const auto take = [&](std::size_t other, double weight) {
      if (std::isnan(from[other])) return;
      sum += weight * from[other];
      all += weight;
    };
    for (std::size_t k = 1; k <= 2; ++k) {
      if (i >= k) take(cell - k * step, weights[k]);
      if (i + k < count) take(cell + k * step, weights[k]);
    }
    to[cell] = sum / all;
  }
}

/// The heights as a scan would have them, whose corners are round: smoothed with a standard deviation of one cell, the
/// 0.25 m by which photogrammetry melts a block. Else a slope would suit the scan of a step better than the step.
auto melted(const View& view, const Heights& grid) -> std::vector<double> {
  std::vector<double> across(view.z.size()), out(view.z.size());
  for (std::size_t row = 0; row < grid.rows; ++row) smooth(view.z, across, row * grid.columns, 1, grid.columns);
  for (std::size_t column = 0; column < grid.columns; ++column) smooth(across, out, column, grid.columns, grid.rows);
  return out;
}

}  // namespace

auto Judge::operator()(const model::Plan& plan) const -> base::Result<Judged> {
  auto sketch = extrude::sketch(plan, raising_, run_);
  if (!sketch) return sketch.error();
  Judged out{plan, std::move(*sketch), {}, 0, 0};
  out.view = view_of(out.sketch, site_.measured, site_.base);
  const auto shown = melted(out.view, site_.measured);
  double sum = 0;
  for (std::size_t i = 0; i < site_.cells.size(); ++i) {
    const auto cell = site_.cells[i];
    sum += site_.weight[i] * loss(height_of(shown, cell) - site_.measured.z[cell], options_.robust);
  }
  out.misfit = sum * site_.cell_area;
  out.cost = out.misfit + options_.face_price * static_cast<double>(out.sketch.faces.size());
  return out;
}

}  // namespace mansard::refine::detail
