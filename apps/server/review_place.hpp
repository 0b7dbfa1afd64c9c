// Where in a building a person should look first: where its scan and its model differ most, or what the scan does not
// cover.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mansard/evaluate/evaluate.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::server {

/// A building with what is around it. Where the model has nothing its height is that of the ground, as in the error of
/// a building.
struct Looked {
  const rays::Scene& model;  ///< of the building and of those that touch it
  const rays::Scene& scan;
  std::span<const geometry::Polygon> footprint;
  std::span<const geometry::Polygon> others;  ///< footprints near it
  double ground = 0;                          ///< z, m
  const evaluate::Options& options;
};

/// Model − scan at points a grid apart.
struct HeightsOver {
  geometry::Point2 origin;
  double grid = 0;  ///< m
  std::size_t columns = 0, rows = 0;
  std::vector<double> over;  ///< m; NaN where nothing is compared
  [[nodiscard]] auto at(std::size_t column, std::size_t row) const -> geometry::Point2 {
    return {origin.x + grid * static_cast<double>(column), origin.y + grid * static_cast<double>(row)};
  }
};
/// Over the footprint, without what is beside walls, as the error of a part is measured: there a scan shows either
/// side.
[[nodiscard]] auto differences_on_roof(const Looked& looked) -> HeightsOver;

enum class Doubted : std::uint8_t { roof, inside, outside, unseen };
[[nodiscard]] constexpr auto to_string(Doubted what) -> std::string_view {
  constexpr std::array<std::string_view, 4> names{"roof", "inside", "outside", "unseen"};
  return names[static_cast<std::size_t>(what)];
}

struct Place {
  geometry::Point3 at;  ///< on the scan; of what is unseen, on the model
  /// roof: away from walls · inside, outside: at the outline, where confidence measures it · unseen: without a scan
  Doubted what = Doubted::roof;
  std::optional<double>
      difference;  ///< m, model − scan, on average over a square of at most 1 m; none of what is unseen
};
/// `reason`: the code of the main reason for doubt, which says what is looked at; "" for none. Nothing where the scan
/// does not show the building at all, and it is none of the reasons.
[[nodiscard]] auto place_of(std::string_view reason, const Looked& looked) -> std::optional<Place>;

}  // namespace mansard::server
