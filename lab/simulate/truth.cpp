// The steps of a truth: what stands where, solids of it, and who shares a wall with whom.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mansard/base/stopped.hpp"
#include "mansard/geometry/angles.hpp"

#include "lab/simulate/detail/details.hpp"
#include "lab/simulate/detail/raising.hpp"
#include "lab/simulate/simulate.hpp"

namespace mansard::simulate {
namespace {

using geometry::Point2;

void turn(geometry::Polygon& polygon, double angle) {
  const Point2 u{geometry::cosine(angle), geometry::sine(angle)};
  const auto turn_ring = [&](geometry::Ring& ring) {
    for (auto& p : ring) p = p.x * u + p.y * left_of(u);
  };
  turn_ring(polygon.outer);
  std::ranges::for_each(polygon.holes, turn_ring);
}

/// Every one, or the first error.
template <class Work>
auto raise_all(std::size_t count, Work work, const base::Run& run) -> base::Result<std::vector<detail::Raised>> {
  std::vector<base::Result<detail::Raised>> results(count, detail::Raised{});
  base::parallel_for(count, [&](std::size_t i) {
    if (!run.cancelled()) results[i] = work(i);
  });
  if (run.cancelled()) return base::stopped();
  std::vector<detail::Raised> raised;
  for (auto& result : results) {
    if (!result) return result.error();
    raised.push_back(std::move(*result));
  }
  return raised;
}

}  // namespace

auto make_block(Kind kind, const BlockOptions& options, std::uint64_t seed, const base::Run& run)
    -> base::Result<Truth> {
  base::Random random(seed, static_cast<std::uint64_t>(kind));
  const double drawn = random.uniform(0, std::numbers::pi / 2);
  auto houses = detail::houses_of(kind, options, random);
  detail::add_details(houses, options, random.next());
  for (auto& house : houses)
    for (auto& lot : house.lots) turn(lot.polygon, options.turn.value_or(drawn));
  auto raised = raise_all(
      houses.size(), [&](std::size_t i) { return detail::raise_house(houses[i], run); }, run);
  if (!raised) return raised.error();
  return detail::truth_over(std::move(*raised), run);
}

auto truth_of(model::City plans, const base::Run& run) -> base::Result<Truth> {
  auto raised = raise_all(
      plans.buildings.size(), [&](std::size_t b) { return detail::raise_again(plans.buildings[b], run); }, run);
  if (!raised) return raised.error();
  auto truth = detail::truth_over(std::move(*raised), run);
  truth.city.frame = plans.frame;
  truth.city.made_by = plans.made_by;
  return truth;
}

}  // namespace mansard::simulate
