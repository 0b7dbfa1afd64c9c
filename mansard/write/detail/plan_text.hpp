// Plan + profiles as JSON and back: docs/write.md and docs/plan.schema.json describe the format.
#pragma once

#include <string>
#include <string_view>

#include "mansard/write/detail/parts.hpp"

namespace mansard::write::detail {

[[nodiscard]] auto plan_text(const City& city) -> std::string;

/// `name` is the file's, for messages. Gives up with the "write-plan-…" codes.
[[nodiscard]] auto parse_plans(std::string_view text, const std::string& name) -> base::Result<City>;
/// One plan by itself; the same codes.
[[nodiscard]] auto parse_plan(std::string_view text, const std::string& name) -> base::Result<geometry::Plan>;

}  // namespace mansard::write::detail
