#include "mansard/refine/detail/judge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mansard::refine::detail {
namespace {

/// A grid in rows with two cells of nothing on every side: what is smoothed, and where there is anything.
class Smoothed {
 public:
  Smoothed(const std::vector<double>& z, const Heights& grid)
      : columns_(grid.columns), rows_(grid.rows), stride_(grid.columns + 2 * reach) {
    const std::size_t cells = stride_ * (rows_ + 2 * reach);
    value_.assign(cells, 0);
    there_.assign(cells, 0);
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t column = 0; column < columns_; ++column) {
        const double height = z[row * columns_ + column];
        if (std::isnan(height)) continue;
        value_[at(column, row)] = height;
        there_[at(column, row)] = 1;
      }
    pass(1);
    pass(stride_);
  }

  [[nodiscard]] auto operator()(std::uint32_t cell) const -> double {
    return value_[at(cell % columns_, cell / columns_)];
  }

 private:
  static constexpr std::size_t reach = 2;

  [[nodiscard]] auto at(std::size_t column, std::size_t row) const -> std::size_t {
    return (row + reach) * stride_ + column + reach;
  }

  /// A binomial of five over every `step`th cell; its variance is one cell squared. What is not there counts nowhere.
  void pass(std::size_t step) {
    const auto sum = [step](const std::vector<double>& of, std::size_t i) {
      return 6 * of[i] + 4 * (of[i - step] + of[i + step]) + (of[i - 2 * step] + of[i + 2 * step]);
    };
    std::vector<double> out(value_.size(), 0);
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t i = at(0, row), end = i + columns_; i < end; ++i)
        out[i] = there_[i] * sum(value_, i) / std::max(1.0, sum(there_, i));
    value_ = std::move(out);
  }

  std::size_t columns_, rows_, stride_;
  std::vector<double> value_, there_;  // m above the base; 1 or 0
};

}  // namespace

auto Judge::operator()(const model::Plan& plan) const -> base::Result<Judged> {
  auto sketch = extrude::sketch(plan, raising_, run_);
  if (!sketch) return sketch.error();
  Judged out{plan, std::move(*sketch), {}, 0, 0};
  out.view = view_of(out.sketch, site_.measured, site_.base);
  // The heights as a scan would have them, whose corners are round: smoothed with a standard deviation of one cell, the
  // 0.25 m by which photogrammetry melts a block. Else a slope would suit the scan of a step better than the step. A
  // sample past the solid (its outline is rounded by some millimetres) falls to its base.
  const Smoothed shown(out.view.z, site_.measured);
  double sum = 0;
  for (std::size_t i = 0; i < site_.cells.size(); ++i) {
    const auto cell = site_.cells[i];
    sum += site_.weight[i] * loss(shown(cell) - site_.measured.z[cell], options_.robust);
  }
  out.misfit = sum * site_.cell_area;
  out.cost = out.misfit + options_.face_price * static_cast<double>(out.sketch.faces.size());
  return out;
}

}  // namespace mansard::refine::detail
