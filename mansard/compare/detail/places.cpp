#include "mansard/compare/detail/places.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mansard/base/statistics.hpp"

namespace mansard::compare::detail {
namespace {

/// m; lower is no building: a platform, a terrace, a roof that is down.
constexpr double lowest_building = 1.5;
constexpr double most_places = 4000;

/// The least of the differences where all have one direction.
auto least(std::initializer_list<std::optional<double>> old, std::initializer_list<std::optional<double>> now)
    -> double {
  double out = 0;
  bool first = true;
  for (const auto& o : old)
    for (const auto& n : now) {
      if (!o || !n) continue;
      const double d = *n - *o;
      if (first) out = d;
      else if ((d > 0) != (out > 0)) return 0;
      else if (std::abs(d) < std::abs(out)) out = d;
      first = false;
    }
  return out;
}

/// What both states have at a place of the ground.
auto place_at(geometry::Point2 at, const Ground& ground, const Surfaces& old, const Surfaces& now) -> Place {
  Place out;
  const auto old_scan = old.scan(at), new_scan = now.scan(at);
  auto old_model = ground.old_contains(at) ? old.model(at) : std::nullopt;
  auto new_model = ground.new_contains(at) ? now.model(at) : std::nullopt;
  // A footprint without a model: what the scan shows is all there is. Beside all footprints it is the ground.
  if (!ground.old_contains(at)) old_model = ground.old_ground;
  if (!ground.new_contains(at)) new_model = ground.new_ground;
  const auto old_top = old_model ? old_model : old_scan, new_top = new_model ? new_model : new_scan;
  if (!old_top || !new_top) return out;
  out.old_seen = old_scan.has_value();
  out.new_seen = new_scan.has_value();
  out.modelled = old_model && new_model;
  const bool was = *old_top - ground.old_ground >= lowest_building,
             is = *new_top - ground.new_ground >= lowest_building;
  if (!was && !is) return out;
  out.of = was && is ? Of::both : is ? Of::new_only : Of::old_only;
  out.models = *new_top - *old_top;
  out.difference = least({old_model, old_scan}, {new_model, new_scan});
  return out;
}

}  // namespace

Surfaces::Surfaces(const State& state, geometry::Point2 shift, double lift)
    : models_(state.models),
      scan_(state.scan),
      shift_(shift),
      to_scan_(state.accuracy.offset),
      lift_(lift),
      has_scan_(!state.scan.triangles.empty()) {}

auto Surfaces::model(geometry::Point2 at) const -> std::optional<double> {
  auto z = models_.top(at - shift_);
  if (z) *z += lift_;
  return z;
}

auto Surfaces::scan(geometry::Point2 at) const -> std::optional<double> {
  if (!has_scan_) return std::nullopt;
  auto z = scan_.top(at - shift_ + to_scan_);
  if (z) *z += lift_;
  return z;
}

auto Places::count(Of of) const -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count(all, of, &Place::of));
}

auto places_of(const Ground& ground, const Surfaces& old, const Surfaces& now) -> Places {
  Places out;
  // Whole multiples of the finest grid, so that a large building has the same places in any frame.
  out.step = finest_step * std::ceil(std::max(1.0, std::sqrt(ground.area / most_places) / finest_step));
  if (ground.box.empty()) return out;
  const double west = std::floor(ground.box.least.x / out.step), south = std::floor(ground.box.least.y / out.step);
  out.columns = static_cast<std::size_t>(std::ceil(ground.box.most.x / out.step) - west);
  out.rows = static_cast<std::size_t>(std::ceil(ground.box.most.y / out.step) - south);
  out.all.resize(out.columns * out.rows);
  for (std::size_t j = 0; j < out.rows; ++j)
    for (std::size_t i = 0; i < out.columns; ++i) {
      const geometry::Point2 at{(west + static_cast<double>(i) + 0.5) * out.step,
                                (south + static_cast<double>(j) + 0.5) * out.step};
      if (ground.contains(at)) out.all[j * out.columns + i] = place_at(at, ground, old, now);
    }
  return out;
}

auto opened(const Places& places, const std::vector<bool>& marked, double radius, std::optional<Of> only)
    -> std::vector<bool> {
  const auto reach = static_cast<std::ptrdiff_t>(std::floor(radius / places.step));
  std::vector<std::array<std::ptrdiff_t, 2>> disc;
  for (std::ptrdiff_t y = -reach; y <= reach; ++y)
    for (std::ptrdiff_t x = -reach; x <= reach; ++x)
      if (static_cast<double>(x * x + y * y) * places.step * places.step <= radius * radius) disc.push_back({x, y});
  const auto columns = static_cast<std::ptrdiff_t>(places.columns), rows = static_cast<std::ptrdiff_t>(places.rows);
  std::vector<bool> out(marked.size());
  for (std::ptrdiff_t j = 0; j < rows; ++j)
    for (std::ptrdiff_t i = 0; i < columns; ++i) {
      if (!marked[static_cast<std::size_t>(j * columns + i)]) continue;
      const auto number = [&](const auto& step) -> std::optional<std::size_t> {
        const auto x = i + step[0], y = j + step[1];
        if (x < 0 || y < 0 || x >= columns || y >= rows) return std::nullopt;
        return static_cast<std::size_t>(y * columns + x);
      };
      // At a straight edge of the places that matter half of a disc is all that there can be.
      std::size_t inside = 0;
      const bool fits = std::ranges::all_of(disc, [&](const auto& step) {
        const auto at = number(step);
        if (at && marked[*at]) return ++inside > 0;
        return only && (!at || places.all[*at].of != *only);
      });
      if (!fits || 2 * inside < disc.size()) continue;
      for (const auto& step : disc)
        if (const auto at = number(step); at && marked[*at]) out[*at] = true;
    }
  return out;
}

auto slope_of_difference(const Places& places, const std::vector<bool>& marked) -> double {
  std::vector<double> slopes;
  for (std::size_t j = 1; j + 1 < places.rows; ++j)
    for (std::size_t i = 1; i + 1 < places.columns; ++i) {
      const auto at = j * places.columns + i;
      const auto usable = [&](std::size_t n) { return marked[n] && places.all[n].modelled; };
      if (!usable(at) || !usable(at - 1) || !usable(at + 1) || !usable(at - places.columns) ||
          !usable(at + places.columns))
        continue;
      const double x = places.all[at + 1].models - places.all[at - 1].models,
                   y = places.all[at + places.columns].models - places.all[at - places.columns].models;
      slopes.push_back(std::sqrt(x * x + y * y) / (2 * places.step));
    }
  return slopes.empty() ? 0 : base::median(std::move(slopes));
}

}  // namespace mansard::compare::detail
