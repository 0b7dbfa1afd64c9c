// Pictures of a run's result.
#pragma once

#include "mansard/picture/picture.hpp"
#include "mansard/report/report.hpp"

namespace mansard::report {

/// Figure 5 of the paper, twice: the scan with the footprints beside the models, from above and at an angle; and the
/// vertical error on a scale of ±`limit` metres.
struct Pictures {
  picture::Image above, angle, error;
};
[[nodiscard]] auto pictures(const Reconstruction& reconstruction, const model::Scene& scene, double limit,
                            const base::Run& run = {}) -> Pictures;

/// The models alone.
[[nodiscard]] auto picture_of(const model::City& city, const picture::View& view = {}, const base::Run& run = {})
    -> picture::Image;

}  // namespace mansard::report
