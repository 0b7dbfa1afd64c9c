// What the classes of a point cloud mean. Reference: ASPRS, LAS Specification 1.4 – R15, table 17.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/cloud/cloud.hpp"

namespace mansard::cloud {

inline constexpr std::uint8_t unclassified = 1, ground = 2, building = 6, noise = 7;

/// By the class in the file, the one that it is taken for.
using ClassMap = std::array<std::uint8_t, 256>;

/// From the lists of classes in the options, which are `building`, `ground` and `noise`. Classes 6 and 2 are
/// `unclassified` where their lists have them not; all others stay. Fails with "option-value" for what is no class, and
/// for a class in two lists.
[[nodiscard]] auto class_map(const Options& options) -> base::Result<ClassMap>;

/// Whether any points are of a class that can be the ground beside a building: ground, water, roads, rails, bridges.
/// `counts`: of points by the class that they are taken for.
[[nodiscard]] auto any_ground(const std::array<std::uint64_t, 256>& counts) -> bool;

/// Whether a class, as the map has it, neither says that a point is of a building nor that it is not: such points are
/// surface only where buildings are found by shape.
[[nodiscard]] auto is_undecided(std::uint8_t classification) -> bool;

/// The name that the specification gives a class, in lower case; empty for one that it reserves or leaves to users.
[[nodiscard]] auto class_name(std::uint8_t classification) -> std::string_view;

/// The classes found with their shares and what each is used for, the most frequent first; empty without points.
/// `counts`: of points by the class in the file.
[[nodiscard]] auto classes_in_words(const std::array<std::uint64_t, 256>& counts, const ClassMap& map) -> std::string;

/// Of those that have no name and are not in the map, the numbers with their counts; empty where there are none.
[[nodiscard]] auto unknown_classes(const std::array<std::uint64_t, 256>& counts, const ClassMap& map) -> std::string;

}  // namespace mansard::cloud
