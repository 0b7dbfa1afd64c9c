// How deep JSON of others may go.
#pragma once

#include <cstddef>
#include <string_view>

namespace mansard::base {

/// Levels of arrays and objects in one another that readers of JSON take. What copies, writes or takes apart a document
/// calls itself for each: a text of a million brackets, small as it is, would end the program on its stack.
inline constexpr std::size_t deepest_json = 1000;

/// Whether a text has more of them than so many. It need not be JSON; strings in it are skipped, which end with their
/// line if not before, so that what holds for many lines holds for each.
[[nodiscard]] auto nests_too_deep(std::string_view json, std::size_t levels = deepest_json) -> bool;

}  // namespace mansard::base
