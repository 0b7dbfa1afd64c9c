// The form scores of a model, as JSON and as lines of a table.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "mansard/evaluate/form.hpp"
#include "mansard/report/evaluation.hpp"

namespace mansard::report::detail {

[[nodiscard]] auto json_of(const evaluate::Form& form) -> nlohmann::ordered_json;
/// `form`: of the model.
[[nodiscard]] auto json_of(const evaluate::FormTruth& found, const evaluate::Form& form) -> nlohmann::ordered_json;

/// What is found of the planes of one building, without those that are too small for a comparison.
[[nodiscard]] auto sum_of(const std::vector<evaluate::ComparedPlane>& planes) -> evaluate::Found;
/// "n of m": of the buildings of the truth.
[[nodiscard]] auto buildings_right(const evaluate::FormTruth& found) -> std::string;
/// Per building of the comparison: docs/evaluate.md lists its members.
[[nodiscard]] auto compared_json(const evaluate::FormTruth& found, const EvaluationInput& input)
    -> nlohmann::ordered_json;

/// A line of a table: what it is, then the value.
using Line = std::pair<std::string, std::string>;
[[nodiscard]] auto lines_of(const evaluate::Form& form) -> std::vector<Line>;
[[nodiscard]] auto lines_of(const evaluate::FormTruth& found, const evaluate::Form& form) -> std::vector<Line>;

}  // namespace mansard::report::detail
