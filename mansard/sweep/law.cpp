#include "mansard/sweep/law.hpp"

#include <algorithm>

namespace mansard::sweep {

auto decided_by(Options o, const model::Accuracy& scan) -> Options {
  // 95 % of a wall's samples. Above 0.45 m the precision and recall of sweep-edges fall (docs/sweep.md), and below the
  // default nothing is gained: walls have bays and frames.
  constexpr double most = 0.45;
  o.line_distance = std::max(o.line_distance, std::min(most, 2 * scan.noise));
  o.registration_noise = std::max(o.registration_noise, scan.edge_noise);
  return o;
}

}  // namespace mansard::sweep
