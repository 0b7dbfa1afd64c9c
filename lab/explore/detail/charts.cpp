#include "lab/explore/detail/charts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/explore/detail/svg.hpp"
#include "mansard/base/text.hpp"

namespace mansard::explore::detail {
namespace {

using geometry::Point2;

constexpr double width = 420, plot_height = 200, left = 58, right = 16, top = 30;
const Attributes axis{{"class", "axis"}}, faint{{"class", "grid"}}, heading{{"class", "heading"}};

struct Scale {
  double least = 0, most = 1, from = 0, to = 1;  // values, pixels
  [[nodiscard]] auto operator()(double value) const -> double {
    return from + (to - from) * (value - least) / (most - least);
  }
};

struct Extent {
  double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (std::isnan(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  /// Something to draw on even where there is nothing, or one value alone.
  void settle() {
    if (least > most) least = 0, most = 1;
    if (least == most) most = least + 1;
  }
};

/// As many decimals as the step between ticks has.
auto tick_text(double value, const std::vector<double>& all) -> std::string {
  const double step = all.size() > 1 ? all[1] - all[0] : 1;
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  return base::to_text(value, std::min(decimals, 9));
}

void draw_axes(Svg& svg, const LineChart& chart, const Scale& x, const Scale& y, const std::vector<double>& x_ticks,
               const std::vector<double>& y_ticks) {
  svg.text({left, 18}, chart.title, heading);
  for (const double value : y_ticks) {
    svg.line({left, y(value)}, {width - right, y(value)}, faint);
    svg.text({left - 6, y(value) + 4}, tick_text(value, y_ticks), {{"text-anchor", "end"}});
  }
  for (std::size_t i = 0; i < x_ticks.size(); ++i) {
    const double at = x(x_ticks[i]);
    if (at < left - 0.5 || at > width - right + 0.5) continue;
    svg.line({at, top + plot_height}, {at, top + plot_height + 4}, axis);
    svg.text({at, top + plot_height + 17}, chart.x_names.empty() ? tick_text(x_ticks[i], x_ticks) : chart.x_names[i],
             {{"text-anchor", "middle"}});
  }
  svg.line({left, top + plot_height}, {width - right, top + plot_height}, axis);
  svg.text({(left + width - right) / 2, top + plot_height + 34}, chart.x_label, {{"text-anchor", "middle"}});
}

void draw_series(Svg& svg, const Series& series, const std::string& colour, const Scale& x, const Scale& y) {
  std::vector<Point2> piece;
  const auto flush = [&] {
    if (piece.size() > 1) svg.polyline(piece, {{"stroke", colour}, {"stroke-width", "2"}});
    for (const auto& p : piece) svg.circle(p, 3, {{"fill", colour}});
    piece.clear();
  };
  for (const auto& p : series.points) {
    if (std::isnan(p.y)) flush();
    else piece.push_back({x(p.x), y(p.y)});
  }
  flush();
}

auto legend_rows(const LineChart& chart) -> double {
  return chart.series.size() < 2 ? 0 : std::ceil(static_cast<double>(chart.series.size()) / 2);
}

void draw_legend(Svg& svg, const LineChart& chart) {
  if (chart.series.size() < 2) return;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const double x = left + (i % 2 == 0 ? 0 : (width - left) / 2);
    const double y = top + plot_height + 54 + 18 * static_cast<double>(i / 2);
    svg.rect({x, y - 9}, 14, 10, {{"fill", series_colour(i)}});
    svg.text({x + 20, y}, chart.series[i].name);
  }
}

auto whole_numbers(std::size_t count) -> std::vector<double> {
  std::vector<double> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(static_cast<double>(i));
  return all;
}

}  // namespace

auto ticks(double least, double most, std::size_t wanted) -> std::vector<double> {
  const double raw = (most - least) / static_cast<double>(std::max<std::size_t>(1, wanted));
  if (!(raw > 0) || !std::isfinite(raw)) return {least};
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  std::vector<double> all;
  const double first = std::floor(least / step + 1e-9), last = std::ceil(most / step - 1e-9);
  for (double k = first; k <= last; ++k) all.push_back(k * step);
  return all;
}

auto line_chart(const LineChart& chart) -> std::string {
  Extent across, up;
  up.add(0);
  for (const auto& series : chart.series)
    for (const auto& p : series.points) across.add(p.x), up.add(p.y);
  across.settle();
  up.settle();
  const auto y_ticks = ticks(up.least, up.most, 4);
  const auto x_ticks =
      chart.x_names.empty() ? ticks(across.least, across.most, 8) : whole_numbers(chart.x_names.size());
  const Scale x{across.least, across.most, left + 10, width - right - 10};
  const Scale y{y_ticks.front(), y_ticks.back(), top + plot_height, top};

  const double height = top + plot_height + 42 + 18 * legend_rows(chart);
  Svg svg(width, height, chart.title + " over " + chart.x_label);
  draw_axes(svg, chart, x, y, x_ticks, y_ticks);
  for (std::size_t i = 0; i < chart.series.size(); ++i) draw_series(svg, chart.series[i], series_colour(i), x, y);
  draw_legend(svg, chart);
  return std::move(svg).done();
}

auto heat_map(const HeatMap& map) -> std::string {
  constexpr double cell_width = 62, cell_height = 34;
  Extent extent;
  for (const double value : map.values) extent.add(value);
  extent.settle();
  const auto columns = static_cast<double>(map.x_names.size()), rows = static_cast<double>(map.y_names.size());
  const double bottom = top + 16 + cell_height * rows;
  Svg svg(left + 24 + cell_width * columns + right, bottom + 42,
          map.title + " over " + map.x_label + " and " + map.y_label);
  svg.text({8, 18}, map.title, heading);
  const double x0 = left + 24, y0 = top + 16;
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const double value = map.values[i];
    const auto column = static_cast<double>(i % map.x_names.size()), row = static_cast<double>(i / map.x_names.size());
    const Point2 corner{x0 + cell_width * column, y0 + cell_height * row};
    const double share = (value - extent.least) / (extent.most - extent.least);
    svg.rect(corner, cell_width - 2, cell_height - 2, {{"fill", scale_colour(share)}, {"class", "cell"}});
    svg.text({corner.x + cell_width / 2 - 1, corner.y + cell_height / 2 + 4},
             std::isnan(value) ? "failed" : base::to_text(value, map.decimals),
             {{"text-anchor", "middle"},
              {"class", std::isnan(value) ? "none"
                        : share < 0.5     ? "on-dark"
                                          : "on-light"}});
  }
  for (std::size_t i = 0; i < map.y_names.size(); ++i)
    svg.text({x0 - 6, y0 + cell_height * (static_cast<double>(i) + 0.5) + 4}, map.y_names[i], {{"text-anchor", "end"}});
  for (std::size_t i = 0; i < map.x_names.size(); ++i)
    svg.text({x0 + cell_width * (static_cast<double>(i) + 0.5), bottom + 14}, map.x_names[i],
             {{"text-anchor", "middle"}});
  svg.text({8, 36}, map.y_label + " ↓");
  svg.text({x0 + cell_width * columns / 2, bottom + 32}, map.x_label + " →", {{"text-anchor", "middle"}});
  return std::move(svg).done();
}

}  // namespace mansard::explore::detail
