// A building of a file of plans, read without a tree of its JSON: many times quicker.
#pragma once

#include <string_view>

#include "mansard/formats/json_cursor.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats::detail {

/// What read_building reads from the same text, or false, where something is unusual or wrong: read_building then says
/// what. `attributes_only`: ids and attributes of a
/// text that was read before; the rest is left out.
[[nodiscard]] auto quick_building(std::string_view text, model::Building& building, bool attributes_only = false)
    -> bool;

}  // namespace mansard::formats::detail
