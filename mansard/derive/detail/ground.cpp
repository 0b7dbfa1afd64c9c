#include "mansard/derive/detail/ground.hpp"

#include "mansard/base/run.hpp"
#include "mansard/geometry/fit.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::derive::detail {
namespace {

/// A plane through the low surface: what the opening must not take for a step where the ground slopes as a whole.
struct Tilt {
  double a = 0, b = 0, c = 0;
  [[nodiscard]] auto at(std::size_t column, std::size_t row) const -> float {
    return static_cast<float>(a * static_cast<double>(column) + b * static_cast<double>(row) + c);
  }
};

/// Least squares over the cells that have a height and a weight.
auto plane_through(const Place& place, const Heights& heights, const Mask& use) -> Tilt {
  geometry::PlaneSums sums;
  const double mx = static_cast<double>(place.columns) / 2, my = static_cast<double>(place.rows) / 2;
  for (std::size_t row = 0; row < place.rows; ++row)
    for (std::size_t column = 0; column < place.columns; ++column) {
      const std::size_t i = place.index(column, row);
      if (use[i] == 0 || std::isnan(heights[i])) continue;
      sums.add(static_cast<double>(column) - mx, static_cast<double>(row) - my, heights[i]);
    }
  if (sums.count < 3) return {};
  const auto equations = sums.centred();
  if (equations.determinant() <= 1e-9 * equations.xx * equations.yy) return {0, 0, sums.z / sums.count};
  const auto plane = sums.plane(equations.slopes());
  const auto [a, b] = plane.slope;
  return {a, b, plane.at_zero - a * mx - b * my};
}

void tilt_by(const Place& place, Heights& heights, const Tilt& tilt, float sign) {
  for (std::size_t row = 0; row < place.rows; ++row)
    for (std::size_t column = 0; column < place.columns; ++column)
      heights[place.index(column, row)] += sign * tilt.at(column, row);
}

/// Cells near the lowest surface of a square `widest` wide around them.
auto lowest_cells(const Place& place, const Heights& heights, std::size_t reach, const Options& o) -> Mask {
  const auto opened = extreme(place, extreme(place, heights, reach, false), reach, true);
  Mask seeds(heights.size(), 0);
  for (std::size_t i = 0; i < seeds.size(); ++i) seeds[i] = heights[i] - opened[i] <= o.ground_seed ? 1 : 0;
  return seeds;
}

/// Cells without a step to any of their four neighbours.
auto smooth_cells(const Place& place, const Heights& heights, const Options& o) -> Mask {
  const auto step = static_cast<float>(o.ground_slope * place.cell + o.ground_noise);
  Mask smooth(heights.size(), 0);
  base::parallel_for(place.rows, [&](std::size_t row) {
    for (std::size_t i = place.index(0, row); i < place.index(0, row + 1); ++i) {
      if (std::isnan(heights[i])) continue;
      bool even = true;
      for_neighbours(place, i, [&](std::size_t next) {
        if (std::abs(heights[next] - heights[i]) > step) even = false;
      });
      smooth[i] = even ? 1 : 0;
    }
  });
  return smooth;
}

/// The cells of the mask that are joined to a seed within it.
auto joined_to(const Place& place, const Mask& seeds, const Mask& mask) -> Mask {
  Mask out(mask.size(), 0);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (seeds[i] != 0 && mask[i] != 0) out[i] = 1, open.push_back(i);
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    for_neighbours(place, cell, [&](std::size_t next) {
      if (mask[next] == 0 || out[next] != 0) return;
      out[next] = 1;
      open.push_back(next);
    });
  }
  return out;
}

