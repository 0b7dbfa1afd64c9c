#include "mansard/refine/detail/judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "mansard/refine/detail/blur.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/strips.hpp"

namespace mansard::refine::detail {
namespace {

/// Working memory that a thread keeps, for a few rows at a time: grids of large parts do not fit into a cache.
struct Scratch {
  std::vector<double> heights;  // m above the base, with two cells of nothing on both sides
  std::array<std::vector<double>, 2 * blur_reach + 1> sums;  // along the last rows
  std::vector<double> losses;                                // m²
};
auto scratch() -> Scratch& {
  thread_local Scratch one;
  return one;
}

/// The weighed losses of some cells of a row. No branches, and nothing overlaps: the compiler takes several at a time.
void losses_of(std::size_t count, const Kernel& kernel, const std::array<const double*, 2 * blur_reach + 1>& sums,
               const double* unblurred, const double* measured, const double* weights, const double* limits,
               double robust, double* __restrict out) {
  const auto [before_2, before, here, after, after_2] = sums;
  for (std::size_t i = 0; i < count; ++i) {
    const double shown = unblurred[i] * (kernel.here * here[i] + kernel.beside * (before[i] + after[i]) +
                                         kernel.beyond * (before_2[i] + after_2[i]));
    const double off = shown - measured[i], d = std::abs(off);
    const double least = std::min(d, limit_of(off, limits[i], robust));
    out[i] = weights[i] * (least * (2 * d - least));  // loss(): d · (2 d − d) or limit · (2 d − limit)
  }
}

/// Chords of a curve are one edge. A wall within a profile is said with the level before it, which ends there: it has
/// no numbers of its own.
auto priced_faces(const FaceStrips& strips, const model::Solid& sketch) -> double {
  std::vector<bool> priced(strips.count, false);
  for (std::size_t f = 0; f < sketch.faces.size(); ++f) {
    const auto& face = sketch.faces[f];
    if (!(face.provenance && face.provenance->part > 0 && std::abs(face.normal.z) <= wall_normal))
      priced[strips.of_face[f]] = true;
  }
  return static_cast<double>(std::ranges::count(priced, true));
}

}  // namespace

auto Judge::loss_at(const View& view, std::size_t sample, double cap) const -> double {
  const double roof = view.z_at[sample];  // NaN past the solid, which falls to its base there
  return site_.weight[sample] *
         stray_loss((roof == roof ? std::min(roof, cap) : 0) - site_.z[sample], options_.samples.stray);
}

auto Judge::reducible_at(const Judged& judged, std::size_t i) const -> double {
  const double d = judged.view.z_of(site_, i) - site_.z[i];
  if (d != d) return 0;
  if (!site_.of_points) return site_.weight[i] * loss(d, limit_of(d, site_.limits[site_.cells[i]], options_.robust));
  const auto plane = site_.plane_of[i];
  double out = stray_loss(d, options_.samples.stray);
  if (plane < site_.planes.size())
    out -= stray_loss(site_.planes[plane].at(site_.places[i]) - site_.base - site_.z[i], options_.samples.stray);
  return site_.weight[i] * out;
}

auto Judge::reducible(const Judged& judged) const -> double {
  if (!site_.of_points) return judged.misfit;
  double of_none = 0;
  std::vector<double> by_plane(site_.planes.size(), 0);
  for (std::size_t i = 0; i < site_.z.size(); ++i) {
    const auto plane = site_.plane_of[i];
    (plane < by_plane.size() ? by_plane[plane] : of_none) += reducible_at(judged, i);
  }
  for (const double of_plane : by_plane) of_none += std::max(0.0, of_plane);
  return of_none * site_.sample_area;
}

auto Judge::with_ceilings(const View& view, double cap, double misfit) const -> double {
  for (const auto& [cell, ceiling] : site_.ceilings)
    if (const double above = std::min(view.z[cell], cap) - ceiling; above > 0)
      misfit += loss(above, options_.robust) * site_.cell_area;
  return misfit;
}

auto Judge::misfit_of_points(const model::Solid& sketch, View& view, double most, double paid) const -> double {
  constexpr std::size_t at_once = 256;
  SampleViews samples(sketch, site_, view);
  double sum = 0;
  for (std::size_t first = 0, last = 0; first < site_.z.size(); first = last) {
    last = std::min(first + at_once, site_.z.size());
    samples.see(first, last);
    for (std::size_t i = first; i < last; ++i) sum += loss_at(view, i, std::numeric_limits<double>::infinity());
    if (sum * site_.sample_area + paid >= most) return sum * site_.sample_area;
  }
  return with_ceilings(view, std::numeric_limits<double>::infinity(), sum * site_.sample_area);
}

auto Judge::misfit_of(const View& view, double cap, double most, double paid) const -> double {
  const auto& z = view.z;
  if (site_.of_points) {
    double sum = 0;
    for (std::size_t i = 0; i < site_.z.size(); ++i) sum += loss_at(view, i, cap);
    return with_ceilings(view, cap, sum * site_.sample_area);
  }
  // The heights as the scan would have them, smoothed as it was measured to smooth. Else a slope would suit the scan of
  // a step better than the step. A sample past the solid (its outline is rounded by some millimetres) falls to its
  // base.
  const auto& grid = site_.measured;
  auto& [heights, sums, losses] = scratch();
  heights.assign(grid.columns + 2 * blur_reach, 0);
  for (auto& row : sums) row.assign(heights.size(), 0);
  losses.resize(grid.columns);
  const double robust = options_.robust;
  double sum = 0;
  // Whole rows, with a weight of nothing where there is no sample. The sum is in the order of the cells. No loss is
  // negative, so that what is too much already stays that.
  for (std::size_t row = 0; row < grid.rows + blur_reach; ++row) {
    auto& newest = sums[row % sums.size()];
    if (row < grid.rows) {
      const double *from = &z[row * grid.columns], *inside = &site_.unblurred[row * grid.columns];
      double* to = &heights[blur_reach];
      for (std::size_t column = 0; column < grid.columns; ++column) {
        const double height = from[column];
        to[column] = inside[column] > 0 && height == height ? std::min(height, cap) : 0.0;
      }
      blur_rows(site_.kernel, heights, newest);
    } else {
      std::ranges::fill(newest, 0.0);
    }
    if (row < blur_reach) continue;
    const std::size_t seen = row - blur_reach, start = seen * grid.columns;
    const auto [first, last] = site_.extents[seen];
    std::array<const double*, 2 * blur_reach + 1> around{};  // those of row − 4, which is as good as row + 1, … row
    for (std::size_t k = 0; k < around.size(); ++k) around[k] = &sums[(row + 1 + k) % sums.size()][blur_reach + first];
    losses_of(last - first, site_.kernel, around, &site_.unblurred[start + first], &site_.heights[start + first],
              &site_.weights[start + first], &site_.limits[start + first], robust, losses.data());
    for (std::size_t i = 0; i < last - first; ++i) sum += losses[i];
    if (sum * site_.cell_area + paid >= most) return sum * site_.cell_area;
  }
  // A roof is under the crown that hides it.
  for (const auto& [cell, ceiling] : site_.ceilings)
    if (const double above = std::min(z[cell], cap) - ceiling; above > 0) sum += loss(above, robust);
  return sum * site_.cell_area;
}

auto Judge::operator()(const model::Plan& plan) const -> base::Result<Judged> {
  pay_for(plan);
  constexpr double any = std::numeric_limits<double>::infinity();
  if (auto judged = again(plan, any)) return std::move(*judged);
  auto sketch = extrude::sketch(plan, raising_, run_);
  if (!sketch) return sketch.error();
  auto judged = of(plan, std::move(*sketch), any);
  if (!judged) return base::error("extrude-no-area", "the roof cannot be compared with the mesh");
  return *std::move(judged);
}

auto Judge::cheaper(const model::Plan& plan, double than) const -> std::optional<Judged> {
  pay_for(plan);
  const double most = than - options_.same_cost;
  if (known_ && known_->costs_at_least(plan) >= most) return std::nullopt;
  auto judged = again(plan, most);
  if (!judged) {
    auto sketch = extrude::sketch(plan, raising_, run_);
    if (!sketch) return std::nullopt;
    judged = of(plan, std::move(*sketch), most);
  }
  if (judged && detail::cheaper(judged->cost, than, options_.same_cost)) return judged;
  if (known_) known_->add_too_dear(plan, most);
  return std::nullopt;
}

auto Judge::again(const model::Plan& plan, double most) const -> std::optional<Judged> {
  const Known* known = known_ ? known_->find(plan) : nullptr;
  if (!known) return std::nullopt;
  Judged out{plan, known->sketch, {}, known->misfit, known->bare, 0, 0};
  price(out, options_.face_price * priced_faces(strips_of(plan, out.sketch), out.sketch));
  if (out.cost < most) out.view = view_of(out.sketch, site_);
  return out;
}

auto Judge::of(const model::Plan& plan, model::Solid sketch, double most) const -> std::optional<Judged> {
  // Sums of what is not negative, rounded, do not fall by what is added: each bound is one of the cost as priced below.
  const auto strips = strips_of(plan, sketch);
  const double faces = options_.face_price * priced_faces(strips, sketch);
  if (faces >= most) return std::nullopt;
  Judged out{plan, std::move(sketch), {}, 0, {}, 0, 0};
  out.view = cells_of(out.sketch, site_);
  out.misfit = site_.of_points ? misfit_of_points(out.sketch, out.view, most, faces)
                               : misfit_of(out.view, std::numeric_limits<double>::infinity(), most, faces);
  if (out.misfit + faces >= most) return std::nullopt;
  out.bare = bare_faces(strips, out.sketch, out.view, site_, options_);
  price(out, faces);
  if (known_) known_->add({plan, out.sketch, out.misfit, out.bare});
  return out;
}

void Judge::price(Judged& judged, double faces) const {
  // Evidence would have to come from elsewhere: as dear as a part.
  judged.unsupported = options_.part_price * static_cast<double>(judged.bare.size());
  judged.cost = judged.unsupported + judged.misfit + faces;
}

}  // namespace mansard::refine::detail
