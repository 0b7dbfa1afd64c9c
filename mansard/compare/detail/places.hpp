// The ground of a building as square places, with the heights that both states have there.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mansard/compare/compare.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::compare::detail {

/// The surfaces of a state, ready to be asked.
class Surfaces {
 public:
  Surfaces(const State& state, geometry::Point2 shift, double lift);
  /// z of the models, and of the scan, in the frame of the new state.
  [[nodiscard]] auto model(geometry::Point2 at) const -> std::optional<double>;
  [[nodiscard]] auto scan(geometry::Point2 at) const -> std::optional<double>;
  [[nodiscard]] auto has_scan() const -> bool { return has_scan_; }
  void move(geometry::Point2 shift, double lift) { shift_ = shift, lift_ = lift; }

 private:
  rays::Scene models_, scan_;
  geometry::Point2 shift_, to_scan_;
  double lift_ = 0;
  bool has_scan_ = false;
};

enum class Of : std::uint8_t { nothing, both, new_only, old_only };

struct Place {
  Of of = Of::nothing;
  double models = 0;      ///< m; new − old of the models
  double difference = 0;  ///< m; the least of all pairs of an old and a new surface; 0 where they disagree
  bool modelled = false;  ///< both heights are of models, or of ground beside them
  bool old_seen = false, new_seen = false;  ///< the scan covers it
};

/// Row by row from the south.
struct Places {
  double step = 0.25;  ///< m
  std::size_t columns = 0, rows = 0;
  std::vector<Place> all;
  [[nodiscard]] auto count(Of of) const -> std::size_t;
};

/// Whose ground is compared, and its ground height in both states.
struct Ground {
  geometry::Box2 box;
  std::function<bool(geometry::Point2)> contains;
  std::function<bool(geometry::Point2)> old_contains, new_contains;  ///< outlines of any building of the state
  double old_ground = 0, new_ground = 0;                             ///< m
  double area = 0;                                                   ///< m², about
};
inline constexpr double finest_step = 0.25;  ///< m; as evaluate.grid
[[nodiscard]] auto places_of(const Ground& ground, const Surfaces& old, const Surfaces& now) -> Places;

/// Which of the marked places are in a disc of that radius, m, of marked ones. With `only`, places that are not of that
/// kind do not matter to a disc, of which half is marked then.
[[nodiscard]] auto opened(const Places& places, const std::vector<bool>& marked, double radius, std::optional<Of> only)
    -> std::vector<bool>;

/// The median slope of the difference of both models over the marked places.
[[nodiscard]] auto slope_of_difference(const Places& places, const std::vector<bool>& marked) -> double;

}  // namespace mansard::compare::detail
