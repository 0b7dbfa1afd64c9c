// The form scores of a model, as JSON and as lines of a table.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "mansard/evaluate/form.hpp"

namespace mansard::report::detail {

[[nodiscard]] auto json_of(const evaluate::Form& form) -> nlohmann::ordered_json;
/// `form`: of the model.
[[nodiscard]] auto json_of(const evaluate::FormTruth& found, const evaluate::Form& form) -> nlohmann::ordered_json;

/// A line of a table: what it is, then the value.
using Line = std::pair<std::string, std::string>;
[[nodiscard]] auto lines_of(const evaluate::Form& form) -> std::vector<Line>;
[[nodiscard]] auto lines_of(const evaluate::FormTruth& found, const evaluate::Form& form) -> std::vector<Line>;

}  // namespace mansard::report::detail
