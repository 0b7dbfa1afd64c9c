// A term of the model of confidence.
#pragma once

#include "mansard/confidence/evidence.hpp"

namespace mansard::confidence::detail {

struct Term {
  Measure measure;
  Measure second;       ///< by which it is multiplied; `alone` for none
  double scale;         ///< of their units: they count as ln(1 + |x| / scale)
  double usual;         ///< mean of that among the models that were right
  double wrong, error;  ///< weights: logarithm of the odds to be wrong, and of the error in metres
};
inline constexpr auto alone = static_cast<Measure>(measures);

}  // namespace mansard::confidence::detail
