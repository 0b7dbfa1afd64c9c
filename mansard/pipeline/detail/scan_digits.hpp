// Digits that the coordinates of a scan have lost.
#pragma once

#include <array>
#include <optional>

#include "mansard/model/scene.hpp"
#include "mansard/pipeline/detail/scan_sample.hpp"

namespace mansard::pipeline::detail {

struct LostDigits {
  std::array<double, 3> steps{};  ///< m; of x, y and z; 0 where they are fine enough
  double noise = 0;               ///< m; of the scan
};
/// The steps on which vertices or points lie, of those that are more than 1 cm and say more than the noise does. None
/// where there are none, and of exact models: the corners of these may be anywhere, also at whole metres.
[[nodiscard]] auto lost_digits(const model::Scene& scene, const ScanSample& sample) -> std::optional<LostDigits>;

}  // namespace mansard::pipeline::detail
