#include "mansard/texture/detail/fill.hpp"

#include <algorithm>

namespace mansard::texture::detail {
namespace {

struct Level {
  std::uint32_t width = 0, height = 0;
  std::vector<Light> light;
  std::vector<bool> known;

  [[nodiscard]] auto at(std::uint32_t x, std::uint32_t y) const -> std::size_t { return std::size_t{y} * width + x; }
};

/// Half as wide and high: the mean of what is known of four.
auto pulled(const Level& fine) -> Level {
  Level out{(fine.width + 1) / 2, (fine.height + 1) / 2, {}, {}};
  const std::size_t count = std::size_t{out.width} * out.height;
  out.light.resize(count);
  out.known.assign(count, false);
  for (std::uint32_t y = 0; y < out.height; ++y)
    for (std::uint32_t x = 0; x < out.width; ++x) {
      std::array<std::uint32_t, 3> sum{};
      std::uint32_t n = 0;
      for (std::uint32_t j = 2 * y; j < std::min(2 * y + 2, fine.height); ++j)
        for (std::uint32_t i = 2 * x; i < std::min(2 * x + 2, fine.width); ++i) {
          if (!fine.known[fine.at(i, j)]) continue;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += fine.light[fine.at(i, j)][c];
          ++n;
        }
      if (n == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) out.light[out.at(x, y)][c] = static_cast<std::uint16_t>((sum[c] + n / 2) / n);
      out.known[out.at(x, y)] = true;
    }
  return out;
}

/// What is unknown, between the four nearest of the coarser level, which knows all.
void push(const Level& coarse, Level& fine) {
  for (std::uint32_t y = 0; y < fine.height; ++y)
    for (std::uint32_t x = 0; x < fine.width; ++x) {
      if (fine.known[fine.at(x, y)]) continue;
      const auto beside = [](std::uint32_t i, std::uint32_t size) {
        const std::uint32_t own = i / 2;
        const std::uint32_t other = i % 2 == 0 ? (own > 0 ? own - 1 : own) : std::min(own + 1, size - 1);
        return std::pair(own, other);
      };
      const auto [x0, x1] = beside(x, coarse.width);
      const auto [y0, y1] = beside(y, coarse.height);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto value = [&](std::uint32_t i, std::uint32_t j) -> std::uint32_t {
          return coarse.light[coarse.at(i, j)][c];
        };
        fine.light[fine.at(x, y)][c] = static_cast<std::uint16_t>(
            (9 * value(x0, y0) + 3 * value(x1, y0) + 3 * value(x0, y1) + value(x1, y1) + 8) / 16);
      }
    }
}

/// The unknown neighbours of what is known become the mean of their known neighbours.
void widen(Level& level) {
  std::vector<bool> known = level.known;
  const auto before = level.light;
  for (std::uint32_t y = 0; y < level.height; ++y)
    for (std::uint32_t x = 0; x < level.width; ++x) {
      if (level.known[level.at(x, y)]) continue;
      std::array<std::uint32_t, 3> sum{};
      std::uint32_t n = 0;
      for (std::uint32_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, level.height - 1); ++j)
        for (std::uint32_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, level.width - 1); ++i) {
          if (!level.known[level.at(i, j)]) continue;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += before[level.at(i, j)][c];
          ++n;
        }
      if (n == 0) continue;
      for (std::size_t c = 0; c < 3; ++c)
        level.light[level.at(x, y)][c] = static_cast<std::uint16_t>((sum[c] + n / 2) / n);
      known[level.at(x, y)] = true;
    }
  level.known = std::move(known);
}

}  // namespace

void continue_from(std::vector<Light>& light, const std::vector<bool>& fixed, std::uint32_t width,
                   std::uint32_t height) {
  std::vector<Level> levels;
  levels.push_back({width, height, std::move(light), fixed});
  for (int step = 0; step < 2; ++step) widen(levels.front());
  while (std::ranges::find(levels.back().known, false) != levels.back().known.end() &&
         (levels.back().width > 1 || levels.back().height > 1))
    levels.push_back(pulled(levels.back()));
  for (std::size_t i = levels.size() - 1; i-- > 0;) push(levels[i + 1], levels[i]);
  light = std::move(levels.front().light);
}

}  // namespace mansard::texture::detail
