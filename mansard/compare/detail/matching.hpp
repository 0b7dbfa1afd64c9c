// Which buildings of two states are on the same ground, and what all of them are displaced by.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/compare/compare.hpp"
#include "mansard/geometry/box_index.hpp"

namespace mansard::compare::detail {

/// Outlines of a state, with what is looked up in them.
class Outlines {
 public:
  explicit Outlines(const State& state);
  [[nodiscard]] auto near(const geometry::Box2& box) const -> std::vector<std::uint32_t>;
  [[nodiscard]] auto box(std::uint32_t building) const -> const geometry::Box2& { return boxes_[building]; }
  [[nodiscard]] auto area(std::uint32_t building) const -> double { return areas_[building]; }

 private:
  std::vector<geometry::Box2> boxes_;
  std::vector<double> areas_;
  geometry::BoxIndex index_;
};

struct Shared {
  std::uint32_t building = 0;
  double area = 0;  ///< m²
};

struct Matching {
  /// By the buildings of each state: those of the other one that have half of the ground of either in common, those
  /// with most of it first.
  std::vector<std::vector<Shared>> of_new, of_old;
};
/// `shift` is what the old outlines are moved by.
[[nodiscard]] auto matched(const State& old, const Outlines& old_outlines, const State& now,
                           const Outlines& new_outlines, geometry::Point2 shift) -> Matching;

/// Medians of the displacement of outlines that are alike.
[[nodiscard]] auto displacement(const State& old, const Outlines& old_outlines, const State& now,
                                const Outlines& new_outlines, const Matching& matching) -> Offset;

/// The median, and the standard error of it by the median absolute deviation.
struct Middle {
  double value = 0, spread = 0, error = 0;
};
[[nodiscard]] auto middle_of(std::vector<double> values) -> Middle;

/// A median of so many values is not moved by two that are changed.
inline constexpr std::size_t least_buildings = 5;

}  // namespace mansard::compare::detail
