// The attributes of a feature, in the order of their source.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace mansard::model {

/// A value of a feature's attribute, as the vector source has it.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;
/// In the order of the source's fields.
using Attributes = std::vector<std::pair<std::string, Value>>;

}  // namespace mansard::model
