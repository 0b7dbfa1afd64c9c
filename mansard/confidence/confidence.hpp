// How sure a model of a building is: the probability that it is right, the error to expect, and the reasons in words.
// References: D. Cox, The regression analysis of binary sequences (1958), for the logistic model; docs/confidence.md
// says what it was trained on, how to train it again, and how well it is calibrated.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/confidence/evidence.hpp"

namespace mansard::confidence {

/// m²; a model is wrong whose mean squared vertical error against the truth is above this, 0.3 m inside its outline.
inline constexpr double wrong_above = 0.5;

struct Confidence {
  double right = 0;  ///< probability that the model is right
  double error = 0;  ///< m; root mean square vertical error to expect, the median of what such evidence was seen with
  /// What speaks against it, the strongest first: that which makes it at least twice as likely to be wrong, where
  /// something is to be doubted at all.
  std::vector<base::Diagnostic> reasons;
};
/// Guarantee: a function of the evidence alone.
[[nodiscard]] auto confidence_of(const Evidence& evidence) -> Confidence;

/// "high" (0.85 and more), "medium" (0.5 and more) or "low".
[[nodiscard]] auto class_of(double right) -> std::string_view;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::confidence
