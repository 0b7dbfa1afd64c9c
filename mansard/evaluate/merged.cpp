#include <algorithm>
#include <cmath>

#include "mansard/evaluate/merged.hpp"

namespace mansard::evaluate {
namespace {

/// The cells that all maps lie in, of `times` the maps' spacing and on whole multiples of it.
struct Frame {
  double grid = 0;
  std::int64_t west = 0, south = 0, columns = 0, rows = 0;

  Frame(std::span<const ErrorMap> maps, double spacing, std::int64_t times)
      : grid(spacing * static_cast<double>(times)) {
    std::int64_t east = 0, north = 0;
    for (const auto& map : maps) {
      if (map.columns == 0) continue;
      const auto least_column = cell(map.origin.x), least_row = cell(map.origin.y);
      const auto most_column = cell(map.origin.x + map.grid * static_cast<double>(map.columns - 1)),
                 most_row = cell(map.origin.y + map.grid * static_cast<double>(map.rows - 1));
      const bool first = columns == 0;
      west = first ? least_column : std::min(west, least_column);
      south = first ? least_row : std::min(south, least_row);
      east = first ? most_column : std::max(east, most_column);
      north = first ? most_row : std::max(north, most_row);
      columns = east - west + 1;
      rows = north - south + 1;
    }
  }
  /// The cell in which a centre of a finer one lies.
  [[nodiscard]] auto cell(double centre) const -> std::int64_t {
    return static_cast<std::int64_t>(std::floor(centre / grid));
  }
};

}  // namespace

auto merged(std::span<const ErrorMap> maps, std::size_t most) -> ErrorMap {
  const auto all = merged_from(
      [&](const auto& take) -> base::Result<void> {
        for (const auto& map : maps) take(map);
        return {};
      },
      most);
  return *all;  // there is nothing that could fail
}

auto merged_from(const EachMap& each, std::size_t most) -> base::Result<ErrorMap> {
  std::vector<ErrorMap> outlines;  // without their values
  auto outlined = each([&](const ErrorMap& map) {
    if (map.columns > 0) outlines.push_back({map.origin, map.grid, map.columns, map.rows, {}});
  });
  if (!outlined) return outlined.failure();
  ErrorMap all;
  if (outlines.empty()) return all;
  const double grid = outlines.front().grid;
  std::int64_t times = 1;
  Frame frame(outlines, grid, times);
  while (static_cast<std::size_t>(frame.columns * frame.rows) > most) frame = Frame(outlines, grid, ++times);

  all.grid = frame.grid;
  all.origin = {(static_cast<double>(frame.west) + 0.5) * frame.grid,
                (static_cast<double>(frame.south) + 0.5) * frame.grid};
  all.columns = static_cast<std::size_t>(frame.columns);
  all.rows = static_cast<std::size_t>(frame.rows);
  all.difference.assign(all.columns * all.rows, std::numeric_limits<float>::quiet_NaN());
  std::vector<std::uint32_t> counts(times > 1 ? all.difference.size() : 0, 0);
  auto filled = each([&](const ErrorMap& map) {
    for (std::size_t r = 0; r < map.rows; ++r)
      for (std::size_t c = 0; c < map.columns; ++c) {
        const float value = map.at(c, r);
        if (std::isnan(value)) continue;
        const auto column = frame.cell(map.origin.x + map.grid * static_cast<double>(c)) - frame.west;
        const auto row = frame.cell(map.origin.y + map.grid * static_cast<double>(r)) - frame.south;
        const auto at = static_cast<std::size_t>(row * frame.columns + column);
        float& cell = all.difference[at];
        // The mean so far, with one more.
        cell = times == 1 || counts[at] == 0 ? value : cell + (value - cell) / static_cast<float>(counts[at] + 1);
        if (times > 1) ++counts[at];
      }
  });
  if (!filled) return filled.failure();
  return all;
}

}  // namespace mansard::evaluate