/// Gives every cell a height: means of ever larger squares, then smoothed from coarse to fine (pull and push).
auto filled(const Place& place, const Heights& heights) -> Heights {
  bool gaps = false, any = false;
  for (const float z : heights) (std::isnan(z) ? gaps : any) = true;
  if (!gaps || !any || place.size() <= 1) return heights;
  const Place coarse{place.corner, 2 * place.cell, (place.columns + 1) / 2, (place.rows + 1) / 2};
  Heights pulled(coarse.size(), none);
  for (std::size_t row = 0; row < coarse.rows; ++row)
    for (std::size_t column = 0; column < coarse.columns; ++column) {
      double sum = 0, count = 0;
      for (std::size_t r = 2 * row; r < std::min(place.rows, 2 * row + 2); ++r)
        for (std::size_t c = 2 * column; c < std::min(place.columns, 2 * column + 2); ++c)
          if (const float z = heights[place.index(c, r)]; !std::isnan(z)) sum += z, count += 1;
      if (count > 0) pulled[coarse.index(column, row)] = static_cast<float>(sum / count);
    }
  pulled = filled(coarse, pulled);
  Heights out = heights;
  const auto near = [](std::size_t at,
                       std::size_t count) {  // the coarse cell of `at`, and the one that is next nearest
    const std::size_t own = at / 2, other = at % 2 == 0 ? (own > 0 ? own - 1 : own) : std::min(own + 1, count - 1);
    return std::pair{own, other};
  };
  for (std::size_t row = 0; row < place.rows; ++row)
    for (std::size_t column = 0; column < place.columns; ++column) {
      float& z = out[place.index(column, row)];
      if (!std::isnan(z)) continue;
      const auto [c0, c1] = near(column, coarse.columns);
      const auto [r0, r1] = near(row, coarse.rows);
      z = 0.5625F * pulled[coarse.index(c0, r0)] + 0.1875F * pulled[coarse.index(c1, r0)] +
          0.1875F * pulled[coarse.index(c0, r1)] + 0.0625F * pulled[coarse.index(c1, r1)];
    }
  return out;
}

}  // namespace

auto place_of(const geometry::Mesh& mesh, double cell) -> Place {
  geometry::Box2 box;
  for (const auto& triangle : mesh.triangles)
    for (const auto v : triangle) box.add(geometry::xy(mesh.vertices[v]));
  if (box.empty()) return {{0, 0}, cell, 0, 0};
  // On whole multiples of the cell, so that a cut-out of a mesh has the cells of the whole.
  const auto least = [cell](double value) { return std::floor(value / cell) - 1; };
  const auto count = [cell, &least](double from, double to) {
    return static_cast<std::size_t>(std::ceil(to / cell) + 1 - least(from));
  };
  return {{least(box.least.x) * cell, least(box.least.y) * cell},
          cell,
          count(box.least.x, box.most.x),
          count(box.least.y, box.most.y)};
}

auto top_heights(const geometry::Mesh& mesh, const Place& place) -> Heights {
  const rays::Scene scene(mesh);
  Heights top(place.size(), none);
  base::parallel_for(place.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < place.columns; ++column)
      if (const auto z = scene.top(place.centre(column, row))) top[place.index(column, row)] = static_cast<float>(*z);
  });
  return top;
}

auto ground_of(const Place& place, const Heights& top, const Options& o) -> Heights {
  // Pits out: the greatest, then the least of small squares.
  const std::size_t pit_reach = place.cells(o.pit_width / 2);
  Heights heights = extreme(place, extreme(place, top, pit_reach, true), pit_reach, false);
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (std::isnan(top[i])) heights[i] = none;

  const std::size_t reach = place.cells(o.widest / 2);
  const auto level = plane_through(place, heights, lowest_cells(place, heights, reach, o));
  tilt_by(place, heights, level, -1);
  const auto seeds = lowest_cells(place, heights, reach, o);
  tilt_by(place, heights, level, 1);

  const double narrow = std::max(1.0, o.ground_width / 2 / place.cell);
  const auto core = shrunk(place, smooth_cells(place, top, o), narrow);
  const auto found = grown(place, joined_to(place, seeds, core), narrow);
  Heights ground(top.size(), none);
  for (std::size_t i = 0; i < ground.size(); ++i)
    if (found[i] != 0 && !std::isnan(top[i])) ground[i] = top[i];
  return filled(place, ground);
}

auto ground_of(const Place& place, const model::HeightGrid& terrain) -> Heights {
  Heights ground(place.size(), none);
  base::parallel_for(place.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < place.columns; ++column)
      if (const auto z = terrain.at(place.centre(column, row)))
        ground[place.index(column, row)] = static_cast<float>(*z);
  });
  return filled(place, ground);
}

}  // namespace mansard::derive::detail
