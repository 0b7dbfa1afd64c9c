// The steps of deriving footprints: heights, ground, what stands, what of it is a building, its outline, straight
// walls.
#include "mansard/derive/derive.hpp"

#include <algorithm>
#include <numeric>

#include "mansard/base/statistics.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/derive/detail/buildings.hpp"
#include "mansard/derive/detail/ground.hpp"
#include "mansard/derive/detail/outline.hpp"
#include "mansard/derive/detail/parting.hpp"
#include "mansard/derive/detail/regular.hpp"

namespace mansard::derive {
namespace {

using detail::Heights;
using detail::Mask;
using detail::Place;
using geometry::Polygon;

/// The cells of one building, with a rim.
struct Cutting {
  Place place;
  Mask mask;
  double height = 0, planes = 0;  ///< m above the ground, median; share of the cells that lie in planes
  geometry::Box2 within;          ///< the mesh ends there
};

struct Extent {
  std::size_t left = SIZE_MAX, right = 0, low = SIZE_MAX, high = 0;
};

auto extents_of(const Place& place, const detail::Cut& cut) -> std::vector<Extent> {
  std::vector<Extent> out(cut.height.size());
  for (std::size_t i = 0; i < cut.of.size(); ++i) {
    if (cut.of[i] == 0) continue;
    auto& extent = out[static_cast<std::size_t>(cut.of[i])];
    const std::size_t column = i % place.columns, row = i / place.columns;
    extent.left = std::min(extent.left, column), extent.right = std::max(extent.right, column);
    extent.low = std::min(extent.low, row), extent.high = std::max(extent.high, row);
  }
  return out;
}

/// Building `number` out of the whole grid, gone on a little under the higher ones that it touches: the wall between
/// two is drawn once, by the higher one, whose roof shows it.
auto cut_out(const Place& place, const detail::Cut& cut, std::size_t number, const Extent& extent, double under)
    -> Cutting {
  const std::size_t rim = place.cells(under) + 1;
  const std::size_t left = extent.left - std::min(rim, extent.left), low = extent.low - std::min(rim, extent.low);
  const std::size_t right = std::min(place.columns - 1, extent.right + rim),
                    high = std::min(place.rows - 1, extent.high + rim);
  Cutting out;
  out.place = {place.corner + place.cell * geometry::Point2{static_cast<double>(left), static_cast<double>(low)},
               place.cell, right - left + 1, high - low + 1};
  std::vector<std::size_t> of(out.place.size());
  for (std::size_t row = low; row <= high; ++row)
    for (std::size_t column = left; column <= right; ++column)
      of[out.place.index(column - left, row - low)] = static_cast<std::size_t>(cut.of[place.index(column, row)]);
  out.mask.resize(of.size());
  std::vector<bool> higher(cut.height.size(), false);
  bool any = false;
  for (std::size_t i = 0; i < of.size(); ++i) {
    out.mask[i] = of[i] == number ? 1 : 0;
    if (out.mask[i] == 0) continue;
    detail::for_neighbours(out.place, i, [&](std::size_t next) {
      const std::size_t other = of[next];
      if (other == 0 || other == number || cut.height[other] <= cut.height[number]) return;
      higher[other] = any = true;
    });
  }
  if (!any) return out;
  const auto wide = detail::grown(out.place, out.mask, under / place.cell);
  for (std::size_t i = 0; i < of.size(); ++i)
    if (wide[i] != 0 && higher[of[i]]) out.mask[i] = 1;
  return out;
}

auto outline_of(const Cutting& cutting, const Options& options, std::vector<base::Diagnostic>& warnings)
    -> base::Result<std::vector<Polygon>> {
  const std::vector<std::int32_t> numbers(cutting.mask.begin(), cutting.mask.end());
  auto drawn = detail::polygons_of(cutting.place, numbers, 2);
  if (!drawn) return drawn.error();
  std::vector<Polygon> out;
  for (auto& polygon : (*drawn)[1]) {
    std::erase_if(polygon.holes, [&](const auto& hole) { return -geometry::signed_area(hole) < options.least_area; });
    if (geometry::area(polygon) < options.least_area) continue;
    const auto regular = detail::regularised(polygon, options);
    if (!regular) warnings.push_back(detail::kept("could not be straightened", regular.error(), polygon));
    for (const auto& straight : regular ? *regular : std::vector{polygon})
      for (auto& piece : detail::clipped(straight, cutting.within, warnings)) out.push_back(std::move(piece));
  }
  return out;
}

/// One footprint before it has a name.
struct Drawn {
  Polygon polygon;
  double height = 0, planes = 0;
};

auto named(std::vector<Drawn> drawn) -> std::vector<model::Footprint> {
  const auto along = [](const Drawn& one) {
    const auto box = geometry::bounds(one.polygon.outer);
    return std::tuple(box.least.x + box.most.x - box.least.y - box.most.y, box.least.x, box.least.y);
  };
  std::ranges::stable_sort(drawn, {}, along);
  std::vector<model::Footprint> out;
  for (auto& one : drawn) {
    model::Footprint footprint;
    footprint.id = "derived-" + std::to_string(out.size() + 1);
    footprint.derived = true;
    footprint.attributes = {{"ms_derived", true},
                            {"ms_derived_height", std::round(one.height * 100) / 100},
                            {"ms_derived_planes", std::round(one.planes * 1000) / 1000}};
    footprint.polygons.push_back(std::move(one.polygon));
    out.push_back(std::move(footprint));
  }
  return out;
}

/// Median height above the ground, and share of cells in planes, of each building.
void measure(const detail::Cut& cut, const Heights& top, const Heights& ground, const Mask& planes,
             std::vector<Cutting>& cuttings) {
  std::vector<std::vector<float>> heights(cuttings.size());
  std::vector<double> in(cuttings.size(), 0);
  for (std::size_t i = 0; i < cut.of.size(); ++i) {
    const auto b = static_cast<std::size_t>(cut.of[i]);
    if (b == 0 || std::isnan(top[i])) continue;
    heights[b].push_back(top[i] - ground[i]);
    in[b] += planes[i];
  }
  for (std::size_t b = 1; b < cuttings.size(); ++b) {
    if (heights[b].empty()) continue;
    cuttings[b].planes = in[b] / static_cast<double>(heights[b].size());
    cuttings[b].height = base::median(std::move(heights[b]));
  }
}

auto nothing() -> base::Diagnostic {
  return base::error(
      "derive-nothing",
      "nothing in the mesh stands high, wide and smooth enough to be a building; see derive.above_ground, "
      "derive.least_area and derive.smooth, or give footprints");
}

}  // namespace

auto footprints(const model::Scene& scene, const Options& options, const base::Run& run) -> base::Result<Derived> {
  run.report("derive", "heights", 0);
  const Place place = detail::place_of(scene.mesh, options.cell);
  if (place.size() == 0) return nothing();
  if (static_cast<double>(place.columns) * static_cast<double>(place.rows) > options.maximum_cells)
    return base::error("derive-size", "the grid of heights would have more than " +
                                          base::to_text(options.maximum_cells / 1e6, 0) +
                                          " million cells; raise derive.cell, or give the meshes "
                                          "of a smaller area");
  const auto top = detail::top_heights(scene.mesh, place);
  if (run.cancelled()) return base::stopped();

  run.report("derive", "ground", 0.3);
  const auto ground = scene.terrain ? detail::ground_of(place, *scene.terrain) : detail::ground_of(place, top, options);
  if (run.cancelled()) return base::stopped();

  run.report("derive", "buildings", 0.5);
  const auto standing = detail::standing(top, ground, options.above_ground);
  const auto planes = detail::in_planes(place, top, standing, options);
  const auto cut = detail::cut_at_steps(place, top, detail::buildings(place, top, standing, planes, options), options);
  if (run.cancelled()) return base::stopped();

  run.report("derive", "outlines", 0.7);
  const auto extents = extents_of(place, cut);
  std::vector<Cutting> cuttings(extents.size());
  std::vector<std::vector<Polygon>> outlines(extents.size());
  std::vector<std::optional<base::Diagnostic>> failures(extents.size());
  std::vector<std::vector<base::Diagnostic>> warnings(extents.size());
  measure(cut, top, ground, planes, cuttings);
  geometry::Box2 end;
  for (const auto& vertex : scene.mesh.vertices) end.add(geometry::xy(vertex));
  base::parallel_for(extents.size(), [&](std::size_t b) {
    if (b == 0 || run.cancelled()) return;
    auto cutting = cut_out(place, cut, b, extents[b], options.underlap);
    cutting.within = end;
    auto outline = outline_of(cutting, options, warnings[b]);
    if (outline) outlines[b] = std::move(*outline);
    else failures[b] = outline.error();
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  if (run.cancelled()) return base::stopped();

  run.report("derive", "outlines", 0.9);
  std::vector<std::size_t> order(extents.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t b) { return cut.height[b]; });
  std::vector<Drawn> drawn;
  std::vector<Polygon> before;
  Derived out;
  for (const std::size_t b : order) {
    out.warnings.insert(out.warnings.end(), warnings[b].begin(), warnings[b].end());
    for (const auto& polygon : detail::parted(std::move(outlines[b]), before, options.slip_width, out.warnings)) {
      if (geometry::area(polygon) < options.least_area) continue;
      for (auto& piece : detail::simple(polygon, out.warnings)) {
        if (geometry::area(piece) < options.least_area) continue;
        before.push_back(piece);
        drawn.push_back({std::move(piece), cuttings[b].height, cuttings[b].planes});
      }
    }
  }
  if (drawn.empty()) return nothing();
  run.report("derive", "outlines", 1);
  out.footprints = named(std::move(drawn));
  return out;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"derive-nothing", "No footprint could be drawn from the mesh: nothing stands high, wide and smooth enough.",
       "Lower derive.above_ground, derive.least_area or derive.smooth, widen --bbox, or give footprints.", 5},
      {"derive-size", "The mesh is too large for a grid of heights with this cell.",
       "Raise derive.cell, or give the meshes of a smaller area.", 4},
      {"derive-outline", "The outlines of the buildings could not be drawn from the grid.",
       "The message has the library's words; raise derive.cell, and please report it.", 5},
      {"derive-outline-kept",
       "An outline could not be straightened, clipped or parted from its neighbours, because an operation on polygons "
       "failed.",
       "The message says what was left undone; look at the footprint there, and correct it by hand.", 0},
  };
}

}  // namespace mansard::derive
