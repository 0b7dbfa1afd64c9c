// Plan + profiles as JSON: whole files, and single plans; written and read back.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/model/city.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::formats {

/// Plan + profiles: a small JSON of its own, documented in docs/formats.md; the source of truth of every part.
[[nodiscard]] auto plans(const model::City& city) -> std::string;

/// Reads plan + profiles back: buildings and parts with plans but without models; from a file of plans, or from the
/// plans that travel in our CityJSON. Fails with "write-plan-…", one diagnostic for every part that is at fault.
[[nodiscard]] auto read_plans(const std::filesystem::path& path) -> base::Result<model::City>;

/// One plan on one line, as the member "plan" of a plans.json has it: numbers read back as the very same doubles.
[[nodiscard]] auto plan_json(const model::Plan& plan) -> std::string;
/// Reads one plan back, as strictly as a file of them; `name` is what messages call its place. Fails with
/// "write-plan-…".
[[nodiscard]] auto read_plan(std::string_view json, const std::string& name) -> base::Result<model::Plan>;

}  // namespace mansard::formats
