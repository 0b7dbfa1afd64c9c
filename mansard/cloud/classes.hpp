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

/// What points of a class are, and with that what is made of them.
enum class Use : std::uint8_t {
  terrain,
  buildings,
  surface,     ///< water, roads, rails, bridges, civil structures: neither buildings nor the terrain
  vegetation,  ///< left out
  wires,       ///< and their masts: left out
  outliers,    ///< noise: left out
  undecided,   ///< the class does not say: a surface only where buildings are found by shape
};
/// Of a class as the map has it.
[[nodiscard]] constexpr auto use_of(std::uint8_t classification) -> Use {
  switch (classification) {
    case ground: return Use::terrain;
    case building: return Use::buildings;
    case 9:
    case 10:
    case 11:
    case 17:
    case 26: return Use::surface;
    case 3:
    case 4:
    case 5: return Use::vegetation;
    case 13:
    case 14:
    case 15:
    case 16: return Use::wires;
    case noise:
    case 18: return Use::outliers;
    default: return Use::undecided;
  }
}

/// By the class in the file, the one that it is taken for.
using ClassMap = std::array<std::uint8_t, 256>;

/// From the lists of classes in the options, which are `building`, `ground` and `noise`. Classes 6 and 2 are
/// `unclassified` where their lists have them not; all others stay. Fails with "option-value" for what is no class, and
/// for a class in two lists.
[[nodiscard]] auto class_map(const Options& options) -> base::Result<ClassMap>;

/// Whether any points are of a class that can be the ground beside a building: ground, water, roads, rails, bridges.
/// `counts`: of points by the class that they are taken for.
[[nodiscard]] auto any_ground(const std::array<std::uint64_t, 256>& counts) -> bool;

/// The name that the specification gives a class, in lower case; empty for one that it reserves or leaves to users.
[[nodiscard]] auto class_name(std::uint8_t classification) -> std::string_view;

/// The classes found with their shares and what each is used for, the most frequent first; empty without points.
/// `counts`: of points by the class in the file.
[[nodiscard]] auto classes_in_words(const std::array<std::uint64_t, 256>& counts, const ClassMap& map) -> std::string;

/// Of those that have no name and are not in the map, the numbers with their counts; empty where there are none.
[[nodiscard]] auto unknown_classes(const std::array<std::uint64_t, 256>& counts, const ClassMap& map) -> std::string;

}  // namespace mansard::cloud
