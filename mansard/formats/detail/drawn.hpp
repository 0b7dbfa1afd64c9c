// What is written of a building: its solids.
#pragma once

#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {

/// A solid as a writer takes it: `part` has its key as id, the model, and the attributes of its parts.
struct DrawnSolid {
  model::Part part;
  std::vector<std::size_t> parts;  ///< those in it, rising
};

struct Drawn {
  std::vector<DrawnSolid> solids;
  std::vector<base::Diagnostic> warnings;  ///< of solid::unite; the subject is the building's id
};

/// The union of the building's parts, or every part by itself. A building that is one solid gives it its own key; of
/// several, each has the key of its first part.
[[nodiscard]] auto drawn(const model::Building& building, const Gate::Keyed& keys, Solids solids) -> Drawn;

/// The attributes of several parts as those of one solid: least, greatest, sum or mean by ground area as the name has
/// it; what has no such rule only where all agree.
[[nodiscard]] auto merged_attributes(const std::vector<const model::Part*>& parts) -> model::Attributes;

}  // namespace mansard::formats::detail
