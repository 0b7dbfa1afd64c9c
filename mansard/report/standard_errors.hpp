// How far the measures of a building may be off: standard errors from the samples of its planes and the accuracy of the
// scan.
#pragma once

#include <optional>

#include "mansard/model/accuracy.hpp"
#include "mansard/model/city.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::report {

/// What the errors follow from.
struct Evidence {
  const rays::Scene& mesh;             ///< where it shows what is built
  const model::Accuracy& accuracy;     ///< of the scan there
  std::optional<double> ground_error;  ///< m; of the height of the ground; none where nothing shows it
};

/// The attributes ms_…_se of a building with solids: m, m², m³. None of what rests on a face that the scan does not
/// show.
///
/// A face of the roof has samples on a grid, without those that the scan rounds along its boundary. Their differences
/// from the face are fitted by a plane, robustly. At a place p the face is off by that plane, which stays because it
/// was made equal to others or fits another face, and by the error of the plane itself, s² A' (1/F + (p − c)ᵀ M⁻¹ (p −
/// c)): the covariance of a plane fitted to F m² around c with second moments M (∫ (q − c)(q − c)ᵀ dF), whose noise s
/// is one error over A' m². s is that of the differences, with what the plane took of it; where they are too few, that
/// of the scan if it is more. Walls are off by the noise of edges and footprints, δ; a height where a slope meets a
/// wall by δ · slope in addition. Volume and areas add up what their faces and walls contribute, independent of each
/// other; the ground is one number. Source: the propagation of errors (C. F. Gauss, Theoria combinationis, 1823).
[[nodiscard]] auto standard_errors(const model::Building& building, const Evidence& evidence) -> model::Attributes;

}  // namespace mansard::report
