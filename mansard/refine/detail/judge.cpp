#include "mansard/refine/detail/judge.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::refine::detail {
namespace {

/// Squared up to `robust`, linear beyond (P. Huber, Robust estimation of a location parameter, 1964).
auto loss(double difference, double robust) -> double {
  const double d = std::abs(difference);
  return d <= robust ? d * d : robust * (2 * d - robust);
}

/// A look past the solid (its outline is rounded by some millimetres) falls to its base.
auto height_of(const View& view, std::uint32_t cell) -> double { return std::isnan(view.z[cell]) ? 0 : view.z[cell]; }

}  // namespace

auto Judge::operator()(const geometry::Plan& plan) const -> base::Result<Judged> {
  auto sketch = extrude::sketch(plan, raising_, run_);
  if (!sketch) return sketch.error();
  Judged out{plan, std::move(*sketch), {}, 0, 0};
  out.view = view_of(out.sketch, site_.measured, site_.base);
  double sum = 0;
  for (std::size_t i = 0; i < site_.cells.size(); ++i) {
    const auto cell = site_.cells[i];
    sum += site_.weight[i] * loss(height_of(out.view, cell) - site_.measured.z[cell], options_.robust);
  }
  out.misfit = sum * site_.cell_area;
  out.cost = out.misfit + options_.face_price * static_cast<double>(out.sketch.faces.size());
  return out;
}

}  // namespace mansard::refine::detail
