#include "mansard/derive/detail/grid.hpp"

#include <deque>

#include "mansard/base/run.hpp"

namespace mansard::derive::detail {
namespace {

/// The extreme of the last and next `reach` values of a line, in linear time: a queue of those that may still win.
void slide(const float* in, float* out, std::size_t count, std::size_t step, std::size_t reach, bool most) {
  std::deque<std::size_t> queue;
  const auto beaten = [&](float old, float by) { return most ? by >= old : by <= old; };
  for (std::size_t next = 0, at = 0; at < count; ++at) {
    for (; next < count && next <= at + reach; ++next) {
      const float value = in[next * step];
      if (std::isnan(value)) continue;
      while (!queue.empty() && beaten(in[queue.back() * step], value)) queue.pop_back();
      queue.push_back(next);
    }
    while (!queue.empty() && queue.front() + reach < at) queue.pop_front();
    out[at * step] = queue.empty() ? none : in[queue.front() * step];
  }
}

/// Squared distance in cells to the nearest cell of the mask (Felzenszwalb and Huttenlocher 2012), by columns, then
/// rows.
auto squared_distances(const Place& place, const Mask& mask) -> std::vector<float> {
  constexpr float far = 1e12F;
  std::vector<float> out(place.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = mask[i] != 0 ? 0 : far;
  const auto line = [&](std::size_t start, std::size_t count, std::size_t step) {
    std::vector<float> f(count);
    for (std::size_t i = 0; i < count; ++i) f[i] = out[start + i * step];
    std::vector<std::size_t> vertex(count);
    std::vector<double> from(count + 1);
    std::size_t k = 0;
    const auto crossing = [&](std::size_t a, std::size_t b) {
      const auto x = static_cast<double>(a), y = static_cast<double>(b);
      return ((f[b] + y * y) - (f[a] + x * x)) / (2 * (y - x));
    };
    from[0] = -std::numeric_limits<double>::infinity();
    from[1] = std::numeric_limits<double>::infinity();
    for (std::size_t q = 1; q < count; ++q) {
      double s = crossing(vertex[k], q);
      while (s <= from[k]) s = crossing(vertex[--k], q);
      vertex[++k] = q;
      from[k] = s;
      from[k + 1] = std::numeric_limits<double>::infinity();
    }
    k = 0;
    for (std::size_t q = 0; q < count; ++q) {
      while (from[k + 1] < static_cast<double>(q)) ++k;
      const double d = static_cast<double>(q) - static_cast<double>(vertex[k]);
      out[start + q * step] = static_cast<float>(std::min<double>(far, d * d + f[vertex[k]]));
    }
  };
  base::parallel_for(place.columns, [&](std::size_t column) { line(column, place.rows, place.columns); });
  base::parallel_for(place.rows, [&](std::size_t row) { line(row * place.columns, place.columns, 1); });
  return out;
}

}  // namespace

auto blobs_of(const Place& place, const Mask& mask) -> Blobs {
  Blobs blobs;
  blobs.of.assign(place.size(), 0);
  std::vector<std::size_t> open;
  for (std::size_t first = 0; first < mask.size(); ++first) {
    if (mask[first] == 0 || blobs.of[first] != 0) continue;
    const auto name = static_cast<std::int32_t>(blobs.size.size());
    blobs.size.push_back(0);
    blobs.of[first] = name;
    open.push_back(first);
    while (!open.empty()) {
      const std::size_t cell = open.back();
      open.pop_back();
      ++blobs.size.back();
      for_neighbours(place, cell, [&](std::size_t next) {
        if (mask[next] == 0 || blobs.of[next] != 0) return;
        blobs.of[next] = name;
        open.push_back(next);
      });
    }
  }
  return blobs;
}

auto extreme(const Place& place, const Heights& heights, std::size_t reach, bool most) -> Heights {
  Heights along(heights.size()), out(heights.size());
  base::parallel_for(place.rows, [&](std::size_t row) {
    const std::size_t start = row * place.columns;
    slide(&heights[start], &along[start], place.columns, 1, reach, most);
  });
  base::parallel_for(place.columns, [&](std::size_t column) {
    slide(&along[column], &out[column], place.rows, place.columns, reach, most);
  });
  return out;
}

auto grown(const Place& place, const Mask& mask, double cells) -> Mask {
  const auto distance = squared_distances(place, mask);
  Mask out(mask.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = distance[i] <= cells * cells ? 1 : 0;
  return out;
}

auto shrunk(const Place& place, const Mask& mask, double cells) -> Mask {
  Mask rest(mask.size());
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = mask[i] != 0 ? 0 : 1;
  rest = grown(place, rest, cells);
  for (auto& value : rest) value = value != 0 ? 0 : 1;
  return rest;
}

auto sums(const Place& place, const std::vector<float>& values, std::size_t reach) -> std::vector<double> {
  // Along rows, then along columns: each line by its running sums.
  std::vector<double> along(values.size()), out(values.size());
  const auto line = [reach](auto value, double* result, std::size_t count, std::size_t step) {
    std::vector<double> running(count + 1, 0);
    for (std::size_t i = 0; i < count; ++i) running[i + 1] = running[i] + value(i);
    for (std::size_t i = 0; i < count; ++i)
      result[i * step] = running[std::min(count, i + reach + 1)] - running[i > reach ? i - reach : 0];
  };
  base::parallel_for(place.rows, [&](std::size_t row) {
    const std::size_t start = row * place.columns;
    line([&](std::size_t i) { return static_cast<double>(values[start + i]); }, &along[start], place.columns, 1);
  });
  base::parallel_for(place.columns, [&](std::size_t column) {
    line([&](std::size_t i) { return along[column + i * place.columns]; }, &out[column], place.rows, place.columns);
  });
  return out;
}

}  // namespace mansard::derive::detail
