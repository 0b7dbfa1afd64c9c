#include "lab/simulate/detail/details.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/geometry/angles.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Point2;

/// The rectangle of a lot: its front from `origin` along u, deep to the left of u.
struct Site {
  Point2 origin, u;
  double length = 0, depth = 0;

  [[nodiscard]] auto rectangle(double from, double near, double to, double far) const -> geometry::Ring {
    const auto at = [&](double along, double deep) { return origin + along * u + deep * left_of(u); };
    return {at(from, near), at(to, near), at(to, far), at(from, far)};
  }
  /// The same seen from the back.
  [[nodiscard]] auto turned() const -> Site {
    return {origin + length * u + depth * left_of(u), -1 * u, length, depth};
  }
};

auto site_of(const Lot& lot) -> std::optional<Site> {
  const auto& ring = lot.polygon.outer;
  if (ring.size() != 4 || !lot.polygon.holes.empty()) return std::nullopt;
  return Site{ring[0], normalised(ring[1] - ring[0]), geometry::length(ring[1] - ring[0]),
              geometry::length(ring[2] - ring[1])};
}

auto is_gable_along(const Lot& lot) -> bool {
  return lot.roof == Roof::pitched && lot.upright == std::vector<bool>{false, true, false, true};
}

class Details {
 public:
  Details(const BlockOptions& options, std::uint64_t seed, std::size_t house)
      : options_(options), random_(seed, house) {}

  void add(House& house) {
    // Every kind is drawn whether or not it is requested, so that one option does not change another's result.
    const double bay = random_.uniform(), extension = random_.uniform(), plant = random_.uniform();
    const double front = random_.uniform(), back = random_.uniform();
    const auto site = site_of(house.lots.front());
    if (!site || house.lots.front().role != "house") return;
    if (bay < options_.bays) add_bay(house, *site);
    if (extension < options_.extensions && house.lots.size() == 1 + house_bays_) add_extension(house, *site);
    if (plant < options_.plant_rooms) add_plant_room(house, *site);
    if (!is_gable_along(house.lots.front())) return;
    if (front < options_.dormers) add_dormers(house, *site);
    if (back < options_.dormers) add_dormers(house, site->turned());
  }

 private:
  /// Before the front, lower than the eaves.
  void add_bay(House& house, const Site& site) {
    const double wide = random_.uniform(1.8, 3), out = random_.uniform(0.6, 1.2);
    const double at = random_.uniform(0.4, std::max(0.4, site.length - wide - 0.4));
    const double most = house.lots.front().eaves - 0.5;
    if (wide + 0.8 > site.length || most < 2.6) return;
    Lot lot;
    lot.role = "bay window";
    lot.polygon.outer = site.rectangle(at, -out, at + wide, 0);
    lot.eaves = random_.uniform(2.6, most);
    house.lots.push_back(std::move(lot));
    ++house_bays_;
  }

  /// Behind the back, over the whole width or half of it.
  void add_extension(House& house, const Site& site) {
    const double deep = random_.uniform(0.8, 2.4), kind = random_.uniform(), side = random_.uniform();
    const double wide = kind < 0.5 ? site.length : random_.uniform(0.4, 0.7) * site.length;
    const double from = side < 0.5 ? 0 : site.length - wide;
    Lot lot;
    lot.role = "extension";
    lot.polygon.outer = site.rectangle(from, site.depth, from + wide, site.depth + deep);
    lot.eaves = random_.uniform(2.4, std::max(2.5, 0.75 * house.lots.front().eaves));
    house.lots.push_back(std::move(lot));
  }

  void add_plant_room(House& house, const Site& site) {
    const Lot& below = house.lots.front();
    const double wide = random_.uniform(2, 4), deep = random_.uniform(2, 4), free = 1.2;
    const double high = random_.uniform(2, 3), along = random_.uniform(), across = random_.uniform();
    if (below.roof != Roof::flat || wide + 2 * free > site.length || deep + 2 * free > site.depth) return;
    const double x = free + along * (site.length - wide - 2 * free), y = free + across * (site.depth - deep - 2 * free);
    Lot lot;
    lot.role = "plant room";
    lot.polygon.outer = site.rectangle(x, y, x + wide, y + deep);
    lot.base = below.eaves;
    lot.eaves = below.eaves + high;
    house.lots.push_back(std::move(lot));
  }

  /// A row of equal ones on the slope that rises from the front.
  void add_dormers(House& house, const Site& site) {
    const Lot roof = house.lots.front();  // a copy: a vector that grows moves what it holds
    const double slope = geometry::tangent(roof.pitch), start = roof.gutter ? 0.3 : 0;
    const double set_back = start + random_.uniform(0.4, 0.9), high = random_.uniform(1.2, 1.6);
    const double spacing = random_.uniform(2.6, 3.6), wish = random_.uniform(1.2, 2.4), gable = random_.uniform();
    const auto count = static_cast<int>((site.length - 0.6) / spacing);
    if (count < 1) return;
    const double wide = std::min(wish, site.length / count - 0.8);
    if (wide < 1.2) return;
    const bool gabled = gable < 0.4;
    const double rise = gabled ? wide / 2 * geometry::tangent(35 * degree) : 0;
    const double ridge = slope * (site.depth / 2 - start), at_front = slope * (set_back - start);
    if (at_front + high + rise > ridge - 0.4) return;  // it would not end below the ridge
    constexpr double sunk = 0.3;                       // m; how far it reaches into the roof
    const double far = set_back + (high + rise) / slope + 0.2;
    for (int k = 0; k < count; ++k) {
      const double middle = (k + 0.5) * site.length / count;
      Lot lot;
      lot.role = "dormer";
      lot.polygon.outer = site.rectangle(middle - wide / 2, set_back, middle + wide / 2, far);
      lot.base = roof.eaves + at_front - sunk;
      lot.eaves = roof.eaves + at_front + high;
      if (gabled) {
        lot.roof = Roof::pitched;
        lot.pitch = 35 * degree;
        lot.upright = {true, false, true, false};
      }
      house.lots.push_back(std::move(lot));
    }
  }

  const BlockOptions& options_;
  base::Random random_;
  std::size_t house_bays_ = 0;
};

}  // namespace

void add_details(std::vector<House>& houses, const BlockOptions& options, std::uint64_t seed) {
  for (std::size_t h = 0; h < houses.size(); ++h) {
    Details(options, seed, h).add(houses[h]);
    for (auto& lot : houses[h].lots)
      if (lot.role == "house" && lot.roof == Roof::pitched && !lot.gutter) lot.overhang = options.overhang;
  }
}

}  // namespace mansard::simulate::detail
