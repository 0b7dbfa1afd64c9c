// A picture of the roof planes that a model and the truth do not have in common.
#pragma once

#include <string>
#include <vector>

#include "mansard/picture/picture.hpp"
#include "mansard/report/evaluation.hpp"

namespace mansard::report {

/// The id of a building of a comparison: that of the truth, otherwise that of the model.
[[nodiscard]] auto id_of(const evaluate::ComparedBuilding& building, const EvaluationInput& input) -> std::string;

/// Per building the planes of the truth beside those of the model, in plan; those that are not found in the other are
/// red and have their pitch and their mean height above ground. Only buildings with such planes, those with most of
/// them first, of equal numbers those with the larger area of them; at most `most`. The evaluation must have a truth.
[[nodiscard]] auto plane_plans(const Evaluation& evaluation, const EvaluationInput& input, std::size_t most)
    -> picture::Image;

}  // namespace mansard::report
